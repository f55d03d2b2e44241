"""A vehicle's state as its messages show it: a fold, without a clock of its own.

Our clock stamps every message at arrival. The vehicle's own clock may be wrong and run at any speed; it only shows the
order of messages and a reboot.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Final

from adapters.mavlink.constants import (
    ACTIVE,
    AUTHORITY_PARAMETERS,
    AUTOPILOT_COMPONENT,
    FIX_3D,
    GEOFENCE,
    PREARM_HEALTHY,
    Cmd,
    ModeFlag,
    Result,
)
from adapters.mavlink.fleet import Craft
from adapters.mavlink.message import Message
from adapters.mavlink.profiles import Profile, profile_of
from physical import Band, PhysicalProperty, Velocity, point

FIX_SECONDS: Final = 10.0
"""How long a fix is believed: GPS_RAW_INT comes once a second, and may be lost."""

BACKWARDS: Final = 5_000
"""Milliseconds by which the vehicle's clock must go back to mean a reboot: less is a late packet."""

LARGEST: Final = 1e6
"""The largest valid radius, height or set of fences."""
MEMORY: Final = 60.0
"""Seconds for which a warning may explain what the vehicle does."""

MOST_WORDS: Final = 3
WARNING: Final = 4
"""MAV_SEVERITY_WARNING: what is less urgent has a larger number."""

NOWHERE: Final = 0.01
"""Degrees around (0, 0) that are ignored: an autopilot reports them before its filter has settled."""


@dataclass(frozen=True, slots=True)
class Position:
    """Where a vehicle is: degrees, metres above sea level and above home, m/s (over ground, upwards), our time."""

    latitude: float
    longitude: float
    altitude: float
    height: float
    speed: float
    course: float
    climb: float
    time: float


@dataclass(frozen=True, slots=True)
class Telemetry:
    """The state of a vehicle as its own messages show it; None is *not reported yet*.

    Attributes:
        heard: When its last message came.
        profile: The profile of its kind.
        mode: Its mode's number.
        armed: Whether its motors may turn.
        active: Whether it reports that it flies (or drives).
        position: Its position, if it has a fix.
        fix_time: When it last reported a fix.
        healthy: Whether it could be armed, and accepts missions.
        current: The number of its current mission item.
        target: Its target in degrees.
        home: Its home in degrees.
        fenced: Whether a fence is active, its own or ours.
        polygon: Whether it has reported that the polygon is active.
        authority: The system id of the station that it obeys.
        authority_parameter: The parameter that holds it.
        parameters: Other reported parameters, of its limits and its circles.
        version: The firmware's major and minor version.
        signs: Whether it signs its packets.
        clock: Its own milliseconds since boot.
        suspect: Its clock when it first seemed to have gone back.
        placed: Its clock when its position was measured.
        boots: How many reboots were seen.
        words: Its last warnings or worse, with their times.
        beat: When its last heartbeat came.
    """

    heard: float | None = None
    profile: Profile | None = None
    mode: int | None = None
    armed: bool | None = None
    active: bool | None = None
    position: Position | None = None
    fix_time: float | None = None
    healthy: bool | None = None
    current: int | None = None
    target: tuple[float, float] | None = None
    home: tuple[float, float] | None = None
    fenced: bool | None = None
    polygon: bool = False
    authority: int | None = None
    authority_parameter: str | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    version: tuple[int, int] | None = None
    signs: bool = False
    clock: int | None = None
    boots: int = 0
    words: tuple[tuple[float, str], ...] = ()
    beat: float | None = None
    suspect: int | None = None
    placed: int | None = None

    @property
    def flying(self) -> bool:
        """Whether it reports that it is off the ground."""
        return bool(self.armed and self.active)

    def last_words(self, now: float) -> str:
        """Return its recent warnings as a suffix of a reason, or an empty text."""
        lately = [text for time, text in self.words if now - time <= MEMORY]
        return f"; its last words: {', '.join(map(repr, dict.fromkeys(lately)))}" if lately else ""


def absorb(known: Telemetry, message: Message, now: float) -> Telemetry:
    """Return the state after one more message from the vehicle's autopilot."""
    if message.component != AUTOPILOT_COMPONENT:
        return known
    known = _clocked(known, message.fields.get("time_boot_ms"), now)
    if known.signs != message.signed:
        known = replace(known, signs=message.signed)
    reader = _READERS.get(message.name)
    return known if reader is None else reader(known, message.fields, now)


def property_of(craft: Craft, at: Position, channels: tuple[str, ...]) -> PhysicalProperty:
    """Return the physical property of a vehicle at a position."""
    return PhysicalProperty(
        craft.entity,
        craft.kind,
        point(at.latitude, at.longitude),
        Band(at.altitude, at.altitude),
        channels,
        time=at.time,
        source="mavlink",
        velocity=Velocity(at.speed, at.course),
    )


def _clocked(known: Telemetry, clock: int | None, now: float) -> Telemetry:
    """Note that it is heard, and follow its clock; two successive messages far behind mean a reboot."""
    if not clock:  # messages without, and those from before its clock began
        return replace(known, heard=now)
    if known.clock is None or clock > known.clock - BACKWARDS:
        return replace(known, heard=now, clock=max(clock, known.clock or 0), suspect=None)
    if known.suspect is None or not 0 <= clock - known.suspect <= BACKWARDS:
        return replace(known, heard=now, suspect=clock)
    return Telemetry(heard=now, profile=known.profile, clock=clock, boots=known.boots + 1)


def _heartbeat(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    profile = profile_of(said["type"], said["autopilot"])
    mode = said["custom_mode"] if said["base_mode"] & ModeFlag.CUSTOM_MODE else None
    armed = bool(said["base_mode"] & ModeFlag.ARMED)
    return replace(
        known, profile=profile, mode=mode, armed=armed, active=said["system_status"] >= ACTIVE, beat=now
    )


def _fix(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    return replace(known, fix_time=now if said["fix_type"] >= FIX_3D else None)


def _position(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    late = known.placed is not None and said["time_boot_ms"] < known.placed
    fixed = known.fix_time is not None and now - known.fix_time <= FIX_SECONDS
    if late or not fixed or not _somewhere(said["lat"] / 1e7, said["lon"] / 1e7):
        return known
    north, east = said["vx"] / 100, said["vy"] / 100
    position = Position(
        said["lat"] / 1e7,
        said["lon"] / 1e7,
        said["alt"] / 1000,
        said["relative_alt"] / 1000,
        math.hypot(north, east),
        math.degrees(math.atan2(east, north)) % 360,
        -said["vz"] / 100,
        now,
    )
    return replace(known, position=position, placed=said["time_boot_ms"])


def _somewhere(latitude: float, longitude: float) -> bool:
    on_earth = abs(latitude) <= 90 and abs(longitude) <= 180
    return on_earth and not (abs(latitude) < NOWHERE and abs(longitude) < NOWHERE)


def _status(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    healthy = bool(said["onboard_control_sensors_health"] & PREARM_HEALTHY)
    return replace(known, healthy=healthy, fenced=bool(said["onboard_control_sensors_enabled"] & GEOFENCE))


def _home(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    at = said["latitude"] / 1e7, said["longitude"] / 1e7
    return replace(known, home=at) if _somewhere(*at) else known


def _current(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    return replace(known, current=said["seq"])


def _target(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    if known.clock is not None and said["time_boot_ms"] < known.clock - 1000:
        return known
    return replace(known, target=(said["lat_int"] / 1e7, said["lon_int"] / 1e7))


def _parameter(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    name, value = said["param_id"], said["param_value"]
    if name in AUTHORITY_PARAMETERS and 0 < value < 256:
        return replace(known, authority=round(value), authority_parameter=name)
    if known.profile is None or name not in known.profile.parameters or not abs(value) <= LARGEST:
        return known
    return replace(known, parameters={**known.parameters, name: value})


def _answer(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    fenced = said["command"] == Cmd.FENCE_ENABLE and said["result"] == Result.ACCEPTED
    return replace(known, polygon=True) if fenced else known


def _version(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    number = said["flight_sw_version"]
    return replace(known, version=(number >> 24 & 255, number >> 16 & 255))


def _text(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    text = "".join(filter(str.isprintable, said["text"])).strip()
    if said["severity"] > WARNING or not text:
        return known
    return replace(known, words=(*known.words, (now, text))[-MOST_WORDS:])


_READERS: Final[Mapping[str, Callable[[Telemetry, Mapping[str, Any], float], Telemetry]]] = MappingProxyType(
    {
        "HEARTBEAT": _heartbeat,
        "GPS_RAW_INT": _fix,
        "GLOBAL_POSITION_INT": _position,
        "SYS_STATUS": _status,
        "HOME_POSITION": _home,
        "MISSION_CURRENT": _current,
        "POSITION_TARGET_GLOBAL_INT": _target,
        "PARAM_VALUE": _parameter,
        "COMMAND_ACK": _answer,
        "AUTOPILOT_VERSION": _version,
        "STATUSTEXT": _text,
    }
)
