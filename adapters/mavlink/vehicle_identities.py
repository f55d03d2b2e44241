"""The vehicles and stations of a mission: names, MAVLink ids, fences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from adapters.mavlink.profiles import Profile
from physical import Geometry, PhysicalError

CONTROL: Final = "control:"
"""The kind of channel for control authority."""


@dataclass(frozen=True, slots=True)
class Craft:
    """A vehicle that is expected on a link.

    Attributes:
        entity: Its name in the mission.
        kind: Its kind there.
        system: Its MAVLink system id; None for the first vehicle heard.
        channels: Its channels while it is heard, beside its control authority.
        fence: The polygon that it must stay in; uploaded before it is armed.
        circle: The radius in metres at which it circles where it stays; None for its own.
        height: Its default height in metres above home; None for its kind's.
        time_to_live: Seconds for which its position is valid.
        serial: Its autopilot's serial number in hexadecimal digits; no other vehicle is then mistaken for it.
        streams: The messages that it is asked to send beside the regular ones.
    """

    entity: str
    kind: str = "UAV"
    system: int | None = None
    channels: tuple[str, ...] = ()
    fence: Geometry | None = None
    circle: float | None = None
    height: float | None = None
    time_to_live: float = 30.0
    serial: str | None = None
    streams: tuple[str, ...] = ()

    def height_of(self, profile: Profile) -> float:
        """Return the height at which it travels."""
        return profile.altitude if self.height is None else self.height


@dataclass(frozen=True, slots=True)
class Stations:
    """The ground stations of a run.

    Attributes:
        ids: Their names in the mission, and their MAVLink system ids.
        own: The stations for which this run speaks.
        in_mission: Whether the mission has channels of control authority; else a vehicle's authority is no channel.
    """

    ids: Mapping[str, int] = field(default_factory=lambda: {"gcs0": 255})
    own: tuple[str, ...] = ("gcs0",)
    in_mission: bool = True

    def __post_init__(self) -> None:
        if len(set(self.ids.values())) < len(self.ids) or not all(
            0 < number < 256 for number in self.ids.values()
        ):
            raise PhysicalError(
                "stations", "two stations share a system id, or one is not from 1 to 255", "give each its own"
            )
        if not self.own or not set(self.own) <= set(self.ids):
            raise PhysicalError("stations", "we speak for a station that has no system id", "give it one")

    def name_of(self, system: int | None) -> str | None:
        """Return the station that has a system id."""
        return next((name for name, number in self.ids.items() if number == system), None)

    def obeyed(self, authority: int | None, profile: Profile | None) -> int | None:
        """Return the system id of a vehicle's station; for one that obeys all stations, the mission's first."""
        obeys_all = profile is not None and not profile.dialect.authority
        return next(iter(self.ids.values())) if obeys_all else authority

    def speaker(self, authority: int | None) -> int:
        """Return the system id for messages to a vehicle: its authority's, if that is ours."""
        name = self.name_of(authority)
        return self.ids[name if name in self.own else self.own[0]]

    def station_of(self, channel: str) -> str | None:
        """Return the station whose control channel it is."""
        name = channel.removeprefix(CONTROL)
        return name if channel.startswith(CONTROL) and name in self.ids else None
