"""The watch over ways: vehicles off their way or out of their band, and the invariants about ways."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from semantics.properties.region_atoms import RegionAtom
from semantics.state.signature import Name

Position = tuple[float, float]
"""Degrees of latitude and longitude."""


@dataclass(frozen=True, slots=True)
class WatchedInvariant:
    """An invariant about ways, compared with what is seen.

    Attributes:
        property: Its name.
        holds: Whether it is true.
        figure: Its figure in words, such as `uav0 is 42 m from uav1; at least 50 m`.
        entities: The entities of the figure.
        points: The points that show it, if there are any.
    """

    property: str
    holds: bool
    figure: str = ""
    entities: tuple[Name, ...] = ()
    points: tuple[Position, ...] = ()


@dataclass(frozen=True, slots=True)
class Watched:
    """The state of that watch.

    Attributes:
        astray: The vehicles that are farther from their ways than the mission says.
        levelled: The vehicles that have reached their bands since their take-off.
        off_level: Those of them that have left their bands.
        standings: The invariants about ways, as of the last look.
        compared: The truth of the atoms that were measured, and the time.
        again: Time of the next look.
        broken: The last time at which each broken invariant was false.
    """

    astray: frozenset[Name] = frozenset()
    levelled: frozenset[Name] = frozenset()
    off_level: frozenset[Name] = frozenset()
    standings: tuple[WatchedInvariant, ...] = ()
    compared: Mapping[RegionAtom, tuple[bool, float]] = field(default_factory=dict)
    again: float = -math.inf
    broken: Mapping[str, float] = field(default_factory=dict)

    def on_way(self, entity: Name) -> Watched:
        """Return the value in which a vehicle is on its way."""
        return replace(self, astray=self.astray - {entity}) if entity in self.astray else self

    def off_way(self, entity: Name) -> Watched:
        """Return the value in which a vehicle is off its way."""
        return replace(self, astray=self.astray | {entity})

    def in_band(self, entity: Name) -> Watched:
        """Return the value in which a vehicle is in its band."""
        if entity in self.levelled and entity not in self.off_level:
            return self
        return replace(self, levelled=self.levelled | {entity}, off_level=self.off_level - {entity})

    def out_of_band(self, entity: Name) -> Watched:
        """Return the value in which a vehicle has left its band."""
        return replace(self, off_level=self.off_level | {entity})

    def unwatched(self, entity: Name) -> Watched:
        """Return the value after the mission has stopped to command a vehicle."""
        if entity not in self.astray | self.levelled | self.off_level:
            return self
        gone = {entity}
        return replace(
            self, astray=self.astray - gone, levelled=self.levelled - gone, off_level=self.off_level - gone
        )

    def looked(
        self,
        standings: tuple[WatchedInvariant, ...],
        broken: Mapping[str, float],
        compared: Mapping[RegionAtom, tuple[bool, float]],
        again: float,
    ) -> Watched:
        """Return the value after a look at the invariants."""
        return replace(self, standings=standings, broken=broken, compared=compared, again=again)
