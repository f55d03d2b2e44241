"""Random flights, flown by the oracle: every sample is in the region, and in the relations that regions promise."""

import os
import time
from dataclasses import dataclass
from functools import wraps
from itertools import count
from pathlib import Path

import numpy as np
from drawing_regions import geometry, rings
from oracles.flown_samples import at_rest, renewed, somewhere, under_way
from oracles.random_places import WORLDS, place
from oracles.sampled_geodesics import apart, away, extreme, is_in, surrounded
from scale import IS_WHOLE, seeds, soak

from physical import (
    EntityMotion,
    FlightPlan,
    Geometry,
    Located,
    Region,
    RegionError,
    Transit,
    Ways,
    at_least,
    nearest,
    nearest_placement,
    possible_point,
    possibly_in,
    surely_in,
    waypoint,
    within,
)
from physical.geodesic_areas import area_of
from physical.place_nesting import Place

COUNT = 100 if IS_WHOLE else 30
TOLERANCES = {"country": 0.5, "continent": 5.0}
MINUTES = float(os.environ.get("BIGACTORS_FLIGHTS_MINUTES", "30"))
CURSOR = Path(__file__).parents[2] / ".hypothesis" / "flights"
"""The number of the next flight: a soak goes on where the last one ended."""


@dataclass
class Flown:
    """An entity of a random mission: its region, and samples of what it may do."""

    located: Located
    samples: np.ndarray


def flown(rng, world, count=COUNT):
    """Draw a vehicle among random places, at rest, or on its way by some of them, and fly it."""
    size = WORLDS[world][2]
    kinds = ("box", "star", "needle")
    places = [place(rng, *WORLDS[world], kinds=kinds) for _ in range(5)]
    names = [f"p{i}" for i in range(5)]
    moves, absent = rng.random(5) < 0.15, rng.random(5) < 0.1
    drawn = [[at, places[(i + 1) % 5]] if moves[i] else [at] for i, at in enumerate(places)]
    motions = [
        EntityMotion(name, tuple(Place(geometry(at)) for at in several), may_be_absent=bool(gone))
        for name, several, gone in zip(names, drawn, absent, strict=True)
    ]
    strays = [None, size / 1000 * rng.random()][rng.integers(0, 2)]
    home = place(rng, *WORLDS[world], kinds=("point",))
    craft = EntityMotion(
        "uav",
        (Place(geometry(home)),),
        targets=frozenset(names),
        via=frozenset(names),
        containers=frozenset(names[:1]),  # so that no place is a hole of another
        strays=strays,
    )
    ways = Ways([*motions, craft])
    way = [int(i) for i in rng.permutation(5)[: rng.integers(1, 4)]]
    steady = not any(moves[i] or absent[i] for i in way)
    first = int(rng.integers(0, 5))
    rests = nearest_placement(geometry(home), geometry(places[first]))
    settled = rng.random() < 0.5 and not moves[first] and not absent[first] and rests is not None
    by = strays or 0.0
    if settled:
        craft = EntityMotion(**{**_fields(craft), "containers": frozenset({names[first]})})
        ways = Ways([*motions, craft])
        begins = np.repeat(_position(rests)[None], count, axis=0)
        if strays is None:
            begins = at_rest(places[first], begins, 0.0, count, rng)
        if rng.random() < 0.4:
            region = ways.region("uav", Place(rests))
            spots = at_rest(places[first], _position(rests), 0.0, count, rng) if strays is None else begins
            return Flown(
                Located("uav", region), under_way(spots, [[spots[:1]]], by, rng) if by else spots
            ), places
        origin = rests
    else:
        begins, origin = np.repeat(home, count, axis=0), geometry(home)
    plan = FlightPlan(names[way[-1]], tuple(names[i] for i in way[:-1]))
    region = ways.region("uav", Transit(Place(origin), plan.to), frozenset({plan}))
    stops = [drawn[i] for i in way]
    if strays is not None and steady:
        stops = [[_position(waypoint(geometry(places[i])))[None]] for i in way]
        stops[-1] = [_position(nearest_placement(geometry(home), geometry(places[way[-1]])))[None]]
    flying = under_way if steady else renewed
    return Flown(Located("uav", region), flying(begins, stops, by, rng)), places


def _fields(motion):
    return {name: getattr(motion, name) for name in EntityMotion.__dataclass_fields__}


def _position(at: Geometry):
    (north, east) = at.vertices[0]
    return np.array([east, north])


def outside(samples, region: Region):
    """Return how far the farthest sample is from the region."""
    return np.min([away(samples, rings(area_of(part))) - part.margin for part in region.parts], axis=0).max()


def unless_refused(test):
    """Decorate a test: only the largest world has regions that are too far from each other, which are refused."""

    @wraps(test)
    def refused(seed):
        try:
            test(seed)
        except RegionError:
            assert list(WORLDS)[seed % len(WORLDS)] == "continent"

    return refused


@seeds(1_000, 12)
@unless_refused
def test_every_sample_of_a_flight_is_in_the_region(seed):
    rng = np.random.default_rng(seed)
    world = list(WORLDS)[seed % len(WORLDS)]
    found, _ = flown(rng, world)
    assert outside(found.samples, found.located.region) <= TOLERANCES.get(world, 0.06)


@seeds(1_000, 12)
@unless_refused
def test_what_relations_promise_of_a_place_holds_for_every_sample(seed):
    rng = np.random.default_rng(seed)
    world = list(WORLDS)[seed % len(WORLDS)]
    found, places = flown(rng, world)
    for at in (*places, place(rng, *WORLDS[world], kinds=("box", "star"))):
        there = Located(
            "p", Ways([EntityMotion("p", (Place(geometry(at)),))]).region("p", Place(geometry(at)))
        )
        inside = is_in(at, found.samples)
        assert possibly_in(found.located, there) >= inside.any()
        assert surely_in(found.located, there) <= inside.all()
        spot = possible_point(found.located, there)
        if spot is not None:
            assert outside([_position(spot)], found.located.region) <= 0.1
        line = nearest(found.located, there)
        distances = away(found.samples, rings(area_of(there.region.parts[0])))
        assert line.metres <= distances.min() + 0.05
        assert at_least(found.located, there, line.metres)
        assert not at_least(found.located, there, line.metres + 0.5 + 10 * TOLERANCES.get(world, 0.0))
        assert not within(found.located, there, distances.max() - 0.05)


@seeds(1_000, 12)
@unless_refused
def test_the_nearest_points_of_two_flights_are_no_farther_than_any_samples(seed):
    rng = np.random.default_rng(seed)
    world = list(WORLDS)[seed % len(WORLDS)]
    one, other = flown(rng, world)[0], flown(rng, world)[0]
    other = Flown(Located("other", other.located.region), other.samples)
    line = nearest(one.located, other.located)
    distances = apart(one.samples, other.samples)
    assert line.metres <= distances.min() + 0.05
    assert at_least(one.located, other.located, line.metres)
    assert not within(one.located, other.located, distances.max() - 0.05)
    bound = _most(one.located.region, other.located.region) + 0.5 + 2 * TOLERANCES.get(world, 0.0)
    assert within(one.located, other.located, bound)
    for spot, located in ((line.first, one), (line.second, other)):
        assert outside([_position(spot)], located.located.region) <= 0.1
    true = _least(one.located.region, other.located.region)
    assert line.metres >= true - TOLERANCES.get(world, 0.1) - 1e-5 * true


def _least(one, other):
    return min(max(0.0, _apart(a, b) - a.margin - b.margin) for a in one.parts for b in other.parts)


def _apart(a, b):
    one, other = rings(area_of(a))[0], rings(area_of(b))[0]
    meet = any(surrounded(x, y).any() for x, y in ((one, other), (other, one)) if len(y) > 2)
    return 0.0 if meet else extreme(one, other)


def _most(one, other):
    return max(
        extreme(rings(area_of(a))[0], rings(area_of(b))[0], best=np.max) + a.margin + b.margin
        for a in one.parts
        for b in other.parts
    )


@soak
def test_flights_without_end():
    """Fly on from the last soak's end, for some minutes."""
    first, until = int(CURSOR.read_text()) if CURSOR.exists() else 1_000, time.monotonic() + 60 * MINUTES
    CURSOR.parent.mkdir(exist_ok=True)
    for seed in count(first):
        CURSOR.write_text(str(seed))  # a failure is met again
        if time.monotonic() > until:
            break
        test_every_sample_of_a_flight_is_in_the_region(seed)
        test_what_relations_promise_of_a_place_holds_for_every_sample(seed)
        test_the_nearest_points_of_two_flights_are_no_farther_than_any_samples(seed)


def test_the_oracle_flies_away_from_a_wrong_region():
    """The judge is worth something: a region without its last leg is found out."""
    rng = np.random.default_rng(8)
    caught = 0
    for seed in range(20):
        found, _ = flown(np.random.default_rng(seed), "lagos")
        parts = found.located.region.parts
        if len(parts) > 1:
            caught += outside(found.samples, Region(parts[:-1])) > 1.0
    assert caught >= 2
    assert somewhere([place(rng, *WORLDS["lagos"])], 3, rng).shape == (3, 2)
