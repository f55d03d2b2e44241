"""The state of a simulated vehicle, and its motion towards a target."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final

from adapters.mavlink.constants import Fence, FenceAction, MavFrame, MissionType
from adapters.mavlink.profiles import BOAT, COPTER, PLANE, PX4_COPTER, PX4_PLANE, ROVER, Profile, TakeOff
from adapters.mavlink.signing import Signing
from adapters.mavlink.zones import Zone, zones
from adapters.simulated import body as bodies
from adapters.simulated.body import Body, Limits, Target, astray, metres_to, moved, towards
from adapters.simulated.store import ARDUPILOT_MANNER, PX4_MANNER, Store
from physical import Geometry

WAYPOINT_RADIUS: Final = 50.0
"""Metres from a waypoint at which a plane takes the next."""

GRAVITY: Final = 9.81
FIX_AFTER: Final = 10.0
UP_AFTER: Final = 5.0
"""Seconds after boot at which it takes missions."""

CRITICAL: Final = 2
WARNING: Final = 4
NOTICE: Final = 5
INFO: Final = 6
"""MAV_SEVERITY_CRITICAL, _WARNING, _NOTICE and _INFO."""

SAG: Final = 1.8
"""Volts that it loses over the second half of its charge; that alone does not count as low."""

NO_FENCE: Final = Fence(0)
STOPS_BEFORE: Final = 4.0
"""Metres before its circle fence at which a ground vehicle stops, without a message."""

PARAMETERS: Final = {
    "WP_RADIUS": WAYPOINT_RADIUS,
    "ARMING_MIS_ITEMS": 0.0,
    "FENCE_ACTION": 1.0,
    "FENCE_ENABLE": 0.0,
    "FENCE_RADIUS": 300.0,
    "RALLY_INCL_HOME": 0.0,
    "RALLY_LIMIT_KM": 5.0,
    "BATT_LOW_VOLT": 10.5,
    "BATT_LOW_TIMER": 10.0,
    "BATT_FS_LOW_ACT": 0.0,
}
ALTITUDES: Final = {
    "FENCE_AUTOENABLE": 0.0,
    "FENCE_ALT_MAX": 100.0,
    "FENCE_ALT_MIN": -10.0,
    "FENCE_OPTIONS": 0.0,
}
OF_KINDS: Final = {
    TakeOff.MISSION: ALTITUDES
    | {"FENCE_TYPE": 4.0, "WP_LOITER_RAD": 80.0, "RTL_AUTOLAND": 0.0, "RTL_RADIUS": 0.0},
    TakeOff.COMMAND: ALTITUDES | {"FENCE_TYPE": 7.0},
    TakeOff.NONE: {"FENCE_TYPE": 6.0},
}
"""ArduPilot 4.6's defaults, except for the radius of a plane's circle, which its simulator sets."""


OF_PX4: Final = {
    "BAT_CRIT_THR": 0.07,
    "COM_LOW_BAT_ACT": 0.0,
    "GF_ACTION": 2.0,
    "GF_MAX_HOR_DIST": 0.0,
    "GF_MAX_VER_DIST": 0.0,
    "MIS_TAKEOFF_ALT": 2.5,
    "MIS_TKO_LAND_REQ": 0.0,
    "NAV_LOITER_RAD": 80.0,
    "RTL_LOITER_RAD": 80.0,
}
"""PX4's defaults, except for a plane's MIS_TKO_LAND_REQ of 2, with which it takes no path."""


class Kind(Enum):
    """A kind of vehicle: MAV_TYPE, profile, limits, radius around a waypoint, its request for mission items."""

    PLANE = (1, PLANE, bodies.PLANE, WAYPOINT_RADIUS, "MISSION_REQUEST")
    COPTER = (2, COPTER, bodies.COPTER, 2.0, "MISSION_REQUEST_INT")
    ROVER = (10, ROVER, bodies.ROVER, 2.0, "MISSION_REQUEST_INT")
    BOAT = (11, BOAT, bodies.ROVER, 4.0, "MISSION_REQUEST_INT")
    PX4_PLANE = (1, PX4_PLANE, bodies.PLANE, WAYPOINT_RADIUS, "MISSION_REQUEST_INT")
    PX4_COPTER = (2, PX4_COPTER, bodies.COPTER, 2.0, "MISSION_REQUEST_INT")

    @property
    def profile(self) -> Profile:
        """Its modes, and its way of taking off."""
        return self.value[1]

    @property
    def limits(self) -> Limits:
        """The limits of its motion."""
        return self.value[2]

    @property
    def returns(self) -> float:
        """The value of BATT_FS_LOW_ACT with which a low battery sends it home; 1 lets a copter land."""
        return 2.0 if self is Kind.COPTER else 1.0

    @property
    def radius(self) -> float:
        """Metres from a waypoint at which it takes the next."""
        return self.value[3]


@dataclass(slots=True)
class State:
    """The state of a simulated vehicle.

    Attributes:
        kind: Its kind.
        home: Degrees, metres above sea level.
        system: Its MAVLink system id.
        speedup: The pace of its clock relative to ours.
        enforce: Whether it obeys only the station that has the authority (SYSID_ENFORCE).
        accept_unsigned: Whether unsigned packets are obeyed although it has a key, as on ArduPilot's first link.
        fixed: Whether its receiver has satellites.
        second: Whether its second receiver has satellites; None if it has no second one.
        fences: The fences that are on.
        version: The version of its firmware: before 4.6 all fences were switched at once.
        slowed: The fraction of its kind's speed that it makes over the ground, as against a head wind.
        wind: Metres a second to the north and to the east: it carries a plane out of its circle.
        serial: Its autopilot's serial number: at most 18 bytes.
        fault: The reason why it cannot be armed, beside a recent boot; it reports it every 30 s.
        complained: The time of that report, in seconds since it booted.
        voltage: The voltage of its full battery; when it is low for a while, the fail-safe acts once.
        charge: The remaining charge of its battery, from 1 to 0.
        low: The start of its low voltage.
        failed_safe: Whether the fail-safe has acted since it booted.
        words: Its texts to send, with their severities.
        ground: The altitude of the ground, in metres above sea level: its first home's.
        told: The mission item whose start it has reported.
        breached: Whether it was outside a fence at the last check.
        refuge: Its point of return, while it returns.
        lands: Whether it has looked for a landing sequence during this return.
    """

    kind: Kind
    home: tuple[float, float, float]
    system: int = 1
    speedup: float = 1.0
    enforce: bool = True
    accept_unsigned: bool = False
    fixed: bool = True
    second: bool | None = None
    booted: float = 0.0
    time: float = 0.0
    armed: bool = False
    mode: int = 0
    current: int = 0
    target: Target | None = None
    fences: Fence = NO_FENCE
    version: tuple[int, int, int] = (4, 6, 3)
    wind: tuple[float, float] = (0.0, 0.0)
    slowed: float = 1.0
    parameters: dict[str, float] = field(default_factory=dict)
    signing: Signing | None = None
    serial: bytes = b""
    ground: float = field(init=False)
    body: Body = field(init=False)
    store: Store = field(init=False)
    reached: list[int] = field(default_factory=list)
    fault: str = ""
    complained: float = -math.inf
    voltage: float = 12.6
    low: float | None = None
    failed_safe: bool = False
    charge: float = 1.0
    words: list[tuple[int, str]] = field(default_factory=list)
    told: int | None = None
    breached: bool = False
    refuge: tuple[float, float] | None = None
    lands: bool = False

    def __post_init__(self) -> None:
        latitude, longitude, altitude = self.home
        self.ground = altitude
        dialect = self.kind.profile.dialect
        defaults = OF_PX4 if dialect.typed else PARAMETERS | OF_KINDS[self.kind.profile.takeoff]
        authority = {self.authority_parameter: 255.0} if dialect.authority else {}
        self.parameters = defaults | authority | self.parameters
        self.mode = self.mode or self.first_mode
        self.body = Body(latitude, longitude)
        manner = ARDUPILOT_MANNER if dialect.home_is_item else PX4_MANNER
        self.store = Store(
            manner, self.kind.value[4], (round(latitude * 1e7), round(longitude * 1e7), altitude)
        )

    @property
    def authority_parameter(self) -> str:
        """The name of its authority parameter."""
        return self.kind.profile.dialect.authority[self.version >= (4, 7, 0)]

    @property
    def speed(self) -> float:
        """Its speed over the ground, in m/s."""
        return self.kind.limits.speed * self.slowed

    @property
    def first_mode(self) -> int:
        """The mode in which it boots."""
        return self.kind.profile.hold if self.kind.profile.climb is not None else 0

    @property
    def fence_action(self) -> FenceAction | None:
        """Its action at fences that need no switch; None if they are switched."""
        action = self.parameters.get(self.kind.profile.dialect.fence_action)
        return None if action is None else FenceAction(int(action))

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The valid zones of the fence on board."""
        found = zones(self.store.items.get(MissionType.FENCE, ()))
        return tuple(zone for zone in found if zone.shape is not None and (zone.within or zone.outside))

    @property
    def fence(self) -> Geometry | None:
        """The first inclusion zone in force, if there is one."""
        within = (zone.shape for zone in self.zones if zone.within)
        return next(within, None) if self.keeps_zones else None

    @property
    def keeps_zones(self) -> bool:
        """Whether the zones on board are in force: ArduPilot switches them, PX4 has an action for them."""
        acts = self.fence_action is not None and self.fence_action > FenceAction.WARN
        return acts or Fence.POLYGON in self.fences

    @property
    def configured(self) -> Fence:
        """The fences that it would keep within if they were on."""
        configured = Fence(int(self.parameters.get("FENCE_TYPE", 0)))
        return configured if self.zones else configured & ~Fence.POLYGON

    def switch_fences(self, fences: Fence, *, on: bool) -> None:
        """Switch its configured fences among these on or off."""
        meant = fences & Fence(int(self.parameters["FENCE_TYPE"]))
        self.fences = self.fences | meant if on else self.fences & ~meant

    @property
    def circle(self) -> float:
        """The radius of its circle, unless a target has one."""
        profile = self.kind.profile
        return abs(self.parameters[profile.dialect.circle]) if self.kind.limits.must_move else profile.circle

    @property
    def home_circle(self) -> float:
        """The radius at which it circles its home; counter-clockwise if negative."""
        return self.parameters.get(self.kind.profile.dialect.home_circle) or self.circle

    @property
    def volts(self) -> float:
        """Its battery's present voltage."""
        return self.voltage - SAG * max(0.0, 1.0 - 2.0 * self.charge)

    def arm(self, *, armed: bool) -> None:
        """Arm or disarm it, with a text."""
        if armed != self.armed:
            self.words.append((INFO, f"Throttle {'armed' if armed else 'disarmed'}"))
        self.armed = armed

    @property
    def flies(self) -> bool:
        """Whether it is off the ground; for a ground vehicle, whether it is armed."""
        above_ground = self.home[2] + self.body.height - self.ground
        return self.armed and (self.kind.profile.takeoff is TakeOff.NONE or above_ground > 1.0)

    @property
    def uptime(self) -> float:
        """Seconds since it booted, by its own clock."""
        return (self.time - self.booted) * self.speedup

    @property
    def has_fix(self) -> bool:
        """Whether it has a position."""
        return (self.fixed or bool(self.second)) and self.uptime >= FIX_AFTER

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch in degrees: a plane banks for its turn, the others stay level."""
        body = self.body
        if not self.kind.limits.must_move or body.speed < 1.0:
            return 0.0, 0.0
        bank = math.atan(body.speed * math.radians(body.turn) / GRAVITY)
        return math.degrees(bank), math.degrees(math.atan2(body.climb, body.speed))

    @property
    def up(self) -> bool:
        """Whether it takes missions."""
        return self.uptime >= UP_AFTER

    def set_home(self, latitude: float, longitude: float, altitude: float) -> None:
        """Move its home; the vehicle and its target stay in place."""
        rise = altitude - self.home[2]
        self.home = (latitude, longitude, altitude)
        self.body = replace(self.body, height=self.body.height - rise)
        self.target = self.target and replace(self.target, height=self.target.height - rise)

    def height_in(self, height: float, frame: int) -> float:
        """Return a height in a frame as a height above home."""
        return height - self.home[2] if frame in (MavFrame.SEA_LEVEL, MavFrame.SEA_LEVEL_INT) else height

    def stay(self) -> None:
        """Hold its position."""
        self.mode = self.kind.profile.hold
        self.target = Target(self.body.latitude, self.body.longitude, self.body.height, self.circle)

    def take_off(self, height: float, seconds: float) -> None:
        """Climb at its position, once it is fast enough."""
        limits = self.kind.limits
        speed = self.speed if limits.must_move else 0.0
        rising = height if not limits.must_move or self.body.speed > 0.6 * speed else self.body.height
        self.body = moved(self.body, limits, self.body.course, speed, rising, seconds)

    def go(self, target: Target, seconds: float) -> None:
        """Go to a target, and stay there."""
        limits = self.kind.limits
        if limits.must_move:
            _, bearing = metres_to(self.body, target.latitude, target.longitude)
            circle = target.circle * astray(bearing, self.wind)
            course = towards(self.body, target.latitude, target.longitude, circle)
            self.body = moved(self.body, limits, course, self.speed, target.height, seconds)
            return
        distance, course = metres_to(self.body, target.latitude, target.longitude)
        speed = min(self.speed, distance)  # slows down over the last second
        if limits.climb == 0 and Fence.CIRCLE in self.fences:
            speed = min(speed, max(0.0, self._before_the_circle(course)))
        height = target.height if limits.climb else 0.0
        self.body = moved(self.body, limits, course, speed, height, seconds)

    def _before_the_circle(self, course: float) -> float:
        """Return the metres that it may drive on a course before it stops at its circle fence."""
        ahead = moved(replace(self.body, course=course, speed=1.0), self.kind.limits, course, 1.0, 0.0, 1.0)
        home = Body(*self.home[:2])
        here, there = (metres_to(home, at.latitude, at.longitude)[0] for at in (self.body, ahead))
        return math.inf if there < here else self.parameters["FENCE_RADIUS"] - STOPS_BEFORE - here
