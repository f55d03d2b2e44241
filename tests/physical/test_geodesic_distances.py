"""Nearest and farthest points of geodesic areas, held to samples of their borders."""

import numpy as np
import pytest
from drawing_regions import geometry, hull, rings
from oracles.random_places import WORLDS, place
from oracles.sampled_geodesics import GEOD, apart, away, between, extreme, feet, metres, on_ring, surrounded
from scale import seeds

from physical import RegionError, box, circle, point
from physical.geodesic_areas import area_of, source_area
from physical.geodesic_distances import feet_on, greatest_distance_of, lies_within, nearest_line
from physical.regions import RegionPart


def drawn(seed):
    """Return two random areas of one world: places or hulls of two, each with its rings."""
    rng = np.random.default_rng(seed)
    name = list(WORLDS)[seed % len(WORLDS)]
    found = []
    for _ in range(2):
        sources = [geometry(place(rng, *WORLDS[name])) for _ in range(rng.integers(1, 3))]
        found.append(area_of(hull(*sources) if len(sources) > 1 else RegionPart((sources[0],))))
    return found


@seeds(3_000, 18)
def test_the_nearest_points_are_as_near_as_any_two_and_lie_in_their_areas(seed):
    a, b = drawn(seed)
    line = nearest_line(a, b)
    assert metres(line.first, line.second)[0] == pytest.approx(line.metres, abs=1e-6)
    assert away(line.first, rings(a)) <= 0.06
    assert away(line.second, rings(b)) <= 0.06
    [one], [other] = rings(a), rings(b)
    meet = any(len(x) > 2 and surrounded(y, x).any() for x, y in ((one, other), (other, one)))
    sampled = 0.0 if meet else extreme(one, other)
    assert line.metres <= sampled + 0.06
    if line.metres > 0.0:
        assert line.metres >= sampled - 0.05 - 1e-5 * sampled


@seeds(600, 18)
def test_the_greatest_distance_is_that_of_the_farthest_points(seed):
    a, b = drawn(seed)
    [one], [other] = rings(a), rings(b)
    sampled = apart(one, other).max()
    found = greatest_distance_of(a, b)
    assert found == pytest.approx(sampled, abs=1e-3)
    assert extreme(one, other, best=np.max) <= found + 1e-3


@seeds(600, 18)
def test_feet_are_the_nearest_points(seed):
    a, b = drawn(seed)
    [one] = rings(a)
    found = feet_on(one, b)
    assert found.metres == pytest.approx(away(one, rings(b)), abs=2e-3)
    assert metres(one, found.feet) == pytest.approx(found.metres, abs=1e-6)
    assert away(found.feet, rings(b)).max() <= 0.01


@seeds(300, 9)
def test_an_area_lies_within_some_metres_of_another_as_its_farthest_point_does(seed):
    a, b = drawn(seed)
    rng = np.random.default_rng(seed)
    [one] = rings(a)
    corners = one[rng.integers(0, len(one), 400)]
    inner = np.array([_mixed(corners[rng.integers(0, 400, 3)], rng) for _ in range(20)])
    some = inner[away(inner, rings(a)) == 0.0] if len(one) > 2 else one
    sides = on_ring(one, rng.random(60))
    sampled = away(np.concatenate([one, some, sides]), rings(b)).max()
    assert not lies_within(a, b, sampled - 0.01)
    if _is_convex(b):
        border = away(on_ring(one, np.linspace(0, 1, 40)), rings(b)).max()
        assert lies_within(a, b, max(border, sampled) * 1.001 + 0.5)


def _mixed(three, rng):
    shares = rng.dirichlet([1, 1, 1])
    east = three[0, 0] + (three[:, 0] - three[0, 0] + 180.0) % 360.0 - 180.0
    return [float(shares @ east), float(shares @ three[:, 1])]


def _is_convex(area):
    """Whether the nearest point of an area is unique, so that the farthest point of another is on its border."""
    return area.shape.geom_type != "Polygon" or area.shape.equals(area.shape.convex_hull)


def test_the_dent_of_a_place_is_far_from_it():
    """The farthest point of an area in the dent of another is inside the area, not on its border."""
    corners = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
    horseshoe = geometry(np.array(corners) / 10)
    dent = source_area(box((0.1, 0.1), (0.4, 0.2)))
    ends = metres([0.1, 0.3], [0.15, 0.3])[0]
    assert not lies_within(dent, source_area(horseshoe), ends - 20)
    assert lies_within(dent, source_area(horseshoe), 12_500)


@pytest.mark.parametrize("size", [2_000.0, 20_000.0, 200_000.0])
def test_a_line_across_a_dent_is_as_far_from_the_place_as_its_middle(size):
    """Both ends are in the arms of a horseshoe; along its middle line, many points are equally far from both arms."""
    shape = np.array([(0, 0), (10, 0), (10, 10), (9, 10), (9, 1), (1, 1), (1, 10), (0, 10)])
    horseshoe = geometry(np.round(shape * size / 1_113_200 + [0.0, 0.001], 7))
    place = source_area(horseshoe)
    (west, south), (east, north) = (
        np.array(rings(place)[0]).min(axis=0),
        np.array(rings(place)[0]).max(axis=0),
    )
    level = south + 0.6 * (north - south)
    arms = [west + 0.05 * (east - west), west + 0.95 * (east - west)]
    line = area_of(hull(point(level, arms[0]), point(level, arms[1])))
    ends = [np.repeat([[arm, level]], 401, axis=0) for arm in arms]
    across = between(*ends, np.linspace(0, 1, 401))
    middle = away(across, rings(place)).max()
    wide = area_of(RegionPart((horseshoe,), spanned=True))
    assert not lies_within(line, place, middle - 0.01)
    assert not lies_within(wide, place, middle - 0.01)
    assert lies_within(line, place, middle + 0.5 + 1e-5 * size)
    assert lies_within(wide, place, 0.4 * size + 0.5 + 1e-3 * size)


def test_the_side_of_an_area_between_two_corners_is_farther_than_both():
    """A parallel of the shore: both ends of a line 50 km off are nearer than its middle, by the earth's curvature."""
    shore = area_of(hull(point(0.0, -1.0), point(0.0, 1.0)))
    north = 50_000 / 110_574
    west, east = [-0.45, north], [0.45, north]
    off = area_of(hull(point(north, -0.45), point(north, 0.45)))
    ends, middle = feet([west, between(west, east, 0.5)[0]], rings(shore)[0])
    assert middle > ends + 1.4
    assert not lies_within(off, shore, ends + 0.7)
    assert lies_within(off, shore, middle + 0.2)


@pytest.mark.parametrize("first", [True, False])
def test_a_frame_that_shows_the_wrong_points_nearest_does_not_decide(first):
    """Far from its centre, a frame shows 99.75 km longer than 100 km at its centre."""
    west, east = [-8.0, 45.0], [8.0, 45.0]
    spots = []
    for share, off in ((0.5, 100_000), (0.95, 99_750)):
        at = between(west, east, share)[0]
        ahead = GEOD.inv(*at, *east)[0]
        spots.append(GEOD.fwd(*at, ahead - 90, off)[:2])
    line, other = (
        area_of(hull(*(point(north, east) for east, north in each))) for each in ((west, east), spots)
    )
    found = nearest_line(line, other) if first else nearest_line(other, line)
    assert found.metres == pytest.approx(99_750, abs=0.1)
    assert metres(found.second if first else found.first, spots[1])[0] < 0.1


def test_areas_that_meet_are_no_metre_apart_and_the_point_is_in_both():
    one, other = source_area(box((37.0, -9.0), (37.2, -8.8))), source_area(circle((37.1, -8.8), 900))
    line = nearest_line(one, other)
    assert line.metres == 0.0
    assert line.first == line.second
    assert away(line.first, rings(one)) == away(line.first, rings(other)) == 0.0


def test_a_point_and_a_point_have_the_distance_of_pyproj_wherever_they_are():
    a, b = source_area(point(37.0, -8.0)), source_area(point(-37.0, 171.9))
    assert nearest_line(a, b).metres == metres([-8.0, 37.0], [171.9, -37.0])[0]


def test_a_comparison_that_reaches_too_far_is_refused():
    a, b = source_area(box((37, -9), (38, -8))), source_area(box((37, 20), (38, 21)))
    with pytest.raises(RegionError, match="a comparison of two regions reaches"):
        nearest_line(a, b)
