"""GeoJSON, read and written."""

import json
import math
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physical import (
    Band,
    GeoJSONError,
    PhysicalProperty,
    area,
    box,
    circle,
    contains,
    point,
    polygon,
    read_geojson,
    write_geojson,
)

SQUARE = [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]
words = st.text(st.characters(categories=["L", "N"]), min_size=1, max_size=8)


def wrapped(longitude):
    return (longitude + 180) % 360 - 180


@st.composite
def shapes(draw):
    """A point or a star, often at the antimeridian."""
    lat = draw(st.floats(-80, 80))
    lon = draw(st.sampled_from([180.0, -179.9, 179.5]) | st.floats(-180, 180))
    n = draw(st.integers(0, 9))
    if n < 3:
        return point(lat, lon)
    radii = draw(st.lists(st.floats(0.2, 1.0), min_size=n, max_size=n))
    turns = [(i + 0.4) * 2 * math.pi / n for i in range(n)]
    return polygon(
        (lat + r * math.sin(a), wrapped(lon + r * math.cos(a))) for r, a in zip(radii, turns, strict=True)
    )


properties = st.builds(
    PhysicalProperty,
    entity=words,
    kind=words,
    geometry=shapes(),
    altitude=st.none() | st.tuples(st.integers(0, 50), st.integers(50, 99)).map(lambda x: Band(*x)),
    channels=st.lists(words, max_size=3).map(tuple),
    carried_by=st.none() | words,
)


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "features": list(features)})


def feature(geometry="Polygon", coordinates=SQUARE, /, **members):
    members = {"name": "a", "kind": "K"} | members
    kept = {key: value for key, value in members.items() if value is not None}
    return {"type": "Feature", "geometry": {"type": geometry, "coordinates": coordinates}, "properties": kept}


@settings(deadline=None)
@given(st.lists(properties, max_size=6, unique_by=lambda item: item.entity))
def test_what_is_written_is_read_back(items):
    text = write_geojson(items)
    assert read_geojson(text) == tuple(sorted(items, key=lambda item: item.entity))
    assert read_geojson(text.encode()) == read_geojson(text)


def test_names_kinds_and_the_rest_are_in_the_properties():
    text = write_geojson([PhysicalProperty("uav0", "UAV", point(1, 2), Band(0, 9), ("wifi",), "vessel0")])
    assert json.loads(text)["features"] == [
        {
            "type": "Feature",
            "properties": {
                "name": "uav0",
                "kind": "UAV",
                "altitude": [0.0, 9.0],
                "channels": ["wifi"],
                "carried_by": "vessel0",
            },
            "geometry": {"type": "Point", "coordinates": [2.0, 1.0]},
        }
    ]


def test_rings_are_written_closed_and_counter_clockwise():
    (written,) = json.loads(write_geojson([PhysicalProperty("a", "K", box((0, 0), (1, 2)))]))["features"]
    assert written["geometry"] == {
        "type": "Polygon",
        "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]]],
    }


def test_what_crosses_the_antimeridian_is_written_cut():
    fiji = PhysicalProperty("fiji", "Place", box((-10, 177), (-20, -178)))
    (written,) = json.loads(write_geojson([fiji]))["features"]
    assert written["geometry"]["type"] == "MultiPolygon"
    easts = [sorted({lon for lon, _ in ring}) for (ring,) in written["geometry"]["coordinates"]]
    assert easts == [[177, 180], [-180, -178]]
    assert read_geojson(write_geojson([fiji])) == (fiji,)


def test_what_only_touches_the_antimeridian_is_written_whole_on_its_side():
    east = PhysicalProperty("east", "Place", box((0, 170), (1, 180)))
    west = PhysicalProperty("west", "Place", box((0, -180), (1, -170)))
    features = json.loads(write_geojson([east, west]))["features"]
    easts = [sorted({lon for lon, _ in item["geometry"]["coordinates"][0]}) for item in features]
    assert easts == [[170, 180], [-180, -170]]
    assert read_geojson(write_geojson([east, west])) == (east, west)


def test_a_line_with_a_width_is_a_corridor_that_programs_read():
    bend = [[-8.6, 37], [-8.5, 37], [-8.5, 37.1]]
    (found,) = read_geojson(collection(feature("LineString", bend, width_m=200)))
    length = 8_899 + 11_099  # metres, by geod
    expected = 200 * length + math.pi * 100**2 - (1 - math.pi / 4) * 100**2
    assert area(found.geometry) == pytest.approx(expected, rel=0.002)
    assert contains(found.geometry, point(37.0008, -8.55))
    assert not contains(found.geometry, point(37.0010, -8.55))
    assert read_geojson(write_geojson([found])) == (found,)


def test_a_corridor_is_the_same_at_the_antimeridian_and_anywhere():
    def at(east):
        line = [[wrapped(east - 0.25), 60], [wrapped(east + 0.25), 60.25]]
        return read_geojson(collection(feature("LineString", line, width_m=500)))[0].geometry

    assert area(at(180)) == pytest.approx(area(at(10)), rel=1e-6)
    assert len(at(180).ring) == len(at(10).ring)


def test_a_multi_geometry_of_one_part_is_that_part():
    line = [[0, 0], [0, 0.1]]
    for single, multi, coordinates, more in (
        ("Point", "MultiPoint", [3, 4], {"radius_m": 9}),
        ("Point", "MultiPoint", [3, 4], {}),
        ("LineString", "MultiLineString", line, {"width_m": 9}),
        ("Polygon", "MultiPolygon", SQUARE, {}),
    ):
        one = read_geojson(collection(feature(single, coordinates, **more)))
        assert read_geojson(collection(feature(multi, [coordinates], **more))) == one


def test_a_point_with_a_radius_is_a_circle():
    (found,) = read_geojson(collection(feature("Point", [5.44, 52.97], radius_m=250)))
    assert found.geometry is circle((52.97, 5.44), 250)
    assert area(found.geometry) == pytest.approx(math.pi * 250**2, rel=0.01)


def test_a_third_coordinate_and_foreign_members_are_left_alone():
    item = feature("Point", [1, 2, 30], colour="red") | {"bbox": [0, 0, 1, 1], "id": 7}
    assert read_geojson(collection(item)) == (PhysicalProperty("a", "K", point(2, 1)),)


def problem(text):
    with pytest.raises(GeoJSONError) as caught:
        read_geojson(text)
    return str(caught.value).splitlines()[0]


@pytest.mark.parametrize(
    ("item", "message"),
    [
        (3, "feature 1: this is no Feature"),
        ({"type": "Feature"}, "feature 1: the feature has no properties"),
        (feature(name=None), "feature 1: the feature has no name"),
        (feature(kind=None), "the feature has no kind"),
        (feature(name=3), "feature 1: the name 3 is no word"),
        (feature(name=" "), "feature 1 ( ): the name ' ' is no word"),
        (feature(kind="a\nb"), r"the kind 'a\nb' is no word"),
        (feature(altitude=5), "the altitude 5 is no band"),
        (feature(altitude=[1]), "the altitude [1] is no band"),
        (feature(altitude=[2, 1]), "the band from 2.0 m to 1.0 m is upside down"),
        (feature(altitude=["a", 1]), "the altitude 'a' is not a number"),
        (feature(channels="wifi"), "the channels 'wifi' are no list"),
        (feature(channels=[1]), "the channel 1 is no word"),
        (feature(carried_by=[]), "the carried_by [] is no word"),
        (feature(radius_m=4), "only a Point can have a radius_m"),
        (feature("Point", [0, 0], radius_m="x"), "the radius 'x' is not a number"),
        (feature("Point", [0, 0], radius_m=0), "the radius 0 m is under 0.5 m"),
        (feature("Point", [0]), "[0] is no position"),
        (feature("Point", [0, 91]), "the latitude 91 is not between -90 and 90"),
        (feature("Point", ["x", 1]), "the longitude 'x' is not a number"),
        (feature("Point", None), "None is no position"),
        (feature("Polygon", 3), "3 is no list of coordinates"),
        (feature("Polygon", []), "None is no list of coordinates"),
        (feature("Polygon", [[]]), "the polygon's ring is not closed"),
        (feature("Polygon", [SQUARE[0][:4]]), "the polygon's ring is not closed"),
        (feature("Polygon", SQUARE * 2), "the polygon has 1 hole(s)"),
        (
            feature("Polygon", [[[0, 0], [1, 1], [0, 1], [1, 0], [0, 0]]]),
            "the polygon's border crosses or touches itself at (0.5000000, 0.5000000)",
        ),
        (
            feature("MultiPolygon", [SQUARE, SQUARE]),
            "a MultiPolygon of 2 parts that are not one polygon cut along the antimeridian",
        ),
        (feature("MultiPoint", [[0, 0], [1, 1]]), "a MultiPoint is not read"),
        (feature("MultiLineString", [[[0, 0], [1, 1]]] * 2), "a MultiLineString is not read"),
        (feature("GeometryCollection", None), "a GeometryCollection is not read"),
        (feature([], None), "a [] is not read"),
        (feature("LineString", [[0, 0], [1, 1]]), "a LineString is no place: it has no inside"),
        (feature(width_m=4), "only a LineString can have a width_m"),
        (feature("LineString", [[0, 0], [1, 1]], radius_m=4), "only a Point can have a radius_m"),
        (feature("LineString", 3, width_m=4), "3 is no list of coordinates"),
        (feature("LineString", [[0, 0], 3], width_m=4), "3 is no position"),
        (feature("LineString", [], width_m=4), "the line has no length"),
        (feature("LineString", [[0, 0], [0, 0]], width_m=4), "the line has no length"),
        (feature("LineString", [[0, 0], [0, 1]], width_m="x"), "the width 'x' is not a number"),
        (feature("LineString", [[0, 0], [0, 1]], width_m=0), "the width 0 m is not between 1 and 300,000 m"),
        (feature("LineString", [[0, 0], [0, 9]], width_m=9), "the line reaches over 300 km from its middle"),
        (
            feature("LineString", SQUARE[0], width_m=9),
            "the line comes back to itself: 9 m wide, it encloses an area that it does not cover",
        ),
        (feature("LineString", [[0, 0]] * 1_001, width_m=9), "the line has 1,001 positions, more than 1,000"),
        (
            {"type": "Feature", "properties": {"name": "a", "kind": "K"}, "geometry": None},
            "the feature has no geometry",
        ),
    ],
)
def test_a_bad_feature_is_refused_by_index_and_name(item, message):
    of_item = message if message.startswith("feature 1") else f"feature 1 (a): {message}"
    assert problem(collection(item)) == of_item


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "{",
            "the text is not JSON: Expecting property name enclosed in double quotes: line 1 column 2 (char 1)",
        ),
        ('{"a": NaN}', "the text is not JSON: NaN is no number"),
        (b'{"a": "\xff"}', "the text is not UTF-8: byte 7 is not valid"),
        ("[" * 100_000, "the text is nested too deeply"),
        ("[]", "the text is no FeatureCollection"),
        ('{"type": "Feature"}', "the text is no FeatureCollection"),
        ('{"type": "FeatureCollection"}', "the collection has no list of features"),
        (" " * 10_000_001, "the text is over 10,000,000 bytes"),
        (collection(*[0] * 20_001), "the collection has over 20,000 features"),
        (collection(feature("Polygon", [[[0, 0]] * 100_001])), "the collection has over 100,000 vertices"),
        (
            '{"type": "FeatureCollection", "crs": {"properties": {"name": "EPSG:28992"}}, "features": []}',
            'the coordinates are not WGS 84 but {"properties": {"name": "EPSG:28992"}}',
        ),
    ],
)
def test_a_text_that_is_no_collection_is_refused(text, message):
    assert problem(text) == message


def test_all_problems_are_reported_at_once_and_carry_their_hints():
    items = [feature(kind=None), feature(name="b"), feature(name="b"), feature("Point", [0, 99], name="c")]
    with pytest.raises(GeoJSONError) as caught:
        read_geojson(collection(*items))
    assert [found.code for found in caught.value.problems] == ["kind", "latitude", "duplicate-name"]
    assert str(caught.value) == (
        "feature 1 (a): the feature has no kind\n"
        'hint: write "kind" into its properties\n'
        "feature 4 (c): the latitude 99 is not between -90 and 90\n"
        "hint: a position of GeoJSON is [longitude, latitude], in degrees, east and north positive\n"
        "2 features have the name b\n"
        "hint: names are unique"
    )


@settings(deadline=None)
@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=3),
        lambda x: (
            st.lists(x, max_size=3)
            | st.dictionaries(
                st.sampled_from(["type", "features", "geometry", "coordinates", "properties", "name"]),
                x,
                max_size=4,
            )
        ),
    )
)
def test_nothing_but_a_diagnostic_comes_out(value):
    for text in (
        json.dumps(value),
        collection(value),
        collection(feature("Polygon", value)),
        collection(feature("MultiPolygon", value)),
        collection(feature("LineString", value, width_m=10)),
        collection(feature("LineString", [[0, 0], [1, 1]], width_m=value)),
    ):
        with suppress(GeoJSONError):
            read_geojson(text)
