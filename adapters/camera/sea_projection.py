"""The position of a pixel on the sea: the flat-sea projection of a camera, and the georeference of a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np

from physical import PhysicalError
from physical.frame import geod

LEAST_DEPRESSION: Final = 10.0
"""Degrees below the horizon from which a pixel counts: above, a degree of error is kilometres of sea."""

HIGHEST: Final = 20_000.0

Array = Any
"""An array of numpy, without its shape for a type checker."""


@dataclass(frozen=True, slots=True)
class Pose:
    """A vehicle's pose: degrees, metres above the sea; degrees of roll (right wing down), pitch (nose up), yaw."""

    time: float
    latitude: float
    longitude: float
    altitude: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


@dataclass(frozen=True, slots=True)
class Lens:
    """A camera without distortion, and its mount.

    Attributes:
        fov: The horizontal field of view in degrees.
        pitch: Of its axis above the nose: -90 looks straight down, with the picture's top towards the nose.
        yaw: Of its axis to the right of the nose.
        roll: Around its axis, clockwise.
        level: Whether a gimbal holds it level: the vehicle's roll and pitch then play no part.
    """

    fov: float = 60.0
    pitch: float = -90.0
    yaw: float = 0.0
    roll: float = 0.0
    level: bool = False

    def __post_init__(self) -> None:
        if not 1.0 <= self.fov <= 150.0:
            raise PhysicalError(
                "field-of-view", f"a field of view of {self.fov:g}° is none", "give 1 to 150 degrees"
            )
        if not (-90.0 <= self.pitch <= 90.0 and abs(self.yaw) <= 360.0 and abs(self.roll) <= 180.0):
            raise PhysicalError("mount", "no camera is mounted so", "-90 <= pitch <= 90, -360 <= yaw <= 360")


class PixelPositions(Protocol):
    """The positions of a frame's pixels."""

    def ground(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the latitudes and longitudes of pixels; NaN without sea, or for too oblique a view of it."""


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture: an array of rows of pixels (blue, green, red; 0 to 255), its time, and the positions of its pixels.

    `sea` is the colour of the sea in earlier frames (CIE L*a*b*): most of this frame may not be sea.
    """

    image: Array
    time: float
    view: PixelPositions
    name: str = ""
    sea: tuple[float, ...] | None = None


@dataclass(frozen=True, slots=True)
class Projection:
    """The view of a camera on a vehicle: each ray meets a flat sea at altitude 0."""

    pose: Pose
    lens: Lens
    width: int
    height: int

    def __post_init__(self) -> None:
        if not 1.0 <= self.pose.altitude <= HIGHEST:
            raise PhysicalError(
                "altitude",
                f"no sea is seen from {self.pose.altitude:g} m",
                f"altitudes are metres above the sea, 1 to {HIGHEST:,.0f}",
            )

    def ground(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return the latitudes and longitudes of pixels; NaN above the horizon, and near it."""
        north, east, down = self._rays(np.asarray(x, float), np.asarray(y, float))
        ahead = np.hypot(north, east)
        seen = down > ahead * np.tan(np.radians(LEAST_DEPRESSION))
        metres = np.where(seen, self.pose.altitude * ahead / np.where(seen, down, 1.0), 0.0)
        bearing = np.degrees(np.arctan2(east, north))
        start = np.full(metres.shape, self.pose.longitude), np.full(metres.shape, self.pose.latitude)
        longitude, latitude, _ = geod().fwd(*start, bearing, metres)
        return np.where(seen, latitude, np.nan), np.where(seen, longitude, np.nan)

    def _rays(self, x: Array, y: Array) -> Array:
        """Return the directions of pixels: to the north, to the east, down."""
        focal = self.width / 2 / np.tan(np.radians(self.lens.fov) / 2)
        ahead = np.ones_like(x)
        in_camera = np.stack([ahead, (x + 0.5 - self.width / 2) / focal, (y + 0.5 - self.height / 2) / focal])
        return np.tensordot(self._attitude(), in_camera, axes=1)

    def _attitude(self) -> Array:
        pose, lens = self.pose, self.lens
        roll, pitch = (0.0, 0.0) if lens.level else (pose.roll, pose.pitch)
        return _turn(pose.yaw, pitch, roll) @ _turn(lens.yaw, lens.pitch, lens.roll)


def _turn(yaw: float, pitch: float, roll: float) -> Array:
    """Return the rotation from forward, right, down to the reference axes: yaw first, then pitch, then roll."""
    (cy, cp, cr), (sy, sp, sr) = (
        np.cos(np.radians([yaw, pitch, roll])),
        np.sin(np.radians([yaw, pitch, roll])),
    )
    about_down = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    about_right = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_forward = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    return about_down @ about_right @ about_forward
