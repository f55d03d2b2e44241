"""A simulated camera: a picture of the sea with slicks, by casting a ray for each pixel.

It has its own rotations and geodesy, so that a fault of the plugin's projection shows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import shapely

from adapters.camera.sea_projection import Lens, Pose
from physical import Geometry
from physical.shape import planar

SEA: Final = (92.0, 70.0, 38.0)
SLICK: Final = (52.0, 46.0, 40.0)
SKY: Final = (225.0, 205.0, 180.0)
E7: Final = 1e7


def render(  # noqa: PLR0913 - each is one property of a picture
    pose: Pose,
    lens: Lens,
    size: tuple[int, int],
    slicks: Sequence[Geometry],
    *,
    seed: int = 0,
    glint: float = 0.0,
    noise: float = 3.0,
    land: Geometry | None = None,
) -> Any:
    """Return a picture (blue, green, red) of the sea with slicks; `size` is in pixels to the right and down."""
    random = np.random.default_rng(seed)
    north, east, down = _rays(pose, lens, size)
    water = down > 1e-3
    reach = pose.altitude / np.where(water, down, 1.0)
    y, x = north * reach, east * reach
    latitude, longitude = _degrees(pose, y, x)
    covered = _within(slicks, latitude, longitude) & water
    waves = _waves(x, y, pose.altitude, random)
    colour = np.where(covered[..., None], SLICK, SEA) + (waves * np.where(covered, 2.0, 5.0))[..., None]
    if glint:
        colour = _with_glint(colour, (north, east, down), np.where(covered, 0.3, 1.0) * glint, random)
    if land is not None:
        grown = random.normal(0, 28, waves.shape)[..., None] + np.array((60.0, 105.0, 95.0))
        colour = np.where((_within([land], latitude, longitude) & water)[..., None], grown, colour)
    haze = np.where(water, np.clip(reach / 40_000, 0, 1), 1.0)[..., None]
    colour = colour * (1 - haze) + np.array(SKY) * haze
    return np.clip(colour + random.normal(0, noise, colour.shape), 0, 255).astype(np.uint8)


def _rays(pose: Pose, lens: Lens, size: tuple[int, int]) -> tuple[Any, Any, Any]:
    """Return the unit vectors of the pixels: the mount's angles are applied first, then the vehicle's."""
    width, height = size
    across = 2 * math.tan(math.radians(lens.fov) / 2) / width
    right, down = np.meshgrid(
        (np.arange(width) - (width - 1) / 2) * across, (np.arange(height) - (height - 1) / 2) * across
    )
    length = np.sqrt(1 + right**2 + down**2)
    ray = (1 / length, right / length, down / length)
    vehicle = (0.0, 0.0, pose.yaw) if lens.level else (pose.roll, pose.pitch, pose.yaw)
    for roll, pitch, yaw in ((lens.roll, lens.pitch, lens.yaw), vehicle):
        ray = _yawed(_pitched(_rolled(ray, roll), pitch), yaw)
    return ray


def _rolled(ray: tuple[Any, Any, Any], degrees: float) -> tuple[Any, Any, Any]:
    (a, b, c), (cos, sin) = ray, _cos_sin(degrees)
    return a, b * cos - c * sin, b * sin + c * cos


def _pitched(ray: tuple[Any, Any, Any], degrees: float) -> tuple[Any, Any, Any]:
    (a, b, c), (cos, sin) = ray, _cos_sin(degrees)
    return a * cos + c * sin, b, c * cos - a * sin


def _yawed(ray: tuple[Any, Any, Any], degrees: float) -> tuple[Any, Any, Any]:
    (a, b, c), (cos, sin) = ray, _cos_sin(degrees)
    return a * cos - b * sin, a * sin + b * cos, c


def _cos_sin(degrees: float) -> tuple[float, float]:
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _degrees(pose: Pose, north: Any, east: Any) -> tuple[Any, Any]:
    """Return the positions at offsets in metres from a vehicle, by the ellipsoid's radii there (WGS 84)."""
    flattened = 1 - 6.69437999e-3 * math.sin(math.radians(pose.latitude)) ** 2
    meridian = 6_378_137.0 * (1 - 6.69437999e-3) / flattened**1.5
    normal = 6_378_137.0 / math.sqrt(flattened)
    latitude = pose.latitude + np.degrees(north / meridian)
    return latitude, pose.longitude + np.degrees(east / normal) / math.cos(math.radians(pose.latitude))


def _within(places: Sequence[Geometry], latitude: Any, longitude: Any) -> Any:
    shape = shapely.union_all([planar(place) for place in places])
    shapely.prepare(shape)
    return shapely.contains_xy(shape, longitude * E7, latitude * E7)


def _waves(x: Any, y: Any, altitude: float, random: Any) -> Any:
    """Return waves of several lengths, all long enough for the pixels."""
    total = np.zeros_like(x)
    for length in (0.03, 0.05, 0.11, 0.3):
        bearing, phase = random.uniform(0, 2 * np.pi, 2)
        along = x * math.sin(bearing) + y * math.cos(bearing)
        total += np.sin(2 * np.pi * along / (length * altitude) + phase)
    return total / 2


def _with_glint(colour: Any, ray: tuple[Any, Any, Any], strength: Any, random: Any) -> Any:
    """Return the colours with sparkles where small waves mirror a sun high in the south-east."""
    north, east, down = ray
    mirrored = np.stack([-0.35 - north, 0.35 - east, 0.87 + down])  # half way between the sun and the eye
    slope = np.hypot(mirrored[0], mirrored[1]) / mirrored[2]
    sparkles = random.random(slope.shape) < strength * np.exp(-((slope / 0.16) ** 2))
    return np.where(sparkles[..., None], 255.0, colour)
