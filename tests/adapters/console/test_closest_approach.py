"""Closest points of approach, beside brute force along the ellipsoid and a textbook's example."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from live_missions import WEST, boat, seen

from adapters.console.closest_approach import closest
from physical.frame import geod
from physical.physical_property import Velocity

METRES = st.floats(-5_000, 5_000)
SPEEDS = st.floats(-30, 30)


@given(st.tuples(METRES, METRES), st.tuples(SPEEDS, SPEEDS))
def test_no_other_moment_is_closer(offset, velocity):
    p, v = np.array(offset), np.array(velocity)
    (seconds,), (metres,) = closest(p[None], v[None])
    times = np.concatenate([np.linspace(0, 3_600, 20_001), [seconds]])
    far = np.linalg.norm(p + times[:, None] * v, axis=1)
    assert metres <= far.min() + 1e-6
    assert metres == pytest.approx(np.linalg.norm(p + seconds * v), abs=1e-6)


def test_a_crossing_ship_passes_as_the_plotting_sheet_says():
    """Own ship 000° at 15 kn; the other 5 nm to the east, 270° at 15 kn: CPA 3.54 nm after 10 min, on 045°."""
    mile, knot = 1852.0, 1852.0 / 3600
    offset = np.array([[0.0, 5 * mile]])
    (seconds,), (metres,) = closest(offset, np.array([[-15 * knot, -15 * knot]]))
    assert (seconds / 60, metres / mile) == pytest.approx((10.0, 5 / math.sqrt(2)))


def test_a_console_tells_of_a_ship_that_comes_close_and_of_none_that_goes_away(tape):
    """The ship starts 3 km to the east and 500 m to the north, westward at 5 m/s, as the ellipsoid has it."""
    start = geod().fwd(WEST[1], WEST[0], 90.0, 3_000.0)[:2]
    east, north = geod().fwd(*start, 0.0, 500.0)[:2]
    comes = boat((north, east), 1000.0, "comes")
    tape.turn(
        0,
        seen("uav0", WEST, 1000.0, velocity=Velocity(0.0, 0.0)),
        *(moving(comes, "comes", 270.0), moving(comes, "goes", 90.0)),
    )
    tape.turn(1, seen("uav0", WEST, 1001.0, velocity=Velocity(0.0, 0.0)))
    (found,) = tape.shown()["approaches"].values()
    assert (found["vehicle"], found["target"]) == ("uav0", "comes")
    way, side = 5.0 * (found["at"] - 1000.0), found["distance"]
    assert (way, side) == pytest.approx((3_000.0, 500.0), abs=10.0)
    least = min(
        geod().inv(WEST[1], WEST[0], *geod().fwd(east, north, 270.0, 5.0 * t)[:2])[2] for t in range(1_200)
    )
    assert side == pytest.approx(least, abs=2.0)


def moving(heard, name, course):
    at = heard.published.geometry.vertices[0]
    return seen(name, at, 1000.0, "ais", "Vessel", (), velocity=Velocity(5.0, course))
