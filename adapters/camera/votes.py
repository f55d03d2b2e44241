"""Frames merged by a vote on a grid: for each cell of the sea the number of views, and the confidence of findings.

Unseen cells are known, too: a region whose border was never in view is marked as a part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import shapely

from adapters.camera.sea_projection import Array, Frame
from adapters.camera.slick import Patch
from physical import Geometry, PhysicalError
from physical.frame import PositionE7, local_frame, rounded
from physical.shape import canonical, planar

SIDE: Final = 64
"""Cells along a tile of the grid."""

MOST_TILES: Final = 1_024
"""The most tiles of a grid; the oldest are dropped first."""

MOST_CELLS: Final = 1_000_000
"""The most cells in the view of one frame; a wider view is rejected."""

MOST_REGIONS: Final = 20
LEAST_CELLS: Final = 12
MAJORITY: Final = 0.4
MOST_VERTICES: Final = 150
STEPS: Final = 24

Tile = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Votes:
    """The votes of frames on the cells of a grid.

    Attributes:
        origin: The grid's centre.
        cell: The side of a cell in metres.
        tiles: Two layers of a tile's cells: the number of views of each, and the sum of the confidences of findings.
    """

    origin: PositionE7
    cell: float
    tiles: Mapping[Tile, Array] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Region:
    """A merged finding: a polygon, its confidence (0 to 1), its square metres, and whether all of it was seen."""

    geometry: Geometry
    confidence: float
    area: float
    whole: bool


class TooWide(PhysicalError):
    """A frame shows more of the sea than the grid can hold."""


def vote(votes: Votes | None, frame: Frame, patches: Sequence[Patch]) -> Votes:
    """Return the votes with those of one more frame; raises TooWide."""
    border = _border(frame)
    if border is None:
        return votes or Votes((0, 0), 1.0)
    if votes is None or not votes.tiles:
        votes = _begun(border)
    footprint = _metres(votes, *border)
    found = [(_on_ground(votes, frame, patch), patch.confidence) for patch in patches]
    west, south, east, north = shapely.bounds(footprint) / votes.cell
    if (east - west) * (north - south) > MOST_CELLS:
        raise TooWide(
            "view", "its view is too wide beside the frames before", "leave out frames from far higher"
        )
    tiles = dict(votes.tiles)
    for tile in _tiles(west, south, east, north):
        seen, covered = _cells(votes, tile, footprint), np.zeros((SIDE, SIDE), np.float32)
        for shape, confidence in found:
            covered = np.maximum(covered, _cells(votes, tile, shape) * np.float32(confidence))
        if seen.any():
            tiles[tile] = tiles.pop(tile, 0) + np.stack([seen.astype(np.float32), covered * seen])
    for tile in list(tiles)[: max(0, len(tiles) - MOST_TILES)]:
        del tiles[tile]
    return replace(votes, tiles=tiles)


def regions(votes: Votes | None) -> tuple[Region, ...]:
    """Return the regions that most of their views found, the largest first."""
    rows = [] if votes is None else [box for tile in sorted(votes.tiles) for box in _rows(votes, tile)]
    if votes is None or not rows:
        return ()
    merged = shapely.union_all(shapely.box(*np.array(rows, float).T))
    large = [part for part in shapely.get_parts(merged) if shapely.area(part) >= LEAST_CELLS]
    large.sort(key=lambda part: -shapely.area(part))
    return tuple(_region(votes, part) for part in large[:MOST_REGIONS])


# --- a frame on the grid ----------------------------------------------------------------------------


def _border(frame: Frame) -> tuple[Array, Array] | None:
    """Return the positions of the border of the sea in view, as the hull of a net of pixels."""
    height, width = frame.image.shape[:2]
    x, y = np.meshgrid(np.linspace(-0.5, width - 0.5, STEPS), np.linspace(-0.5, height - 0.5, STEPS))
    latitude, longitude = frame.view.ground(x, y)
    seen = np.isfinite(latitude)
    return (latitude[seen], longitude[seen]) if seen.sum() >= 3 else None


def _begun(border: tuple[Array, Array]) -> Votes:
    """Return an empty grid around a frame's view, with some 150 cells along the view's side."""
    origin = rounded(float(np.mean(border[0])), float(np.mean(border[1])))
    side = np.sqrt(shapely.area(_metres(Votes(origin, 1.0), *border)))
    return Votes(origin, float(np.clip(side / 150, 0.25, 100.0)))


def _metres(votes: Votes, latitude: Array, longitude: Array) -> shapely.Geometry:
    x, y = local_frame(votes.origin).proj(longitude, latitude)
    return shapely.convex_hull(shapely.multipoints(np.column_stack([x, y])))


def _on_ground(votes: Votes, frame: Frame, patch: Patch) -> shapely.Geometry:
    latitude, longitude = frame.view.ground(*np.array(patch.corners).T)
    seen = np.isfinite(latitude)
    if seen.sum() < 3:
        return shapely.Polygon()
    x, y = local_frame(votes.origin).proj(longitude[seen], latitude[seen])
    return shapely.make_valid(shapely.Polygon(np.column_stack([x, y])))


def _tiles(west: float, south: float, east: float, north: float) -> Iterator[Tile]:
    for column in range(int(west // SIDE), int(east // SIDE) + 1):
        for row in range(int(south // SIDE), int(north // SIDE) + 1):
            yield column, row


def _cells(votes: Votes, tile: Tile, shape: shapely.Geometry) -> Array:
    """Return a mask of a tile's cells with their centres in a shape."""
    x = (tile[0] * SIDE + np.arange(SIDE) + 0.5) * votes.cell
    y = (tile[1] * SIDE + np.arange(SIDE) + 0.5) * votes.cell
    shapely.prepare(shape)
    return shapely.contains_xy(shape, *np.meshgrid(x, y))


# --- the grid as regions ----------------------------------------------------------------------------


def _rows(votes: Votes, tile: Tile) -> Iterator[tuple[int, int, int, int]]:
    """Yield the boxes, in cells, of a tile's cells that most of their views found covered, row by row."""
    seen, covered = votes.tiles[tile]
    taken = (covered >= MAJORITY * seen / 2) & (covered > 0)
    for row in np.flatnonzero(taken.any(axis=1)):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], taken[row], [0]])))
        south = tile[1] * SIDE + int(row)
        for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            yield tile[0] * SIDE + start, south, tile[0] * SIDE + end, south + 1


def _region(votes: Votes, part: shapely.Geometry) -> Region:
    outline = shapely.Polygon(shapely.get_coordinates(part.exterior) * votes.cell)
    tolerance = votes.cell
    smooth = outline.simplify(tolerance)
    while len(smooth.exterior.coords) > MOST_VERTICES:
        tolerance *= 1.5
        smooth = outline.simplify(tolerance)
    frame = local_frame(votes.origin)
    ring = [frame.position(x, y) for x, y in smooth.exterior.coords[:-1]]
    around = shapely.buffer(outline, 1.5 * votes.cell)
    seen = covered = unseen = 0.0
    for tile in _tiles(*(np.array(around.bounds) / votes.cell)):
        layers = votes.tiles.get(tile, np.zeros((2, SIDE, SIDE), np.float32))
        inside = _cells(votes, tile, outline)
        seen, covered = seen + layers[0][inside].sum(), covered + layers[1][inside].sum()
        unseen += (_cells(votes, tile, around) & (layers[0] == 0)).sum()
    return Region(canonical(ring), float(covered / max(seen, 1e-9)), float(smooth.area), unseen == 0)


def share(a: Geometry, b: Geometry) -> float:
    """Return the intersection over union of two polygons."""
    one, other = planar(a), planar(b)
    return float(shapely.area(one & other) / shapely.area(one | other))
