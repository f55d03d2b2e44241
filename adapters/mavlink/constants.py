"""MAVLink's numeric constants, by their names there."""

from enum import IntEnum, IntFlag
from typing import Final

AUTOPILOT_COMPONENT: Final = 1
GROUND_STATION: Final = 6
"""MAV_TYPE_GCS."""

GROUND_COMPONENT: Final = 190
"""MAV_COMP_ID_MISSIONPLANNER: the component id of ground stations."""

ARDUPILOT: Final = 3
"""MAV_AUTOPILOT_ARDUPILOTMEGA."""

PX4: Final = 12
"""MAV_AUTOPILOT_PX4."""

INTEGERS: Final = range(1, 7)
"""MAV_PARAM_TYPE of numbers without a fraction, of at most 32 bits."""

NO_AUTOPILOT: Final = 8
ACTIVE: Final = 4
"""MAV_STATE_ACTIVE: for an aircraft, in the air."""

PREARM_HEALTHY: Final = 0x10000000
"""The bit of SYS_STATUS for a vehicle that could be armed, and takes missions."""

GEOFENCE: Final = 0x100000
"""The bit of SYS_STATUS for an active fence."""

FIX_3D: Final = 3
AUTOPILOT_VERSION: Final = 148
"""The number of the message with an autopilot's serial number."""

AUTHORITY_PARAMETERS: Final = ("SYSID_MYGCS", "MAV_GCS_SYSID")
"""ArduPilot's parameter for the ground station that it obeys: its name up to 4.6, and from 4.7 on."""

FENCE_PARAMETERS: Final = ("FENCE_ENABLE", "FENCE_TYPE", "FENCE_RADIUS", "FENCE_ACTION")
HEIGHT_PARAMETERS: Final = ("FENCE_AUTOENABLE", "FENCE_ALT_MAX", "FENCE_OPTIONS")
ARMING_PARAMETERS: Final = ("ARMING_MIS_ITEMS", "RALLY_LIMIT_KM", "RALLY_INCL_HOME")
LANDING_PARAMETERS: Final = ("RTL_AUTOLAND", "WP_RADIUS")
CIRCLE_PARAMETERS: Final = ("WP_LOITER_RAD", "RTL_RADIUS")


class ModeFlag(IntFlag):
    """MAV_MODE_FLAG, the flags that we use."""

    CUSTOM_MODE = 1
    ARMED = 128


class MavFrame(IntEnum):
    """MAV_FRAME: the origin of an altitude."""

    SEA_LEVEL = 0
    HOME = 3
    SEA_LEVEL_INT = 5
    HOME_INT = 6


class Estimate(IntFlag):
    """EKF_STATUS_FLAGS, with the same numbers as ESTIMATOR_STATUS_FLAGS: the flags that we use."""

    POS_HORIZ_REL = 8
    POS_HORIZ_ABS = 16
    CONST_POS_MODE = 128
    PRED_POS_HORIZ_ABS = 512
    UNINITIALIZED = 1024


KNOWN_FLAGS: Final = sum(Estimate)


class Landed(IntEnum):
    """MAV_LANDED_STATE."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4


class FenceAction(IntEnum):
    """PX4's actions at its fences: the values of GF_ACTION (navigator/geofence_params.yaml)."""

    NONE = 0
    WARN = 1
    HOLD = 2
    RETURN = 3
    TERMINATE = 4
    LAND = 5


class MissionType(IntEnum):
    """MAV_MISSION_TYPE."""

    MISSION = 0
    FENCE = 1
    RALLY = 2


class Fence(IntFlag):
    """ArduPilot's fences: the bits of FENCE_TYPE, and of the second parameter of DO_FENCE_ENABLE."""

    ALT_MAX = 1
    CIRCLE = 2
    POLYGON = 4
    ALT_MIN = 8


class MissionResult(IntEnum):
    """MAV_MISSION_RESULT."""

    ACCEPTED = 0
    ERROR = 1
    UNSUPPORTED_FRAME = 2
    UNSUPPORTED = 3
    NO_SPACE = 4
    INVALID = 5
    INVALID_PARAM1 = 6
    INVALID_PARAM2 = 7
    INVALID_PARAM3 = 8
    INVALID_PARAM4 = 9
    INVALID_PARAM5_X = 10
    INVALID_PARAM6_Y = 11
    INVALID_PARAM7 = 12
    INVALID_SEQUENCE = 13
    DENIED = 14
    CANCELLED = 15


class Result(IntEnum):
    """MAV_RESULT: the answer to a command."""

    ACCEPTED = 0
    TEMPORARILY_REJECTED = 1
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4
    IN_PROGRESS = 5
    CANCELLED = 6


class Cmd(IntEnum):
    """MAV_CMD, the commands that we use."""

    WAYPOINT = 16
    LOITER_UNLIMITED = 17
    RETURN_TO_LAUNCH = 20
    LAND = 21
    TAKEOFF = 22
    VTOL_TAKEOFF = 84
    VTOL_LAND = 85
    DO_SET_MODE = 176
    DO_JUMP = 177
    DO_SET_HOME = 179
    DO_RETURN_PATH_START = 188
    DO_LAND_START = 189
    REPOSITION = 192
    FENCE_ENABLE = 207
    SET_MISSION_CURRENT = 224
    MISSION_START = 300
    ARM_DISARM = 400
    SET_MESSAGE_INTERVAL = 511
    REQUEST_MESSAGE = 512
    FENCE_RETURN_POINT = 5000
    FENCE_VERTEX_INCLUSION = 5001
    FENCE_VERTEX_EXCLUSION = 5002
    FENCE_CIRCLE_INCLUSION = 5003
    FENCE_CIRCLE_EXCLUSION = 5004
    RALLY_POINT = 5100


STREAMS: Final = {
    "GLOBAL_POSITION_INT": (33, 0.2),
    "SYS_STATUS": (1, 1.0),
    "GPS_RAW_INT": (24, 1.0),
    "MISSION_CURRENT": (42, 1.0),
    "POSITION_TARGET_GLOBAL_INT": (87, 1.0),
    "HOME_POSITION": (242, 5.0),
    "EXTENDED_SYS_STATE": (245, 1.0),
    "EKF_STATUS_REPORT": (193, 1.0),
    "ESTIMATOR_STATUS": (230, 1.0),
    "ATTITUDE": (30, 0.2),
}
"""The messages that a vehicle can send regularly: number, and period in seconds."""

REGULAR: Final = tuple(name for name in STREAMS if name not in ("ATTITUDE", "ESTIMATOR_STATUS"))
"""The messages requested of a vehicle of unknown kind; its attitude only matters for a camera."""
