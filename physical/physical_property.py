"""Physical properties: the known facts about one entity (paper §3.2.1)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from physical.altitude import Band
from physical.shape import Geometry


@dataclass(frozen=True, slots=True)
class Velocity:
    """Speed over ground in metres a second, course in degrees clockwise from true north."""

    speed: float
    course: float


@dataclass(frozen=True, slots=True)
class PhysicalProperty:
    """What is known of one entity.

    Attributes:
        entity: Its unique name, given by the naming service.
        kind: What it is, such as `Vessel`.
        geometry: Where it is.
        altitude: The altitudes that it takes up, if known.
        channels: The channels that it is on, sorted, each once.
        carried_by: The entity that carries it.
        time: When it was so, in seconds since 1970 UTC. Time, source and velocity are outside equality.
        source: Who says so, such as `ais`.
        velocity: How it moves.
    """

    entity: str
    kind: str
    geometry: Geometry
    altitude: Band | None = None
    channels: tuple[str, ...] = ()
    carried_by: str | None = None
    time: float | None = field(default=None, compare=False)
    source: str | None = field(default=None, compare=False)
    velocity: Velocity | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "channels", tuple(sorted(set(self.channels))))

    def at(self, geometry: Geometry) -> PhysicalProperty:
        """Return P[entity ↦ geometry]."""
        return replace(self, geometry=geometry)

    def on(self, channels: Iterable[str]) -> PhysicalProperty:
        """Return the property with other channels."""
        return replace(self, channels=tuple(channels))
