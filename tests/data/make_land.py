"""Make `physical/land.zip`, the coasts of maps, of Natural Earth's land, minor islands and lakes (1:10 million).

    python tests/data/make_land.py FOLDER

FOLDER holds `ne_10m_land.json`, `ne_10m_minor_islands.json` and `ne_10m_lakes.json`, the GeoJSON of Natural Earth
(naturalearthdata.com), which is in the public domain. Lakes under some 10 km² and islands under 0.3 km² are left out,
and borders are simplified by 300 m, which is less than Natural Earth promises. `physical/land.py` says what is in the
file.
"""

import json
import struct
import sys
from array import array
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import shapely
from shapely.geometry import shape

from physical.land import OVERVIEW, OVERVIEW_STEP, STEP, TILE, tile_name

SIMPLER, COARSE = 0.003, 0.1
"""Degrees that a border may move, and in the overview."""

SMALLEST_LAKE, SMALLEST_ISLAND, SMALLEST_SEEN = 1e-3, 3e-5, 2e-2
"""In square degrees: of a lake, of an island, and of what the overview has."""


def main(folder: Path, target: Path) -> None:
    """Write the file."""
    parts = list(simplified(land_of(folder), SIMPLER))
    tree = shapely.STRtree(parts)
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=9) as file:
        for west in range(-180, 180, TILE):
            for south in range(-90, 90, TILE):
                tile = shapely.box(west, south, west + TILE, south + TILE)
                here = [shapely.intersection(parts[each], tile) for each in tree.query(tile)]
                write(file, tile_name(west, south), shapely.union_all(here), (west, south, STEP))
        large = [part for part in parts if part.area > SMALLEST_SEEN]
        coarse = shapely.union_all(list(simplified(shapely.union_all(large), COARSE)))
        write(file, OVERVIEW, coarse, (-180, -90, OVERVIEW_STEP))


def land_of(folder: Path) -> shapely.Geometry:
    """Return all land and no lakes."""
    land, islands, lakes = (
        read(folder / f"ne_10m_{name}.json") for name in ("land", "minor_islands", "lakes")
    )
    return shapely.difference(shapely.union(land, islands), lakes)


def read(path: Path) -> shapely.Geometry:
    """Return all that is in a GeoJSON file."""
    features = json.loads(path.read_text(encoding="utf-8"))["features"]
    return shapely.union_all([shapely.make_valid(shape(each["geometry"])) for each in features])


def simplified(geometry: shapely.Geometry, tolerance: float) -> Iterator[shapely.Polygon]:
    """Yield the polygons of a geometry with fewer vertices, without what is small."""
    for polygon in shapely.get_parts(shapely.simplify(geometry, tolerance)):
        lakes = [ring for ring in polygon.interiors if shapely.Polygon(ring).area > SMALLEST_LAKE]
        if polygon.area > SMALLEST_ISLAND:
            yield shapely.Polygon(polygon.exterior, lakes)


def write(file: ZipFile, name: str, land: shapely.Geometry, grid: tuple[int, int, float]) -> None:
    """Write a tile: how many polygons, how many rings each has, how many vertices each of them, all steps."""
    rounded = shapely.make_valid(shapely.set_precision(land, 0))
    polygons = [rings for each in polygons_of(rounded) if (rings := list(rings_of(each, grid)))]
    if not polygons:
        return
    rings = [ring for polygon in polygons for ring in polygon]
    counts = [len(polygons), *map(len, polygons), *map(len, rings)]
    steps = [[step for ring in rings for step in differences([at[axis] for at in ring])] for axis in (0, 1)]
    numbers = array("i", counts).tobytes() + b"".join(planes(each) for each in steps)
    info = ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    info.compress_type = ZIP_DEFLATED
    file.writestr(info, numbers)


def polygons_of(geometry: shapely.Geometry) -> Iterator[shapely.Polygon]:
    """Yield the polygons of any geometry."""
    return (each for each in shapely.get_parts(geometry).tolist() if each.geom_type == "Polygon")


def rings_of(polygon: shapely.Polygon, grid: tuple[int, int, float]) -> Iterator[list[tuple[int, int]]]:
    """Yield the border of a polygon and of each of its holes on a grid, none if the border has no area there."""
    west, south, step = grid
    for rank, ring in enumerate((polygon.exterior, *polygon.interiors)):
        spots: list[tuple[int, int]] = []
        for x, y in list(ring.coords)[:-1]:
            spot = (round((x - west) / step), round((y - south) / step))
            if not spots or spot != spots[-1]:
                spots.append(spot)
        if len(spots) >= 3:
            yield spots
        elif rank == 0:
            return


def differences(numbers: list[int]) -> list[int]:
    """Return each number less the one before, the first as it is; 0, -1, 1, -2 and so on become 0, 1, 2, 3."""
    steps = (there - here for here, there in zip([0, *numbers], numbers, strict=False))
    return [2 * step if step >= 0 else -2 * step - 1 for step in steps]


def planes(numbers: list[int]) -> bytes:
    """Return 16-bit numbers as all low bytes and then all high ones, which compress better."""
    both = struct.pack(f"<{len(numbers)}H", *numbers)
    return both[::2] + both[1::2]


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(__file__).parents[2] / "physical" / "land.zip")
