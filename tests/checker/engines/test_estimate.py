"""Estimates of how much there is in all, on layers that explorations of shipped missions have recorded."""

from collections import Counter
from functools import cache

import pytest

from checker import Engine, explore
from checker.engines.contract import Progress
from checker.engines.estimate import MOST, SizeEstimate, estimate
from specs.elaboration import load_mission

LARGE = ("rendezvous",)
"""Missions of which the layers rise and fall once, or on the whole: where an estimate is given it is right."""

WAVES = ("takeover", "broken_deadlock", "spill_watch", "convoy")
"""Those that rise and fall again and again: there an estimate may be too low."""


@cache
def layers_of(name):
    """Return the sizes of the layers, by the lengths of shortest paths."""
    found = explore(load_mission(name).initial, engine=Engine.FAST)
    depths = [0]
    for origin in found.origins[1:]:
        depths.append(depths[origin] + 1)
    return list(Counter(depths).values())


def estimates(layers):
    """Return what is told after each layer, with how many were met."""
    told = ((sum(layers[:end]), estimate(layers[:end])) for end in range(1, len(layers) + 1))
    return [(met, each) for met, each in told if each is not None]


@pytest.mark.parametrize("name", LARGE)
def test_what_is_told_of_large_missions_is_right_from_the_first_time(name):
    layers = layers_of(name)
    told = estimates(layers)
    assert told[0][0] < 0.8 * sum(layers)
    assert all(each.least <= sum(layers) <= each.most for _, each in told)


@pytest.mark.parametrize("name", [*LARGE, *WAVES])
def test_at_least_is_never_more_than_there_is_and_nothing_is_told_while_layers_grow(name):
    layers = layers_of(name)
    assert estimates(layers)
    assert all(met == each.least <= sum(layers) for met, each in estimates(layers))
    grown = [end for end in range(1, len(layers) + 1) if layers[:end][-1] == max(layers[:end])]
    assert grown
    assert all(estimate(layers[:end]) is None for end in grown)
    told = [estimate(layers[:end]) is not None for end in range(1, len(layers) + 1)]
    assert (False in told[told.index(True) :]) is (name in WAVES)  # a second wave takes it back


@pytest.mark.parametrize(
    "layers", [[1], [1] * 40, [7, 6, 5], [2**k for k in range(40)], [40 - k for k in range(5)]]
)
def test_there_is_no_estimate_without_a_rise_and_a_fall(layers):
    assert estimate(layers) is None


def test_a_range_that_says_nothing_is_not_told():
    slow = [100, 200, 1_000_000, 999_999, 999_998, 999_997]
    assert estimate(slow) is None
    assert MOST * sum(slow) < 999_997**2


def test_seconds_left_follow_from_rate_and_frontier():
    progress = Progress(1_000, 3_000, 9, 100, 50.0, SizeEstimate(1_000, 1_400))
    assert progress.left == (2.0, 10.0)
    assert Progress(1_000, 3_000, 9, 100, 50.0).left is None
    assert Progress(1_000, 3_000, 9, 100, 0.0, SizeEstimate(1_000, 1_400)).left is None


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_both_explorers_tell_of_the_same_layers(engine, monkeypatch):
    told = []
    if engine is Engine.FAST:
        monkeypatch.setattr("checker.engines.fast.explorer.CHUNK", 16)
    initial = load_mission("takeover").initial
    explore(initial, report=told.append, every=0.0, engine=engine)
    layers = layers_of("takeover")
    by_depth = {each.depth: each.estimate for each in told}
    assert len(by_depth) > 20
    assert by_depth == {depth: estimate(layers[: depth + 1]) for depth in by_depth}
