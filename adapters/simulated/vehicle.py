"""A simulated vehicle: its state, its behaviour in each mode, and its start-up.

Commands and messages are `protocol`'s and `reporting`'s business, packets `serving`'s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final

from adapters.mavlink.constants import Fence, FenceAction, Frame, MissionType
from adapters.mavlink.profiles import BOAT, COPTER, PLANE, PX4_COPTER, PX4_PLANE, ROVER, Profile, TakeOff
from adapters.mavlink.signing import Signing
from adapters.mavlink.zones import Zone, zones
from adapters.simulated import body as bodies
from adapters.simulated import fences, missions
from adapters.simulated.body import Body, Limits, Target, astray, metres_to, moved, towards
from adapters.simulated.store import ARDUPILOT_MANNER, PX4_MANNER, Store
from physical import Geometry

WAYPOINT_RADIUS: Final = 50.0
"""Metres from a waypoint at which a plane takes the next."""

GRAVITY: Final = 9.81
FIX_AFTER: Final = 10.0
READY_AFTER: Final = 19.0
"""Seconds after boot at which it has a fix, and could be armed; before, it says that it is near (0, 0)."""

UP_AFTER: Final = 5.0
"""Seconds after boot at which it takes missions."""

WARNING: Final = 4
INFO: Final = 6
"""MAV_SEVERITY_WARNING and MAV_SEVERITY_INFO."""

ENDURANCE: Final = 7_200.0
"""Seconds for which a full battery lasts."""

SAG: Final = 1.8
"""Volts that it loses over the second half of its charge; that alone is not low yet."""

NO_FENCE: Final = Fence(0)

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
"""What ArduPilot 4.6 has by default, but for the radius of a plane's circle, which its simulator sets."""


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
"""What PX4 has by default, but for a plane's MIS_TKO_LAND_REQ of 2, with which it takes no path."""

LOW_BATTERY_RETURNS: Final = 3.0
"""PX4's COM_LOW_BAT_ACT with which it returns at a critical charge."""


class Kind(Enum):
    """A kind of vehicle: MAV_TYPE, profile, limits, radius around a waypoint, how it asks for mission items."""

    PLANE = (1, PLANE, bodies.PLANE, WAYPOINT_RADIUS, "MISSION_REQUEST")
    COPTER = (2, COPTER, bodies.COPTER, 2.0, "MISSION_REQUEST_INT")
    ROVER = (10, ROVER, bodies.ROVER, 2.0, "MISSION_REQUEST_INT")
    BOAT = (11, BOAT, bodies.ROVER, 4.0, "MISSION_REQUEST_INT")
    PX4_PLANE = (1, PX4_PLANE, bodies.PLANE, WAYPOINT_RADIUS, "MISSION_REQUEST_INT")
    PX4_COPTER = (2, PX4_COPTER, bodies.COPTER, 2.0, "MISSION_REQUEST_INT")

    @property
    def profile(self) -> Profile:
        """Its modes, and how it takes off."""
        return self.value[1]

    @property
    def limits(self) -> Limits:
        """What it can do."""
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
class Vehicle:
    """The state of a simulated vehicle.

    Attributes:
        kind: What it is.
        home: Degrees, metres above sea level.
        system: Its MAVLink system id.
        speedup: How much faster than ours its clock says that time passes.
        enforce: Whether it obeys only the station that has the authority (SYSID_ENFORCE).
        accept_unsigned: Whether unsigned packets are obeyed although it has a key, as on ArduPilot's first link.
        fixed: Whether its receiver has satellites.
        second: Whether its second receiver has satellites; None if it has no second one.
        fences: Which of its fences are on.
        version: Of its firmware: before 4.6 all fences were switched at once.
        slowed: What part of its kind's speed it makes over the ground, as against a head wind.
        wind: Metres a second to the north and to the east: it carries a plane out of its circle.
        serial: Its autopilot's serial number: at most 18 bytes.
        voltage: Its battery's when it is full; when it is low for a while, the fail-safe acts once.
        charge: How much of its battery is left, from 1 to 0.
        low: Since when it is low.
        failed_safe: Whether the fail-safe has acted since it booted.
        words: What it has to say, with its severity.
        ground: The altitude of the ground, in metres above sea level: its first home's.
        told: The item of its mission that it has said it begins.
        breached: Whether it was outside a fence when it last looked.
        refuge: Where it returns to, since it does.
        lands: Whether it has looked for a landing sequence since it returns.
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
        """The speed over the ground that it flies at, in m/s."""
        return self.kind.limits.speed * self.slowed

    @property
    def first_mode(self) -> int:
        """The mode in which it boots."""
        return self.kind.profile.hold if self.kind.profile.climb is not None else 0

    @property
    def fence_action(self) -> FenceAction | None:
        """What it does at its fences, which need no switch; None where they are switched."""
        action = self.parameters.get(self.kind.profile.dialect.fence_action)
        return None if action is None else FenceAction(int(action))

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the fence on board that make sense."""
        found = zones(self.store.items.get(MissionType.FENCE, ()))
        return tuple(zone for zone in found if zone.shape is not None and (zone.within or zone.outside))

    @property
    def fence(self) -> Geometry | None:
        """The first zone that it stays in, if there is one in force."""
        within = (zone.shape for zone in self.zones if zone.within)
        return next(within, None) if fences.in_force(self) else None

    @property
    def configured(self) -> Fence:
        """Which fences it would keep within if they were on."""
        configured = Fence(int(self.parameters.get("FENCE_TYPE", 0)))
        return configured if self.zones else configured & ~Fence.POLYGON

    def switch_fences(self, fences: Fence, *, on: bool) -> None:
        """Switch the fences on, or off, that it is configured to have."""
        meant = fences & Fence(int(self.parameters["FENCE_TYPE"]))
        self.fences = self.fences | meant if on else self.fences & ~meant

    @property
    def circle(self) -> float:
        """The radius at which it circles where it is told none."""
        profile = self.kind.profile
        return abs(self.parameters[profile.dialect.circle]) if self.kind.limits.must_move else profile.circle

    @property
    def home_circle(self) -> float:
        """The radius at which it circles its home; counter-clockwise if negative."""
        return self.parameters.get(self.kind.profile.dialect.home_circle) or self.circle

    @property
    def volts(self) -> float:
        """Its battery's voltage now."""
        return self.voltage - SAG * max(0.0, 1.0 - 2.0 * self.charge)

    def arm(self, *, armed: bool) -> None:
        """Arm or disarm it, and say so."""
        if armed != self.armed:
            self.words.append((INFO, f"Throttle {'armed' if armed else 'disarmed'}"))
        self.armed = armed

    @property
    def flies(self) -> bool:
        """Whether it is off the ground; for what does not fly, whether it is armed."""
        above_ground = self.home[2] + self.body.height - self.ground
        return self.armed and (self.kind.profile.takeoff is TakeOff.NONE or above_ground > 1.0)

    @property
    def uptime(self) -> float:
        """Seconds since it booted, by its own clock."""
        return (self.time - self.booted) * self.speedup

    @property
    def has_fix(self) -> bool:
        """Whether it knows where it is."""
        return (self.fixed or bool(self.second)) and self.uptime >= FIX_AFTER

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch in degrees: a plane banks as its turn takes it, the others stay level."""
        body = self.body
        if not self.kind.limits.must_move or body.speed < 1.0:
            return 0.0, 0.0
        bank = math.atan(body.speed * math.radians(body.turn) / GRAVITY)
        return math.degrees(bank), math.degrees(math.atan2(body.climb, body.speed))

    @property
    def up(self) -> bool:
        """Whether it takes missions."""
        return self.uptime >= UP_AFTER

    @property
    def ready(self) -> bool:
        """Whether it could be armed."""
        return self.uptime >= READY_AFTER and not missions.missing(self)

    def reboot(self, *, armed: bool = False) -> None:
        """Reboot, also in the air; its permanent memory stays. A watchdog's reboot keeps it armed."""
        self.booted = self.time
        self.armed = armed and self.armed
        self.current, self.target = 0, None
        self.mode = self.mode if self.armed else self.first_mode
        self.store.abandon()
        self.low, self.failed_safe = None, False
        self.fences = NO_FENCE
        if self.parameters.get("FENCE_ENABLE"):
            self.switch_fences(~Fence.ALT_MIN, on=True)

    def restart(self) -> None:
        """Reboot on the ground at home, like a simulator that was killed in flight and restarted."""
        self.reboot()
        self.body = Body(*self.home[:2], self.ground - self.home[2])

    # --- moving -----------------------------------------------------------------------------------

    def set_home(self, latitude: float, longitude: float, altitude: float) -> None:
        """Move its home; it stays where it is, and so does its target."""
        rise = altitude - self.home[2]
        self.home = (latitude, longitude, altitude)
        self.body = replace(self.body, height=self.body.height - rise)
        self.target = self.target and replace(self.target, height=self.target.height - rise)

    def height_in(self, height: float, frame: int) -> float:
        """Return a height in a frame as a height above home."""
        return height - self.home[2] if frame in (Frame.SEA_LEVEL, Frame.SEA_LEVEL_INT) else height

    def move(self, now: float) -> None:
        """Move on to a time."""
        seconds, self.time = now - self.time, now
        profile = self.kind.profile
        self.store.flown = self.armed and self.mode == profile.auto
        fences.switch_by_itself(self)
        if not self.armed or seconds <= 0:
            return
        self.charge = max(0.0, self.charge - seconds / ENDURANCE)
        fences.keep(self)
        self._watch_battery()
        self.told = self.told if self.mode == profile.auto else None
        self.refuge = self.refuge if self.mode == profile.home else None
        if self.mode == profile.auto:
            missions.follow(self, seconds)
        elif self.mode == profile.climb:
            self._climb(seconds)
        elif self.mode == profile.guided and self.target:
            self.go(self.target, seconds)
        elif self.mode == profile.home:
            self._return(seconds)
        else:
            self._idle(seconds)

    def _return(self, seconds: float) -> None:
        """Go to the nearest rally point or home, or by the landing sequence, as it is configured to."""
        if self.refuge is None:
            self.refuge, self.lands = missions.refuge(self), False
        if not self.lands and missions.may_land(self):
            self.lands = True
            if missions.land(self):
                return
        self.go(Target(*self.refuge, self.kind.profile.altitude, self.home_circle), seconds)

    def stay(self) -> None:
        """Hold where it is."""
        self.mode = self.kind.profile.hold
        self.target = Target(self.body.latitude, self.body.longitude, self.body.height, self.circle)

    def _climb(self, seconds: float) -> None:
        """Take off in the mode for it, and hold once it is high enough."""
        height = self.target.height if self.target else 0.0
        self.take_off(height, seconds)
        if self.body.height >= height - 1.0:
            self.stay()

    def holds(self, latitude: float, longitude: float, height: float) -> bool:
        """Tell whether somewhere is inside all fences that are on."""
        return fences.holds(self, latitude, longitude, height)

    def _watch_battery(self) -> None:
        """Return once the battery is low, if the parameters say so; who sends it on after that has overruled it."""
        if self.kind.profile.dialect.typed:
            self._watch_charge()
            return
        if self.volts >= self.parameters["BATT_LOW_VOLT"] or self.failed_safe:
            self.low = None
            return
        self.low = self.time if self.low is None else self.low
        if self.time - self.low < self.parameters["BATT_LOW_TIMER"]:
            return
        self.failed_safe = True
        self.words.append((WARNING, f"Battery 1 is low {self.volts:.2f}V used 0 mAh"))
        if self.parameters["BATT_FS_LOW_ACT"] == self.kind.returns:
            self.mode = self.kind.profile.home

    def _watch_charge(self) -> None:
        """Return once the charge is critical, if COM_LOW_BAT_ACT says so."""
        if self.charge > self.parameters["BAT_CRIT_THR"] or self.failed_safe:
            return
        self.failed_safe = True
        self.words.append((WARNING, "Critical battery, return"))
        if self.parameters["COM_LOW_BAT_ACT"] == LOW_BATTERY_RETURNS:
            self.mode = self.kind.profile.home

    def take_off(self, height: float, seconds: float) -> None:
        """Climb where it is, once it is fast enough."""
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
            speed = min(speed, max(0.0, fences.before_the_circle(self, course)))
        height = target.height if limits.climb else 0.0
        self.body = moved(self.body, limits, course, speed, height, seconds)

    def _idle(self, seconds: float) -> None:
        """Circle where it is, if it must move; else stop, at the height that it was told to take off to."""
        limits = self.kind.limits
        if limits.must_move and self.flies:
            circling = self.body.course + limits.turn * seconds * 0.5
            self.body = moved(self.body, limits, circling, self.speed, self.body.height, seconds)
        elif not limits.must_move:
            self.body = moved(self.body, limits, self.body.course, 0.0, self.body.height, seconds)
