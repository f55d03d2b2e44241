"""Mobility commands to vehicles (paper §3.2.3, Figure 6)."""

from __future__ import annotations

from dataclasses import dataclass

from physical.altitude import Band
from physical.errors import PhysicalError
from physical.geometry_measures import waypoint
from physical.physical_property import PhysicalProperty
from physical.shape import Geometry


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Go to a point, within an optional band of altitudes."""

    entity: str
    point: Geometry
    altitude: Band | None = None

    def __post_init__(self) -> None:
        if not self.point.is_point:
            raise PhysicalError("waypoint", f"{self.point!r} is no point", "take the waypoint of the polygon")


@dataclass(frozen=True, slots=True)
class JoinChannel:
    """Start using a channel."""

    entity: str
    channel: str


@dataclass(frozen=True, slots=True)
class LeaveChannel:
    """Stop using a channel."""

    entity: str
    channel: str


MobilityCommand = Waypoint | JoinChannel | LeaveChannel


def go_to(entity: str, target: PhysicalProperty) -> Waypoint:
    """Return the command that moves an entity to a target: its centroid if that is inside, else an interior point."""
    return Waypoint(entity, waypoint(target.geometry), target.altitude)


def rechannel(entity: str, before: tuple[str, ...], after: tuple[str, ...]) -> tuple[MobilityCommand, ...]:
    """Return the commands that change an entity's channels: those to leave, then those to join, sorted."""
    leave = sorted(set(before) - set(after))
    join = sorted(set(after) - set(before))
    return (
        *(LeaveChannel(entity, channel) for channel in leave),
        *(JoinChannel(entity, channel) for channel in join),
    )
