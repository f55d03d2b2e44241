"""Gnomonic frames: straightness, lengths, sharing, refusals."""

import numpy as np
import pytest
from oracles.sampled_geodesics import GEOD, between, metres

from physical import RegionError
from physical.gnomonic import FARTHEST_REACH, FINE, Disc, around, check_reach, frame_of, slack, stretch

LATITUDES = (0.0, 20.0, 37.0, -45.0, 60.0, 70.0, -85.0)


def ends(latitude, reach, count=2_000):
    """Return pairs of positions at most `reach` metres from a centre, and positions on the lines between them."""
    rng = np.random.default_rng(int(latitude) + 90)
    found = []
    for _ in range(2):
        far = reach * np.sqrt(np.maximum(rng.random(count), rng.integers(0, 2, count)))
        at = np.full(count, 0.0), np.full(count, latitude)
        found.append(np.column_stack(GEOD.fwd(*at, rng.uniform(0, 360, count), far)[:2]))
    return *found, between(*found, rng.random(count))


def leaving(frame, a, b, middle):
    """Return how far the images of positions are from the chords of others, in metres of the frame."""
    a, b, middle = (frame.plane(each) for each in (a, b, middle))
    along, beside = b - a, middle - a
    return np.abs(along[:, 0] * beside[:, 1] - along[:, 1] * beside[:, 0]) / np.hypot(*along.T)


@pytest.mark.parametrize(("reach", "bound"), [(50_000.0, 1e-4), (FINE, 0.11), (FARTHEST_REACH, 1.7)])
def test_a_shortest_line_leaves_its_chord_by_what_the_module_says(reach, bound):
    worst = max(
        leaving(frame_of(Disc(lat, 0.0, 0.0)), *ends(lat, reach)).max() for lat in (0.0, 37.5, -45.0, 60.0)
    )
    assert bound / 20 < worst < bound


@pytest.mark.parametrize("reach", [1_000.0, 100_000.0, FINE, FARTHEST_REACH])
def test_the_slack_covers_a_frame_whose_centre_is_beside_the_middle(reach):
    for latitude in LATITUDES:
        frame = frame_of(Disc(latitude, 0.0, reach))
        assert leaving(frame, *ends(latitude, reach)).max() + 0.04 <= slack(reach)
    assert slack(FINE) < 0.5
    assert slack(FARTHEST_REACH) < 5.0


@pytest.mark.parametrize("reach", [1_000.0, 100_000.0, FINE, FARTHEST_REACH])
def test_a_length_in_a_frame_is_longer_than_on_the_earth_by_the_stretch_at_most(reach):
    for latitude in LATITUDES:
        frame = frame_of(Disc(latitude, 0.0, 0.0))
        a, b, _ = ends(latitude, reach)
        beside = metres([[0.0, latitude]], [[frame.longitude, frame.latitude]])[0]
        factors = np.hypot(*(frame.plane(b) - frame.plane(a)).T) / metres(a, b)
        assert factors.min() > 1 - 1e-9
        assert factors.max() < stretch(reach + beside) + 1e-9


def test_neighbours_share_a_frame_and_a_frame_is_near_its_middle():
    assert frame_of(Disc(37.01, -8.61, 500.0)) is frame_of(Disc(37.02, -8.60, 900.0))
    for reach in (0.0, 20_000.0, 300_000.0, FARTHEST_REACH):
        frame = frame_of(Disc(37.19, 179.99, reach))
        beside = metres([[frame.longitude, frame.latitude]], [[179.99, 37.19]])[0]
        assert beside < 12_000.0 + 0.08 * reach


def test_positions_come_back_from_a_frame():
    a, _, _ = ends(-45.0, FARTHEST_REACH)
    frame = frame_of(Disc(-45.0, 0.0, FARTHEST_REACH))
    assert metres(frame.positions(frame.plane(a)), a).max() < 1e-6


def test_the_bounds_of_discs_hold_for_their_points():
    rng = np.random.default_rng(2)
    for _ in range(200):
        one, other = (
            Disc(rng.uniform(-85, 85), rng.uniform(-180, 180), 10 ** rng.uniform(0, 5.5)) for _ in range(2)
        )
        azimuths = rng.uniform(0, 360, 2)
        a, b = (
            np.array(GEOD.fwd(disc.longitude, disc.latitude, azimuth, disc.radius)[:2])
            for disc, azimuth in zip((one, other), azimuths, strict=True)
        )
        apart = metres(a, b)[0]
        assert one.least(other) <= apart <= one.most(other)
        both = around(one, other)
        assert metres(a, [both.longitude, both.latitude])[0] <= both.radius + 1e-3
    inner, outer = Disc(37.0, -8.0, 10.0), Disc(37.0, -8.0, 500.0)
    assert around(inner, outer) is outer
    assert around(outer, inner) is outer


def test_what_reaches_over_a_thousand_kilometres_is_refused():
    check_reach(Disc(37.0, -8.0, FARTHEST_REACH), "a region")
    with pytest.raises(RegionError, match=r"a region reaches 1,200 km from its middle, over 1,000 km"):
        check_reach(Disc(37.0, -8.0, 1.2 * FARTHEST_REACH), "a region")
