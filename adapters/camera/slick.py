"""Slicks on water, by colour: areas that differ from the sea around them and are no rougher.

The sea's colour is fitted over the picture as a surface of second degree, so that it includes the sun's gradient. Oil
damps small waves; glint and land are rougher than the sea, and excluded by that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from adapters.camera.libraries import opencv
from adapters.camera.sea_projection import Array, Frame

LARGEST_SIDE: Final = 480
"""The longer side in pixels to which a picture is reduced."""

DIFFERS: Final = 5.0
"""The least difference of a slick from the sea, in multiples of the sea's own spread."""

ALIKE: Final = 12.0
"""The largest distance of a colour from the sea's (the sum over L*, a*, b*) that counts as sea."""

SMALL: Final = 120
"""The longer side in pixels to which a picture is reduced for the sea's colour."""

LEARNS: Final = 0.2
"""The weight of each new frame in the sea's colour."""

LEAST_SPREAD: Final = 1.5
ROUGHER: Final = 2.2
"""The least roughness, in multiples of the sea's, that excludes a slick."""

WIDER: Final = 21
"""Pixels over which roughness is more than an edge."""

LEAST_PART: Final = 0.002
"""The least fraction of the picture's pixels for a slick."""

LEAST_SEA: Final = 0.05
MOST_PATCHES: Final = 20
MOST_CORNERS: Final = 200
ROUNDS: Final = 6


@dataclass(frozen=True, slots=True)
class Patch:
    """A polygon in a frame, in its pixels (x to the right, y down), and its confidence: 0 to 1."""

    corners: tuple[tuple[float, float], ...]
    confidence: float


Detector = Callable[[Frame], tuple[Patch, ...]]
"""A pure function that finds a mission's targets in a frame."""


def find_slicks(frame: Frame) -> tuple[Patch, ...]:
    """Return the slicks in a frame, the surest first."""
    cv2 = opencv()
    height, width = frame.image.shape[:2]
    scale = min(1.0, LARGEST_SIDE / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    image = cv2.medianBlur(cv2.resize(frame.image, size, interpolation=cv2.INTER_AREA), 3)
    sea = _sea(frame, size, width / size[0], height / size[1])
    if sea.mean() < LEAST_SEA:
        return ()
    colours = cv2.cvtColor(image, cv2.COLOR_BGR2LAB).astype(np.float32)
    calm = cv2.GaussianBlur(cv2.medianBlur(image, 7), (0, 0), 1.5)
    apart = _apart(cv2.cvtColor(calm, cv2.COLOR_BGR2LAB).astype(np.float32), sea, frame.sea)
    rough = _roughness(colours[..., 0], sea)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
    broken = (rough > ROUGHER).astype(np.uint8)
    broken = cv2.morphologyEx(broken, cv2.MORPH_OPEN, np.ones((WIDER, WIDER), np.uint8))
    differs = ((apart > DIFFERS) & sea & (broken == 0)).astype(np.uint8)
    differs = cv2.morphologyEx(cv2.morphologyEx(differs, cv2.MORPH_OPEN, kernel), cv2.MORPH_CLOSE, kernel)
    found = (
        _patch(outline, apart, rough, (width / size[0], height / size[1]))
        for outline in cv2.findContours(differs, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
        if cv2.contourArea(outline) >= LEAST_PART * size[0] * size[1]
    )
    known = [patch for patch in found if patch is not None]
    return tuple(sorted(known, key=lambda patch: -patch.confidence)[:MOST_PATCHES])


def _sea(frame: Frame, size: tuple[int, int], wide: float, high: float) -> Array:
    """Return the pixels of a reduced picture below the horizon, without empty ones (a satellite's black border)."""
    x, y = np.meshgrid((np.arange(size[0]) + 0.5) * wide - 0.5, (np.arange(size[1]) + 0.5) * high - 0.5)
    latitude, _ = frame.view.ground(x, y)
    within = frame.image[y.astype(int), x.astype(int)].any(axis=2)
    return np.isfinite(latitude) & within


def sea_colour(frame: Frame, patches: Sequence[Patch]) -> tuple[float, ...] | None:
    """Return the colour of the sea beside the patches of a frame; the former colour if too little sea is in view."""
    cv2 = opencv()
    height, width = frame.image.shape[:2]
    scale = min(1.0, SMALL / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    image = cv2.resize(frame.image, size, interpolation=cv2.INTER_AREA)
    sea = _sea(frame, size, width / size[0], height / size[1]).astype(np.uint8)
    for patch in patches:
        corners = np.round(np.array(patch.corners) * scale).astype(np.int32)
        cv2.fillPoly(sea, [corners], 0)
    if sea.mean() < LEAST_SEA:
        return frame.sea
    found = np.median(cv2.cvtColor(image, cv2.COLOR_BGR2LAB)[sea > 0].astype(float), axis=0)
    known = found if frame.sea is None else np.array(frame.sea)
    return tuple((known + (found - known) * LEARNS).tolist())


def _apart(colours: Array, sea: Array, expected: tuple[float, ...] | None) -> Array:
    """Return each pixel's distance from the sea's colour there, in multiples of the sea's spread."""
    rows, columns = np.mgrid[-1 : 1 : colours.shape[0] * 1j, -1 : 1 : colours.shape[1] * 1j]
    terms = np.stack([np.ones_like(rows), rows, columns, rows * rows, rows * columns, columns * columns], -1)
    step = max(1, int(np.sqrt(sea.sum() / 4_000)))
    here = sea[::step, ::step]
    basis, values = terms[::step, ::step][here], colours[::step, ::step][here]
    degree = 3  # first a plane: a slick would bend the surface towards itself
    most = np.median(values, axis=0)
    limit = np.inf
    if expected is not None and (np.abs(values - expected).sum(axis=-1) < ALIKE).mean() > LEAST_SEA:
        most, limit = np.array(expected), ALIKE
    kept = _near(values, most, limit)
    for number in range(ROUNDS):
        fit = np.linalg.lstsq(basis[kept, :degree], values[kept], rcond=None)[0]
        kept = _near(values, basis[:, :degree] @ fit, limit)
        degree = 3 if number < ROUNDS // 2 else 6
    fit = np.linalg.lstsq(basis[kept], values[kept], rcond=None)[0]
    spread = np.maximum(1.4826 * np.median(np.abs(values[kept] - basis[kept] @ fit), axis=0), LEAST_SPREAD)
    return np.sqrt((((colours - terms @ fit) / spread) ** 2).sum(axis=-1))


def _near(values: Array, expected: Array, limit: float) -> Array:
    """Return a mask of the colours nearest to the sea's expected colour; none of them is too far."""
    distance = np.abs(values - expected).sum(axis=-1)
    return distance <= max(min(float(np.quantile(distance, 0.6)), limit), 2 * LEAST_SPREAD)


def _roughness(light: Array, sea: Array) -> Array:
    """Return the roughness of each pixel's surroundings, in multiples of the sea's."""
    cv2 = opencv()
    fine = (light - cv2.GaussianBlur(light, (0, 0), 2.0)) ** 2
    around = np.sqrt(cv2.blur(fine, (9, 9)))
    return around / max(float(np.median(around[sea])), 0.5)


def _patch(outline: Array, apart: Array, rough: Array, scale: tuple[float, float]) -> Patch | None:
    cv2 = opencv()
    inside = np.zeros(apart.shape, np.uint8)
    cv2.drawContours(inside, [outline], -1, 1, cv2.FILLED)
    core = cv2.erode(inside, np.ones((9, 9), np.uint8))  # an edge is rough by itself
    core = (core if core.any() else inside).astype(bool)
    if np.median(rough[core]) > ROUGHER:
        return None
    tolerance = 0.7
    while len(corners := cv2.approxPolyDP(outline, tolerance, closed=True)) > MOST_CORNERS:
        tolerance *= 1.5
    wide, high = scale
    ring = tuple(((x + 0.5) * wide - 0.5, (y + 0.5) * high - 0.5) for x, y in corners[:, 0].tolist())
    return Patch(ring, float(1 - DIFFERS / (2 * max(DIFFERS, np.median(apart[core])))))
