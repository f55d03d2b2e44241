"""ROS messages with positions: their types, and their bytes read by `rosbags`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np

from physical import Geometry, PhysicalError, point
from physical.wordings import install_extra

MOST_BYTES: Final = 4_096
"""The longest message: a position has some hundred bytes, and the name of a frame."""

NO_FIX: Final = 0
"""The least status of a receiver with a position."""

FIX: Final = "sensor_msgs/msg/NavSatFix"
POSE: Final = "geographic_msgs/msg/GeoPose"
STAMPED: Final = "geographic_msgs/msg/GeoPoseStamped"
WHERE: Final = "geographic_msgs/msg/GeoPointStamped"
STRING: Final = "std_msgs/msg/String"
PATH: Final = "geographic_msgs/msg/GeoPath"
TRIGGER: Final = "std_srvs/srv/Trigger"
ANSWER: Final = "std_srvs/msg/Trigger_Response"  # its name in `rosbags`
TYPES: Final = (FIX, POSE, STAMPED)

GEOGRAPHIC: Final = {
    "geographic_msgs/msg/GeoPoint": "float64 latitude\nfloat64 longitude\nfloat64 altitude\n",
    POSE: "geographic_msgs/GeoPoint position\ngeometry_msgs/Quaternion orientation\n",
    STAMPED: "std_msgs/Header header\ngeographic_msgs/GeoPose pose\n",
    WHERE: "std_msgs/Header header\ngeographic_msgs/GeoPoint position\n",
    PATH: "std_msgs/Header header\ngeographic_msgs/GeoPoseStamped[] poses\n",
    ANSWER: "bool success\nstring message\n",
}
"""The definitions of geographic_msgs and std_srvs, which `rosbags` lacks."""

EMPTY: Final = b"\x00\x01\x00\x00\x00"
"""A message without fields, which ROS writes as one byte."""

MAP: Final = "map"
"""The frame of goals, whose places are in degrees."""


@dataclass(frozen=True, slots=True)
class RosPosition:
    """A position; its time is 0 if the message has none.

    Heights in messages are above the ellipsoid, those in P above sea level: a message's height is only sent back to
    its robot.
    """

    geometry: Geometry
    time: float = 0.0
    height: float = math.nan


def read_position(type_name: str, raw: bytes) -> RosPosition:
    """Read a position; raises PhysicalError for any other message."""
    if len(raw) > MOST_BYTES:
        raise PhysicalError("message too long", f"{len(raw):,} bytes of at most {MOST_BYTES:,}")
    store, error = typestore()
    try:
        said = store.deserialize_cdr(raw, type_name)
    except error as problem:
        raise PhysicalError("message unreadable", f"{problem!s:.200}") from problem
    match type_name:
        case "sensor_msgs/msg/NavSatFix":
            if said.status.status < NO_FIX:
                raise PhysicalError("no fix", f"its status is {said.status.status}")
            return RosPosition(
                point(said.latitude, said.longitude), _seconds(said.header.stamp), said.altitude
            )
        case "geographic_msgs/msg/GeoPoseStamped":
            return RosPosition(
                _at(said.pose.position), _seconds(said.header.stamp), said.pose.position.altitude
            )
    return RosPosition(_at(said.position), height=said.position.altitude)


def write_fix(latitude: float, longitude: float, time: float, frame: str) -> bytes:
    """Write a fix with unknown height and accuracy."""
    status = _made("sensor_msgs/msg/NavSatStatus", status=NO_FIX, service=0)
    place = {"latitude": latitude, "longitude": longitude, "altitude": math.nan}
    accuracy = {"position_covariance": np.zeros(9), "position_covariance_type": 0}
    return _written(FIX, header=_header(time, frame), status=status, **place, **accuracy)


def write_where(latitude: float, longitude: float, time: float, frame: str) -> bytes:
    """Write a place without a receiver."""
    return _written(WHERE, header=_header(time, frame), position=_point(latitude, longitude))


def write_goal(latitude: float, longitude: float, time: float, height: float = math.nan) -> bytes:
    """Write a goal and its height; NaN leaves the height open. ROS cannot leave the heading open: it is east."""
    return bytes(typestore()[0].serialize_cdr(_goal(latitude, longitude, time, height), STAMPED))


def write_path(waypoints: Iterable[tuple[float, float]], time: float, height: float = math.nan) -> bytes:
    """Write a path of goals."""
    poses = [_goal(*each, time, height) for each in waypoints]
    return _written(PATH, header=_header(time, MAP), poses=poses)


def read_answer(raw: bytes) -> tuple[bool, str]:
    """Read a service's success and its text; raises PhysicalError."""
    store, error = typestore()
    try:
        said = store.deserialize_cdr(raw[:MOST_BYTES], ANSWER)
    except error as problem:
        raise PhysicalError("message unreadable", f"{problem!s:.200}") from problem
    return bool(said.success), str(said.message)


def _goal(latitude: float, longitude: float, time: float, height: float) -> Any:
    east = _made("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
    pose = _made(POSE, position=_point(latitude, longitude, height), orientation=east)
    return _made(STAMPED, header=_header(time, MAP), pose=pose)


def _point(latitude: float, longitude: float, height: float = math.nan) -> Any:
    return _made("geographic_msgs/msg/GeoPoint", latitude=latitude, longitude=longitude, altitude=height)


def write_string(text: str) -> bytes:
    """Write a text."""
    return _written(STRING, data=text)


def _header(time: float, frame: str) -> Any:
    seconds, rest = divmod(round(time * 1e9), 1_000_000_000)
    stamp = _made("builtin_interfaces/msg/Time", sec=seconds, nanosec=rest)
    return _made("std_msgs/msg/Header", stamp=stamp, frame_id=frame)


def _made(type_name: str, **fields: Any) -> Any:
    return typestore()[0].types[type_name](**fields)


def _written(type_name: str, **fields: Any) -> bytes:
    return bytes(typestore()[0].serialize_cdr(_made(type_name, **fields), type_name))


@cache
def typestore() -> tuple[Any, type[Exception]]:
    """Return the types, and the error for bytes of no type; raises PhysicalError without the extra."""
    try:
        from rosbags.serde import SerdeError  # noqa: PLC0415 - an extra
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore  # noqa: PLC0415
    except ImportError as missing:
        raise PhysicalError(
            "ros-extra", "ROS needs rosbags, which is not installed", install_extra("ros")
        ) from missing
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, definition in GEOGRAPHIC.items():
        store.register(get_types_from_msg(definition, name))
    return store, SerdeError


@cache
def hash_of(type_name: str) -> str:
    """Return the hash of a type's description, which ROS writes into keys and bags."""
    return str(typestore()[0].hash_rihs01(type_name))


def _at(position: Any) -> Geometry:
    return point(position.latitude, position.longitude)


def _seconds(stamp: Any) -> float:
    return float(stamp.sec) + float(stamp.nanosec) / 1e9
