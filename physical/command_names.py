"""The names of mission commands (MAV_CMD), for messages about unread ones."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

FENCES: Final = MappingProxyType(
    {
        5000: "fence return point",
        5001: "fence vertex (to stay in)",
        5002: "fence vertex (to stay out)",
        5003: "fence circle (to stay in)",
        5004: "fence circle (to stay out)",
        5100: "rally point",
    }
)
"""Commands for parts of a fence and for rally points: their positions are no waypoints."""

_POINTING: Final = MappingProxyType(
    {
        80: "NAV_ROI",
        179: "DO_SET_HOME",
        189: "DO_LAND_START",
        195: "DO_SET_ROI_LOCATION",
        201: "DO_SET_ROI",
        4501: "CONDITION_GATE",
        **dict.fromkeys(range(31005, 31010), "SPATIAL_USER"),
    }
)

POSITIONS: Final = frozenset({*FENCES, *_POINTING})
"""Commands with a position that the vehicle does not go to."""

_NAMES: Final = MappingProxyType(
    {
        16: "WAYPOINT",
        17: "LOITER_UNLIM",
        18: "LOITER_TURNS",
        19: "LOITER_TIME",
        20: "RETURN_TO_LAUNCH",
        21: "LAND",
        22: "TAKEOFF",
        23: "LAND_LOCAL",
        24: "TAKEOFF_LOCAL",
        25: "FOLLOW",
        30: "CONTINUE_AND_CHANGE_ALT",
        31: "LOITER_TO_ALT",
        34: "DO_ORBIT",
        35: "DO_FIGURE_EIGHT",
        36: "ARC_WAYPOINT",
        81: "PATHPLANNING",
        82: "SPLINE_WAYPOINT",
        84: "VTOL_TAKEOFF",
        85: "VTOL_LAND",
        92: "GUIDED_ENABLE",
        93: "DELAY",
        94: "PAYLOAD_PLACE",
        112: "CONDITION_DELAY",
        113: "CONDITION_CHANGE_ALT",
        114: "CONDITION_DISTANCE",
        115: "CONDITION_YAW",
        176: "DO_SET_MODE",
        177: "DO_JUMP",
        178: "DO_CHANGE_SPEED",
        181: "DO_SET_RELAY",
        182: "DO_REPEAT_RELAY",
        183: "DO_SET_SERVO",
        184: "DO_REPEAT_SERVO",
        188: "DO_RETURN_PATH_START",
        191: "DO_GO_AROUND",
        192: "DO_REPOSITION",
        194: "DO_SET_REVERSE",
        197: "DO_SET_ROI_NONE",
        203: "DO_DIGICAM_CONTROL",
        205: "DO_MOUNT_CONTROL",
        206: "DO_SET_CAM_TRIGG_DIST",
        207: "DO_FENCE_ENABLE",
        208: "DO_PARACHUTE",
        210: "DO_INVERTED_FLIGHT",
        211: "DO_GRIPPER",
        530: "SET_CAMERA_MODE",
        600: "JUMP_TAG",
        601: "DO_JUMP_TAG",
        1000: "DO_GIMBAL_MANAGER_PITCHYAW",
        2000: "IMAGE_START_CAPTURE",
        2001: "IMAGE_STOP_CAPTURE",
        2500: "VIDEO_START_CAPTURE",
        2501: "VIDEO_STOP_CAPTURE",
        3000: "DO_VTOL_TRANSITION",
        **FENCES,
        **_POINTING,
    }
)


def command_name(command: int) -> str:
    """Return the name of a command.

    >>> command_name(177), command_name(5100), command_name(43000)
    ('DO_JUMP', 'rally point', 'command 43000')
    """
    return _NAMES.get(command, f"command {command}")
