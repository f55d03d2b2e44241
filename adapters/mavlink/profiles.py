"""Profiles of vehicle types: modes, take-off, and how well they hold a position.

The numbers are ArduPilot 4.6's; the kind comes from HEARTBEAT.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from adapters.mavlink.constants import ARDUPILOT, CIRCLE_PARAMETERS, FENCE_PARAMETERS, HEIGHT_PARAMETERS


class TakeOff(StrEnum):
    """How a vehicle leaves the ground."""

    MISSION = "by a mission whose first item is a take-off"
    COMMAND = "by a command, in guided mode"
    NONE = "it does not"


@dataclass(frozen=True, slots=True)
class Profile:
    """One kind of vehicle.

    Attributes:
        kind: The name that people use.
        modes: Its modes by number.
        guided: The mode in which it goes to a point and stays.
        auto: The mode in which it follows its mission.
        hold: The mode in which it stays where it is, without a pilot's sticks.
        home: The mode in which it returns.
        takeoff: How it leaves the ground.
        circle: The radius in metres that it needs to stay somewhere.
        reach: How near in metres counts as being at a point.
        altitude: Its default height in metres above home.
        parameters: The parameters of its limits and its circles.
        drift: The factor by which wind and inertia widen its circle.
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
    parameters: tuple[str, ...] = FENCE_PARAMETERS
    drift: float = 1.0

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

FLIES: Final = (*FENCE_PARAMETERS, *HEIGHT_PARAMETERS)

# Seen: 50 m at waypoints, and circles of 80 m in guided mode, in 8 m/s of wind from 85 to 103 m: 1.29 times as far out.
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
    (*FLIES, *CIRCLE_PARAMETERS),
    1.3,
)
# BRAKE: LOITER would use the centre of a throttle stick that no pilot holds.
COPTER: Final = Profile("copter", _COPTER_MODES, 4, 3, 17, 6, TakeOff.COMMAND, 5.0, 5.0, 30.0, FLIES)
ROVER: Final = Profile("rover", _ROVER_MODES, 15, 10, 4, 11, TakeOff.NONE, 2.0, 4.0, 0.0)
# A boat in HOLD drifts away: it must keep its position.
BOAT: Final = Profile("boat", _ROVER_MODES, 15, 10, 5, 11, TakeOff.NONE, 5.0, 8.0, 0.0)

_BY_TYPE: Final = (
    ((1, 19, 20, 21, 22, 23, 24, 25), PLANE),
    ((2, 3, 4, 13, 14, 15, 29), COPTER),
    ((10,), ROVER),
    ((11,), BOAT),
)


def profile_of(vehicle_type: int, autopilot: int) -> Profile | None:
    """Return the profile of a HEARTBEAT's sender; None for a kind that we can't command.

    >>> profile_of(2, 3).kind, profile_of(2, 12)
    ('copter', None)
    """
    if autopilot != ARDUPILOT:
        return None
    return next((profile for types, profile in _BY_TYPE if vehicle_type in types), None)
