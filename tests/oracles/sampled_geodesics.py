"""The oracle of regions: samples on the ellipsoid by pyproj's geodesics. It shares no code with `physical`.

A position is a row of longitude and latitude in degrees. A ring is an array of positions whose edges are shortest
lines; a place is a ring whose edges are straight in latitude and longitude.
"""

import numpy as np
from pyproj import Geod

GEOD = Geod(ellps="WGS84")


def metres(a, b):
    """Return the distances between positions, row by row."""
    a, b = np.broadcast_arrays(np.atleast_2d(a), np.atleast_2d(b))
    return GEOD.inv(a[:, 0], a[:, 1], b[:, 0], b[:, 1])[2]


def between(a, b, share):
    """Return the positions at some shares of the shortest lines from one to another."""
    a, b = np.broadcast_arrays(np.atleast_2d(a), np.atleast_2d(b))
    azimuth, _, length = GEOD.inv(a[:, 0], a[:, 1], b[:, 0], b[:, 1])
    east, north, _ = GEOD.fwd(a[:, 0], a[:, 1], azimuth, length * np.broadcast_to(share, len(a)))
    return np.column_stack([east, north])


def off(positions, by, rng):
    """Return positions moved by up to some metres in any direction; half of them by all of it."""
    far = by * np.minimum(1.0, 2.0 * rng.random(len(positions)))
    azimuth = rng.uniform(0, 360, len(positions))
    return np.column_stack(GEOD.fwd(positions[:, 0], positions[:, 1], azimuth, far)[:2])


# --- places, straight in latitude and longitude -----------------------------------------------------


def unrolled(place):
    """Return a place with continuous longitudes."""
    ring = np.array(place, dtype=float)
    steps = (np.diff(ring[:, 0]) + 180.0) % 360.0 - 180.0
    ring[:, 0] = ring[0, 0] + np.concatenate([[0.0], np.cumsum(steps)])
    return ring


def is_in(place, positions):
    """Whether positions are in a place: an odd number of its edges is west of each."""
    ring = unrolled(place)
    middle = (ring[:, 0].min() + ring[:, 0].max()) / 2
    east = middle + (positions[:, 0] - middle + 180.0) % 360.0 - 180.0
    north = positions[:, 1]
    inside = np.zeros(len(positions), dtype=bool)
    for (x1, y1), (x2, y2) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        if y1 != y2:
            inside ^= ((y1 > north) != (y2 > north)) & (east > x1 + (north - y1) / (y2 - y1) * (x2 - x1))
    return inside


def points_in(place, count, rng):
    """Return random points of a place: its corners, its border, and its interior."""
    ring = unrolled(place)
    if len(ring) == 1:
        return np.repeat(ring, count, axis=0)
    at = rng.integers(0, len(ring), count)
    share = rng.random(count)[:, None] * rng.integers(0, 2, count)[:, None]
    border = ring[at] + share * (np.roll(ring, -1, axis=0)[at] - ring[at])
    low, high = ring.min(axis=0), ring.max(axis=0)
    within = rng.uniform(low, high, (count, 2))
    kept = is_in(place, within) & (rng.random(count) < 0.5)
    return np.where(kept[:, None], within, border)


# --- rings of shortest lines ------------------------------------------------------------------------


def apart(one, other):
    """Return the distances of all positions from all others."""
    one, other = np.atleast_2d(one), np.atleast_2d(other)
    pairs = np.repeat(one, len(other), axis=0), np.tile(other, (len(one), 1))
    return metres(*pairs).reshape(len(one), len(other))


def feet(positions, ring):
    """Return the least distance of each position from a ring: along each edge it has one minimum."""
    positions, start, end = np.atleast_2d(positions), np.array(ring), np.roll(ring, -1, axis=0)
    from_start, lengths = apart(positions, start), metres(start, end)
    which, edge = np.nonzero(from_start - lengths <= from_start.min(axis=1, keepdims=True))
    spot, start, end = positions[which], start[edge], end[edge]
    low, high = np.zeros(len(edge)), np.ones(len(edge))
    for _ in range(60):
        third = (high - low) / 3
        one, other = (metres(spot, between(start, end, at)) for at in (low + third, high - third))
        low, high = np.where(one < other, low, low + third), np.where(one < other, high - third, high)
    least = np.full(len(positions), np.inf)
    np.minimum.at(least, which, metres(spot, between(start, end, (low + high) / 2)))
    return least


def surrounded(positions, ring):
    """Whether a ring goes around each position: the azimuths of its corners turn once."""
    positions, ring = np.atleast_2d(positions), np.vstack([ring, ring[:1]])
    pairs = np.repeat(positions, len(ring), axis=0), np.tile(ring, (len(positions), 1))
    azimuths = GEOD.inv(*pairs[0].T, *pairs[1].T)[0].reshape(len(positions), len(ring))
    turns = (np.diff(azimuths, axis=1) + 180.0) % 360.0 - 180.0
    return np.abs(turns.sum(axis=1)) > 180.0


def away(positions, rings):
    """Return how far each position is from the area of rings: an outer one, then its holes; 0 inside."""
    outer, *holes = rings
    inside = surrounded(positions, outer) if len(outer) > 2 else np.zeros(len(np.atleast_2d(positions)), bool)
    for hole in holes:
        inside &= ~surrounded(positions, hole)
    return np.where(inside, 0.0, np.min([feet(positions, ring) for ring in rings], axis=0))


def on_ring(ring, along):
    """Return the positions at shares (0 to 1) of the length of a ring."""
    start, end = np.array(ring), np.roll(ring, -1, axis=0)
    ends = np.concatenate([[0.0], np.cumsum(metres(start, end))])
    at = (np.asarray(along) % 1.0) * ends[-1]
    edge = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(start) - 1)
    lengths = np.maximum(np.diff(ends)[edge], 1e-9)
    return between(start[edge], end[edge], np.clip((at - ends[edge]) / lengths, 0.0, 1.0))


def extreme(one, other, best=np.min, count=150):
    """Return the least (or greatest) distance between points of two rings: the best pair of samples, refined."""
    sign = 1.0 if best is np.min else -1.0
    spans, middles = (0.5, 0.5), (0.5, 0.5)
    for step in range(14):
        shares = [m + s * np.linspace(-1, 1, count) for m, s in zip(middles, spans, strict=True)]
        a, b = on_ring(one, shares[0]), on_ring(other, shares[1])
        distances = apart(a, b)
        i, j = np.unravel_index((sign * distances).argmin(), distances.shape)
        middles = (shares[0][i], shares[1][j])
        spans, count = tuple(10 * s / count for s in spans), 40 if step == 0 else count
    return float(distances[i, j])
