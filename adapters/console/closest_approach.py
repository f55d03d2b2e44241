"""The closest points of approach (CPA) of vehicles and other targets, if all keep their course and speed.

The plane about each vehicle has the ellipsoid's own scales: within the few miles that matter here it is exact enough.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from adapters.console.console_view import Json
from adapters.console.facts import Facts, SeenEntity

NEAR: Final = 1852.0
"""Metres; farther approaches are not shown."""

SOON: Final = 1200.0
"""Seconds; later approaches are not shown."""

MOST: Final = 50

EQUATOR: Final = 6_378_137.0
ECCENTRICITY: Final = 0.0818191908426
"""The ellipsoid WGS 84: its greater radius in metres, and its eccentricity."""

Floats = NDArray[np.float64]


def closest(offset: Floats, velocity: Floats) -> tuple[Floats, Floats]:
    """Return the seconds until the closest approach, and its distance, of points at an offset with a relative velocity.

    The distance |p + t v| is least at t = -p·v / v·v. Points that go apart, or keep their distance, are closest now.

    >>> seconds, metres = closest(np.array([[3000.0, 400.0]]), np.array([[-10.0, 0.0]]))
    >>> float(seconds[0]), float(metres[0])
    (300.0, 400.0)
    """
    speed = np.einsum("...i,...i", velocity, velocity)
    towards = -np.einsum("...i,...i", offset, velocity)
    seconds = np.where(speed > 0, np.maximum(0.0, towards / np.where(speed > 0, speed, 1.0)), 0.0)
    return seconds, np.linalg.norm(offset + seconds[..., None] * velocity, axis=-1)


def approaches(facts: Facts, now: float) -> Mapping[str, Json]:
    """Return the section `approaches`: the vehicles and targets that come close soon, the closest first."""
    vehicles = frozenset() if facts.run is None else frozenset(facts.run.vehicles)
    moving = tuple(
        (name, seen)
        for name, seen in facts.seen.items()
        if seen.until >= now and (name in vehicles or not _is_fixed(facts, name))
    )
    return _approaches(moving, vehicles, int(now))


def _is_fixed(facts: Facts, name: str) -> bool:
    return facts.standing is not None and name in facts.standing.rules.fixed


@lru_cache(maxsize=8)
def _approaches(
    moving: tuple[tuple[str, SeenEntity], ...], vehicles: frozenset[str], now: int
) -> Mapping[str, Json]:
    ours = [each for each in moving if each[0] in vehicles]
    others = [each for each in moving if each[0] not in vehicles]
    if not ours or not others:
        return {}
    at, velocity = _motion(ours, now)
    at_others, velocity_others = _motion(others, now)
    offset = at_others[None, :] - at[:, None]
    offset[..., 1] = (offset[..., 1] + 180.0) % 360.0 - 180.0
    offset *= _scales(at)[:, None]
    relative = velocity_others[None, :] - velocity[:, None]
    seconds, metres = closest(offset, relative)
    shown = np.argwhere((metres <= NEAR) & (seconds <= SOON))
    first = sorted(map(tuple, shown.tolist()), key=lambda pair: (metres[pair], seconds[pair]))[:MOST]
    return {
        f"{ours[i][0]} {others[j][0]}": {
            "vehicle": ours[i][0],
            "target": others[j][0],
            "range": round(float(np.linalg.norm(offset[i, j]))),
            "distance": round(float(metres[i, j])),
            "at": now + round(float(seconds[i, j])),
        }
        for i, j in first
    }


def _motion(seen: list[tuple[str, SeenEntity]], now: float) -> tuple[Floats, Floats]:
    """Return the positions in degrees, carried on to a time, and the velocities in metres a second, north and east."""
    at = np.array([each.at for _, each in seen])
    speed = np.array([each.speed or 0.0 for _, each in seen])
    course = np.radians([each.course or 0.0 for _, each in seen])
    velocity = np.stack([speed * np.cos(course), speed * np.sin(course)], axis=-1)
    age = np.array([max(0.0, now - each.time) for _, each in seen])
    return at + velocity * age[:, None] / _scales(at), velocity


def _scales(at: Floats) -> Floats:
    """Return the metres in a degree of latitude and of longitude, by the ellipsoid's radii of curvature."""
    latitude = np.radians(at[:, 0])
    flat = 1.0 - (ECCENTRICITY * np.sin(latitude)) ** 2
    north = EQUATOR * (1.0 - ECCENTRICITY**2) / flat**1.5
    east = EQUATOR / np.sqrt(flat) * np.maximum(np.cos(latitude), 1e-9)
    return np.radians(np.stack([north, east], axis=-1))
