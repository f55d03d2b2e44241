"""Regions as GeoJSON: a feature for each part, with its entity, its kind and its altitudes (RFC 7946).

Borders are shortest lines, which GeoJSON does not have. They are cut so that its straight edges stay within a metre. A
margin is drawn a little too large rather than too small. A part is cut at the antimeridian, and an outer ring runs
counterclockwise.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, Final, NamedTuple

import shapely
from shapely.affinity import translate
from shapely.geometry.polygon import orient

from physical.geodesic_areas import area_of, disc_of, projected
from physical.gnomonic import Disc, GnomonicFrame, frame_of, stretch
from physical.regions import Region, RegionPart

LONGEST_EDGE: Final = 2_000.0
"""Metres of an edge, unless there were too many."""

MOST_EDGES: Final = 2_000
DIGITS: Final = 7
HALF: Final = 180.0


class NamedRegion(NamedTuple):
    """A region of an entity, and the words for its flight; empty where it does not fly."""

    entity: str
    kind: str
    region: Region
    flight: str = ""


def write_regions(regions: Iterable[NamedRegion]) -> str:
    """Return a feature collection of all parts of regions, in their order, each once."""
    features = [_feature(named, part) for named in regions for part in named.region.parts]
    distinct = {json.dumps(feature, ensure_ascii=False): feature for feature in features}
    return (
        json.dumps({"type": "FeatureCollection", "features": list(distinct.values())}, ensure_ascii=False)
        + "\n"
    )


def _feature(named: NamedRegion, part: RegionPart) -> dict[str, Any]:
    known = {
        "name": named.entity,
        "kind": named.kind,
        "region": part.kind.value,
        "altitude": None if part.altitude is None else [part.altitude.low, part.altitude.high],
        "margin_m": part.margin or None,
        "between": list(part.between) or None,
        "flight": named.flight or None,
    }
    properties = {name: value for name, value in known.items() if value is not None}
    return {"type": "Feature", "properties": properties, "geometry": _geometry(part)}


def _geometry(part: RegionPart) -> dict[str, Any]:
    disc = disc_of(part)
    frame = frame_of(disc)
    shape = projected(area_of(part), frame)
    if part.margin > 0.0:
        shape = shape.buffer(part.margin * stretch(disc.radius), quad_segs=16)
    pieces = _cut_at_the_antimeridian(_unrolled(_divided(shape), frame, disc))
    coordinates = [_coordinates(piece) for piece in pieces]
    kind = pieces[0].geom_type
    if len(pieces) == 1:
        return {"type": kind, "coordinates": coordinates[0]}
    return {"type": f"Multi{kind}", "coordinates": coordinates}


def _divided(shape: shapely.Geometry) -> shapely.Geometry:
    longest = max(LONGEST_EDGE, shapely.length(shape) / MOST_EDGES)
    return shapely.segmentize(shape, longest)


def _unrolled(shape: shapely.Geometry, frame: GnomonicFrame, disc: Disc) -> shapely.Geometry:
    """Return a shape in degrees with longitudes around that of its middle."""
    degrees = frame.unproject(shape)

    def beside(coordinates: Any) -> Any:
        coordinates[:, 0] = disc.longitude + (coordinates[:, 0] - disc.longitude + HALF) % (2 * HALF) - HALF
        return coordinates.round(DIGITS)

    return shapely.transform(degrees, beside)


def _cut_at_the_antimeridian(shape: shapely.Geometry) -> list[shapely.Geometry]:
    """Return the pieces of a shape with longitudes between -180 and 180."""
    west, _, east, _ = shape.bounds
    if west >= -HALF and east <= HALF:
        return [shape]
    pieces = []
    for turn in (-1, 0, 1):
        side = shapely.box((2 * turn - 1) * HALF, -90.0, (2 * turn + 1) * HALF, 90.0)
        inside = translate(shapely.intersection(shape, side), -2 * turn * HALF)
        pieces += [
            part
            for part in shapely.get_parts(inside)
            if part.geom_type == shape.geom_type and not part.is_empty
        ]
    return pieces


def _coordinates(shape: shapely.Geometry) -> Any:
    if shape.geom_type == "Point":
        return [shape.x, shape.y]
    if shape.geom_type == "LineString":
        return [list(position) for position in shape.coords]
    rings = (orient(shape).exterior, *orient(shape).interiors)
    return [[list(position) for position in ring.coords] for ring in rings]
