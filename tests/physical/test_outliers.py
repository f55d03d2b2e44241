"""What lies far from everything else: who, how far, and whether its latitude and longitude are swapped."""

import pytest

from physical import box, circle, distance, point
from physical.outliers import all_swapped, is_swapped, lonely_points, outliers

BAY = {
    "bay0": box((37.1, -8.6), (37.0, -8.7)),
    "uav0": point(37.05, -8.65),
    "gcs0": point(37.15, -8.58),
}
SWAPPED = circle((-8.584, 37.149), 900)


def test_what_is_a_thousand_kilometres_off_is_an_outlier_with_its_distance():
    found = outliers({**BAY, "airfield0": SWAPPED})
    assert found == {"airfield0": min(distance(SWAPPED, each) for each in BAY.values())}
    assert found["airfield0"] == pytest.approx(6_935_000, rel=0.01)
    assert is_swapped(SWAPPED, BAY.values(), found["airfield0"])


def test_what_belongs_together_is_no_outlier_though_it_reaches_far():
    chain = {number: point(37.0, -8.0 + 4 * number) for number in range(40)}
    assert outliers(chain) == {}
    assert outliers({**BAY, "ocean0": box((60.0, 0.0), (-60.0, -60.0)), "uav1": point(0.0, -30.0)}) == {}
    assert outliers({}) == {}


def test_both_sides_of_the_antimeridian_are_near():
    assert outliers({"east": point(-17.0, 179.9), "west": point(-17.0, -179.9)}) == {}


def test_of_two_halves_the_first_is_where_the_world_is():
    assert list(outliers({"here": point(37.0, -8.0), "there": point(-8.0, 37.0)})) == ["there"]


def test_what_is_nowhere_near_either_way_is_not_swapped():
    assert not is_swapped(point(60.0, 120.0), BAY.values(), 9_000_000.0)
    assert not is_swapped(point(37.0, -8.6), {"x": point(37.0, -8.6)}.values(), 0.0)


def test_of_thousands_of_vessels_the_one_far_away_is_found():
    vessels = {number: point(50.0 + number / 1e4, 4.0) for number in range(20_000)}
    assert list(outliers({**vessels, "far": point(4.0, 50.0)})) == ["far"]


def test_boats_that_are_all_on_land_were_probably_swapped():
    bay = [point(37.05, -8.6), point(37.0, -8.7)]
    exchanged = [point(-8.6, 37.05), point(-8.7, 37.0)]
    assert all_swapped(bay, bay) == ""
    assert all_swapped(exchanged, exchanged) == "stands on land"
    assert all_swapped(exchanged, []) == ""  # a UAV over Tanzania may be meant


@pytest.mark.parametrize(
    "port",
    [
        (53.54, 9.93), (51.50, 0.05), (51.90, 4.40), (30.50, 32.30), (29.97, 32.55),  # Hamburg, London, Rotterdam, Suez
        (51.23, 4.40), (53.10, 8.75), (48.85, 2.35), (49.48, 8.45), (48.20, 16.40),  # Antwerp, Bremen, Paris, Mannheim
        (30.05, 31.23), (22.35, 88.20), (30.53, 47.80), (41.90, -87.60), (-34.60, -58.40), (-3.10, -60.00),
        (59.33, 18.07), (9.10, -79.70), (52.84, 5.71), (52.50, 13.40), (47.50, 19.05), (-27.47, 153.05 - 180),
    ],
)  # fmt: skip
def test_boats_in_the_harbours_of_rivers_and_canals_were_not_swapped(port):
    assert all_swapped([point(*port)], [point(*port)]) == ""


@pytest.mark.parametrize("bay", [(37.05, -8.60), (36.90, -7.90), (43.35, -8.40), (54.40, 10.20)])
def test_boats_of_a_bay_whose_exchange_is_far_inland_were_probably_swapped(bay):
    assert all_swapped([point(*bay)], [point(*bay)]) == ""
    exchanged = [point(*bay[::-1])]
    assert all_swapped(exchanged, exchanged) != ""


def test_a_world_far_out_at_sea_that_exchanged_is_on_a_coast_was_probably_swapped():
    assert all_swapped([point(10.0, 54.0), point(10.2, 54.1)], []) == "is more than 100 km from any coast"
    assert all_swapped([point(54.0, 10.0)], []) == ""
    assert all_swapped([point(0.0, -30.0)], []) == ""  # exchanged it is as far out
    assert all_swapped([point(10.0, 54.0), point(30.0, 54.0)], []) == ""  # too wide for one place
    assert all_swapped([], []) == ""


def test_a_point_a_degree_off_is_lonely_and_what_lies_within_or_near_something_is_not():
    typed = point(38.05, -8.65)
    found = lonely_points({**BAY, "uav1": typed})
    assert found == {"uav1": min(distance(typed, each) for each in BAY.values())}
    assert found["uav1"] == pytest.approx(100_000, rel=0.02)
    assert lonely_points({**BAY, "far0": circle((38.05, -8.65), 900)}) == {}  # a far place may be meant
    assert lonely_points({**BAY, "far0": circle((38.05, -8.65), 900), "uav1": typed}) == {}
    assert lonely_points({"here": point(37.0, -8.0), "there": point(38.0, -8.0)}) == {}
    sea = box((39.0, -7.0), (36.0, -10.0))
    assert lonely_points({"sea0": sea, "uav0": point(37.5, -8.5)}) == {}
    assert lonely_points({"sea0": sea, "uav0": point(39.6, -8.5)}) == {}  # the sea reaches as far


def test_both_sides_of_the_antimeridian_are_near_for_points_too():
    here = {"east0": circle((-17.0, 179.95), 900), "uav0": point(-17.0, -179.95)}
    assert lonely_points(here) == {}


def test_the_points_of_a_large_world_are_not_compared():
    ships = {number: point(37.0 + number / 1e5, -8.0) for number in range(1_001)}
    assert lonely_points({**ships, "x": point(39.0, -8.0)}) == {}
