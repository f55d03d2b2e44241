"""Lessons: what was learned of one agent, or of one part of a transition, is known of all that are like it.

The rules of a mission are the same under an exchange of names that its text, its environment and their kinds do not
distinguish. So what was recorded of one of fifty agents holds, renamed, for each whose cells answer the renamed
questions alike. A lesson is kept in the names of the first of them, and in values: each has columns of its own.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from checker.engines.fast.columns import ABSENT, Place
from checker.engines.fast.recording import Ask, Edited
from checker.engines.fast.skeletons import put_together, taken_apart
from checker.reduction.renaming import WORD, Renaming, asked
from semantics.behaviours.observations import AGENT
from semantics.state.cells import Cell
from semantics.state.configuration import Label
from semantics.state.requests import REQUESTS
from semantics.state.signature import Name

_QUOTED = re.compile(r'("(?:[^"\\]|\\.)*")')
"""A text as it is printed."""


class NoImage(Exception):
    """Something has no image under an exchange, or it can't be told."""


@lru_cache(maxsize=1 << 16)
def names_in(value: Any) -> frozenset[Any]:
    """Return the names that a value mentions; raises NoImage where that can't be told."""
    try:
        found = asked(lambda renaming: renaming.value(value))
    except TypeError:
        raise NoImage from None
    return frozenset(each.removeprefix(AGENT) if isinstance(each, str) else each for each in found)


@dataclass(frozen=True)
class Exchange:
    """An exchange of names under which the rules are the same, as it changes what a rule reads and writes.

    Attributes:
        mobile: The names that observations are taken apart by.
        unordered: Whether requests in line have an order of their own.
        renaming: The names, and the statements and variables that go with them.
    """

    mobile: frozenset[Name]
    unordered: bool
    renaming: Renaming = field(default_factory=Renaming)

    @cached_property
    def inverse(self) -> "Exchange":
        """The exchange that undoes it."""
        return self._of(self.renaming.inverse)

    def then(self, one: Name, other: Name) -> "Exchange":
        """Return this exchange, and then that of two names."""
        swap = Renaming({one: other, other: one})
        return self if one == other else self._of(swap.after(self.renaming))

    def _of(self, renaming: Renaming) -> "Exchange":
        return Exchange(self.mobile, self.unordered, renaming)

    @cached_property
    def moved(self) -> frozenset[Any]:
        """The names, statements, variables and cells that are exchanged."""
        return frozenset(each for part in self.renaming.parts for each in part)

    def cell(self, cell: Cell) -> Cell:
        """Return the image of a cell."""
        return cell if self.moved.isdisjoint((cell, *cell)) else self.renaming.cell(cell)

    def name(self, name: Name) -> Name:
        """Return the image of whom a hole is about; an agent stands under another name there."""
        bare = name.removeprefix(AGENT)
        return name if bare not in self.moved else name.removesuffix(bare) + self.renaming.name(bare)

    def place(self, place: Place) -> Place:
        """Return the image of what a column is of."""
        cell = self.cell(place[0])
        return (cell,) if len(place) == 1 else (cell, place[1], self.name(place[2]))

    def ask(self, ask: Ask) -> Ask:
        """Return the image of a question."""
        hole = None if ask.hole is None else (ask.hole[0], self.name(ask.hole[1]))
        return Ask(self.cell(ask.cell), hole, ask.question, self.constant(ask.constants))

    def answer(self, ask: Ask, answer: Any) -> Any:
        """Return the image of what a question is answered with."""
        is_skeleton = ask.hole is None and ask.question is None
        return self.value(ask.cell, answer) if is_skeleton else self.constant(answer)

    def constant(self, value: Any) -> Any:
        """Return the image of a value that no cell holds."""
        if isinstance(value, bool) or names_in(value).isdisjoint(self.moved):
            return value
        return self._renamed(lambda: self.renaming.value(value))

    def value(self, cell: Cell, skeleton: Any) -> Any:
        """Return the image of a cell's value, or of its skeleton."""
        if skeleton is None or skeleton is ABSENT or not self.moved:
            return skeleton
        has_names_only = cell[0] not in ("code", "store")  # no statements or variables
        if has_names_only and names_in(skeleton).isdisjoint(self.moved):
            return skeleton
        is_sorted = not {"sends", "mailbox", *(["line"] if self.unordered else ())}.isdisjoint(cell)
        if is_sorted and len(skeleton) > 1:
            raise NoImage  # members, and what goes with each, might have another order
        whole = put_together(skeleton, lambda hole: dict(hole.still))
        image = self._renamed(lambda: self.renaming.content(cell, whole, unordered=self.unordered))
        return taken_apart(image, self.mobile)[0]

    def edited(self, edited: Edited) -> Edited:
        """Return the image of an edit."""
        return replace(edited, cell=self.cell(edited.cell), constants=self.constant(edited.constants))

    def label(self, label: Label) -> Label:
        """Return the image of a label: of a request, of what is received, or words of the mission's text."""
        about = self.constant(label.about) if isinstance(label.about, REQUESTS) else label.about
        if isinstance(about, str):
            about = self.printed(about)
        return Label(label.rule, None if label.agent is None else self.renaming.name(label.agent), about)

    def printed(self, text: str) -> str:
        """Return the image of words in the notation of the language: texts, in quotes, stay."""
        pieces = _QUOTED.split(text)
        pieces[::2] = map(self.renaming.text, pieces[::2])
        return "".join(pieces)

    def shown(self, text: str) -> str:
        """Return a text that mentions nobody who is exchanged: whether a word of it is a name can't be told."""
        if self.renaming.text(text) != text:
            raise NoImage
        return text

    def keeps_order(self, names: Iterable[Name]) -> bool:
        """Tell whether names have images in the same order: rules go through names in theirs."""
        images = [self.name(name) for name in sorted(names)]
        return images == sorted(images)

    def _renamed(self, image: Callable[[], Any]) -> Any:
        try:
            return image()
        except TypeError:
            raise NoImage from None


class Outcome(NamedTuple):
    """One transition, or what a part of one writes.

    Attributes:
        label: What it is called, without what is received.
        shown: What it displays.
        turn: Where what it serves stands in the queue.
        writes: What is written, by place.
        copies: The places that get what others hold.
        edits: What is made of cells, whatever they hold.
        apart: About whom there are parts.
        parts: What is known of those.
    """

    label: Label | None = None
    shown: tuple[str, ...] = ()
    turn: int = 0
    writes: tuple[tuple[Place, Any], ...] = ()
    copies: tuple[tuple[Place, Place], ...] = ()
    edits: tuple[Edited, ...] = ()
    apart: tuple[Name, ...] = ()
    parts: "Parts | None" = None

    def image(self, under: Exchange) -> "Outcome":
        """Return it under other names; raises NoImage where it has no image. What is known of parts is the same."""
        return Outcome(
            None if self.label is None else under.label(self.label),
            tuple(map(under.shown, self.shown)),
            self.turn,
            tuple((under.place(place), _held(under, place, value)) for place, value in self.writes),
            tuple((under.place(to), under.place(of)) for to, of in self.copies),
            tuple(map(under.edited, self.edits)),
            tuple(sorted(map(under.name, self.apart))),
            self.parts,
        )


def _held(under: Exchange, place: Place, value: Any) -> Any:
    return under.value(place[0], value) if len(place) == 1 else under.constant(value)


@dataclass(slots=True)
class Parts:
    """What is known of the parts of one transition, and which of them are alike.

    Attributes:
        firsts: For each about whom a part is the first that is like that, unless it is that itself.
        known: By that first what is known.
    """

    firsts: Mapping[Name, Name]
    known: dict[Name, "Lessons"] = field(default_factory=dict)

    def has_like(self, name: Name) -> bool:
        """Tell whether another part is like that about somebody."""
        return name in self.firsts or name in self.firsts.values()

    def of(self, name: Name, under: Exchange) -> "Kin":
        """Return what is known of a part, and the exchange that makes it that of the first."""
        image = under.name(name)
        first = self.firsts.get(image, image)
        return Kin(self.known.setdefault(first, Lessons()), under.then(image, first))


@dataclass(frozen=True, slots=True)
class Lesson:
    """What follows from some answers.

    Attributes:
        flags: Of the leaf.
        outcomes: The transitions.
        still: The cells that were taken to be never written and mention nobody who may be exchanged.
        taken: The others, with what they hold.
        depths: How many observations each cell that is written has columns for.
        names: The names that questions and values mention.
    """

    flags: int
    outcomes: tuple[Outcome, ...]
    still: frozenset[Cell]
    taken: Mapping[Cell, Any]
    depths: Mapping[Cell, int]
    names: frozenset[Name]

    def image(self, under: Exchange) -> "Lesson":
        """Return it under other names; raises NoImage where it has no image."""
        if not under.keeps_order(self.names):
            raise NoImage
        return Lesson(
            self.flags,
            tuple(each.image(under) for each in self.outcomes),
            self.still,
            {under.cell(cell): under.value(cell, value) for cell, value in self.taken.items()},
            {under.cell(cell): depth for cell, depth in self.depths.items()},
            frozenset(map(under.name, self.names)),
        )


Taken = tuple[tuple[Cell, Any], ...]
"""Cells that were taken to be never written, with what they hold, sorted."""


class Stage(NamedTuple):
    """One stage of a run: what was taken to be never written, then one question with its answer; none at the end.

    Attributes:
        taken: The cells that mention somebody who may be exchanged.
        ask: The question.
        answer: Its answer.
    """

    taken: Taken
    ask: Ask | None = None
    answer: Any = None


@dataclass(slots=True)
class Branch:
    """What is known where some cells that are never written hold this.

    Attributes:
        ask: What is asked next.
        after: By the answer what is known then.
        lesson: What follows where nothing more is asked.
    """

    ask: Ask | None = None
    after: dict[Any, "Lessons"] = field(default_factory=dict)
    lesson: Lesson | None = None


@dataclass(slots=True)
class Lessons:
    """All lessons of those that are alike, in the names of the first: a decision tree by values.

    A run depends on all that it reads: on what is never written, too, which may differ between two that are alike.

    Attributes:
        branches: By what is taken to be never written what is known then.
        since: How often what was taken for known had been forgotten when it began.
    """

    branches: dict[Taken, Branch] = field(default_factory=dict)
    since: int = 0

    def begin(self, since: int) -> None:
        """Know nothing, if something was forgotten since."""
        if since != self.since:
            self.branches, self.since = {}, since

    def find(self, answer: Callable[[Ask], Any], holds: Callable[[Cell], Any]) -> Lesson | None:
        """Return what follows where questions are answered so and cells hold this, None where it isn't known."""
        node = self
        while True:
            branch = next((each for taken, each in node.branches.items() if _agree(taken, holds)), None)
            if branch is None or branch.ask is None:
                return None if branch is None else branch.lesson
            found = branch.after.get(answer(branch.ask))
            if found is None:
                return None
            node = found

    def learn(self, stages: Iterable[Stage], lesson: Lesson) -> None:
        """Know what follows from some answers; nothing where something else was asked after the same ones.

        Rules may go through names in their order, and stop: two that are alike may then ask in another order.
        """
        node = self
        for taken, ask, answer in stages:
            branch = node.branches.setdefault(taken, Branch(ask))
            if branch.ask != ask:
                return
            if ask is None:
                branch.lesson = lesson
                return
            node = branch.after.setdefault(answer, Lessons())


def _agree(taken: Taken, holds: Callable[[Cell], Any]) -> bool:
    return all(holds(cell) == value for cell, value in taken)


class Kin(NamedTuple):
    """What is known of those that are like somebody, and the exchange that makes somebody the first of them."""

    lessons: Lessons
    exchange: Exchange


def mentioned(asked: Iterable[Ask], outcomes: Iterable[Outcome]) -> frozenset[Name]:
    """Return the names that questions and values mention; raises NoImage where that can't be told."""
    found: set[Any] = set()
    for ask in asked:
        found.update(ask.cell[1:], names_in(ask.constants), () if ask.hole is None else (ask.hole[1],))
    for outcome in outcomes:
        held = (value for _, value in outcome.writes if value is not ABSENT)
        found.update(*map(names_in, held), *(names_in(each.constants) for each in outcome.edits))
        found.update(() if outcome.label is None else WORD.findall(str(outcome.label)))
    return frozenset(each for each in found if isinstance(each, str))
