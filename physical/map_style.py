"""The style of a map: the colours and markers of kinds, and inks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

SMALL: Final = 7.5
"""The size of the smallest lettering, in points."""

INK: Final = "#1f2933"
QUIET: Final = "#66727f"
FAINT: Final = "#dde5ec"
PAPER: Final = "#f5f7f9"
SEA: Final = "#f0f6fb"

LAND: Final = "#f3efe4"
COAST: Final = "#b9ae92"
HALO: Final = "#e4572e"
"""The colour behind highlighted entities."""

BROKEN: Final = "#c0281c"
"""The colour of a breach."""

MARK: Final = "#1f2933"
"""The colour of the dashed outline of marked entities."""

PALETTE: Final = (
    "#4f86c6",
    "#4fa672",
    "#d08a3c",
    "#8e6bbf",
    "#cf6363",
    "#3f9ea3",
    "#a8973a",
    "#7b8494",
)
"""Calm colours of equal lightness."""

Outline = tuple[tuple[float, float], ...]


def _regular(corners: int, turn: float = 0.0) -> Outline:
    angles = [math.radians(90.0 + turn + 360.0 * corner / corners) for corner in range(corners)]
    return tuple((math.cos(angle), math.sin(angle)) for angle in angles)


DART: Final = ((0.0, 1.1), (0.85, -0.85), (0.0, -0.42), (-0.85, -0.85))
HULL: Final = ((0.0, 1.2), (0.45, 0.65), (0.6, 0.1), (0.55, -1.0), (-0.55, -1.0), (-0.6, 0.1), (-0.45, 0.65))
SQUARE: Final = ((0.8, 0.8), (0.8, -0.8), (-0.8, -0.8), (-0.8, 0.8))
DISC: Final = tuple((0.8 * x, 0.8 * y) for x, y in _regular(32))
DIAMOND: Final = _regular(4)
SHAPES: Final = (DISC, DIAMOND, _regular(6), _regular(3, 60.0), _regular(5), _regular(3))

WORDS: Final = (
    (("uav", "drone", "aircraft", "plane", "copter"), DART),
    (("vessel", "ship", "boat", "usv", "ferry"), HULL),
    (("station", "gcs", "base", "tower", "home"), SQUARE),
    (("drifter", "buoy", "float"), DISC),
    (("aton", "beacon", "light"), DIAMOND),
)
"""The shapes of kinds by words in their names."""


def kind_colours(kinds: Iterable[str]) -> dict[str, str]:
    """Return a colour for each kind: the palette, in alphabetical order."""
    return {kind: PALETTE[rank % len(PALETTE)] for rank, kind in enumerate(sorted(set(kinds)))}


def darker(colour: str) -> str:
    """Return a `#rrggbb` colour dark enough for text on white.

    >>> darker("#4f86c6")
    '#2f5076'
    """
    parts = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
    return "#" + "".join(f"{int(part * 0.6):02x}" for part in parts)


def kind_shapes(kinds: Iterable[str]) -> dict[str, Outline]:
    """Return the outline of each kind's marker, about one unit in radius; unknown kinds take unused shapes."""
    found: dict[str, Outline] = {}
    for kind in sorted(set(kinds)):
        lower = kind.lower()
        named = (shape for words, shape in WORDS if any(word in lower for word in words))
        left = [shape for shape in SHAPES if shape not in found.values()] or [DISC]
        found[kind] = next(named, left[0])
    return found
