import json

import pytest

from physical import GeoJSONError, GeometryError, box, contains, point, polygon
from physical.geojson import read_features
from physical.long_edges import check_edges, check_width, goes_around


def ring(west, east, *, clockwise=False):
    corners = [[west, -10], [east, -10], [east, 10], [west, 10], [west, -10]]
    return corners[::-1] if clockwise else corners


def collection(coordinates, kind="Polygon", **properties):
    geometry = {"type": kind, "coordinates": coordinates}
    feature = {
        "type": "Feature",
        "properties": {"name": "a", "kind": "Place", **properties},
        "geometry": geometry,
    }
    return json.dumps({"type": "FeatureCollection", "features": [feature]})


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize(("west", "east"), [(-100, 100), (-91, 90), (-134, 135)])
def test_a_ring_that_may_be_wider_or_across_the_antimeridian_is_refused(west, east, clockwise):
    with pytest.raises(GeoJSONError, match="across the antimeridian: which is meant is not clear"):
        read_features(collection([ring(west, east, clockwise=clockwise)]))


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize(("west", "east"), [(-170, 170), (-135, 135), (-179.9, 179)])
def test_a_ring_across_the_antimeridian_is_read_as_one(west, east, clockwise):
    read = read_features(collection([ring(west, east, clockwise=clockwise)]))
    ((place,), (tally,)) = read.properties, read.tallies
    assert contains(place.geometry, point(0, 179.99))
    assert not contains(place.geometry, point(0, 0))
    # By RFC 7946 a ring that is counterclockwise by its numbers would be the other one: that is told.
    assert bool(tally.asides) == (not clockwise)


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_ring_of_less_than_half_the_earth_is_read_as_it_is_written(clockwise):
    read = read_features(collection([ring(-85, 85, clockwise=clockwise)]))
    assert contains(read.properties[0].geometry, point(0, 0))
    assert not contains(read.properties[0].geometry, point(0, 179))
    assert read.missing() == ()


def test_parts_of_a_cut_polygon_are_held_to_the_same():
    wide = [[ring(-100, 100)], [ring(100, 180)]]
    with pytest.raises(GeoJSONError, match="is not clear"):
        read_features(collection(wide, "MultiPolygon"))


@pytest.mark.parametrize(
    "corners",
    [((10, -100), (-10, 100)), ((10, 100), (-10, -100)), ((-10, -100), (10, 100))],
)
def test_a_box_that_may_be_wider_or_across_the_antimeridian_is_refused_whatever_its_corners(corners):
    with pytest.raises(GeometryError, match="200 degrees, or 160 degrees across the antimeridian"):
        box(*corners)


def test_a_box_across_the_antimeridian_is_one():
    assert box((10, 170), (-10, -170)) is box((10, -170), (-10, 170))
    assert contains(box((10, 170), (-10, -170)), point(0, 180))


def test_polygons_made_in_python_go_the_shorter_way():
    assert polygon(box((10, 100), (-10, 150)).vertices) is box((10, 100), (-10, 150))


def test_what_lies_between_two_meridians_is_counted_eastwards():
    check_width(170, -170)
    check_width(-85, 85)
    for west, east in ((-100, 100), (-170, 170), (0, 180)):
        with pytest.raises(GeometryError, match="eastwards"):
            check_width(west, east)


def test_edges_are_looked_at_one_by_one():
    check_edges([(0, -100), (0, 0), (0, 100)], closed=False)
    with pytest.raises(GeometryError):
        check_edges([(0, -100), (0, 0), (0, 100)])
    assert not goes_around([(0, 0), (0, 10), (10, 10)])
