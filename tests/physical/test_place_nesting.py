"""The index of places, and whether places nest."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physical import (
    Band,
    Conflict,
    Place,
    PlaceIndex,
    area,
    box,
    check_places,
    circle,
    contains,
    overlaps,
    point,
)
from physical.shape import covers

OCEAN = box((38, -10), (36, -7))
SEARCH = box((37.04, -8.59), (36.94, -8.79))
SPILL = circle((37.0, -8.7), 1000)


def wrapped(longitude):
    return (longitude + 180) % 360 - 180


corners = st.tuples(st.integers(-8, 8), st.integers(-8, 8))


@st.composite
def boxes(draw, at):
    """A box on a coarse grid, so that borders meet often."""
    lat, lon = draw(corners)
    high, wide = draw(st.integers(1, 8)), draw(st.integers(1, 8))
    return box((lat, wrapped(at + lon)), (lat + high, wrapped(at + lon + wide)))


@st.composite
def worlds(draw):
    """Boxes and a query, at the Gulf of Guinea or at the antimeridian."""
    at = draw(st.sampled_from([0, 180]))
    shapes = draw(st.lists(boxes(at), max_size=12))
    query = draw(boxes(at) | st.builds(lambda c: point(c[0], wrapped(at + c[1])), corners))
    return {f"p{i}": shape for i, shape in enumerate(shapes)}, query


@settings(deadline=None)
@given(worlds())
def test_the_index_answers_like_brute_force(world):
    places, query = world
    index = PlaceIndex(places)
    expected = sorted((area(shape), name) for name, shape in places.items() if contains(shape, query))
    assert index.containers(query) == tuple(name for _, name in expected)
    assert index.smallest(query) == (expected[0][1] if expected else None)
    held = [name for _, name in expected]
    assert index.minimal(query) == tuple(
        sorted(n for n in held if not any(contains(places[n], places[m]) for m in held))
    )


@settings(deadline=None)
@given(st.sampled_from([0, 180]), corners, st.integers(1, 8), st.integers(1, 8), corners)
def test_a_box_covers_what_lies_in_it_or_on_its_border(at, corner, high, wide, where):
    (south, west), (north, east) = corner, where
    place = box((south, wrapped(at + west)), (south + high, wrapped(at + west + wide)))
    inner = point(north, wrapped(at + east))
    assert covers(place, inner) == (0 <= north - south <= high and 0 <= east - west <= wide)
    assert contains(place, inner) == (0 < north - south < high and 0 < east - west < wide)


@settings(deadline=None)
@given(worlds())
def test_every_two_places_that_do_not_nest_are_named(world):
    places, _ = world
    expected = {
        (a, b)
        for a, one in places.items()
        for b, other in places.items()
        if a < b and (one is other or overlaps(one, other))
    }
    assert {(found.first, found.second) for found in check_places(places)} == expected


def test_altitude_counts_where_both_have_a_band():
    index = PlaceIndex({"low": Place(SEARCH, Band(0, 50)), "high": Place(SEARCH, Band(50, 500))})
    assert index.containers(SPILL, Band(10, 20)) == ("low",)
    assert index.containers(SPILL, Band(60, 70)) == ("high",)
    assert index.containers(SPILL) == ("high", "low")


@pytest.mark.parametrize(
    ("a", "b", "reason"),
    [
        (SEARCH, SEARCH, "are the same place"),
        (SEARCH, box((37.0, -8.6), (38.0, -8.5)), "partly overlap"),
        (Place(SEARCH, Band(0, 9)), Place(SEARCH, Band(0, 5)), "have one border and overlap in altitude"),
        (
            Place(SEARCH, Band(0, 9)),
            Place(SPILL, Band(5, 20)),
            "nest on the ground, but not in altitude",
        ),
    ],
)
def test_a_conflict_names_both_places_and_says_why(a, b, reason):
    (found,) = check_places({"x": a, "w": b})
    assert found == Conflict("w", "x", reason)
    assert str(found) == f"w and x {reason}"
    assert found.hint == "places must nest or be apart: change one of the two"


def test_a_place_that_touches_the_border_of_the_one_around_it_is_told_to_make_that_larger():
    (found,) = check_places({"cell": box((0, 0), (1, 1)), "area": box((0, 0), (2, 2))})
    assert found == Conflict("area", "cell", "share a border: neither is inside the other", "area")
    assert found.hint == "a place inside another touches no border: make area a little larger"


@pytest.mark.parametrize(
    ("a", "b"),
    [
        (OCEAN, SEARCH),
        (box((0, 0), (1, 1)), box((0, 1), (1, 2))),
        (Place(SEARCH, Band(0, 50)), Place(SEARCH, Band(50, 500))),
        (Place(OCEAN, Band(0, 50)), SEARCH),
        (SEARCH, point(37, -8.7)),
        (point(1, 1), point(1, 1)),
    ],
)
def test_places_that_nest_or_are_apart_are_no_conflict(a, b):
    assert check_places({"a": a, "b": b}) == ()
