"""Where a vehicle that circles can stay."""

import pytest

from physical import (
    Surroundings,
    box,
    circle,
    contains,
    distance,
    leads_straight,
    overlaps,
    point,
    polygon,
    standing,
    surroundings_of,
    waypoint,
    widest,
)

BAY = circle((37.0, -8.6), 1000)
HERE = point(37.0, -8.6)
UAV = point(0, 0)


def ring(at, radius):
    return circle(at.vertices[0], radius)


def test_a_vehicle_stands_at_the_centroid_where_its_circle_fits_there():
    assert standing(UAV, BAY, surroundings_of(HERE, [BAY]), 104.0) == waypoint(BAY)


def test_a_vehicle_stands_where_its_circle_stays_in_the_place_and_out_of_smaller_ones():
    slick = circle((37.001, -8.601), 130)
    at = standing(UAV, BAY, surroundings_of(HERE, [BAY, slick]), 104.0)
    assert contains(BAY, ring(at, 104.0))
    assert not overlaps(slick, ring(at, 104.0))
    assert distance(at, waypoint(slick)) == pytest.approx(234.0, abs=2.0)


def test_a_vehicle_that_is_in_a_smaller_place_stays_in_it():
    slick = circle((37.004, -8.6), 500)
    around = surroundings_of(HERE, [BAY, slick])
    assert around.inside == tuple(sorted((BAY, slick)))
    assert contains(slick, ring(standing(UAV, BAY, around, 104.0), 104.0))


def test_where_no_circle_fits_there_is_nowhere_to_stand_and_the_widest_is_told():
    slick = circle((37.0, -8.6), 850)
    around = Surroundings((BAY,), (slick,))
    assert standing(UAV, BAY, around, 104.0) is None
    assert widest(UAV, BAY, around) == pytest.approx(75.0, abs=1.0)
    assert standing(UAV, BAY, around, 74.0) is not None


def test_a_place_of_any_shape_has_its_widest_circle():
    assert widest(UAV, box((37.0, -8.6), (37.0018, -8.58)), Surroundings()) == pytest.approx(100.0, rel=0.01)


DENTED = polygon([(37.0, -8.62), (37.0, -8.58), (37.02, -8.58), (37.005, -8.6), (37.02, -8.62)])


def test_the_way_over_a_dent_does_not_lead_straight():
    around = Surroundings((DENTED,), ())
    assert not leads_straight(UAV, point(37.018, -8.581), point(37.018, -8.619), around)
    assert leads_straight(UAV, point(37.003, -8.581), point(37.003, -8.619), around)
    assert leads_straight(UAV, point(37.003, -8.6), point(37.003, -8.6), around)


def test_the_way_over_a_smaller_place_does_not_lead_straight():
    slick = circle((37.0, -8.605), 100)
    around = Surroundings((BAY,), (slick,))
    assert not leads_straight(UAV, point(37.0, -8.609), HERE, around)
    assert leads_straight(UAV, point(37.003, -8.6), HERE, around)


def test_a_mover_with_an_extent_keeps_its_whole_circle_in_the_place():
    raft = circle((36.0, -9.0), 50)
    strip = box((37.0, -8.6), (37.0018, -8.58))
    assert widest(raft, strip, Surroundings((strip,), ())) == pytest.approx(50.0, rel=0.05)
