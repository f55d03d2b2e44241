"""The state of a vehicle as a fold over its messages; it has no clock of its own.

Our clock stamps every message at arrival. The vehicle's clock may be wrong and run at any speed: it only orders
messages and reveals a reboot.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final

from adapters.mavlink.constants import (
    ACTIVE,
    AUTHORITY_PARAMETERS,
    AUTOPILOT_COMPONENT,
    FIX_3D,
    GEOFENCE,
    INTEGERS,
    KNOWN_FLAGS,
    PREARM_HEALTHY,
    Cmd,
    Estimate,
    Landed,
    ModeFlag,
    Result,
)
from adapters.mavlink.message import MavlinkMessage, changed
from adapters.mavlink.profiles import ARDUPILOT_DIALECT, Dialect, Profile, profile_of
from adapters.mavlink.texts import Chunks, Joined, VehicleText, give_up, join
from adapters.mavlink.vehicle_identities import Craft
from adapters.plugin import Battery
from physical import Band, PhysicalProperty, Velocity, distance, point

FIX_SECONDS: Final = 10.0
"""Seconds for which a fix or an estimate is valid: it comes once a second, and may be lost."""

HOME_METRES: Final = 30.0
HOME_RISE: Final = 10.0
"""Metres along and up that count as a moved home; arming sets home anew, to the vehicle's position."""

BACKWARDS: Final = 5_000
"""Milliseconds by which the vehicle's clock must go back to mean a reboot; a smaller step is a late packet."""

UNKNOWN: Final = 65_535
"""MAVLink's value for an unknown voltage or heading."""

LARGEST: Final = 1e6
"""The largest valid radius, height or set of fences."""
MEMORY: Final = 60.0
"""Seconds for which a warning may explain the behaviour of a vehicle."""

MOST_WORDS: Final = 3
REFUSES_TO_ARM: Final = ("PreArm:", "Arm:", "Arming denied", "Preflight Fail")
"""The beginnings of texts in which a vehicle explains why it cannot be armed."""

WARNING: Final = 4
"""MAV_SEVERITY_WARNING; less urgent texts have larger numbers."""

_NUMBERS: Final = ("mission_id", "fence_id", "rally_points_id")
"""In the order of `MissionType`; only PX4 sends them."""

NOWHERE: Final = 0.01
"""Degrees around (0, 0) that are ignored: an autopilot reports them before its filter has settled."""


@dataclass(frozen=True, slots=True)
class VehiclePosition:
    """A vehicle's position: degrees, metres above sea level and above home, m/s (over ground, upwards), our time."""

    latitude: float
    longitude: float
    altitude: float
    height: float
    speed: float
    course: float
    climb: float
    time: float


@dataclass(frozen=True)  # no slots: `changed`
class Telemetry:
    """The state of a vehicle according to its own messages; None means *not reported yet*.

    Attributes:
        heard: Arrival of its last message.
        profile: The profile of its kind.
        sort: Its MAV_TYPE and its MAV_AUTOPILOT.
        mode: Its mode's number.
        armed: Whether its motors may turn.
        active: Whether it reports that it flies (or drives).
        position: Its position, if it has a fix.
        fixes: The last fix (GPS_FIX_TYPE) of each receiver, and its time.
        estimate: Whether its filter has a good position, and the time of that report.
        healthy: Whether it could be armed, and accepts missions.
        current: The number of its current mission item.
        total: Its own count of the mission's items; None if it reports none.
        numbers: The ids of its mission, fence and rally points, which change with them; None if it reports none.
        target: Its target in degrees.
        aim: Its target's altitude in metres above sea level.
        home: Its home in degrees.
        ground: Its home's altitude in metres above sea level.
        base: Its home when it was last seen disarmed, else the first: heights of the mission are above it.
        fenced: Whether a fence is active, its own or ours.
        polygon: Whether it has acknowledged the polygon fence.
        authority: The system id of the station that it obeys.
        authority_parameter: The name of the parameter with that id.
        parameters: Other reported parameters, of its limits and its circles.
        version: The firmware's major and minor version.
        signs: Whether it signs its packets.
        clock: Its own milliseconds since boot.
        suspect: Its clock when it first seemed to have gone back.
        placed: Its clock at the measurement of its position.
        boots: The number of reboots seen.
        words: Its last warnings or worse, with their times.
        chunks: The received chunks of a long text.
        texts: Its texts that are not collected yet.
        battery: Its battery.
        heading: Its heading, in degrees from true north.
        beat: Arrival of its last heartbeat.
    """

    heard: float | None = None
    profile: Profile | None = None
    sort: tuple[int, int] | None = None
    mode: int | None = None
    armed: bool | None = None
    active: bool | None = None
    position: VehiclePosition | None = None
    fixes: Mapping[int, tuple[int, float]] = field(default_factory=dict)
    estimate: tuple[bool, float] | None = None
    healthy: bool | None = None
    current: int | None = None
    total: int | None = None
    numbers: tuple[int, ...] | None = None
    target: tuple[float, float] | None = None
    aim: float | None = None
    home: tuple[float, float] | None = None
    ground: float | None = None
    base: tuple[float, float, float] | None = None
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
    chunks: Chunks | None = None
    texts: tuple[VehicleText, ...] = ()
    battery: Battery | None = None
    heading: float | None = None
    beat: float | None = None
    suspect: int | None = None
    placed: int | None = None

    @property
    def dialect(self) -> Dialect:
        """The dialect of its firmware, ArduPilot's before its kind is known."""
        return ARDUPILOT_DIALECT if self.profile is None else self.profile.dialect

    @property
    def flying(self) -> bool:
        """Whether it reports that it is off the ground."""
        return bool(self.armed and self.active)

    def is_placed(self, now: float) -> bool:
        """Return whether its position is valid: by its own filter, else by the fix of any receiver."""
        if self.estimate is not None and now - self.estimate[1] <= FIX_SECONDS:
            return self.estimate[0]
        return any(fix >= FIX_3D and now - time <= FIX_SECONDS for fix, time in self.fixes.values())

    def lacks(self, now: float) -> str:
        """Return the reason why it has no position; an empty text if it has one."""
        if self.is_placed(now):
            return ""
        said = [
            f"GPS{f' {number}' if number > 1 else ''} fix {fix if now - time <= FIX_SECONDS else 'no longer reported'}"
            for number, (fix, time) in sorted(self.fixes.items())
        ]
        own = [] if self.estimate is None else ["its own estimate is not good"]
        return f"it has no position: {', '.join([*said, *own]) or 'it reports no GPS'}"

    def unready(self, now: float) -> tuple[str, ...]:
        """Return its recent reasons why it cannot be armed, each once."""
        lately = dict.fromkeys(text for time, text in self.words if now - time <= MEMORY)
        return () if self.armed else tuple(text for text in lately if text.startswith(REFUSES_TO_ARM))

    @property
    def datum(self) -> float | None:
        """The altitude in metres above sea level from which heights of the mission count."""
        return None if self.base is None else self.base[2]

    @property
    def home_moved(self) -> str:
        """The move of its home since it was armed, in words; empty if there was none."""
        if self.base is None or self.home is None or self.ground is None:
            return ""
        away, up = distance(point(*self.base[:2]), point(*self.home)), self.ground - self.base[2]
        moved = away > HOME_METRES or abs(up) > HOME_RISE
        return f"its home was moved by {away:.0f} m and {up:+.0f} m in height" if moved else ""

    def said(self, now: float) -> str:
        """Return its recent warnings, or an empty text."""
        return ", ".join(map(repr, dict.fromkeys(text for time, text in self.words if now - time <= MEMORY)))

    def last_words(self, now: float) -> str:
        """Return its recent warnings as a suffix of a reason, or an empty text."""
        said = self.said(now)
        return f"; its last words: {said}" if said else ""


def absorb(known: Telemetry, message: MavlinkMessage, now: float) -> Telemetry:
    """Return the state after one more message from the vehicle's autopilot."""
    if message.component != AUTOPILOT_COMPONENT:
        return known
    known = _clocked(known, message.fields.get("time_boot_ms"), now)
    if known.signs != message.signed:
        known = changed(known, signs=message.signed)
    reader = _READERS.get(message.name)
    return known if reader is None else reader(known, message.fields, now)


def property_of(craft: Craft, at: VehiclePosition, channels: tuple[str, ...]) -> PhysicalProperty:
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
    """Record the arrival, and follow the vehicle's clock; two successive messages far behind mean a reboot."""
    if not clock:  # messages without a clock, and those from before it began
        return changed(known, heard=now)
    if known.clock is None or clock > known.clock - BACKWARDS:
        return changed(known, heard=now, clock=max(clock, known.clock or 0), suspect=None)
    if known.suspect is None or not 0 <= clock - known.suspect <= BACKWARDS:
        return changed(known, heard=now, suspect=clock)
    return Telemetry(heard=now, profile=known.profile, clock=clock, boots=known.boots + 1)


def _heartbeat(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    sort = said["type"], said["autopilot"]
    profile = profile_of(*sort)
    mode = said["custom_mode"] if said["base_mode"] & ModeFlag.CUSTOM_MODE else None
    armed = bool(said["base_mode"] & ModeFlag.ARMED)
    elsewhere = profile is not None and profile.dialect.lands_by_state
    active = known.active if elsewhere else said["system_status"] >= ACTIVE
    return changed(known, profile=profile, sort=sort, mode=mode, armed=armed, active=active, beat=now)


def _landed(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    if known.profile is None or not known.profile.dialect.lands_by_state:
        return known
    return changed(known, active=said["landed_state"] > Landed.ON_GROUND)


def _fix(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    return changed(known, fixes={**known.fixes, 1: (said["fix_type"], now)})


def _second_fix(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    return changed(known, fixes={**known.fixes, 2: (said["fix_type"], now)})


def _estimate(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    """Record whether its filter has a position; as in ArduPilot, a predicted one is enough until it is armed."""
    flags = Estimate(said["flags"] & KNOWN_FLAGS)
    predicted = known.armed is False and Estimate.PRED_POS_HORIZ_ABS in flags
    placed = Estimate.POS_HORIZ_ABS in flags and Estimate.CONST_POS_MODE not in flags
    good = (predicted or placed) and Estimate.UNINITIALIZED not in flags
    return changed(known, estimate=(good, now))


def _position(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    heading = None if said["hdg"] == UNKNOWN else said["hdg"] / 100
    late = known.placed is not None and said["time_boot_ms"] < known.placed
    if late or not known.is_placed(now) or not _somewhere(said["lat"] / 1e7, said["lon"] / 1e7):
        return changed(known, heading=heading)
    north, east = said["vx"] / 100, said["vy"] / 100
    position = VehiclePosition(
        said["lat"] / 1e7,
        said["lon"] / 1e7,
        said["alt"] / 1000,
        said["relative_alt"] / 1000,
        math.hypot(north, east),
        math.degrees(math.atan2(east, north)) % 360,
        -said["vz"] / 100,
        now,
    )
    return changed(known, heading=heading, position=position, placed=said["time_boot_ms"])


def _somewhere(latitude: float, longitude: float) -> bool:
    on_earth = abs(latitude) <= 90 and abs(longitude) <= 180
    return on_earth and not (abs(latitude) < NOWHERE and abs(longitude) < NOWHERE)


def _status(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    healthy = bool(said["onboard_control_sensors_health"] & PREARM_HEALTHY)
    known = changed(known, healthy=healthy, fenced=bool(said["onboard_control_sensors_enabled"] & GEOFENCE))
    return _charged(known, said["battery_remaining"], said["voltage_battery"])


def _battery(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    if said["id"] != 0:  # only the first battery, which SYS_STATUS reports too
        return known
    cells = (each for each in said["voltages"] if each != UNKNOWN)
    return _charged(known, said["battery_remaining"], sum(cells))


def _charged(known: Telemetry, percent: int, millivolts: int) -> Telemetry:
    """Record the report of a battery's monitor; values that it does not measure keep those of other messages."""
    before = known.battery or Battery()
    battery = Battery(
        percent if 0 <= percent <= 100 else before.percent,
        millivolts / 1000 if millivolts not in (0, UNKNOWN) else before.volts,
    )
    return known if battery == before else changed(known, battery=battery)


def _home(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    at = said["latitude"] / 1e7, said["longitude"] / 1e7
    if not _somewhere(*at):
        return known
    ground = said["altitude"] / 1000
    base = (*at, ground) if known.base is None or not known.armed else known.base
    return changed(known, home=at, ground=ground, base=base)


def _current(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    total, numbers = said.get("total", UNKNOWN), tuple(said.get(name, 0) for name in _NUMBERS)
    return changed(
        known,
        current=said["seq"],
        total=None if total == UNKNOWN else total,
        numbers=numbers if any(numbers) else None,
    )


def _target(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    if known.clock is not None and said["time_boot_ms"] < known.clock - 1000:
        return known
    return changed(known, target=(said["lat_int"] / 1e7, said["lon_int"] / 1e7), aim=said["alt"])


def _parameter(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    name, value = said["param_id"], said["param_value"]
    if known.profile is not None and known.profile.dialect.typed and said["param_type"] in INTEGERS:
        value = float(int.from_bytes(struct.pack("<f", value), "little", signed=True))
    if name in AUTHORITY_PARAMETERS and 0 < value < 256:
        return changed(known, authority=round(value), authority_parameter=name)
    if known.profile is None or name not in known.profile.parameters or not abs(value) <= LARGEST:
        return known
    return changed(known, parameters={**known.parameters, name: value})


def _answer(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    fenced = said["command"] == Cmd.FENCE_ENABLE and said["result"] == Result.ACCEPTED
    return changed(known, polygon=True) if fenced else known


def _version(known: Telemetry, said: Mapping[str, Any], _now: float) -> Telemetry:
    number = said["flight_sw_version"]
    return changed(known, version=(number >> 24 & 255, number >> 16 & 255))


def _text(known: Telemetry, said: Mapping[str, Any], now: float) -> Telemetry:
    return _said(known, join(known.chunks, said, now), now)


def waited(known: Telemetry, now: float) -> Telemetry:
    """Return the state with a long text given up, once the wait for its rest has ended."""
    return known if known.chunks is None else _said(known, give_up(known.chunks, now), now)


def _matters(text: str) -> bool:
    """Return whether a text of any severity explains a vehicle's behaviour: ArduPilot's fence texts are notices."""
    return "breach" in text.lower() or text.startswith(REFUSES_TO_ARM)


def _said(known: Telemetry, joined: Joined, now: float) -> Telemetry:
    chunks, texts = joined
    grave = tuple((now, each.text) for each in texts if each.severity <= WARNING or _matters(each.text))
    words = (*known.words, *grave)[-MOST_WORDS:]
    return changed(known, chunks=chunks, words=words, texts=(*known.texts, *texts))


_READERS: Final[Mapping[str, Callable[[Telemetry, Mapping[str, Any], float], Telemetry]]] = MappingProxyType(
    {
        "HEARTBEAT": _heartbeat,
        "EXTENDED_SYS_STATE": _landed,
        "GPS_RAW_INT": _fix,
        "GPS2_RAW": _second_fix,
        "EKF_STATUS_REPORT": _estimate,
        "ESTIMATOR_STATUS": _estimate,
        "GLOBAL_POSITION_INT": _position,
        "SYS_STATUS": _status,
        "BATTERY_STATUS": _battery,
        "HOME_POSITION": _home,
        "MISSION_CURRENT": _current,
        "POSITION_TARGET_GLOBAL_INT": _target,
        "PARAM_VALUE": _parameter,
        "COMMAND_ACK": _answer,
        "AUTOPILOT_VERSION": _version,
        "STATUSTEXT": _text,
    }
)
