"""Poses: a flight log as CSV, a vehicle's messages in flight, and interpolation between two poses."""

from __future__ import annotations

import csv
import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from itertools import islice
from pathlib import Path
from typing import Any, Final

from adapters.camera.sea_projection import Pose
from physical import PhysicalError, open_file
from physical.frame import E7

NEEDED: Final = ("latitude", "longitude", "altitude")
ANGLES: Final = ("roll", "pitch", "yaw")
MOST_POSES: Final = 1_000_000
MOST_BYTES: Final = 200_000_000
MOST_KEPT: Final = 300
"""In flight: the most poses of each sort, about a minute's."""

MOST_APART: Final = 2.0
"""Seconds between two poses for interpolation; a longer gap stays unknown."""


def read_poses(path: Path) -> tuple[tuple[str, Pose], ...]:
    """Return the rows of a flight log, by time: the frame's file, if a row has one, and the pose."""
    with open_file(path) as file:
        text = file.read(MOST_BYTES + 1)
    if len(text) > MOST_BYTES:
        raise PhysicalError("too-large", f"over {MOST_BYTES:,} bytes", "cut the log", str(path))
    rows = csv.DictReader(text.decode("utf-8-sig", "replace").splitlines())
    missing = [name for name in NEEDED if name not in (rows.fieldnames or ())]
    if missing:
        hint = (
            "its first line is file,time,latitude,longitude,altitude,roll,pitch,yaw (file, angles as needed)"
        )
        raise PhysicalError("poses", f"the log has no column {missing[0]}", hint, str(path))
    found = [_row(row, path, number) for number, row in enumerate(islice(rows, MOST_POSES), 2)]
    return tuple(sorted(found, key=lambda each: each[1].time))


def _row(row: dict[str, str], path: Path, number: int) -> tuple[str, Pose]:
    where = f"{path}:{number}"
    try:
        values = {name: float(row.get(name) or 0) for name in (*NEEDED, *ANGLES)}
        pose = Pose(_time(row.get("time") or "0"), **values)
    except (ValueError, TypeError):
        raise PhysicalError(
            "poses", "a value is no number", "write degrees and metres, time in seconds or ISO 8601", where
        ) from None
    sound = all(map(math.isfinite, (pose.time, *values.values())))
    if not sound or abs(pose.latitude) > 89.9 or abs(pose.longitude) > 180:
        raise PhysicalError("poses", "no vehicle is there", "write latitude and longitude in degrees", where)
    return (row.get("file") or "", pose)


def _time(text: str) -> float:
    """Read seconds, or a time in ISO 8601.

    >>> _time("1.5"), _time("1970-01-01T00:01:00Z")
    (1.5, 60.0)
    """
    try:
        return float(text)
    except ValueError:
        return datetime.fromisoformat(text).timestamp()


class PoseLog:
    """The newest poses of a vehicle in flight: MAVLink sends positions and attitudes in separate messages."""

    def __init__(self) -> None:
        self._positions: list[Pose] = []
        self._attitudes: list[Pose] = []

    def hear(self, name: str, said: Mapping[str, Any], now: float) -> None:
        """Record the position or attitude in a message."""
        if name == "GLOBAL_POSITION_INT" and (said["lat"], said["lon"]) != (0, 0):
            latitude, longitude, altitude = said["lat"] / E7, said["lon"] / E7, said["alt"] / 1000
            if abs(latitude) <= 89.9 and abs(longitude) <= 180:
                _keep(self._positions, Pose(now, latitude, longitude, altitude))
        elif name == "ATTITUDE" and all(map(math.isfinite, (said[angle] for angle in ANGLES))):
            angles = (math.degrees(said[angle]) for angle in ANGLES)
            _keep(self._attitudes, Pose(now, 0.0, 0.0, 0.0, *angles))

    @property
    def until(self) -> float:
        """The time up to which the pose is known."""
        return min((each[-1].time if each else -math.inf) for each in (self._positions, self._attitudes))

    def at(self, time: float) -> Pose | None:
        """Return the pose at a time, None if it is unknown."""
        where, how = pose_at(self._positions, time), pose_at(self._attitudes, time)
        return (
            None
            if where is None or how is None
            else replace(where, roll=how.roll, pitch=how.pitch, yaw=how.yaw)
        )


def _keep(poses: list[Pose], pose: Pose) -> None:
    """Add a pose, unless its clock went back; drop the oldest beyond the limit."""
    if not poses or pose.time > poses[-1].time:
        poses.append(pose)
        del poses[:-MOST_KEPT]


def pose_at(poses: Sequence[Pose], time: float) -> Pose | None:
    """Return the pose at a time, interpolated from the two around it; None if they are too far apart."""
    after = bisect_left(poses, time, key=lambda pose: pose.time)
    if after < len(poses) and poses[after].time == time:
        return poses[after]
    if not 0 < after < len(poses) or poses[after].time - poses[after - 1].time > MOST_APART:
        return None
    first, second = poses[after - 1], poses[after]
    part = (time - first.time) / (second.time - first.time)

    def between(name: str, turn: float = 0.0) -> float:
        start, end = getattr(first, name), getattr(second, name)
        way = (end - start + turn / 2) % turn - turn / 2 if turn else end - start
        return float(start + part * way)

    return Pose(
        time,
        between("latitude"),
        (between("longitude", 360.0) + 180) % 360 - 180,
        between("altitude"),
        *(between(angle, 360.0) for angle in ANGLES),
    )
