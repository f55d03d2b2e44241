"""What a vehicle may do, by samples, from ways.md alone: it shares no code with `physical`.

A stop is a list of places (`sampled_geodesics`), one of which the vehicle finds there; it may find another one at the
next renewal. `points` are the positions to which `run` sends it, where these are known and kept to.
"""

import numpy as np
from oracles.sampled_geodesics import between, off, points_in


def somewhere(places, count, rng):
    """Return random points of some places."""
    drawn = np.array([points_in(place, count, rng) for place in places])
    return drawn[rng.integers(0, len(places), count), np.arange(count)]


def at_rest(place, waypoint, strays, count, rng):
    """Return positions after an arrival: seen in the place, it flies on to its waypoint."""
    return off(between(points_in(place, count, rng), waypoint, rng.random(count)), strays, rng)


def under_way(begins, stops, strays, rng):
    """Return positions on the way from some positions through one place of each stop, straight between them."""
    count = len(begins)
    path = [begins, *(somewhere(stop, count, rng) for stop in stops)]
    return off(_on(path, rng.random(count), rng), strays, rng)


def renewed(begins, stops, strays, rng, times=3):
    """Return positions after some renewals: each time it flies to all stops again, from anywhere on its way."""
    at = begins
    for _ in range(times):
        path = [at, *(somewhere(stop, len(begins), rng) for stop in stops)]
        at = _on(path, rng.random(len(begins)), rng)
    return off(at, strays, rng)


def _on(path, shares, rng):
    """Return a position on each path, on any leg."""
    leg = rng.integers(0, len(path) - 1, len(shares))
    ends = np.array(path)
    rows = np.arange(len(shares))
    return between(ends[leg, rows], ends[leg + 1, rows], shares)
