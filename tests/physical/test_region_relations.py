"""The four relations over regions, and the nearest points of two, one test for each sentence about them."""

import math

import pytest

from physical import (
    Band,
    DriftWithin,
    EntityMotion,
    FlightPlan,
    Located,
    Region,
    RegionError,
    RegionKind,
    RegionPart,
    Transit,
    Ways,
    at_least,
    box,
    centroid,
    circle,
    distance,
    drift_faces,
    nearest,
    point,
    polygon,
    possible_point,
    possibly_in,
    surely_in,
    within,
)
from physical.frame import geod
from physical.place_nesting import Place
from physical.region_clearances import outermost

WEST, BESIDE = box((37.0, -9.0), (37.05, -8.95)), box((37.0, -8.95), (37.05, -8.9))
NORTH = box((37.05, -9.0), (37.1, -8.95))
INNER = box((37.01, -8.99), (37.02, -8.98))


def certain(geometry, altitude=None, name="p"):
    part = RegionPart((geometry,), altitude=altitude)
    return Located(name, Region((part,), certain=True, is_area=not geometry.is_point))


def resting(place, margin=0.0, altitude=None, name="u"):
    return Located(
        name, Region((RegionPart((place,), margin=margin, altitude=altitude, kind=RegionKind.REST),))
    )


def flying(*sources, margin=0.0, altitude=None, name="u"):
    part = RegionPart(tuple(sorted(sources)), True, margin, altitude, RegionKind.LEG)
    return Located(name, Region((part,)))


def carried(name, *carriers, by=None):
    return Located(name, (by or certain(WEST)).region, carriers)


ABSENT = Located("gone", Region())


# --- possibly and surely ----------------------------------------------------------------------------


def test_places_and_certain_things_compare_exactly():
    on_the_border = point(37.05, -8.97)
    assert not possibly_in(certain(on_the_border), certain(WEST, name="w"))
    assert possibly_in(certain(point(37.0499999, -8.97)), certain(WEST, name="w"))
    assert not surely_in(certain(on_the_border), certain(WEST, name="w"))
    assert surely_in(certain(point(37.0499999, -8.97)), certain(WEST, name="w"))
    for other in (BESIDE, NORTH):
        assert not possibly_in(resting(WEST), certain(other))
    assert possibly_in(resting(WEST), certain(INNER))
    assert possibly_in(resting(INNER), certain(WEST))
    assert not surely_in(resting(WEST), certain(INNER))
    assert surely_in(resting(INNER), certain(WEST))


def test_what_came_to_rest_in_a_place_is_surely_in_it_and_an_equal_certain_area_is_not():
    assert surely_in(resting(WEST), certain(WEST))
    assert not surely_in(certain(WEST, name="u"), certain(WEST))
    assert possibly_in(certain(WEST, name="u"), certain(WEST))


def test_a_line_need_only_cross_a_place():
    across = flying(point(37.02, -9.1), point(37.02, -8.92))
    assert possibly_in(across, certain(WEST))
    assert not surely_in(across, certain(WEST))
    assert not possibly_in(across, certain(NORTH))
    spot = possible_point(across, certain(WEST))
    assert spot.vertices[0][0] == pytest.approx(37.02, abs=1e-4)
    assert -9.0 <= spot.vertices[0][1] <= -8.95
    assert possible_point(across, certain(NORTH)) is None


def test_in_doubt_possibly_is_true_and_surely_false():
    """The doubt is less than half a metre: 1e-6 degree is 0.11 m."""
    for off, near in ((2e-7, True), (6e-6, False)):
        beside = flying(point(37.05 + off, -8.99), point(37.05 + off, -8.98))
        assert possibly_in(beside, certain(WEST)) is near
        inside = flying(point(37.0 + off, -8.99), point(37.0 + off, -8.98))
        assert surely_in(inside, certain(WEST)) is not near


def test_a_way_along_the_northern_border_of_a_box_leaves_it():
    low, high = point(37.0499, -9.0 + 1e-5), point(37.0499, -8.95 - 1e-5)
    assert surely_in(flying(low, high), certain(WEST))  # 11 m from the border
    wide = box((36.0, -9.0), (37.05, -8.0))
    edge = flying(point(37.0499, -8.999), point(37.0499, -8.001))
    assert not surely_in(edge, certain(wide))
    assert possibly_in(edge, certain(box((37.05, -9.0), (37.1, -8.0))))


def test_what_may_stray_is_in_a_place_only_if_it_may_stray_no_farther():
    middle = centroid(WEST)
    to_border = distance(middle, point(37.025, -8.95))
    assert surely_in(flying(middle, margin=to_border - 1), certain(WEST))
    assert not surely_in(flying(middle, margin=to_border + 1), certain(WEST))
    assert not possibly_in(flying(middle, margin=to_border - 1), certain(BESIDE))
    assert possibly_in(flying(middle, margin=to_border + 1), certain(BESIDE))
    assert not surely_in(resting(WEST, margin=10.0), certain(WEST))
    spot = possible_point(flying(middle, margin=to_border + 100), certain(BESIDE))
    assert distance(spot, middle) <= to_border + 100.1
    assert distance(spot, BESIDE) <= 0.1


def between_corners(circle_centre, metres):
    """Return a point at a distance from a centre, half-way between two corners of a circle around it."""
    north, east = circle_centre
    to_east, to_north, _ = geod().fwd(east, north, 360 / 64 / 2, metres)
    return point(to_north, to_east)


@pytest.mark.parametrize("radius", [300.0, 1_000.0, 20_000.0])
def test_a_circle_is_as_large_as_its_radius_between_the_corners_of_its_polygon(radius):
    centre = (37.1, -8.6)
    drawn, far = circle(centre, radius), point(37.6, -8.5)
    lacking = radius * (1 - math.cos(math.pi / 64))
    just_inside = flying(between_corners(centre, radius - lacking / 4), far)
    assert distance(between_corners(centre, radius - lacking / 4), drawn) > 0.0
    assert possibly_in(just_inside, certain(drawn))
    assert not at_least(just_inside, certain(drawn), 0.1)
    outside = flying(between_corners(centre, radius + 1.0), far)
    assert not possibly_in(outside, certain(drawn))
    assert not surely_in(resting(drawn), certain(polygon(drawn.vertices[::2])))


def test_altitudes_meet_at_their_ends():
    place = certain(WEST, Band(0, 50))
    for band, possibly, surely in (
        (Band(50, 60), True, False),
        (Band(50.1, 60), False, False),
        (Band(0, 50), True, True),
        (None, True, False),
    ):
        assert possibly_in(resting(INNER, altitude=band), place) is possibly
        assert surely_in(resting(INNER, altitude=band), place) is surely
        assert surely_in(resting(INNER, altitude=band), certain(WEST))


def test_what_carries_an_entity_has_it_and_what_is_absent_has_nothing():
    drifter = carried("drifter", "uav", "ship")
    for name in ("uav", "ship"):
        assert possibly_in(drifter, certain(point(0, 0), name=name))
        assert surely_in(drifter, certain(point(0, 0), name=name))
        assert possible_point(drifter, certain(point(0, 0), name=name)) is None
    assert possibly_in(carried("u", "ship", by=resting(INNER)), certain(WEST))
    assert not possibly_in(ABSENT, certain(WEST))
    assert not surely_in(ABSENT, certain(WEST))
    assert not possibly_in(resting(INNER), ABSENT)
    assert not surely_in(resting(INNER), ABSENT)


def test_a_place_that_is_not_certain_counts_whole_and_is_never_sure():
    spill = Located("spill", Region(flying(INNER, WEST).region.parts, is_area=True))
    assert possibly_in(certain(centroid(WEST), name="u"), spill)
    assert not surely_in(certain(centroid(INNER), name="u"), spill)
    vehicle = flying(point(37.02, -9.1), point(37.02, -8.9), name="uav1")
    assert not possibly_in(flying(point(37.0, -9.0), point(37.1, -9.0)), vehicle)  # it has no area


def test_no_entity_is_in_itself():
    assert not possibly_in(certain(WEST), certain(WEST))
    assert not surely_in(certain(WEST), certain(WEST))


def test_a_face_is_in_the_places_of_its_relations_and_in_no_neighbour():
    drift = DriftWithin(point(37.04, -8.99), WEST, {"west": WEST, "inner": INNER})
    ways = Ways([EntityMotion("spill", (Place(drift.mover),), drift=drift)])
    for face in drift_faces(drift.mover, drift.within, drift.places):
        spill = Located("spill", ways.region("spill", Place(face.representative)))
        assert surely_in(spill, certain(WEST))
        assert (
            possibly_in(spill, certain(INNER)) is surely_in(spill, certain(INNER)) is ("inner" in face.inside)
        )
        assert not surely_in(spill, certain(box((37.0, -9.0), (37.015, -8.95))))


# --- at least ---------------------------------------------------------------------------------------


def test_at_least_compares_the_nearest_points():
    one, other = flying(point(37.0, -9.0), point(37.0, -8.9)), certain(point(37.01, -8.95), name="v")
    line = nearest(one, other)
    assert line.metres == pytest.approx(1106, abs=5)
    assert line.second is point(37.01, -8.95)
    assert at_least(one, other, line.metres)
    assert not at_least(one, other, line.metres + 0.5)
    assert at_least(other, one, line.metres)
    assert nearest(other, one).metres == line.metres


def test_certain_points_compare_by_their_distance():
    one, other = certain(point(37.0, -9.0), name="u"), certain(point(37.001, -9.0), name="v")
    apart = distance(point(37.0, -9.0), point(37.001, -9.0))
    assert at_least(one, other, apart)
    assert not at_least(one, other, apart + 1e-6)
    assert within(one, other, apart)
    assert not within(one, other, apart - 1e-6)
    far = certain(point(-37.0, 171.0), name="v")
    assert at_least(one, far, 1_000_000)
    assert nearest(one, far).metres > 19_000_000


def test_margins_are_taken_off_and_the_points_lie_on_them():
    one, other = flying(point(37.0, -9.0), margin=100.0), flying(point(37.01, -9.0), margin=200.0, name="v")
    apart = distance(point(37.0, -9.0), point(37.01, -9.0))
    line = nearest(one, other)
    assert line.metres == pytest.approx(apart - 300.0, abs=0.1)
    assert distance(line.first, point(37.0, -9.0)) == pytest.approx(100.0, abs=0.02)
    assert distance(line.second, point(37.01, -9.0)) == pytest.approx(200.0, abs=0.02)
    overlapping = nearest(flying(point(37.0, -9.0), margin=1000.0), other)
    assert overlapping.metres == 0.0
    assert overlapping.first == overlapping.second
    assert distance(overlapping.first, point(37.0, -9.0)) < 1000.0
    assert distance(overlapping.first, point(37.01, -9.0)) < 200.0


def test_bands_that_are_far_apart_are_enough():
    low, high = resting(WEST, altitude=Band(0, 20)), resting(WEST, altitude=Band(50, 60), name="v")
    assert at_least(low, high, 30)
    assert not at_least(low, high, 31)
    assert at_least(low, high, 500, up=30)
    assert not at_least(low, high, 500, up=30.5)
    assert not at_least(low, resting(WEST, name="v"), 1)
    line = nearest(low, high)
    assert (line.metres, line.gap) == (0.0, 30.0)
    assert nearest(low, high, up=30) is None
    assert not at_least(low, resting(WEST, altitude=Band(20, 30), name="v"), 1)  # they touch


def test_the_absent_are_apart_and_what_shares_a_carrier_is_not():
    assert at_least(ABSENT, resting(WEST), 50)
    assert at_least(resting(WEST), ABSENT, 50)
    assert nearest(ABSENT, resting(WEST)) is None
    one, other = carried("a", "ship"), carried("b", "uav", "ship")
    assert not at_least(one, other, 1)
    assert not at_least(one, certain(WEST, name="ship"), 1)
    assert nearest(one, other) is None
    assert within(one, other, 0)
    assert at_least(carried("a", "ship", by=certain(INNER)), carried("b", "boat", by=certain(NORTH)), 50)


def test_the_nearest_of_several_parts_counts():
    legs = tuple(
        part
        for stop in (point(37.3, -9.0), point(37.2, -9.0), point(37.4, -9.0))
        for part in flying(stop, point(37.3, -8.5)).region.parts
    )
    several = Located("u", Region(legs))
    line = nearest(several, certain(WEST))
    assert line.parts[0] is legs[1]
    assert line.metres == min(nearest(Located("u", Region((leg,))), certain(WEST)).metres for leg in legs)


# --- within -----------------------------------------------------------------------------------------


def test_within_of_a_certain_place_counts_from_its_nearest_point():
    base = certain(WEST)
    east = point(37.02, -8.9)
    reach = distance(east, WEST)
    assert within(certain(east, name="u"), base, reach + 0.1)
    assert not within(certain(east, name="u"), base, reach - 0.1)
    assert within(resting(INNER), base, 0.5)
    assert within(flying(INNER, east), base, reach + 1)
    assert not within(flying(INNER, east), base, reach - 1)
    assert not within(flying(east, margin=100.0), base, reach + 99)
    assert within(flying(east, margin=100.0), base, reach + 101)


def test_within_of_what_is_not_certain_counts_from_its_farthest_point():
    one, other = flying(point(37.0, -9.0), margin=10.0), resting(WEST, margin=20.0, name="v")
    farthest = distance(point(37.0, -9.0), point(37.05, -8.95)) + 30.0
    assert within(one, other, farthest + 0.5)
    assert not within(one, other, farthest - 0.5)


def test_the_absent_are_within_nothing():
    assert not within(ABSENT, resting(WEST), 1e6)
    assert not within(resting(WEST), ABSENT, 1e6)


def test_in_the_dent_of_a_certain_place_the_nearest_shore_counts():
    bay = polygon([(0, 0), (0, 0.3), (0.3, 0.3), (0.3, 0.2), (0.1, 0.2), (0.1, 0.1), (0.3, 0.1), (0.3, 0)])
    inside = resting(box((0.15, 0.12), (0.25, 0.18)))
    half = distance(point(0.2, 0.1), point(0.2, 0.15))
    assert within(inside, certain(bay), half + 2)
    assert not within(inside, certain(bay), half - 2)


# --- far away ---------------------------------------------------------------------------------------


def test_regions_far_from_each_other_are_compared_by_their_bounds_or_refused():
    here, there = resting(WEST), resting(box((37.0, 30.0), (37.1, 30.1)), name="v")
    assert at_least(here, there, 50_000)
    assert not within(here, there, 50_000)
    assert not possibly_in(here, certain(box((37.0, 30.0), (37.1, 30.1))))
    assert within(here, there, 5_000_000)
    with pytest.raises(RegionError, match="a comparison of two regions reaches 1,7"):
        at_least(here, there, 3_429_000)


def test_a_flight_over_the_date_line_is_compared_across_it():
    ways = Ways(
        [
            EntityMotion("uav", (Place(point(10.0, 179.9)),), targets=frozenset({"isle"})),
            EntityMotion("isle", (Place(circle((10.0, -179.9), 1000)),)),
        ]
    )
    region = ways.region("uav", Transit(Place(point(10.0, 179.9)), "isle"), frozenset({FlightPlan("isle")}))
    uav = Located("uav", region)
    assert possibly_in(uav, certain(circle((10.0, 180.0), 500)))
    assert nearest(uav, certain(point(10.1, -180.0))).metres == pytest.approx(11_061 - 513, abs=10)


def test_what_lies_in_a_certain_place_is_no_distance_from_it_whatever_its_margin():
    inside = flying(INNER, margin=300.0)
    assert surely_in(inside, certain(WEST))
    assert within(inside, certain(WEST), 0.0)
    assert not within(flying(INNER, margin=3_000.0), certain(WEST), 100.0)


# --- beyond a place ---------------------------------------------------------------------------------


def test_a_region_reaches_beyond_a_place_by_its_farthest_corner_or_by_its_margin():
    east, depth = point(37.02, -8.9), 500.0
    found = outermost(flying(INNER, east, margin=100.0), certain(WEST))
    assert found.metres == pytest.approx(distance(east, point(37.02, -8.95)) + 100, abs=1)
    assert distance(found.point, east) < 0.1
    spot = geod().fwd(-8.95, 37.02, -90, depth)
    inside = point(spot[1], spot[0])
    assert outermost(flying(inside, point(37.02, -8.97), margin=depth + 20), certain(WEST)).metres == (
        pytest.approx(20, abs=0.1)
    )
    assert outermost(flying(inside, point(37.02, -8.97), margin=depth - 20), certain(WEST)) is None
    assert outermost(ABSENT, certain(WEST)) is None
    assert outermost(flying(east), resting(WEST)) is None
