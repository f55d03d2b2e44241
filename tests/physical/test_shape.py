"""Canonical geometry values and their relations."""

import copy
import math
import pickle
import subprocess
import sys
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physical import GeometryError, box, circle, contains, equal, overlaps, point, polygon, translate_to
from physical.shape import _INTERNED

lats = st.floats(-84, 84)
lons = st.floats(-180, 180)


@st.composite
def stars(draw, at=None, largest=3.0):
    """A simple polygon, star-shaped around its centre, as (latitude, longitude) pairs."""
    lat, lon = at or (draw(lats), draw(lons))
    n = draw(st.integers(3, 9))
    reach = draw(st.floats(0.001, largest))
    radii = draw(st.lists(st.floats(0.3, 1.0), min_size=n, max_size=n))
    turns = [(i + 0.4) * 2 * math.pi / n for i in range(n)]
    return [
        (lat + reach * r * math.sin(turn), wrapped(lon + reach * r * math.cos(turn)))
        for r, turn in zip(radii, turns, strict=True)
    ]


def wrapped(longitude):
    return (longitude + 180) % 360 - 180


def shifted(vertices, degrees):
    return [(lat, wrapped(lon + degrees)) for lat, lon in vertices]


def near_points(vertices):
    """Points about a polygon, on its border and at its vertices too."""
    centre = st.sampled_from(vertices)
    step = st.floats(-2, 2)
    return st.one_of(
        centre,
        st.tuples(centre, step, step).map(
            lambda x: (max(-90, min(90, x[0][0] + x[1])), wrapped(x[0][1] + x[2]))
        ),
    )


def test_the_box_of_example_1_is_the_same_from_any_two_opposite_corners():
    search_area = box((37.04, -8.59), (36.94, -8.79))
    assert search_area is box((36.94, -8.79), (37.04, -8.59)) is box((37.04, -8.79), (36.94, -8.59))
    assert search_area.vertices == ((36.94, -8.79), (36.94, -8.59), (37.04, -8.59), (37.04, -8.79))


@settings(deadline=None)
@given(stars(), st.data())
def test_start_vertex_direction_and_closing_do_not_matter(vertices, data):
    start = data.draw(st.integers(0, len(vertices) - 1))
    turned = [*vertices[start:], *vertices[:start]]
    assert polygon(turned) is polygon(vertices) is polygon(turned[::-1]) is polygon([*turned, turned[0]])


def test_vertices_amid_a_straight_edge_do_not_matter():
    assert polygon([(0, 0), (0, 1), (0, 3), (2, 3), (2, 0), (1, 0)]) is box((0, 0), (2, 3))


@pytest.mark.parametrize(
    ("one", "other"),
    [((0.0, 0), (-0.0, -0.0)), ((5, 180), (5, -180)), ((90, 12), (90, 77)), ((1, 2), (1.00000004, 2))],
)
def test_a_point_has_one_spelling(one, other):
    assert point(*one) is point(*other)
    assert hash(point(*one)) == hash(point(*other))


@settings(deadline=None)
@given(stars(largest=0.05))
def test_values_survive_pickling_and_copying_as_the_same_object(vertices):
    shape = polygon(vertices)
    moved = translate_to(shape, point(12, 34))
    for value in (shape, moved):
        assert pickle.loads(pickle.dumps(value)) is value
        assert copy.deepcopy(value) is value
        assert copy.copy(value) is value


def test_hash_and_order_are_the_same_in_every_process():
    code = (
        "from physical import *; a = circle((1, 2), 30); b = translate_to(a, point(3, 4));"
        "print(hash(a), hash(b), sorted([b, a, point(5, 6)]))"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", code], env={"PYTHONHASHSEED": seed}, capture_output=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(outputs) == 1


def test_geometry_cannot_be_changed():
    with pytest.raises(AttributeError):
        point(1, 2).ring = ()


def test_repr_is_the_call_and_elides_long_polygons():
    assert repr(point(1.5, -2)) == "point(1.5, -2.0)"
    triangle = polygon([(0, 0), (0, 1), (1, 0)])
    assert eval(repr(triangle), {"polygon": polygon}) is triangle
    assert repr(circle((0, 0), 50)).endswith("... 56 more])")


# --- errors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "code", "message"),
    [
        (lambda: point(math.nan, 0), "not-finite", "the latitude nan is not between -90 and 90"),
        (lambda: point(0, math.inf), "not-finite", "the longitude inf is not between -180 and 180"),
        (lambda: point(90.1, 0), "latitude", "the latitude 90.1 is not between -90 and 90"),
        (lambda: point(0, -181), "longitude", "the longitude -181 is not between -180 and 180"),
        (lambda: point(10**9999, 0), "latitude", "the latitude given is not between -90 and 90"),
        (lambda: point("1", 0), "not-a-number", "the latitude '1' is not a number"),
        (lambda: point(True, 0), "not-a-number", "the latitude True is not a number"),
        (lambda: polygon([1, 2, 3]), "not-a-position", "1 is no position"),
        (lambda: polygon(["ab", "cd"]), "not-a-position", "'ab' is no position"),
        (lambda: polygon([(1, 2, 3)]), "not-a-position", "(1, 2, 3) is no position"),
        (
            lambda: polygon([(0, 0), (0, 1), (0, 0)]),
            "too-few-vertices",
            "a polygon needs at least 3 different vertices; 2 given",
        ),
        (lambda: polygon([]), "too-few-vertices", "a polygon needs at least 3 different vertices; 0 given"),
        (
            lambda: polygon([(0, 0), (1, 1), (2, 2)]),
            "zero-area",
            "the polygon has no area: its vertices lie on one line",
        ),
        (lambda: box((1, 2), (1, 5)), "zero-area", "the box has no area: its corners lie on one line"),
        (
            lambda: polygon([(0, 0), (1, 1), (1, 0), (0, 1)]),
            "self-intersection",
            "the polygon's border crosses or touches itself at (0.5000000, 0.5000000)",
        ),
        (
            lambda: polygon([(0, 179), (1, -179), (1, 179), (0, -179)]),
            "self-intersection",
            "the polygon's border crosses or touches itself at (0.5000000, -180.0000000)",
        ),
        (
            lambda: polygon([(0, 0), (0, 2), (2, 2), (0, 1)]),
            "self-intersection",
            "the polygon's border crosses or touches itself at (0.0000000, 1.0000000)",
        ),
        (lambda: circle((1, 2), 0), "radius", "the radius 0 m is under 0.5 m"),
        (lambda: circle((1, 2), -5.0), "radius", "the radius -5.0 m is under 0.5 m"),
        (lambda: circle((1, 2), math.nan), "radius", "the radius nan is not a number"),
        (lambda: circle((1, 2), "9"), "radius", "the radius '9' is not a number"),
        (lambda: circle((1, 2), 1e7), "hemisphere", "the radius 10000000.0 m reaches half around the earth"),
        (lambda: circle((1, 2), 5, 2), "vertices", "a circle of 2 vertices"),
        (lambda: circle((89.99, 0), 5000), "pole", "the polygon encloses a pole"),
        (lambda: polygon([(80, 0), (80, 120), (80, -120)]), "pole", "the polygon encloses a pole"),
        (
            lambda: polygon([(0, -100), (0, 0), (0, 90), (1, 90), (1, 0), (1, -100)]),
            "hemisphere",
            "the polygon reaches half around the earth or more",
        ),
        (
            lambda: polygon((0, i / 1e5) for i in range(10_002)),
            "too-many-vertices",
            "the polygon has more than 10000 vertices",
        ),
    ],
)
def test_what_is_no_geometry_is_refused(make, code, message):
    with pytest.raises(GeometryError) as caught:
        make()
    assert (caught.value.code, caught.value.message) == (code, message)
    assert caught.value.hint
    assert str(caught.value) == f"{message}\nhint: {caught.value.hint}"


def test_a_polygon_may_have_ten_thousand_vertices():
    ring = [(math.sin(i * math.pi / 5000), math.cos(i * math.pi / 5000)) for i in range(10_000)]
    assert len(polygon([*ring, ring[0]]).ring) == 10_000


# --- containment ----------------------------------------------------------------------------------


def crossing_number(vertices, lat, lon):
    """Say inside (1), outside (-1) or on the border (0), in exact arithmetic, by the parity of crossings."""
    x, y = Fraction(lon), Fraction(lat)
    inside = False
    for (y1, x1), (y2, x2) in pairwise([*vertices, vertices[0]]):
        cross = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
        if cross == 0 and min(x1, x2) <= x <= max(x1, x2) and min(y1, y2) <= y <= max(y1, y2):
            return 0
        if (y1 > y) != (y2 > y) and (cross > 0) == (y2 > y1):
            inside = not inside
    return 1 if inside else -1


@settings(deadline=None)
@given(stars(at=(50.0, 10.0)), st.data())
def test_a_point_is_contained_iff_it_is_strictly_inside(vertices, data):
    shape, at = polygon(vertices), point(*data.draw(near_points(vertices)))
    assert contains(shape, at) == (crossing_number(shape.ring, *at.ring[0]) == 1)


@settings(deadline=None)
@given(stars(), st.data(), st.sampled_from([180, 90, -170]))
def test_a_world_shifted_around_the_earth_behaves_the_same(vertices, data, degrees):
    # Whole degrees and a coarse grid, so that shifting does not round.
    vertices = [(round(lat, 4), round(lon, 4)) for lat, lon in vertices]
    other = data.draw(stars(at=vertices[0]))
    other = [(round(lat, 4), round(lon, 4)) for lat, lon in other]
    at = data.draw(near_points(vertices))
    at = (round(at[0], 4), round(at[1], 4))
    here = [polygon(vertices), polygon(other), point(*at)]
    there = [
        polygon(shifted(vertices, degrees)),
        polygon(shifted(other, degrees)),
        point(at[0], wrapped(at[1] + degrees)),
    ]
    for relation in (contains, overlaps):
        for a, b in ((0, 1), (1, 0), (0, 2), (1, 2), (2, 0), (0, 0)):
            assert relation(here[a], here[b]) == relation(there[a], there[b])


def test_containment_is_of_the_interior():
    room, outer = box((0, 0), (1, 1)), box((0, 0), (2, 2))
    assert not contains(outer, room)
    assert contains(outer, box((0.1, 0.1), (1, 1)))
    assert not contains(outer, point(0, 1))
    assert contains(outer, point(1, 1))
    assert not contains(point(1, 1), point(1, 1))
    assert not contains(outer, outer)


def test_polygons_overlap_where_they_share_interior_and_do_not_nest():
    a = box((0, 0), (2, 2))
    assert overlaps(a, box((1, 1), (3, 3)))
    assert overlaps(a, box((0, 0), (1, 1)))  # touches from inside
    assert not overlaps(a, box((0.5, 0.5), (1, 1)))
    assert not overlaps(a, box((0, 2), (2, 4)))  # a common border
    assert not overlaps(a, box((2, 2), (3, 3)))  # a common corner
    assert not overlaps(a, box((5, 5), (6, 6)))
    assert not overlaps(a, a)
    assert not overlaps(a, point(1, 1))
    assert overlaps(box((0, 179), (1, -179)), box((0, -179.5), (1, -178)))


def test_equal_compares_where_geometries_are_and_not_what_they_are_placements_of():
    ship = circle((10, 10), 30)
    moved = translate_to(ship, point(20, 20))
    copied = polygon(moved.vertices)
    assert equal(moved, copied)
    assert moved is not copied
    assert not equal(moved, ship)


def test_positions_that_come_and_go_are_not_remembered():
    shape = polygon([(0, 0), (0, 2), (2, 2), (2, 0)])
    before = len(_INTERNED)
    inside = [contains(shape, point(1 + number * 1e-5, 1)) for number in range(3_000)]
    assert all(inside)
    assert len(_INTERNED) - before < 100
