"""The marks of a property about regions: the regions of its entities, the breach, and the nearest points."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from physical import Geometry, GeometryError, Located, RegionError, Transit, centroid, nearest, polygon
from physical.frame import Position
from physical.map_regions import NO_WAYS, MapRegion, MapSpan, MapWays
from physical.region_outlines import Shape, farthest_from, outline_around, outline_of, rings_of, spot_in
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, asks_of_regions, watching
from semantics.properties.propositions import holds
from semantics.properties.region_atoms import (
    ApartFrom,
    PossiblyIn,
    RegionAtom,
    SurelyIn,
    WithinRangeOf,
    operands,
)
from semantics.regions.region_report import deciding
from semantics.regions.region_truth import flights, is_true, located
from semantics.regions.stances import stance_of
from semantics.state.configuration import Configuration
from semantics.state.physical_model import InTransit
from semantics.state.signature import Name

MOST_ATOMS: Final = 4
"""The most atoms of a property that are drawn, as in a report."""

METRES_TO: Final = 10_000
"""Metres from which a length is written in kilometres."""


@dataclass(frozen=True, slots=True)
class RegionMarks:
    """The atoms about regions that decide a property at the end of a run.

    Attributes:
        initial: The run's initial configuration, with the facts about regions.
        atoms: The atoms.
        last: The last configuration, which is marked even if everything is at rest.
        drawn: The marks so far, by the placements and flights on which they depend.
    """

    initial: Configuration
    atoms: tuple[RegionAtom, ...]
    last: Configuration
    drawn: dict[Hashable, MapWays] = field(default_factory=dict, compare=False, repr=False)

    def ways(self, c: Configuration) -> MapWays:
        """Return the marks in a configuration; none while everything is at rest, but for the last one."""
        known = with_facts(c, self.initial)
        names = dict.fromkeys(name for atom in self.atoms for name in operands(atom))
        stances = tuple(stance_of(known, name) for name in names)
        is_flying = any(isinstance(stance.chain[-1][1], Transit) for stance in stances)
        if not is_flying and c != self.last:
            return NO_WAYS
        if stances not in self.drawn:
            try:
                self.drawn[stances] = _Drawing(known).ways(self.atoms)
            except RegionError:  # the verdict has said so
                self.drawn[stances] = NO_WAYS
        return self.drawn[stances]

    def positions(self, configurations: Iterable[Configuration]) -> Iterator[Geometry]:
        """Yield geometries around which a map fits the marks in some configurations."""
        for c in dict.fromkeys(configurations):
            corners = list(self.ways(c).positions())
            if corners:
                yield from _around(corners)


def marks_of(
    initial: Configuration,
    last: Configuration,
    properties: Iterable[Property],
    *,
    violated: bool | None = None,
) -> RegionMarks | None:
    """Return the marks of the properties about regions that a configuration decides; None without any.

    Args:
        initial: The initial configuration of the run.
        last: The configuration.
        properties: The properties.
        violated: Whether it is a violation or a witness; None for either.
    """
    asked = [each for each in properties if each.kind.has_proposition and asks_of_regions([each])]
    if not asked:
        return None
    initial = watching(initial, asked)
    known = with_facts(last, initial)
    atoms: dict[RegionAtom, None] = {}
    for each in asked:
        wanted = each.kind is PropertyKind.REACHABLE
        if violated in (None, not wanted) and holds(each.formula, known) is wanted:
            atoms |= dict.fromkeys(deciding(each.formula, known, wanted=wanted))
    return RegionMarks(initial, tuple(atoms)[:MOST_ATOMS], last) if atoms else None


def with_facts(c: Configuration, initial: Configuration) -> Configuration:
    """Return a configuration with the facts about regions of the initial one."""
    if c.setting.regions is not None:
        return c
    return Configuration(c.setting.with_(regions=initial.setting.regions), c.state)


def _around(corners: Sequence[Position]) -> Iterator[Geometry]:
    norths, easts = zip(*corners, strict=True)
    south, north, west, east = min(norths), max(norths), min(easts), max(easts)
    try:
        yield polygon([(south, west), (south, east), (north, east), (north, west)])
    except GeometryError:  # it has no area: its ends are drawn anyway
        return


class _Drawing:
    """The marks in one configuration."""

    def __init__(self, c: Configuration) -> None:
        self.c = c
        self.breaches: list[Shape] = []
        self.limits: list[Shape] = []
        self.spans: list[MapSpan] = []

    def ways(self, atoms: Sequence[RegionAtom]) -> MapWays:
        """Return all marks."""
        names = sorted({name for atom in atoms for name in operands(atom)})
        for atom in atoms:
            self.mark(atom)
        return MapWays(
            tuple(region for name in names for region in self.region(name)),
            tuple(rings for shape in self.breaches for rings in rings_of(shape)),
            tuple(rings for shape in self.limits for rings in rings_of(shape)),
            tuple(dict.fromkeys(self.spans)),
        )

    def region(self, name: Name) -> Iterator[MapRegion]:
        """Yield the region of an entity, unless it is certain: a map shows that anyway."""
        found = located(self.c, name)
        if not found.region or found.region.certain or found.carriers:
            return
        polygons = tuple(rings for part in found.region.parts for rings in rings_of(outline_of(part)))
        yield MapRegion(name, polygons, tuple(self._path(name)))

    def _path(self, name: Name) -> Iterator[Position]:
        """Yield the middle of a flight: its begin, the places by which it leads, and its destination."""
        physical = self.c.structure.physical
        at = physical.placement(name)
        plans = flights(self.c, name) if isinstance(at, InTransit) else ()
        if not isinstance(at, InTransit) or len(plans) != 1:
            return
        stops = [physical.position(stop) for plan in plans for stop in (*plan.via, plan.to)]
        for geometry in (at.origin.geometry, *(stop.geometry for stop in stops if stop is not None)):
            yield centroid(geometry).vertices[0]

    def mark(self, atom: RegionAtom) -> None:
        """Add the breach, the limit and the line of an atom."""
        u, v = (located(self.c, name) for name in operands(atom))
        if not u.region or not v.region or u.bearer == v.bearer:
            return
        match atom:
            case PossiblyIn():
                self._inside(
                    atom, u, v, self._shape(u).intersection(self._shape(v, u)), is_true(atom, self.c)
                )
            case SurelyIn():
                broken = not is_true(atom, self.c)
                self._inside(atom, u, v, self._shape(u).difference(self._shape(v, u)), broken, "outside")
            case ApartFrom(distance=distance, height=height):
                up = distance if height is None else height
                broken = not is_true(atom, self.c)
                self._apart(
                    u, v, up, broken=broken, wanted=f", not {length_text(distance)}" if broken else ""
                )
            case WithinRangeOf(distance=distance):
                self._within(u, v, distance, broken=not is_true(atom, self.c))

    def _shape(self, u: Located, beside: Located | None = None, farther: float = 0.0) -> Shape:
        return outline_around(u.region.parts, (u if beside is None else beside).region.parts[0], farther)

    def _inside(
        self,
        atom: RegionAtom,
        u: Located,
        v: Located,
        breach: Shape,
        broken: bool,
        word: str = "in",
    ) -> None:
        if broken and not breach.is_empty:
            self.breaches.append(breach)
            spot, text = spot_in(breach), f"{u.entity} may be {word} {v.entity}"
            self.spans.append(MapSpan(spot, spot, text, broken=True))
        elif not broken and isinstance(atom, PossiblyIn):
            self._apart(u, v, None, broken=False)

    def _apart(self, u: Located, v: Located, up: float | None, *, broken: bool, wanted: str = "") -> None:
        found = nearest(u, v, up) or nearest(u, v)
        if found is None:
            return
        gap = f", {found.gap:g} m up" if found.gap else ""
        if found.metres >= 1.0:
            text = f"{length_text(found.metres)}{gap}{wanted}"
            ends = found.first.vertices[0], found.second.vertices[0]
            self.spans.append(MapSpan(*ends, text, broken))
            return
        meeting = self._shape(u).intersection(self._shape(v, u))
        if broken:
            self.breaches.append(meeting)
        spot = spot_in(meeting) if meeting.area else found.first.vertices[0]
        self.spans.append(MapSpan(spot, spot, f"may meet{gap}" if not gap else f"0 m{gap}", broken))

    def _within(self, u: Located, v: Located, distance: float, *, broken: bool) -> None:
        """Draw the limit around a certain entity, and the line from there to the farthest point."""
        if not v.region.certain and u.region.certain and not u.region.is_area:
            u, v = v, u
        limit = self._shape(v, u, distance)
        if v.region.certain:
            self.limits.append(limit)
            if broken:
                self.breaches.append(self._shape(u).difference(limit))
        if v.region.certain and not v.region.is_area:
            middle = spot_in(self._shape(v))
            at, metres = farthest_from(self._shape(u), middle)
            wanted = f", not {length_text(distance)}" if broken else ""
            self.spans.append(MapSpan(middle, at, f"{length_text(math.ceil(metres))}{wanted}", broken))


def length_text(metres: float) -> str:
    """Return a length as text: whole metres, or kilometres with one digit.

    >>> length_text(1109.3), length_text(12345.0), length_text(6000.0)
    ('1,109 m', '12.3 km', '6 km')
    """
    kilometres = metres >= METRES_TO or (metres >= 1000 and metres % 100 == 0)
    return f"{metres / 1000:,.1f}".removesuffix(".0") + " km" if kilometres else f"{int(metres):,} m"
