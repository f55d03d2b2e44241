"""GeoJSON (RFC 7946) feature collections, read and written as physical properties.

A feature needs `properties.name` and `properties.kind`. Optional properties are `altitude` ([low, high], metres),
`channels`, `carried_by`, `radius_m` of a Point (a circle) and `width_m` of a LineString (a corridor). A Multi geometry
with a single part is that part. Other members are ignored and counted; the third number of a position is no altitude
band. Edges are straight in longitude and latitude, as in this model (§3.1.1). A geometry across the antimeridian is
written cut (§3.1.9) and joined again when read. A moved polygon is written as its vertices, without its template.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from typing import Final, NoReturn

import shapely
from shapely.affinity import translate

from physical.altitude import Band
from physical.corridor import corridor
from physical.errors import PhysicalError
from physical.file_account import Counting, Read
from physical.frame import E7, TURN, PositionE7
from physical.long_edges import check_edges, goes_around
from physical.physical_property import PhysicalProperty
from physical.shape import Geometry, canonical, circle, planar, point, polygon
from physical.untrusted_text import is_word, legible, read_json

MAX_BYTES: Final = 10_000_000
MAX_FEATURES: Final = 20_000
MAX_VERTICES: Final = 100_000

READ: Final = ("name", "kind", "altitude", "channels", "carried_by", "radius_m", "width_m")
"""The properties of a feature that are read."""

MULTI: Final = {"MultiPoint": "Point", "MultiLineString": "LineString", "MultiPolygon": "Polygon"}
"""The part type of each Multi geometry."""

Json = Mapping[str, object]

_ORDER: Final = "a position of GeoJSON is [longitude, latitude], in degrees, east and north positive"


class GeoJSONError(PhysicalError):
    """The mistakes in a GeoJSON text; `problems` has all of them, each with its feature."""

    def __init__(self, problems: Sequence[PhysicalError]) -> None:
        first = problems[0]
        super().__init__(first.code, first.message, first.hint, first.where)
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return "\n".join(map(str, self.problems))


def read_geojson(text: str | bytes) -> tuple[PhysicalProperty, ...]:
    """Return the physical properties of a feature collection, in its order.

    Raises:
        GeoJSONError: With all problems of all features.
    """
    return tuple(reading_geojson(text))


def read_features(text: str | bytes) -> Read:
    """Return the physical properties of a feature collection, with the account of its features.

    Raises:
        GeoJSONError: With all problems of all features.
    """
    counting = Counting()
    found = tuple(reading_geojson(text, counting))
    counting.take("feature", len(found))
    return Read(found, (counting.tally(len(found), "feature"),))


def reading_geojson(
    text: str | bytes, counting: Counting | None = None
) -> Generator[PhysicalProperty, None, None]:
    """Yield the properties one by one, so that the caller can work in between; problems are raised at the end.

    Ignored parts of a feature are counted as asides.

    Raises:
        GeoJSONError: With all problems of all features.
    """
    counting = counting or Counting()
    found: list[PhysicalProperty] = []
    problems: list[PhysicalError] = []
    for index, feature in enumerate(_features(_parsed(text)), 1):
        try:
            found.append(_property(feature, counting))
        except PhysicalError as problem:
            where = f"feature {index}{_label(feature)}"
            hint = _ORDER if problem.code in ("latitude", "longitude") else problem.hint
            problems.append(PhysicalError(problem.code, problem.message, hint, where))
        else:
            yield found[-1]
    problems += _repeated(found)
    if problems:
        raise GeoJSONError(problems)


def write_geojson(properties: Iterable[PhysicalProperty]) -> str:
    """Return a feature collection of physical properties, sorted by name."""
    features = [_feature(item) for item in sorted(properties, key=lambda item: item.entity)]
    return (
        json.dumps({"type": "FeatureCollection", "features": features}, ensure_ascii=False, indent=1) + "\n"
    )


# --- reading --------------------------------------------------------------------------------------


def _fail(code: str, message: str, hint: str = "") -> NoReturn:
    raise PhysicalError(code, message, hint)


def _parsed(text: str | bytes) -> object:
    try:
        return read_json(text, MAX_BYTES)
    except PhysicalError as problem:
        raise GeoJSONError([problem]) from None


def _features(collection: object) -> Sequence[object]:
    try:
        if not isinstance(collection, dict) or collection.get("type") != "FeatureCollection":
            _fail(
                "collection",
                "the text is no FeatureCollection",
                'write {"type": "FeatureCollection", "features": [...]}',
            )
        _check_crs(collection.get("crs"))
        features = collection.get("features")
        if not isinstance(features, list):
            _fail("collection", "the collection has no list of features", 'write "features": [...]')
        if len(features) > MAX_FEATURES:
            _fail(
                "too-large",
                f"the collection has over {MAX_FEATURES:,} features",
                "leave out features without a part in the mission",
            )
        if sum(map(_count, features)) > MAX_VERTICES:
            _fail("too-large", f"the collection has over {MAX_VERTICES:,} vertices", "simplify its borders")
    except PhysicalError as problem:
        raise GeoJSONError([problem]) from None
    return features


def _check_crs(crs: object) -> None:
    """Raise PhysicalError for a coordinate system other than WGS 84, which GeoJSON allowed before RFC 7946."""
    named = json.dumps(crs)
    if crs is not None and "CRS84" not in named and "4326" not in named:
        _fail("crs", f"the coordinates are not WGS 84 but {named:.80}", "convert them: RFC 7946 has no other")


def _count(feature: object) -> int:
    """Return the number of positions of a feature, whatever its structure."""
    geometry = feature.get("geometry") if isinstance(feature, dict) else None
    coordinates = geometry.get("coordinates") if isinstance(geometry, dict) else None
    return sum(1 for _ in _positions(coordinates))


def _positions(coordinates: object) -> Iterator[list[object]]:
    """Yield the innermost lists of coordinates, whatever their structure."""
    open_lists = [coordinates]
    while open_lists:
        part = open_lists.pop()
        if isinstance(part, list):
            if not isinstance(part[0] if part else None, list):
                yield part
            open_lists += [inner for inner in part if isinstance(inner, list)]


def _label(feature: object) -> str:
    properties = feature.get("properties") if isinstance(feature, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    return f" ({legible(name, 60)})" if isinstance(name, str) else ""


def _repeated(found: Sequence[PhysicalProperty]) -> list[PhysicalError]:
    counted = Counter(item.entity for item in found)
    return [
        PhysicalError("duplicate-name", f"{count} features have the name {name}", "names are unique")
        for name, count in counted.items()
        if count > 1
    ]


def _property(feature: object, counting: Counting) -> PhysicalProperty:
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        _fail(
            "feature", "this is no Feature", 'write {"type": "Feature", "geometry": ..., "properties": ...}'
        )
    properties = feature.get("properties")
    if not isinstance(properties, dict):
        _fail("properties", "the feature has no properties", 'write at least "name" and "kind"')
    _note_unread(feature.get("geometry"), properties, counting)
    return PhysicalProperty(
        entity=_word(properties, "name"),
        kind=_word(properties, "kind"),
        geometry=_geometry(feature.get("geometry"), properties, counting),
        altitude=_altitude(properties.get("altitude")),
        channels=_channels(properties.get("channels")),
        carried_by=None if properties.get("carried_by") is None else _word(properties, "carried_by"),
    )


def _note_unread(geometry: object, properties: Json, counting: Counting) -> None:
    """Count ignored data: other properties, and heights in coordinates, which are no altitude bands."""
    if others := len(properties.keys() - READ):
        counting.note(f"property of a feature with another name than {', '.join(READ)}", others)
    coordinates = geometry.get("coordinates") if isinstance(geometry, dict) else None
    if heights := sum(len(position) == 3 for position in _positions(coordinates)):
        counting.note('height in a coordinate, which is not read: write "altitude": [low, high]', heights)


def _word(properties: Json, member: str) -> str:
    value = properties.get(member)
    if value is None:
        _fail(member, f"the feature has no {member}", f'write "{member}" into its properties')
    if not is_word(value):
        _fail(member, f"the {member} {value!r:.60} is no word", "write a text of 1 to 200 characters")
    return value


def _altitude(value: object) -> Band | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 2:
        _fail("altitude", f"the altitude {value!r:.60} is no band", "write [low, high], in metres")
    return Band(*value)


def _channels(value: object) -> tuple[str, ...]:
    if value is None:
        return ()
    if not isinstance(value, list):
        _fail("channels", f"the channels {value!r:.60} are no list", 'write ["wifi", ...]')
    return tuple(_word({"channel": channel}, "channel") for channel in value)


def _geometry(geometry: object, properties: Json, counting: Counting) -> Geometry:
    kind, coordinates = _single(geometry)
    radius, width = properties.get("radius_m"), properties.get("width_m")
    if radius is not None and kind != "Point":
        _fail("radius", "only a Point can have a radius_m", "leave it out, or write the centre as a Point")
    if width is not None and kind != "LineString":
        _fail(
            "width",
            "only a LineString can have a width_m",
            "leave it out, or write the middle as a LineString",
        )
    match kind:
        case "Point":
            at = _position(coordinates)
            return point(*at) if radius is None else circle(at, radius)  # type: ignore[arg-type]  # circle checks it
        case "LineString":
            return _corridor(coordinates, width)
        case "Polygon":
            return _polygon(_ring(coordinates), counting)
        case "MultiPolygon":
            return _joined(_list(coordinates))
        case None:
            _fail(
                "geometry",
                "the feature has no geometry",
                "write a Point, a LineString with width_m, or a Polygon",
            )
    return _fail(
        "geometry",
        f"a {kind!s:.40} is not read",
        "write one feature for each Point, LineString and Polygon",
    )


def _single(geometry: object) -> tuple[object, object]:
    """Return the type and the coordinates of a geometry, or of the part of a Multi geometry with a single part."""
    if not isinstance(geometry, dict):
        return None, None
    kind, coordinates = geometry.get("type"), geometry.get("coordinates")
    if isinstance(kind, str) and kind in MULTI and isinstance(coordinates, list) and len(coordinates) == 1:
        return MULTI[kind], coordinates[0]
    return kind, coordinates


def _polygon(ring: list[tuple[float, float]], counting: Counting) -> Geometry:
    """Return the polygon of a ring, which may cross the antimeridian without a cut."""
    found = polygon(ring)
    check_edges(ring)
    if goes_around(ring):
        counting.note("ring with an edge over most of the earth: it is read as one across the antimeridian")
    return found


def _corridor(coordinates: object, width: object) -> Geometry:
    line = [_position(each) for each in _list(coordinates)]
    if width is None:
        _fail(
            "width",
            "a LineString is no place: it has no inside",
            'write its width into its properties: "width_m", in metres',
        )
    return corridor(line, width)  # type: ignore[arg-type]  # corridor checks it


def _list(value: object) -> list[object]:
    return (
        value if isinstance(value, list) else _fail("coordinates", f"{value!r:.60} is no list of coordinates")
    )


def _position(value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) not in (2, 3):
        _fail("not-a-position", f"{value!r:.60} is no position", "write [longitude, latitude], in degrees")
    return value[1], value[0]


def _ring(value: object) -> list[tuple[float, float]]:
    rings = _list(value)
    if len(rings) > 1:
        _fail(
            "hole",
            f"the polygon has {len(rings) - 1} hole(s)",
            "write the hole as a place of its own",
        )
    positions = [_position(vertex) for vertex in _list(rings[0] if rings else None)]
    if not positions or positions[0] != positions[-1]:
        _fail("open-ring", "the polygon's ring is not closed", "repeat its first position at its end")
    return positions


def _joined(parts: Sequence[object]) -> Geometry:
    """Return the polygon that was cut along the antimeridian (RFC 7946 §3.1.9)."""
    rings = [_ring(part) for part in parts]
    found = [planar(polygon(ring)) for ring in rings]
    for ring in rings:
        check_edges(ring)
    west = [_turned_east(shape) for shape in found]
    whole = shapely.union_all(west) if _cut(west) else None
    if whole is None or whole.geom_type != "Polygon" or whole.interiors:
        _fail(
            "geometry",
            f"a MultiPolygon of {len(parts)} parts that are not one polygon cut along the antimeridian",
            "write one feature for each Polygon",
        )
    return canonical(
        _without_cuts([(round(north), round(east)) for east, north in whole.exterior.coords[:-1]])
    )


def _turned_east(shape: shapely.Polygon) -> shapely.Polygon:
    return translate(shape, TURN) if shape.bounds[0] == -TURN // 2 else shape


def _cut(parts: Sequence[shapely.Polygon]) -> bool:
    """Whether every part ends at the antimeridian, and both sides occur."""
    sides = {(part.bounds[0] == TURN // 2, part.bounds[2] == TURN // 2) for part in parts}
    return sides == {(True, False), (False, True)}


def _without_cuts(ring: list[PositionE7]) -> list[PositionE7]:
    """Return the ring without vertices on the antimeridian that the cut added to an edge, up to rounding."""
    around = zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1], strict=True)
    return [here for before, here, after in around if here[1] != TURN // 2 or not _amid(before, here, after)]


def _amid(a: PositionE7, b: PositionE7, c: PositionE7) -> bool:
    run = c[1] - a[1]
    return (a[1] < b[1]) != (c[1] < b[1]) and abs((b[0] - a[0]) * run - (c[0] - a[0]) * (b[1] - a[1])) <= abs(
        run
    )


# --- writing --------------------------------------------------------------------------------------


def _feature(item: PhysicalProperty) -> Json:
    known = {
        "name": item.entity,
        "kind": item.kind,
        "altitude": None if item.altitude is None else [item.altitude.low, item.altitude.high],
        "channels": list(item.channels) or None,
        "carried_by": item.carried_by,
    }
    properties = {name: value for name, value in known.items() if value is not None}
    return {"type": "Feature", "properties": properties, "geometry": _written(item.geometry)}


def _written(geometry: Geometry) -> Json:
    shape = planar(geometry)
    if geometry.is_point:
        return {"type": "Point", "coordinates": [shape.x / E7, shape.y / E7]}
    half = TURN // 2
    if shape.bounds[2] <= half:
        return {"type": "Polygon", "coordinates": _rings(shape)}
    _, south, _, north = shape.bounds
    east = shapely.intersection(shape, shapely.box(-half, south, half, north))
    west = translate(shapely.intersection(shape, shapely.box(half, south, 2 * TURN, north)), -TURN)
    parts = [part for side in (east, west) for part in shapely.get_parts(side) if part.geom_type == "Polygon"]
    return {"type": "MultiPolygon", "coordinates": [_rings(part) for part in parts]}


def _rings(shape: shapely.Polygon) -> list[list[list[float]]]:
    ring = shapely.geometry.polygon.orient(shape).exterior.coords
    return [[[round(east) / E7, round(north) / E7] for east, north in ring]]
