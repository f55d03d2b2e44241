"""Profiles of vehicle types: their autopilot's dialect, modes, take-off, and precision in holding a position.

The numbers are ArduPilot 4.6's and PX4 1.18's; kind and autopilot come from HEARTBEAT.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from adapters.mavlink.constants import (
    ARDUPILOT,
    ARMING_PARAMETERS,
    AUTHORITY_PARAMETERS,
    CIRCLE_PARAMETERS,
    FENCE_PARAMETERS,
    HEIGHT_PARAMETERS,
    LANDING_PARAMETERS,
    PX4,
    REGULAR,
)


class TakeOff(StrEnum):
    """How a vehicle leaves the ground."""

    MISSION = "by a mission whose first item is a take-off"
    COMMAND = "by a command, in guided mode"
    MODE = "by a command that puts it into a mode of its own, which it leaves at its height"
    NONE = "it does not"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The differences of one make of autopilot, with the same messages.

    Attributes:
        name: Its name for people.
        number: Its MAV_AUTOPILOT.
        authority: The parameters, by version, for the station that it obeys; none: it obeys all on its link.
        circle: The parameter of the radius at which it circles.
        home_circle: The parameter of the radius at which it circles its home.
        fence_action: The parameter of its action at its fences; empty: they are switched on and off.
        fence_circle: The parameter of its fence around home.
        fence_ceiling: The parameter of its fence above home.
        landing_rule: The parameter that may demand a landing of each mission; empty: none does.
        main_and_sub: Whether a mode's number consists of a main mode and a sub-mode.
        above_sea: Whether heights of commands are above sea level, not above home.
        home_is_item: Whether item 0 of a mission is home.
        begins_by_command: Whether a command, not a message, makes an item of a mission the current one.
        enters: Whether every target needs the flag that enters guided mode, or else may be refused.
        lands_by_state: Whether EXTENDED_SYS_STATE reports flight; else HEARTBEAT does.
        typed: Whether parameters are the bytes of their type, not all floats.
        unites: Whether any one of its fence's inclusion zones is enough; else it must be in all.
        marks_landing: Whether a landing sequence begins with a marker; else also with the landing.
        streams: The messages that it is asked to send regularly.
    """

    name: str
    number: int
    authority: tuple[str, ...]
    circle: str
    home_circle: str
    fence_circle: str
    fence_ceiling: str
    fence_action: str = ""
    landing_rule: str = ""
    main_and_sub: bool = False
    above_sea: bool = False
    home_is_item: bool = False
    begins_by_command: bool = True
    enters: bool = False
    lands_by_state: bool = False
    typed: bool = False
    unites: bool = False
    marks_landing: bool = True
    streams: tuple[str, ...] = REGULAR

    def mode_parameters(self, mode: int) -> tuple[int, ...]:
        """Return the second parameter, and maybe the third, of DO_SET_MODE.

        >>> PX4_DIALECT.mode_parameters(mode_number(4, 3)), ARDUPILOT_DIALECT.mode_parameters(15)
        ((4, 3), (15,))
        """
        return (mode >> 16 & 255, mode >> 24 & 255) if self.main_and_sub else (mode,)


def mode_number(main: int, sub: int = 0) -> int:
    """Return PX4's number of a mode, in the form of HEARTBEAT."""
    return main << 16 | sub << 24


ARDUPILOT_DIALECT: Final = Dialect(
    "ArduPilot",
    ARDUPILOT,
    AUTHORITY_PARAMETERS,
    circle="WP_LOITER_RAD",
    home_circle="RTL_RADIUS",
    fence_circle="FENCE_RADIUS",
    fence_ceiling="FENCE_ALT_MAX",
    home_is_item=True,
    streams=tuple(name for name in REGULAR if name != "EXTENDED_SYS_STATE"),
)

PX4_DIALECT: Final = Dialect(
    "PX4",
    PX4,
    (),
    circle="NAV_LOITER_RAD",
    home_circle="RTL_LOITER_RAD",
    fence_circle="GF_MAX_HOR_DIST",
    fence_ceiling="GF_MAX_VER_DIST",
    fence_action="GF_ACTION",
    landing_rule="MIS_TKO_LAND_REQ",
    main_and_sub=True,
    above_sea=True,
    begins_by_command=False,
    enters=True,
    lands_by_state=True,
    typed=True,
    streams=(*(name for name in REGULAR if name != "EKF_STATUS_REPORT"), "ESTIMATOR_STATUS"),
    unites=True,
    marks_landing=False,
)


@dataclass(frozen=True, slots=True)
class Profile:
    """One kind of vehicle.

    Attributes:
        kind: Its name for people.
        modes: Its modes by number.
        guided: The mode in which it goes to a point and stays.
        auto: The mode in which it follows its mission.
        hold: The mode in which it stays where it is, without a pilot's sticks.
        home: The mode in which it returns.
        takeoff: How it leaves the ground.
        circle: The radius in metres that it needs to stay somewhere.
        reach: The distance in metres that counts as being at a point.
        altitude: Its default height in metres above home.
        parameters: The parameters of its limits and its circles.
        drift: The factor by which wind and inertia widen its circle.
        dialect: The differences of its autopilot from others.
        climb: The mode in which it takes off, if it has one for that.
        rise: The height in metres above home of a take-off by command, before any other target.
    """

    kind: str
    modes: dict[int, str]
    guided: int
    auto: int
    hold: int
    home: int
    takeoff: TakeOff
    circle: float
    reach: float
    altitude: float
    parameters: tuple[str, ...] = (*FENCE_PARAMETERS, *ARMING_PARAMETERS)
    drift: float = 1.0
    dialect: Dialect = ARDUPILOT_DIALECT
    climb: int | None = None
    rise: float = 10.0

    def mode_name(self, mode: int | None) -> str:
        """Name a mode for people."""
        return self.modes.get(-1 if mode is None else mode, f"mode {mode}")


_PLANE_MODES: Final = {
    0: "MANUAL", 1: "CIRCLE", 2: "STABILIZE", 5: "FBWA", 6: "FBWB", 7: "CRUISE",
    10: "AUTO", 11: "RTL", 12: "LOITER", 13: "TAKEOFF", 15: "GUIDED",
}  # fmt: skip
_COPTER_MODES: Final = {
    0: "STABILIZE", 2: "ALT_HOLD", 3: "AUTO", 4: "GUIDED", 5: "LOITER", 6: "RTL", 9: "LAND", 16: "POSHOLD", 17: "BRAKE",
}  # fmt: skip
_ROVER_MODES: Final = {
    0: "MANUAL", 1: "ACRO", 3: "STEERING", 4: "HOLD", 5: "LOITER", 10: "AUTO", 11: "RTL", 15: "GUIDED",
}  # fmt: skip

FLIES: Final = (*FENCE_PARAMETERS, *HEIGHT_PARAMETERS, *ARMING_PARAMETERS)

# Measured: 50 m at waypoints; circles of 80 m in guided mode have 85 to 103 m in 8 m/s of wind: 1.29 times.
PLANE: Final = Profile(
    "plane",
    _PLANE_MODES,
    15,
    10,
    12,
    11,
    TakeOff.MISSION,
    80.0,
    100.0,
    100.0,
    (*FLIES, *CIRCLE_PARAMETERS, *LANDING_PARAMETERS),
    1.3,
)
# BRAKE: LOITER would use the centre of a throttle stick that no pilot holds.
COPTER: Final = Profile("copter", _COPTER_MODES, 4, 3, 17, 6, TakeOff.COMMAND, 5.0, 5.0, 30.0, FLIES)
ROVER: Final = Profile("rover", _ROVER_MODES, 15, 10, 4, 11, TakeOff.NONE, 2.0, 4.0, 0.0)
# A boat in HOLD drifts away: it must keep its position.
BOAT: Final = Profile("boat", _ROVER_MODES, 15, 10, 5, 11, TakeOff.NONE, 5.0, 8.0, 0.0)

AUTO: Final = 4
"""PX4's main mode of all autonomous flight."""

_PX4_MODES: Final = {
    mode_number(1): "MANUAL", mode_number(2): "ALTCTL", mode_number(3): "POSCTL", mode_number(5): "ACRO",
    mode_number(6): "OFFBOARD", mode_number(7): "STABILIZED", mode_number(10): "TERMINATION",
    mode_number(3, 1): "POSCTL.ORBIT", mode_number(3, 2): "POSCTL.SLOW",
    mode_number(AUTO, 1): "AUTO.READY", mode_number(AUTO, 2): "AUTO.TAKEOFF", mode_number(AUTO, 3): "AUTO.LOITER",
    mode_number(AUTO, 4): "AUTO.MISSION", mode_number(AUTO, 5): "AUTO.RTL", mode_number(AUTO, 6): "AUTO.LAND",
    mode_number(AUTO, 8): "AUTO.FOLLOW_TARGET", mode_number(AUTO, 9): "AUTO.PRECLAND",
}  # fmt: skip
_TAKES_OFF, _LOITER, _MISSION, _RTL = (mode_number(AUTO, sub) for sub in (2, 3, 4, 5))
_PX4_FLIES: Final = ("GF_ACTION", "GF_MAX_HOR_DIST", "GF_MAX_VER_DIST", "MIS_TKO_LAND_REQ")

PX4_PLANE: Final = Profile(
    "plane",
    _PX4_MODES,
    _LOITER,
    _MISSION,
    _LOITER,
    _RTL,
    TakeOff.MODE,
    80.0,
    100.0,
    100.0,
    (*_PX4_FLIES, "NAV_LOITER_RAD", "RTL_LOITER_RAD"),
    1.3,
    PX4_DIALECT,
    _TAKES_OFF,
    30.0,
)
PX4_COPTER: Final = Profile(
    "copter",
    _PX4_MODES,
    _LOITER,
    _MISSION,
    _LOITER,
    _RTL,
    TakeOff.MODE,
    5.0,
    5.0,
    30.0,
    _PX4_FLIES,
    dialect=PX4_DIALECT,
    climb=_TAKES_OFF,
)

_PLANES, _VTOLS, _COPTERS = (1,), (19, 20, 21, 22, 23, 24, 25), (2, 3, 4, 13, 14, 15, 29)
_BY_TYPE: Final = {
    ARDUPILOT: (((*_PLANES, *_VTOLS), PLANE), (_COPTERS, COPTER), ((10,), ROVER), ((11,), BOAT)),
    PX4: ((_PLANES, PX4_PLANE), (_COPTERS, PX4_COPTER)),
}


def profile_of(vehicle_type: int, autopilot: int) -> Profile | None:
    """Return the profile of a HEARTBEAT's sender; None for a kind that we can't command.

    >>> profile_of(2, 3).kind, profile_of(1, 12).dialect.name, profile_of(10, 12)
    ('copter', 'PX4', None)
    """
    profiles = _BY_TYPE.get(autopilot, ())
    return next((profile for types, profile in profiles if vehicle_type in types), None)


def unknown_kind(vehicle_type: int, autopilot: int) -> str:
    """Return the reason why a HEARTBEAT's sender has no profile.

    >>> unknown_kind(20, 12)
    'it is a vehicle of MAV_TYPE 20 with PX4, of which only planes and copters are known here'
    """
    if autopilot not in _BY_TYPE:
        return f"it is no vehicle with ArduPilot or PX4, and only those are known here (MAV_AUTOPILOT {autopilot})"
    kinds = [f"{profile.kind}s" for _, profile in _BY_TYPE[autopilot]]
    listed = f"{', '.join(kinds[:-1])} and {kinds[-1]}"
    name = _BY_TYPE[autopilot][0][1].dialect.name
    return f"it is a vehicle of MAV_TYPE {vehicle_type} with {name}, of which only {listed} are known here"
