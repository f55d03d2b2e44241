"""Physical properties: the known facts about one entity (paper §3.2.1)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from physical.altitude import Band
from physical.shape import Geometry


@dataclass(frozen=True, slots=True)
class Velocity:
    """Speed over ground in metres per second, course in degrees clockwise from true north."""

    speed: float
    course: float


@dataclass(frozen=True, slots=True)
class PhysicalProperty:
    """The known facts about one entity.

    Attributes:
        entity: Its unique name, from the naming service.
        kind: Its kind, such as `Vessel`.
        geometry: Its position or area.
        altitude: Its band of altitudes, if known.
        channels: Its channels, sorted and distinct.
        carried_by: Its carrier.
        time: The time of these facts, in seconds since 1970 UTC. Equality ignores time, source and velocity.
        source: The origin of these facts, such as `ais`.
        velocity: Its velocity.
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
