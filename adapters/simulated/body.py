"""The motion of a simulated vehicle: a point with course, speed and climb near its place on the earth.

A plane turns no faster than its bank allows, and circles instead of stopping. A plane's figures are those of the
recording in `tests/adapters/test_recording.py`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

METRES_PER_DEGREE: Final = 111_194.9

EASES: Final = 1.0
"""Seconds until a turn has its full rate, and a plane its bank."""


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of a kind of vehicle: m/s, degrees a second, m/s up and down, seconds to gain speed."""

    speed: float
    turn: float
    climb: float
    sink: float
    acceleration: float
    must_move: bool


PLANE: Final = Limits(22.2, 20.0, 9.3, 3.0, 6.0, must_move=True)
COPTER: Final = Limits(10.0, 90.0, 2.5, 1.5, 2.5, must_move=False)
ROVER: Final = Limits(5.0, 60.0, 0.0, 0.0, 2.0, must_move=False)


@dataclass(frozen=True, slots=True)
class Body:
    """Position and motion: degrees, metres above home, m/s, degrees true, m/s upwards, degrees a second."""

    latitude: float
    longitude: float
    height: float = 0.0
    course: float = 0.0
    speed: float = 0.0
    climb: float = 0.0
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class Target:
    """The target of a guided vehicle: degrees, metres above home, the circle's radius."""

    latitude: float
    longitude: float
    height: float
    circle: float


def metres_to(body: Body, latitude: float, longitude: float) -> tuple[float, float]:
    """Return distance and bearing to a point, as on a plane."""
    north = (latitude - body.latitude) * METRES_PER_DEGREE
    east = (longitude - body.longitude) * METRES_PER_DEGREE * math.cos(math.radians(body.latitude))
    return math.hypot(north, east), math.degrees(math.atan2(east, north)) % 360


def towards(body: Body, latitude: float, longitude: float, circle: float) -> float:
    """Return the course to a point, or onto a circle around it: clockwise, counter-clockwise if negative."""
    distance, bearing = metres_to(body, latitude, longitude)
    if not circle:
        return bearing
    # Seen from the centre, the course is a right angle ahead on the circle, and inwards far outside it.
    inwards = math.degrees(math.atan2(distance - abs(circle), abs(circle) / 2))
    return (bearing + math.copysign(inwards - 90, circle)) % 360


def astray(bearing: float, wind: tuple[float, float]) -> float:
    """Return the factor by which wind (m/s to north and east) widens a plane's circle, at a bearing of its centre.

    As seen of ArduPlane: a circle of 80 m in 8 m/s of wind had 85 m on the one side and 103 m on the other.
    """
    speed, blows = math.hypot(*wind), math.degrees(math.atan2(wind[1], wind[0]))
    return 1.0 + speed / 8.0 * (0.175 - 0.105 * math.cos(math.radians(bearing - blows)))


def moved(body: Body, limits: Limits, course: float, speed: float, height: float, seconds: float) -> Body:
    """Return the body after a while of turning to a course, a speed and a height, as fast as it can."""
    turn = _bounded((course - body.course + 180) % 360 - 180, limits.turn * seconds)
    speed = body.speed + _bounded(speed - body.speed, limits.acceleration * seconds)
    rise = max(-limits.sink * seconds, min(limits.climb * seconds, height - body.height))
    turned = (body.course + turn) % 360
    north = speed * seconds * math.cos(math.radians(turned))
    east = speed * seconds * math.sin(math.radians(turned))
    return replace(
        body,
        latitude=body.latitude + north / METRES_PER_DEGREE,
        longitude=body.longitude + east / METRES_PER_DEGREE / math.cos(math.radians(body.latitude)),
        height=body.height + rise,
        course=turned,
        speed=speed,
        climb=rise / seconds,
        turn=body.turn + (turn / seconds - body.turn) * min(1.0, seconds / EASES),
    )


def _bounded(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
