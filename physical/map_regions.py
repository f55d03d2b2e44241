"""Regions on a map, as plain data: where entities may be, the parts that break a property, and lines with metres."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from physical.frame import Position

if TYPE_CHECKING:
    from physical.region_outlines import Rings


@dataclass(frozen=True, slots=True)
class MapRegion:
    """Where an entity may be.

    Attributes:
        name: The entity, which gives the colour.
        polygons: The outlines of its parts.
        path: The middle of its way if it flies: its begin, the places by which it flies, and its destination.
    """

    name: str
    polygons: tuple[Rings, ...]
    path: tuple[Position, ...] = ()


@dataclass(frozen=True, slots=True)
class MapSpan:
    """A line between two points with its metres; a spot if both are one.

    Attributes:
        first: One end.
        second: The other.
        text: The metres, or a few words.
        broken: Whether it breaks a property.
    """

    first: Position
    second: Position
    text: str
    broken: bool = False


@dataclass(frozen=True, slots=True)
class MapWays:
    """The regions on a map.

    Attributes:
        regions: Where entities may be.
        breaches: The polygons in which they break a property.
        limits: The borders of ranges.
        spans: The lines with metres.
    """

    regions: tuple[MapRegion, ...] = ()
    breaches: tuple[Rings, ...] = ()
    limits: tuple[Rings, ...] = ()
    spans: tuple[MapSpan, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.regions or self.spans)

    @property
    def flying(self) -> frozenset[str]:
        """The entities whose path is drawn."""
        return frozenset(region.name for region in self.regions if region.path)

    def positions(self) -> Iterator[Position]:
        """Yield positions around which a map fits everything but ranges."""
        yield from (at for region in self.regions for rings in region.polygons for at in rings[0])
        yield from (at for span in self.spans for at in (span.first, span.second))


NO_WAYS: Final = MapWays()
