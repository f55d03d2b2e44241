"""The properties that a mission asks to check, and the variables that they need."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

from semantics.behaviours.program import VariableOf
from semantics.properties.kinds import PropertyKind
from semantics.properties.propositions import Always, Proposition, atoms_of
from semantics.properties.region_atoms import RegionAtom
from semantics.properties.temporal import Fairness, Temporal
from semantics.state.brief import cut
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

TRUE: Final = Always(True)


Ranges = tuple[tuple[Name, ...], ...]
"""The ranges of quantifiers; names are sorted."""


@dataclass(frozen=True, slots=True)
class Property:
    """A property to check.

    Attributes:
        kind: Its kind.
        name: Its name; the word of its kind if the mission gives none.
        formula: The proposition of an invariant, or of reachability.
        line: Its line in the mission's text, from 1; 0 if it was not written.
        temporal: The formula of `ltl` and `ctl`.
        fairness: The fairness of the runs considered, for `ltl`, `ctl`, `progress` and `deadlock_freedom`; all runs if
            empty.
        ranges: The ranges of the quantifiers in its formula.
        written: Its formula as written in the mission's text; empty if it was not written.
        bound: The deadline of `within`, in ticks.
        then: The proposition that has to follow the formula within the bound (`F leads to G`); None if the formula
            itself has to become true.
    """

    kind: PropertyKind
    name: str
    formula: Proposition = TRUE
    line: int = 0
    temporal: Temporal | None = None
    fairness: tuple[Fairness, ...] = ()
    ranges: Ranges = ()
    written: str = ""
    bound: int = 0
    then: Proposition | None = None

    def __repr__(self) -> str:
        return f"<Property {cut(self.name)}{'' if self.name == self.kind else f' kind={self.kind}'}>"

    @property
    def shown(self) -> str:
        """Its formula for people: as written, with its quantifiers; otherwise the expanded formula."""
        return self.written or str(self.formula if self.temporal is None else self.temporal)

    @property
    def is_of_runs(self) -> bool:
        """Whether it is about runs: its kind is, or it has a fairness condition."""
        return self.kind.is_of_runs or bool(self.fairness)


def watched(properties: Iterable[Property]) -> frozenset[VariableOf]:
    """Return the variables that the properties mention, at any depth."""
    return frozenset(part for part in _parts(properties) if isinstance(part, VariableOf))


def asks_of_regions(properties: Iterable[Property]) -> bool:
    """Whether some property is about the regions of entities."""
    return next(region_atoms(properties), None) is not None


def region_atoms(properties: Iterable[Property]) -> Iterator[RegionAtom]:
    """Yield the atoms about regions in properties, as written: those of quantifiers may have variables."""
    return (part for part in _parts(properties) if isinstance(part, RegionAtom))


def instantiated_region_atoms(properties: Iterable[Property]) -> tuple[RegionAtom, ...]:
    """Return the atoms about regions in the propositions of properties, each once; of a quantifier, its instances'."""
    atoms = (
        atom
        for each in _parts(properties, whole=True)
        if isinstance(each, Proposition)
        for atom in atoms_of(each)
    )
    return tuple(dict.fromkeys(atom for atom in atoms if isinstance(atom, RegionAtom)))


def _parts(properties: Iterable[Property], *, whole: bool = False) -> Iterator[object]:
    """Yield the parts of properties, at any depth; those of a proposition unless it is left `whole`."""
    waiting: list[object] = list(properties)
    while waiting:
        part = waiting.pop()
        yield part
        if whole and isinstance(part, Proposition):
            continue
        if isinstance(part, tuple):
            waiting.extend(part)
        elif not isinstance(part, VariableOf):
            waiting.extend(getattr(part, name) for name in getattr(part, "__dataclass_fields__", ()))


def watching(c: Configuration, properties: Iterable[Property], *, ways: bool = False) -> Configuration:
    """Return an initial configuration with all that its properties need.

    Their variables are kept to the end of the run. The facts that regions need are computed if one asks for regions, or
    with `ways`.
    Endurance is timed only for a property `endurance`, since the clocks of several vehicles multiply the states.
    """
    asked, setting = tuple(properties), c.setting
    program, timing = setting.program.watching(watched(asked)), setting.timing
    if (
        timing is not None
        and timing.endurances
        and all(each.kind is not PropertyKind.ENDURANCE for each in asked)
    ):
        timing = timing.without_endurances()
    regions = setting.regions
    if regions is None and (ways or asks_of_regions(asked)):
        from semantics.regions.possible_motions import region_facts  # noqa: PLC0415 - geometry takes its time to load

        regions = region_facts(c)
    if program is setting.program and timing is setting.timing and regions is setting.regions:
        return c
    return Configuration(setting.with_(program=program, timing=timing, regions=regions), c.state)
