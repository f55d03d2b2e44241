"""Likeness: what is learned about one name holds, renamed, for each name that the mission does not tell from it.

The rules of a mission are the same under an exchange of two names that its text, its environment and their kinds do not
distinguish. So a part of a conclusion that was recorded about one of fifty vehicles is known about all whose cells
answer its questions alike: as long as neither what the transition itself rests on nor any answer mentions them.
"""

from collections.abc import Hashable, Iterable, Sequence, Set
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, Protocol

from checker.engines.fast.columns import Columns, Place, Writes
from checker.engines.fast.leaves import Leaves
from checker.engines.fast.recording import Ask, Scope
from checker.engines.fast.trees import UNKNOWN, Trees
from checker.reduction.automorphisms import Automorphisms
from checker.reduction.pairing import Pairing, Unlike
from checker.reduction.renaming import asked
from semantics.behaviours.observations import AGENT
from semantics.state.cells import Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.state.signature import Name


class Mentioned(Exception):
    """Something mentions one of two names, or may: it has no image."""


@dataclass(frozen=True, slots=True)
class Swap:
    """One name in the place of another, in all that mentions no other of both.

    Attributes:
        one: The name that something is known about.
        other: The name that it is to be known about.
    """

    one: Name
    other: Name

    def cell(self, cell: Cell) -> Cell:
        """Return the image of a cell; raises Mentioned where it is about the other name."""
        if self.other in cell:
            raise Mentioned
        return tuple(self.other if each == self.one else each for each in cell)

    def place(self, place: Place) -> Place:
        """Return the image of what a column is of; raises Mentioned where that is the same, or about the other."""
        cell = self.cell(place[0])
        image: Place = (cell,) if len(place) == 1 else (cell, place[1], self._name(place[2]))
        if image == place:
            raise Mentioned
        return image

    def ask(self, ask: Ask) -> Ask:
        """Return the image of a question; raises Mentioned where names would be asked in another order."""
        self.constant(ask.constants)
        told = () if ask.hole is None else (ask.hole[1],)
        if not all(each == self.one or self._stands_alike(each) for each in (*ask.cell[1:], *told)):
            raise Mentioned
        hole = None if ask.hole is None else (ask.hole[0], self._name(ask.hole[1]))
        return Ask(self.cell(ask.cell), hole, ask.question, ask.constants)

    def constant(self, value: Any) -> Any:
        """Return a value that mentions neither name; raises Mentioned where it does."""
        if not names_in(value).isdisjoint((self.one, self.other)):
            raise Mentioned
        return value

    def still(self, cell: Cell, still: Row, varying: Set[Cell]) -> Cell:
        """Return the image of a cell that was taken to be never written, where that holds the same."""
        image, value = self.cell(cell), still.read(cell)
        if image in varying or still.read(image) != value:
            raise Mentioned
        if (self.one in names_in(value)) is not (self.other in names_in(value)):
            raise Mentioned
        return image

    def _name(self, name: Name) -> Name:
        """Return the image of whom a hole is about; an agent stands under another name there."""
        if name == self.one:
            return self.other
        if name.removeprefix(AGENT) in (self.one, self.other):
            raise Mentioned
        return name

    def _stands_alike(self, name: Name) -> bool:
        """Tell whether a name stands on one side of both: rules go through names in their order."""
        return (name < self.one) is (name < self.other)


@lru_cache(maxsize=1 << 16)
def names_in(value: Any) -> frozenset[Any]:
    """Return the names that a value mentions; raises Mentioned where that can't be told."""
    try:
        found = asked(lambda renaming: renaming.value(value))
    except TypeError:
        raise Mentioned from None
    return frozenset(each.removeprefix(AGENT) if isinstance(each, str) else each for each in found)


class Learned(NamedTuple):
    """What is known of one part.

    Attributes:
        scope: What it asked.
        writes: What it writes.
        codes: For each question to a value the code of that.
    """

    scope: Scope
    writes: Writes
    codes: dict[Ask, int]


class Source(Protocol):
    """One configuration."""

    def code(self, number: int) -> int:
        """Return the code of a column."""


@dataclass(frozen=True)
class Images:
    """What is learned of a part, as it is known of another.

    Attributes:
        columns, trees, leaves: All that there are.
        still: The first configuration.
        varying: The cells that were written so far.
    """

    columns: Columns
    trees: Trees
    leaves: Leaves
    still: Row
    varying: Set[Cell]

    def known(self, tree: int, taken: Iterable[Cell], swap: Swap, source: Source) -> Learned | None:
        """Return the image of what a tree knows where a configuration answers the images of its questions, if anything.

        Raises:
            Mentioned: It has no image.
        """
        found = Learned(Scope(), [], {})
        reference = int(self.trees.root.room[tree])
        while reference > UNKNOWN:
            reference = self._after(reference - 1, swap, source, found)
        if reference == UNKNOWN:
            return None
        found.scope.taken.update(swap.still(cell, self.still, self.varying) for cell in taken)
        (step,) = self.leaves.steps_of(-reference - 1)
        found.writes.extend(self._writes(self.leaves.codes_of(step).items(), swap))
        return found

    def _after(self, node: int, swap: Swap, source: Source, found: Learned) -> int:
        """Put the image of a node's question to a configuration, note it, and return where the answer leads."""
        ask = swap.ask(self.trees.asks[node])
        number = self.columns.asked(ask)
        code = source.code(number)
        value = swap.constant(self.columns.all[number].value(code))
        if ask.question is not None:
            answer = found.scope.asked[ask] = ask.question(value, *ask.constants)
            return self.trees.after_answer(node, answer)
        found.scope.asked[ask], found.codes[ask] = value, code
        return self.trees.after(node, self.columns.all[self.trees.column_of(node)].code_of(value))

    def of(self, learned: Learned, swap: Swap) -> Learned:
        """Return the image of what was learned.

        Raises:
            Mentioned: It has none, or a value never stood where its image would.
        """
        scope, codes = Scope(), dict[Ask, int]()
        for ask, answer in learned.scope.asked.items():
            image = swap.ask(ask)
            scope.asked[image] = swap.constant(answer)
            if ask.question is None:
                code = self.columns.all[self.columns.asked(image)].code_of(answer)
                if code is None:
                    raise Mentioned
                codes[image] = code
        scope.taken = {swap.still(cell, self.still, self.varying) for cell in learned.scope.taken}
        return Learned(scope, self._writes(learned.writes, swap), codes)

    def _writes(self, writes: Iterable[tuple[int, int]], swap: Swap) -> Writes:
        columns, found = self.columns, []
        for number, code in writes:
            place = swap.place(columns.all[number].place)
            if place[0] not in self.varying:
                raise Mentioned  # that it varies is learned where it is written
            image, value = columns.number(place), swap.constant(columns.all[number].values[code])
            found.append((image, columns.all[image].code(value)))
        return found


@dataclass
class Likeness:
    """Which names a mission does not tell apart.

    Attributes:
        setting: The mission.
        still: Its first configuration.
        apart: Of whom parts may be.
    """

    setting: Setting
    still: Row
    apart: frozenset[Name]
    firsts: dict[Name, Name] = field(default_factory=dict)
    held: dict[Cell, tuple[tuple[Name, Hashable], ...]] = field(default_factory=dict)

    @cached_property
    def _automorphisms(self) -> Automorphisms:
        return Automorphisms(Configuration(self.setting, self.still))

    def models(self, names: Sequence[Name], scope: Scope) -> dict[Name, Name]:
        """Return for names that parts of a conclusion are about the first that is like each, unless it is that itself.

        Whom the transition itself asked about, as `scope` tells, is like nobody.
        """
        if self.setting.timing is not None:  # that says of vehicles, by name, how fast they are
            return {}
        try:
            mentioned, taken = _mentioned(scope), self._taken(scope)
        except Mentioned:
            return {}
        there: dict[Hashable, Name] = {}
        models = {
            name: there.setdefault((self._first(name), frozenset(taken.get(name, ()))), name)
            for name in names
            if name not in mentioned and not name.startswith(AGENT)
        }
        return {name: model for name, model in models.items() if name != model}

    def _taken(self, scope: Scope) -> dict[Name, list[Hashable]]:
        """Return for each name what the cells that were taken to be never written hold of it, without its name."""
        found: dict[Name, list[Hashable]] = {}
        for cell in scope.taken:
            if cell not in self.held:
                self.held[cell] = self._held(cell)
            for name, what in self.held[cell]:
                found.setdefault(name, []).append(what)
        return found

    def _held(self, cell: Cell) -> tuple[tuple[Name, Hashable], ...]:
        """Return of whom parts may be that a cell mentions, each with what it holds of it, without its name."""
        value = self.still.read(cell)
        return tuple(
            (name, (tuple(None if each == name else each for each in cell), value if name in cell else None))
            for name in names_in(value).union(cell[1:]).intersection(self.apart)
        )

    def _first(self, name: Name) -> Name:
        """Return the first name that was met of those that are like one."""
        if name not in self.firsts:
            others = dict.fromkeys(self.firsts.values())
            self.firsts[name] = next((each for each in others if self._are_like(each, name)), name)
        return self.firsts[name]

    def _are_like(self, one: Name, other: Name) -> bool:
        pairing = Pairing(self._automorphisms.c)
        try:
            pairing.pair(pairing.names, one, other)
            self._automorphisms.of_setting(pairing)
        except Unlike:
            return False
        return True


def _mentioned(scope: Scope) -> frozenset[Any]:
    """Return the names that questions with their answers mention."""
    found: set[Any] = set()
    for ask, answer in scope.asked.items():
        found.update(ask.cell[1:], names_in(ask.constants), names_in(answer))
        if ask.hole is not None:
            found.add(ask.hole[1].removeprefix(AGENT))
    return frozenset(found)
