"""Shared lessons: a recorded run of one agent, or of one part, holds for all interchangeable ones.

The rules of a mission are invariant under an exchange of names that its text, its environment and their kinds don't
distinguish. A run recorded for one of fifty agents holds, renamed, for each agent whose cells give the renamed answers.
A lesson is stored in the names of the first of them, and in values instead of codes, since each agent has its own
columns.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from checker.engines.fast.model.columns import ABSENT, Place
from checker.recording.access_recording import ColumnQuestion, Edited
from checker.recording.value_templates import join_value, split_value
from checker.reduction.configuration_renaming import WORD, Renaming, requested_keys
from semantics.behaviours.observations import AGENT
from semantics.state.cell_values import Cell
from semantics.state.configuration import Label
from semantics.state.requests import REQUESTS
from semantics.state.signature import Name

_QUOTED = re.compile(r'("(?:[^"\\]|\\.)*")')
"""A text as it is printed."""


class NoImage(Exception):
    """Something has no image under an exchange, or the image can't be determined."""


@lru_cache(maxsize=1 << 16)
def names_in(value: Any) -> frozenset[Any]:
    """Return the names that a value mentions; raises NoImage if they can't be determined."""
    try:
        found = requested_keys(lambda renaming: renaming.value(value))
    except TypeError:
        raise NoImage from None
    return frozenset(each.removeprefix(AGENT) if isinstance(each, str) else each for each in found)


@dataclass(frozen=True)
class Exchange:
    """An exchange of names under which the rules are invariant, applied to everything that a rule reads or writes.

    Attributes:
        mobile: The names with columns for their facts in observations.
        unordered: Whether the requests in line are unordered, hence stored in a canonical order.
        renaming: The names, with their statements and variables.
    """

    mobile: frozenset[Name]
    unordered: bool
    renaming: Renaming = field(default_factory=Renaming)

    @cached_property
    def inverse(self) -> "Exchange":
        """The inverse exchange."""
        return self._of(self.renaming.inverse)

    def then(self, one: Name, other: Name) -> "Exchange":
        """Return this exchange followed by the swap of two names."""
        swap = Renaming({one: other, other: one})
        return self if one == other else self._of(swap.after(self.renaming))

    def _of(self, renaming: Renaming) -> "Exchange":
        return Exchange(self.mobile, self.unordered, renaming)

    @cached_property
    def moved(self) -> frozenset[Any]:
        """The names, statements, variables and cells that the exchange moves."""
        return frozenset(each for part in self.renaming.parts for each in part)

    def cell(self, cell: Cell) -> Cell:
        """Return the image of a cell."""
        return cell if self.moved.isdisjoint((cell, *cell)) else self.renaming.cell(cell)

    def name(self, name: Name) -> Name:
        """Return the image of the name of a fact; for an agent, the name has a prefix."""
        bare = name.removeprefix(AGENT)
        return name if bare not in self.moved else name.removesuffix(bare) + self.renaming.name(bare)

    def place(self, place: Place) -> Place:
        """Return the image of the subject of a column."""
        cell = self.cell(place[0])
        return (cell,) if len(place) == 1 else (cell, place[1], self.name(place[2]))

    def ask(self, ask: ColumnQuestion) -> ColumnQuestion:
        """Return the image of a question."""
        hole = None if ask.hole is None else (ask.hole[0], self.name(ask.hole[1]))
        return ColumnQuestion(self.cell(ask.cell), hole, ask.question, self.constant(ask.constants))

    def answer(self, ask: ColumnQuestion, answer: Any) -> Any:
        """Return the image of the answer to a question."""
        is_skeleton = ask.hole is None and ask.question is None
        return self.value(ask.cell, answer) if is_skeleton else self.constant(answer)

    def constant(self, value: Any) -> Any:
        """Return the image of a value that is no cell's content."""
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
            raise NoImage  # the elements of the image, and their attachments, may be in another order
        whole = join_value(skeleton, lambda hole: dict(hole.still))
        image = self._renamed(lambda: self.renaming.content(cell, whole, unordered=self.unordered))
        return split_value(image, self.mobile)[0]

    def edited(self, edited: Edited) -> Edited:
        """Return the image of an edit."""
        return replace(edited, cell=self.cell(edited.cell), constants=self.constant(edited.constants))

    def label(self, label: Label) -> Label:
        """Return the image of a label about a request, a received observation, or words of the mission."""
        about = self.constant(label.about) if isinstance(label.about, REQUESTS) else label.about
        if isinstance(about, str):
            about = self.printed(about)
        agent = None if label.agent is None else self.renaming.name(label.agent)
        return Label(label.rule, agent, about, tuple(sorted(map(self.name, label.missed))))

    def printed(self, text: str) -> str:
        """Return the image of words in the notation of the language: texts, in quotes, stay."""
        pieces = _QUOTED.split(text)
        pieces[::2] = map(self.renaming.text, pieces[::2])
        return "".join(pieces)

    def shown(self, text: str) -> str:
        """Return a text that mentions no moved name; raise NoImage otherwise: its words may or may not be names."""
        if self.renaming.text(text) != text:
            raise NoImage
        return text

    def keeps_order(self, names: Iterable[Name]) -> bool:
        """Return whether the images of names have the same order: rules iterate over names in their order."""
        images = [self.name(name) for name in sorted(names)]
        return images == sorted(images)

    def _renamed(self, image: Callable[[], Any]) -> Any:
        try:
            return image()
        except TypeError:
            raise NoImage from None


class CachedOutcome(NamedTuple):
    """One transition, or the writes of a part.

    Attributes:
        label: Its label, without a received observation.
        shown: The texts that it displays.
        turn: The position in the queue of the request that it serves.
        writes: The values written, by place.
        copies: Target places with their source places.
        edits: The edits of cells, independent of their values.
        apart: The names that have parts.
        parts: The lessons of these parts.
    """

    label: Label | None = None
    shown: tuple[str, ...] = ()
    turn: int = 0
    writes: tuple[tuple[Place, Any], ...] = ()
    copies: tuple[tuple[Place, Place], ...] = ()
    edits: tuple[Edited, ...] = ()
    apart: tuple[Name, ...] = ()
    parts: "PartLessons | None" = None

    def image(self, under: Exchange) -> "CachedOutcome":
        """Return the outcome under other names; raises NoImage if it has no image. The lessons of parts are shared."""
        return CachedOutcome(
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
class PartLessons:
    """The lessons of the parts of one transition, and which parts are interchangeable.

    Attributes:
        firsts: For each name, the first name with an interchangeable part; the first itself is not a key.
        known: The lessons of each first name.
    """

    firsts: Mapping[Name, Name]
    known: dict[Name, "Lessons"] = field(default_factory=dict)

    def has_like(self, name: Name) -> bool:
        """Return whether another part is interchangeable with that of a name."""
        return name in self.firsts or name in self.firsts.values()

    def of(self, name: Name, under: Exchange) -> "Kin":
        """Return the lessons for a part, with the exchange that maps it to its first."""
        image = under.name(name)
        first = self.firsts.get(image, image)
        return Kin(self.known.setdefault(first, Lessons()), under.then(image, first))


@dataclass(frozen=True, slots=True)
class Lesson:
    """The conclusion of a sequence of answers.

    Attributes:
        flags: The flags of the leaf.
        outcomes: The transitions.
        still: The cells assumed constant that mention no exchangeable name.
        taken: The other cells assumed constant, with their values.
        depths: The number of observations with columns, for each cell that is written.
        names: The names that questions and values mention.
    """

    flags: int
    outcomes: tuple[CachedOutcome, ...]
    still: frozenset[Cell]
    taken: Mapping[Cell, Any]
    depths: Mapping[Cell, int]
    names: frozenset[Name]

    def image(self, under: Exchange) -> "Lesson":
        """Return the lesson under other names; raises NoImage if it has no image."""
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
"""Cells assumed constant, with their values, sorted."""


class LessonStage(NamedTuple):
    """One stage of a run: assumptions about constant cells, then one question with its answer; none at the end.

    Attributes:
        taken: The cells assumed constant that mention an exchangeable name, with their values.
        ask: The question.
        answer: Its answer.
    """

    taken: Taken
    ask: ColumnQuestion | None = None
    answer: Any = None


@dataclass(slots=True)
class Branch:
    """The knowledge for one set of values of constant cells.

    Attributes:
        ask: The next question.
        after: The lessons by its answer.
        lesson: The conclusion, if there is no further question.
    """

    ask: ColumnQuestion | None = None
    after: dict[Any, "Lessons"] = field(default_factory=dict)
    lesson: Lesson | None = None


@dataclass(slots=True)
class Lessons:
    """A decision tree over values, in the names of the first of several interchangeable agents or parts.

    A run also depends on constant cells, which may differ between interchangeable agents.

    Attributes:
        branches: The branches by the values of constant cells.
        since: The value of `Sharing.forgotten` when the tree began.
    """

    branches: dict[Taken, Branch] = field(default_factory=dict)
    since: int = 0

    def begin(self, since: int) -> None:
        """Clear the tree if assumptions were discarded after it began."""
        if since != self.since:
            self.branches, self.since = {}, since

    def find(self, answer: Callable[[ColumnQuestion], Any], holds: Callable[[Cell], Any]) -> Lesson | None:
        """Return the lesson for the given answers and cell values, None if it is unknown."""
        node = self
        while True:
            branch = next((each for taken, each in node.branches.items() if _agree(taken, holds)), None)
            if branch is None or branch.ask is None:
                return None if branch is None else branch.lesson
            found = branch.after.get(answer(branch.ask))
            if found is None:
                return None
            node = found

    def learn(self, stages: Iterable[LessonStage], lesson: Lesson) -> None:
        """Add a lesson to the tree, unless another question was asked after the same answers.

        Rules may iterate over names in order and stop; interchangeable agents may then ask in different orders.
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
    """The lessons shared by interchangeable agents or parts, and the exchange that maps this one to the first."""

    lessons: Lessons
    exchange: Exchange


def mentioned(asked: Iterable[ColumnQuestion], outcomes: Iterable[CachedOutcome]) -> frozenset[Name]:
    """Return the names that questions and outcomes mention; raises NoImage if they can't be determined."""
    found: set[Any] = set()
    for ask in asked:
        found.update(ask.cell[1:], names_in(ask.constants), () if ask.hole is None else (ask.hole[1],))
    for outcome in outcomes:
        held = (value for _, value in outcome.writes if value is not ABSENT)
        found.update(*map(names_in, held), *(names_in(each.constants) for each in outcome.edits))
        found.update(() if outcome.label is None else WORD.findall(str(outcome.label)))
    return frozenset(each for each in found if isinstance(each, str))
