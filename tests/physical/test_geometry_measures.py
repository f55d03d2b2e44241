"""Metres: area, distance, centroid, waypoints."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyproj import Geod

from physical import (
    GeometryError,
    area,
    box,
    centroid,
    circle,
    contains,
    distance,
    interior_point,
    point,
    polygon,
    waypoint,
)

GEOD = Geod(ellps="WGS84")
U = [(0, 0), (0, 3), (2, 3), (2, 2), (1, 2), (1, 1), (2, 1), (2, 0)]


@pytest.mark.parametrize("latitude", [0, 37, -60, 80, 89])
@pytest.mark.parametrize("longitude", [0, 179.999, -8.6])
def test_a_circle_has_its_radius_and_area_in_metres_everywhere(latitude, longitude):
    disc = circle((latitude, longitude), 1000)
    centre = point(latitude, longitude)
    for vertex in disc.vertices[::7]:
        assert distance(centre, point(*vertex)) == pytest.approx(1000, abs=0.02)
    assert area(disc) == pytest.approx(32 * 1e6 * math.sin(math.pi / 32), rel=1e-5)
    assert distance(centroid(disc), centre) < 0.05


@settings(deadline=None)
@given(st.floats(-85, 84), st.floats(-180, 180), st.floats(0.01, 1), st.floats(0.01, 60))
def test_the_area_of_a_box_is_that_of_the_ellipsoid_between_its_parallels(south, west, high, wide):
    north, east = south + high, (west + wide + 180) % 360 - 180
    found = box((south, west), (north, east))
    (south, west), (north, _) = found.vertices[0], found.vertices[2]
    lons = [west + wide * i / 4000 for i in range(4001)]
    ring = [(lon, south) for lon in lons] + [(lon, north) for lon in lons[::-1]]
    reference, _ = GEOD.polygon_area_perimeter([x for x, _ in ring], [y for _, y in ring])
    assert area(found) == pytest.approx(reference, rel=1e-4)


@settings(deadline=None)
@given(
    st.tuples(st.floats(-90, 90), st.floats(-180, 180)), st.tuples(st.floats(-90, 90), st.floats(-180, 180))
)
def test_the_distance_of_points_is_the_geodesic(a, b):
    reference = GEOD.inv(a[1], a[0], b[1], b[0])[2]
    assert distance(point(*a), point(*b)) == pytest.approx(reference, abs=0.05)
    assert distance(point(*a), point(*b)) == pytest.approx(distance(point(*b), point(*a)))


def test_the_distance_of_polygons_is_that_of_their_nearest_points():
    disc = circle((80, 179.99), 1000)
    assert distance(disc, point(80, -179.9)) == pytest.approx(
        distance(point(80, 179.99), point(80, -179.9)) - 1000, abs=2
    )
    assert distance(box((0, 0), (1, 1)), box((0.2, 2), (0.8, 3))) == pytest.approx(
        GEOD.inv(1, 0.8, 2, 0.8)[2], rel=1e-6
    )


def test_what_meets_is_at_no_distance():
    a = box((0, 0), (1, 1))
    assert distance(a, box((0.5, 0.5), (2, 2))) == 0.0
    assert distance(a, point(0.5, 0.5)) == 0.0
    assert distance(point(0.5, 0.5), a) == 0.0


def test_centroid_is_the_centre_of_area():
    assert centroid(box((1, 179), (-1, -179))) is point(0, 180)
    assert centroid(box((37.04, -8.59), (36.94, -8.79))).vertices[0] == pytest.approx(
        (36.99, -8.69), abs=1e-4
    )
    assert centroid(point(3, 4)) is point(3, 4)


def test_a_waypoint_is_the_centroid_where_it_lies_inside():
    search_area = box((37.04, -8.59), (36.94, -8.79))
    assert waypoint(search_area) is centroid(search_area)
    assert waypoint(point(1, 2)) is point(1, 2)


def test_a_waypoint_lies_inside_where_the_centroid_does_not():
    bay = polygon(
        [
            (lat / 100, lon / 100)
            for lat, lon in [(0, 0), (0, 9), (9, 9), (9, 8), (1, 8), (1, 1), (9, 1), (9, 0)]
        ]
    )
    assert not contains(bay, centroid(bay))
    assert contains(bay, waypoint(bay))


@settings(deadline=None)
@given(st.floats(0.00001, 1), st.floats(-80, 80))
def test_an_interior_point_is_inside(size, latitude):
    shape = polygon(
        [
            (latitude + y * size, 179.99 + x * size if 179.99 + x * size <= 180 else x * size - 180.01)
            for y, x in U
        ]
    )
    assert contains(shape, interior_point(shape))
    assert interior_point(interior_point(shape)) is interior_point(shape)


def test_what_is_thinner_than_the_grid_has_no_interior_point():
    sliver = polygon([(0, 0), (0, 1e-7), (1e-7, 0)])
    with pytest.raises(GeometryError, match="no position on the grid of 1 cm lies inside") as caught:
        interior_point(sliver)
    assert caught.value.code == "too-thin"


def test_areas_on_the_other_side_of_the_earth_are_far_away_both_ways():
    bay, far = box((37.1, -8.6), (37.0, -8.7)), circle((-37.06, 171.3), 400)
    assert distance(bay, far) == pytest.approx(distance(far, bay))
    assert distance(bay, far) == pytest.approx(2.0e7, rel=0.01)
