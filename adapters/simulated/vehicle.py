"""A simulated vehicle: its state, its behaviour in each mode, and its start-up.

Commands and messages are `protocol`'s and `reporting`'s business, packets `serving`'s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import lru_cache
from typing import Final

from adapters.mavlink.constants import Cmd, Fence, FenceAction, Frame, MissionType
from adapters.mavlink.items import Item
from adapters.mavlink.profiles import BOAT, COPTER, PLANE, PX4_COPTER, PX4_PLANE, ROVER, Profile, TakeOff
from adapters.mavlink.signing import Signing
from adapters.simulated import body as bodies
from adapters.simulated.body import Body, Limits, astray, metres_to, moved, towards
from adapters.simulated.store import ARDUPILOT_MANNER, PX4_MANNER, Store
from physical import Geometry, PhysicalError, contains, point, polygon

WAYPOINT_RADIUS: Final = 50.0
"""Metres from a waypoint at which a plane takes the next."""

GRAVITY: Final = 9.81
FIX_AFTER: Final = 10.0
READY_AFTER: Final = 19.0
"""Seconds after boot at which it has a fix, and could be armed; before, it says that it is near (0, 0)."""

COMPLAINS_EVERY: Final = 30.0
"""Seconds between two texts of why it cannot be armed."""

CRITICAL: Final = 2
WARNING: Final = 4
NOTICE: Final = 5
INFO: Final = 6
"""MAV_SEVERITY_CRITICAL, _WARNING, _NOTICE and _INFO."""

ITEMS: Final[dict[int, str]] = {Cmd.TAKEOFF: "Takeoff", Cmd.WAYPOINT: "WP", Cmd.LOITER_UNLIMITED: "LoitUnlim"}
"""What ArduPilot calls the items of a mission when it begins them."""

ENDURANCE: Final = 7_200.0
"""Seconds for which a full battery lasts."""

SAG: Final = 1.8
"""Volts that it loses over the second half of its charge; that alone is not low yet."""

NO_FENCE: Final = Fence(0)
STOPS_BEFORE: Final = 4.0
"""Metres before its circle fence at which what drives stops, in silence."""

PARAMETERS: Final = {
    "WP_RADIUS": WAYPOINT_RADIUS,
    "FENCE_ENABLE": 0.0,
    "FENCE_RADIUS": 300.0,
    "BATT_LOW_VOLT": 10.5,
    "BATT_LOW_TIMER": 10.0,
    "BATT_FS_LOW_ACT": 0.0,
}
ALTITUDES: Final = {"FENCE_AUTOENABLE": 0.0, "FENCE_ALT_MAX": 100.0, "FENCE_ALT_MIN": -10.0}
OF_KINDS: Final = {
    TakeOff.MISSION: ALTITUDES | {"FENCE_TYPE": 4.0, "WP_LOITER_RAD": 80.0, "RTL_RADIUS": 0.0},
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


@dataclass(frozen=True, slots=True)
class Target:
    """Where a guided vehicle goes: degrees, metres above home, the circle's radius."""

    latitude: float
    longitude: float
    height: float
    circle: float


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
        fault: Why it cannot be armed, beside that it has only just booted; it says so every 30 s.
        told: The item of its mission that it has said it begins.
        breached: Whether it was outside a fence when it last looked.
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
    fault: str = ""
    complained: float = -math.inf
    low: float | None = None
    failed_safe: bool = False
    charge: float = 1.0
    words: list[tuple[int, str]] = field(default_factory=list)
    told: int | None = None
    breached: bool = False

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
    def fence(self) -> Geometry | None:
        """The polygon that it keeps within."""
        acts = self.fence_action is not None and self.fence_action > FenceAction.WARN
        return self.polygon if acts or Fence.POLYGON in self.fences else None

    @property
    def polygon(self) -> Geometry | None:
        """The polygon that is on board, if it is one."""
        return _polygon(tuple((each.x, each.y) for each in self.store.items.get(MissionType.FENCE, ())))

    @property
    def configured(self) -> Fence:
        """Which fences it would keep within if they were on."""
        configured = Fence(int(self.parameters.get("FENCE_TYPE", 0)))
        return configured if self.polygon is not None else configured & ~Fence.POLYGON

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
    def ready(self) -> bool:
        """Whether it could be armed, and takes missions."""
        return self.uptime >= READY_AFTER and not self.fault

    def reboot(self, *, armed: bool = False) -> None:
        """Reboot, also in the air; its permanent memory stays. A watchdog's reboot keeps it armed."""
        self.booted = self.time
        self.armed = armed and self.armed
        self.current, self.target = 0, None
        self.mode = self.mode if self.armed else self.first_mode
        self.store.receiving = None
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
        self._complain()
        if not self.armed or seconds <= 0:
            return
        self.charge = max(0.0, self.charge - seconds / ENDURANCE)
        self._keep_fence()
        self._watch_battery()
        profile = self.kind.profile
        self.told = self.told if self.mode == profile.auto else None
        if self.mode == profile.auto:
            self._follow(seconds)
        elif self.mode == profile.climb:
            self._climb(seconds)
        elif self.mode == profile.guided and self.target:
            self._go(self.target, seconds)
        elif self.mode == profile.home:
            self._go(Target(*self.home[:2], profile.altitude, self.home_circle), seconds)
        else:
            self._idle(seconds)

    def _complain(self) -> None:
        """Say why it cannot be armed, every 30 s."""
        due = self.uptime >= READY_AFTER and self.uptime - self.complained >= COMPLAINS_EVERY
        if self.fault and due and not self.armed:
            self.complained = self.uptime
            self.words.append((CRITICAL, f"PreArm: {self.fault}"))

    def _keep_fence(self) -> None:
        """Return, or stop, as soon as it is outside a fence; what drives has stopped before its circle."""
        here = self.body
        outside = not self.holds(here.latitude, here.longitude, here.height)
        if outside and self.fence_action is FenceAction.HOLD:
            if not self.breached:
                self.words.append((WARNING, "Geofence violation: holding"))
                self.stay()
        elif outside:
            if not self.breached and not self.kind.profile.dialect.typed:
                self.words.append((NOTICE, f"{self._breached_fence()} fence breached"))
            self.mode = self.kind.profile.home
        self.breached = outside

    def _breached_fence(self) -> str:
        """Name the fence that it is outside of, as ArduPilot does."""
        here, fence = self.body, self.fence
        if fence is not None and not contains(fence, point(here.latitude, here.longitude)):
            return "Polygon"
        higher = Fence.ALT_MAX in self.fences and here.height > self.parameters["FENCE_ALT_MAX"]
        return "Max Alt" if higher else "Circle"

    def stay(self) -> None:
        """Hold where it is."""
        self.mode = self.kind.profile.hold
        self.target = Target(self.body.latitude, self.body.longitude, self.body.height, self.circle)

    def _climb(self, seconds: float) -> None:
        """Take off in the mode for it, and hold once it is high enough."""
        height = self.target.height if self.target else 0.0
        self._take_off(height, seconds)
        if self.body.height >= height - 1.0:
            self.stay()

    def holds(self, latitude: float, longitude: float, height: float) -> bool:
        """Tell whether somewhere is inside all fences that are on."""
        fence = self.fence
        inside = fence is None or contains(fence, point(latitude, longitude))
        if Fence.CIRCLE in self.fences:
            away = metres_to(Body(*self.home[:2]), latitude, longitude)[0]
            inside = inside and away <= self.parameters["FENCE_RADIUS"]
        if Fence.ALT_MAX in self.fences:
            inside = inside and height <= self.parameters["FENCE_ALT_MAX"]
        return inside

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

    def _follow(self, seconds: float) -> None:
        items = self.store.items.get(MissionType.MISSION, ())
        first = int(self.kind.profile.dialect.home_is_item)
        if len(items) <= first:
            return
        self.current = max(first, min(self.current, len(items) - 1))
        item = items[self.current]
        if self.told != self.current:
            self.told = self.current
            self.words.append((INFO, f"Mission: {self.current} {ITEMS.get(item.command, item.command)}"))
        if item.command == Cmd.TAKEOFF:
            self._take_off(self.height_in(item.z, item.frame), seconds)
        else:
            stays = item.command == Cmd.LOITER_UNLIMITED
            circle = self.circle if stays and self.kind.limits.must_move else 0.0
            self._go(Target(item.x / 1e7, item.y / 1e7, self.height_in(item.z, item.frame), circle), seconds)
        if self._done(item) and self.current < len(items) - 1:
            self.reached.append(self.current)
            if item.command == Cmd.WAYPOINT:
                away = metres_to(self.body, item.x / 1e7, item.y / 1e7)[0]
                self.words.append((INFO, f"Reached waypoint #{self.current} dist {away:.0f}m"))
            self.current += 1

    def _done(self, item: Item) -> bool:
        if item.command == Cmd.TAKEOFF:
            return self.body.height >= self.height_in(item.z, item.frame) - 1.0
        distance, _ = metres_to(self.body, item.x / 1e7, item.y / 1e7)
        return item.command == Cmd.WAYPOINT and distance <= self.kind.radius

    def _take_off(self, height: float, seconds: float) -> None:
        limits = self.kind.limits
        speed = self.speed if limits.must_move else 0.0
        rising = height if not limits.must_move or self.body.speed > 0.6 * speed else self.body.height
        self.body = moved(self.body, limits, self.body.course, speed, rising, seconds)

    def _go(self, target: Target, seconds: float) -> None:
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

    def _idle(self, seconds: float) -> None:
        """Circle where it is, if it must move; else stop, at the height that it was told to take off to."""
        limits = self.kind.limits
        if limits.must_move and self.flies:
            circling = self.body.course + limits.turn * seconds * 0.5
            self.body = moved(self.body, limits, circling, self.speed, self.body.height, seconds)
        elif not limits.must_move:
            self.body = moved(self.body, limits, self.body.course, 0.0, self.body.height, seconds)


@lru_cache(maxsize=64)
def _polygon(corners: tuple[tuple[int, int], ...]) -> Geometry | None:
    """Return the polygon of corners in 1e-7 degrees, None if they make none; it is asked for at each step."""
    try:
        return polygon([(latitude / 1e7, longitude / 1e7) for latitude, longitude in corners])
    except PhysicalError:
        return None
