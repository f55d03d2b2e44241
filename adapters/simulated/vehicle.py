"""A simulated vehicle: its state, its behaviour in each mode, and its start-up.

Commands and messages are `protocol`'s and `reporting`'s business, packets `serving`'s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import lru_cache
from typing import Final

from adapters.mavlink.constants import AUTHORITY_PARAMETERS, Cmd, Fence, MissionType
from adapters.mavlink.items import Item
from adapters.mavlink.profiles import BOAT, COPTER, PLANE, ROVER, Profile, TakeOff
from adapters.mavlink.signing import Signing
from adapters.simulated import body as bodies
from adapters.simulated.body import Body, Limits, astray, metres_to, moved, towards
from adapters.simulated.store import Store
from physical import Geometry, PhysicalError, contains, point, polygon

WAYPOINT_RADIUS: Final = 50.0
"""Metres from a waypoint at which a plane takes the next."""

FIX_AFTER: Final = 10.0
READY_AFTER: Final = 19.0
"""Seconds after boot at which it has a fix, and could be armed; before, it says that it is near (0, 0)."""

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


class Kind(Enum):
    """A kind of vehicle: MAV_TYPE, profile, limits, radius around a waypoint, how it asks for mission items."""

    PLANE = (1, PLANE, bodies.PLANE, WAYPOINT_RADIUS, "MISSION_REQUEST")
    COPTER = (2, COPTER, bodies.COPTER, 2.0, "MISSION_REQUEST_INT")
    ROVER = (10, ROVER, bodies.ROVER, 2.0, "MISSION_REQUEST_INT")
    BOAT = (11, BOAT, bodies.ROVER, 4.0, "MISSION_REQUEST_INT")

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
        fences: Which of its fences are on.
        version: Of its firmware: before 4.6 all fences were switched at once.
        wind: Metres a second to the north and to the east: it carries a plane out of its circle.
        serial: Its autopilot's serial number: at most 18 bytes.
        voltage: Its battery's; when it is low for a while, the fail-safe acts once.
        low: Since when it is low.
        failed_safe: Whether the fail-safe has acted since it booted.
        words: What it has to say.
    """

    kind: Kind
    home: tuple[float, float, float]
    system: int = 1
    speedup: float = 1.0
    enforce: bool = True
    accept_unsigned: bool = False
    fixed: bool = True
    booted: float = 0.0
    time: float = 0.0
    armed: bool = False
    mode: int = 0
    current: int = 0
    target: Target | None = None
    fences: Fence = NO_FENCE
    version: tuple[int, int, int] = (4, 6, 3)
    wind: tuple[float, float] = (0.0, 0.0)
    parameters: dict[str, float] = field(default_factory=dict)
    signing: Signing | None = None
    serial: bytes = b""
    body: Body = field(init=False)
    store: Store = field(init=False)
    reached: list[int] = field(default_factory=list)
    voltage: float = 12.6
    low: float | None = None
    failed_safe: bool = False
    words: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        latitude, longitude, altitude = self.home
        defaults = PARAMETERS | OF_KINDS[self.kind.profile.takeoff] | {self.authority_parameter: 255.0}
        self.parameters = defaults | self.parameters
        self.body = Body(latitude, longitude)
        self.store = Store(self.kind.value[4], (round(latitude * 1e7), round(longitude * 1e7), altitude))

    @property
    def authority_parameter(self) -> str:
        """The name of its authority parameter."""
        return AUTHORITY_PARAMETERS[self.version >= (4, 7, 0)]

    @property
    def fence(self) -> Geometry | None:
        """The polygon that it keeps within."""
        return self.polygon if Fence.POLYGON in self.fences else None

    @property
    def polygon(self) -> Geometry | None:
        """The polygon that is on board, if it is one."""
        return _polygon(tuple((each.x, each.y) for each in self.store.items.get(MissionType.FENCE, ())))

    @property
    def configured(self) -> Fence:
        """Which fences it would keep within if they were on."""
        configured = Fence(int(self.parameters["FENCE_TYPE"]))
        return configured if self.polygon is not None else configured & ~Fence.POLYGON

    def switch_fences(self, fences: Fence, *, on: bool) -> None:
        """Switch the fences on, or off, that it is configured to have."""
        meant = fences & Fence(int(self.parameters["FENCE_TYPE"]))
        self.fences = self.fences | meant if on else self.fences & ~meant

    @property
    def circle(self) -> float:
        """The radius at which it circles where it is told none."""
        return (
            abs(self.parameters["WP_LOITER_RAD"]) if self.kind.limits.must_move else self.kind.profile.circle
        )

    @property
    def home_circle(self) -> float:
        """The radius at which it circles its home; counter-clockwise if negative."""
        return self.parameters.get("RTL_RADIUS") or self.circle

    @property
    def flies(self) -> bool:
        """Whether it is off the ground; for what does not fly, whether it is armed."""
        return self.armed and (self.kind.profile.takeoff is TakeOff.NONE or self.body.height > 1.0)

    @property
    def uptime(self) -> float:
        """Seconds since it booted, by its own clock."""
        return (self.time - self.booted) * self.speedup

    @property
    def has_fix(self) -> bool:
        """Whether it knows where it is."""
        return self.fixed and self.uptime >= FIX_AFTER

    @property
    def ready(self) -> bool:
        """Whether it could be armed, and takes missions."""
        return self.uptime >= READY_AFTER

    def reboot(self, *, armed: bool = False) -> None:
        """Reboot, also in the air; its permanent memory stays. A watchdog's reboot keeps it armed."""
        self.booted = self.time
        self.armed = armed and self.armed
        self.current, self.target = 0, None
        self.mode = self.mode if self.armed else 0
        self.store.receiving = None
        self.low, self.failed_safe = None, False
        self.fences = NO_FENCE
        if self.parameters["FENCE_ENABLE"]:
            self.switch_fences(~Fence.ALT_MIN, on=True)

    def restart(self) -> None:
        """Reboot on the ground at home, like a simulator that was killed in flight and restarted."""
        self.reboot()
        self.body = Body(*self.home[:2])

    # --- moving -----------------------------------------------------------------------------------

    def move(self, now: float) -> None:
        """Move on to a time."""
        seconds, self.time = now - self.time, now
        if not self.armed or seconds <= 0:
            return
        self._keep_fence()
        self._watch_battery()
        profile = self.kind.profile
        if self.mode == profile.auto:
            self._follow(seconds)
        elif self.mode == profile.guided and self.target:
            self._go(self.target, seconds)
        elif self.mode == profile.home:
            self._go(Target(*self.home[:2], profile.altitude, self.home_circle), seconds)
        else:
            self._idle(seconds)

    def _keep_fence(self) -> None:
        """Return as soon as it is outside a fence; what drives has stopped before its circle."""
        here = self.body
        if not self.holds(here.latitude, here.longitude, here.height):
            self.mode = self.kind.profile.home

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
        if self.voltage >= self.parameters["BATT_LOW_VOLT"] or self.failed_safe:
            self.low = None
            return
        self.low = self.time if self.low is None else self.low
        if self.time - self.low < self.parameters["BATT_LOW_TIMER"]:
            return
        self.failed_safe = True
        self.words.append(f"Battery 1 is low {self.voltage:.2f}V used 0 mAh")
        if self.parameters["BATT_FS_LOW_ACT"] == self.kind.returns:
            self.mode = self.kind.profile.home

    def _follow(self, seconds: float) -> None:
        items = self.store.items.get(MissionType.MISSION, ())
        if len(items) < 2:
            return
        self.current = max(1, min(self.current, len(items) - 1))
        item = items[self.current]
        if item.command == Cmd.TAKEOFF:
            self._take_off(item.z, seconds)
        else:
            stays = item.command == Cmd.LOITER_UNLIMITED
            circle = self.circle if stays and self.kind.limits.must_move else 0.0
            self._go(Target(item.x / 1e7, item.y / 1e7, item.z, circle), seconds)
        if self._done(item) and self.current < len(items) - 1:
            self.reached.append(self.current)
            self.current += 1

    def _done(self, item: Item) -> bool:
        if item.command == Cmd.TAKEOFF:
            return self.body.height >= item.z - 1.0
        distance, _ = metres_to(self.body, item.x / 1e7, item.y / 1e7)
        return item.command == Cmd.WAYPOINT and distance <= self.kind.radius

    def _take_off(self, height: float, seconds: float) -> None:
        limits = self.kind.limits
        speed = limits.speed if limits.must_move else 0.0
        rising = height if not limits.must_move or self.body.speed > 0.6 * speed else self.body.height
        self.body = moved(self.body, limits, self.body.course, speed, rising, seconds)

    def _go(self, target: Target, seconds: float) -> None:
        limits = self.kind.limits
        if limits.must_move:
            _, bearing = metres_to(self.body, target.latitude, target.longitude)
            circle = target.circle * astray(bearing, self.wind)
            course = towards(self.body, target.latitude, target.longitude, circle)
            self.body = moved(self.body, limits, course, limits.speed, target.height, seconds)
            return
        distance, course = metres_to(self.body, target.latitude, target.longitude)
        speed = min(limits.speed, distance)  # slows down over the last second
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
            self.body = moved(self.body, limits, circling, limits.speed, self.body.height, seconds)
        elif not limits.must_move:
            self.body = moved(self.body, limits, self.body.course, 0.0, self.body.height, seconds)


@lru_cache(maxsize=64)
def _polygon(corners: tuple[tuple[int, int], ...]) -> Geometry | None:
    """Return the polygon of corners in 1e-7 degrees, None if they make none; it is asked for at each step."""
    try:
        return polygon([(latitude / 1e7, longitude / 1e7) for latitude, longitude in corners])
    except PhysicalError:
        return None
