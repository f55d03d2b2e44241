"""Bounds of distances between extents, held to geodesics between random points of random extents."""

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from physical import Geometry, box, circle, distance, point, polygon
from physical.extents import FARTHEST, Extent, extent, greatest_distance, least_distance, span
from physical.frame import E7, geod
from physical.shape import planar

FIGURES = 1e-6
"""Metres by which the geodesics that are compared with may be off."""


@st.composite
def shapes(draw: st.DrawFn, around: tuple[float, float], size: float) -> Geometry:
    """Draw a point, a box, a circle or a concave polygon near a place, of some size in degrees of latitude."""
    offsets = st.floats(-size, size)
    latitude, longitude = around[0] + draw(offsets), around[1] + draw(offsets)
    extent_ = draw(st.floats(0.05, 1.0)) * size
    match draw(st.sampled_from(["point", "box", "circle", "polygon"])):
        case "point":
            return point(latitude, _normal(longitude))
        case "box":
            return box((latitude, _normal(longitude)), (latitude + extent_, _normal(longitude + extent_)))
        case "circle":
            return circle((latitude, _normal(longitude)), max(1.0, extent_ * 50_000))
        case _:
            corners = [(0, 0), (0, 1), (1, 1), (0.2, 0.3)]
            return polygon([(latitude + y * extent_, _normal(longitude + x * extent_)) for y, x in corners])


def _normal(longitude: float) -> float:
    return (longitude + 180.0) % 360.0 - 180.0


@st.composite
def worlds(draw: st.DrawFn) -> tuple[Geometry, ...]:
    """Draw four shapes in a world of ten metres to some hundred kilometres, anywhere but at a pole."""
    size = 10.0 ** draw(st.floats(-4, 0.5))
    around = draw(st.floats(-75, 75)), draw(st.floats(-180, 179.9))
    return tuple(draw(shapes(around, size)) for _ in range(4))


@st.composite
def positions(draw: st.DrawFn, geometry: Geometry) -> tuple[float, float]:
    """Draw a point of a geometry (longitude, latitude): a corner, one of its border or one inside."""
    shape = planar(geometry)
    if geometry.is_point:
        return (shape.x / E7, shape.y / E7)
    on_border = shape.exterior.interpolate(draw(st.floats(0, 1)), normalized=True)
    if draw(st.booleans()):
        across = shapely.intersection(
            shape, shapely.LineString([(shape.bounds[0], on_border.y), (shape.bounds[2], on_border.y)])
        )
        on_border = (
            shapely.line_interpolate_point(
                max(shapely.get_parts(across), key=lambda part: part.length),
                draw(st.floats(0, 1)),
                normalized=True,
            )
            if across.length
            else on_border
        )
    return (on_border.x / E7, on_border.y / E7)


def metres(a: tuple[float, float], b: tuple[float, float]) -> float:
    return float(geod().inv(*a, *b)[2])


@given(st.data())
def test_no_two_points_are_nearer_than_the_least_or_farther_than_the_greatest_distance(data):
    a, b, *_ = data.draw(worlds())
    between = metres(data.draw(positions(a)), data.draw(positions(b)))
    assert least_distance(extent(a), extent(b)) <= between + FIGURES
    assert between - FIGURES <= greatest_distance(extent(a), extent(b))


@given(st.data())
def test_a_straight_way_between_two_points_of_a_hull_belongs_to_it(data):
    a, b, c, d = data.draw(worlds())
    start, end = data.draw(positions(a)), data.draw(positions(b))
    azimuth, _, length = geod().inv(*start, *end)
    *on_the_way, _ = geod().fwd(*start, azimuth, length * data.draw(st.floats(0, 1)))
    hull = span([extent(a), extent(b), extent(c)])
    between = metres((on_the_way[0], on_the_way[1]), data.draw(positions(d)))
    assert least_distance(hull, extent(d)) <= between + FIGURES
    assert between - FIGURES <= greatest_distance(hull, extent(d))


@given(worlds())
def test_the_least_distance_is_little_less_than_the_nearest_points_are_apart(world):
    a, b, *_ = world
    slack = distance(a, b) - least_distance(extent(a), extent(b))
    size = greatest_distance(extent(a), extent(b)) + greatest_distance(extent(a), extent(a)) + 1
    assert -0.03 <= slack <= 0.05 + size * (3e-6 + (size / 6_371_000) ** 2)


@given(worlds())
def test_the_greatest_distance_is_that_of_two_corners_and_little_more(world):
    a, b, *_ = world
    corners = max(metres(one[::-1], other[::-1]) for one in a.vertices for other in b.vertices)
    between = greatest_distance(extent(a), extent(b))
    sides = greatest_distance(extent(a), extent(a)) + greatest_distance(extent(b), extent(b))
    assert corners <= between <= corners + 0.1 + sides * sides / 1_000_000  # edges bend


def test_a_margin_is_taken_off_and_added():
    a, b = point(37, -9), point(37, -8)
    apart = distance(a, b)
    assert least_distance(extent(a, 100), extent(b, 50)) == pytest.approx(apart - 150)
    assert greatest_distance(extent(a, 100), extent(b, 50)) == pytest.approx(apart + 150)
    assert least_distance(extent(a, apart), extent(b)) == 0.0


def test_what_meets_is_no_metre_apart():
    harbour = box((37.0, -8.8), (37.1, -8.7))
    assert least_distance(extent(harbour), extent(point(37.05, -8.75))) == 0.0
    across = span([extent(point(37.05, -9.0)), extent(point(37.05, -8.5))])
    assert least_distance(extent(harbour), across) == 0.0


def test_places_of_continents_are_followed_by_samples():
    america, europe = box((-50, -80), (60, -60)), box((36, -9), (60, 30))
    near = metres((-60, 60), (-9, 60))
    assert 0.97 * near < least_distance(extent(america), extent(europe)) <= near
    assert least_distance(span([extent(america)]), extent(europe)) == 0.0  # no hull is drawn so large
    assert greatest_distance(extent(america), extent(europe)) == FARTHEST
    antipodes = point(-37, 171.9)
    assert greatest_distance(extent(point(37, -8)), extent(antipodes)) == FARTHEST
    assert least_distance(extent(box((36, -9), (38, -8))), extent(antipodes)) > 19_000_000


def test_the_date_line_is_no_border():
    west, east = point(10.5, 179.5), box((10, -179.5), (11, -179))
    there = Extent((box((10, -0.5), (11, 0)),))
    assert least_distance(extent(west), extent(east)) == pytest.approx(
        least_distance(extent(point(10.5, -1.5)), there), rel=1e-6
    )
    assert greatest_distance(extent(west), extent(east)) == pytest.approx(
        greatest_distance(extent(point(10.5, -1.5)), there), rel=1e-6
    )
