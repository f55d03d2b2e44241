"""Likeness: what is learned about one name holds, renamed, for each name that the mission does not tell from it.

The rules of a mission are the same under an exchange of two names that its text, its environment and their kinds do not
distinguish. So a part of a conclusion that was recorded about one of fifty vehicles is known about all whose cells
answer its questions alike: as long as neither what the transition itself rests on nor any answer mentions them.
"""

from collections.abc import Hashable, Sequence, Set
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

from checker.engines.fast.columns import Place
from checker.engines.fast.recording import Ask, Scope
from checker.reduction.automorphisms import Automorphisms
from checker.reduction.pairing import Pairing, Unlike
from checker.reduction.renaming import asked
from semantics.behaviours.observations import AGENT
from semantics.state.cells import Cell, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.state.signature import Name


class Mentioned(Exception):
    """Something mentions one of two names, or may: nothing is known of its image."""


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
        alike = ((self._first(name), frozenset(taken.get(name, ()))) for name in names)
        models = {
            name: there.setdefault(like, name)
            for name, like in zip(names, alike, strict=True)
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
