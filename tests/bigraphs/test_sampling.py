"""Many runs: the same as single ones, and estimates that cover what is known by hand."""

import random
from importlib import import_module
from itertools import product
from math import isinf

import numpy as np
import pytest

from bigraphs import sampling
from bigraphs.examples import example_names, example_text
from bigraphs.notation import read_system
from bigraphs.sampling import End, Sampler, first_times, mean, share, shares_until, student_quantile
from bigraphs.simulation import Bounds, chances, simulate
from bigraphs.system import SystemKind

GAMBLER = """\
ctrl Purse = 0; ctrl Bank = 0; atomic ctrl Coin = 0;
big table = Purse.(Coin | Coin) | Bank.(Coin | Coin);
big rich = Bank.1; big broke = Purse.1; big never = Purse | Purse;
react win = Purse.(Coin | id) | Bank.(Coin | id) -[ 1 ]-> Purse.(Coin | Coin | id) | Bank;
react lose = Purse.(Coin | id) | Bank.(Coin | id) -[ 1 ]-> Purse | Bank.(Coin | Coin | id);
begin pbrs init table; rules = [ {win, lose} ]; preds = { rich, broke, never }; end
"""
DECAY = """\
atomic ctrl A = 0; atomic ctrl B = 0;
big start = A | A; big one = B; big both = B | B;
react decay = A -[ 0.5 ]-> B;
begin sbrs init start; rules = [ {decay} ]; preds = { one, both }; end
"""


@pytest.fixture
def stats():
    """Load scipy's statistics where they judge: it takes a second."""
    return import_module("scipy.stats")


def runs(text, count, steps=100, until=None):
    system = read_system(text)
    sampler = Sampler(system, Bounds(steps, until))
    return system, [sampler.run(number) for number in range(count)]


@pytest.mark.parametrize("text", [GAMBLER, DECAY, *map(example_text, example_names())])
def test_a_sample_is_the_run_of_its_number(text):
    system = read_system(text)
    until = 1.5 if system.kind is SystemKind.SBRS else None
    sampler = Sampler(system, Bounds(30, until))
    for number in range(8):
        sample, run = sampler.run(number), list(simulate(system, 0, Bounds(30, until), run=number))
        assert sample.steps == len(run) - 1
        assert sample.time == (until if sample.end is End.TIME else run[-1].time)
        for place, predicate in enumerate(system.predicates):
            true = (stage.time for stage in run if predicate.label in stage.labels)
            assert sample.first[place] == next(true, None)


def test_what_is_forgotten_changes_no_run(monkeypatch):
    _, remembered = runs(GAMBLER, 50)
    monkeypatch.setattr(sampling, "MOST_REMEMBERED", 2)
    assert runs(GAMBLER, 50)[1] == remembered


def test_estimates_cover_what_is_known_by_hand():
    # A fair game of two coins each: rich with probability 1/2, after 4 steps on average.
    system, samples = runs(GAMBLER, 1000)
    rich, broke, never = first_times(system, samples)
    assert rich.share.low < 0.5 < rich.share.high
    assert rich.time.low < 4 < rich.time.high
    assert rich.runs + broke.runs == 1000
    assert (rich.least, never.runs, never.time) == (2, 0, None)
    assert samples[rich.first_run].first[0] == 2


def test_delays_are_those_of_the_rates():
    # Two halves-a-second decays: one of them after 1 on average, both after 1 + 2.
    system, samples = runs(DECAY, 1000)
    one, both = first_times(system, samples)
    assert one.time.low < 1 < one.time.high
    assert both.time.low < 3 < both.time.high
    assert {each.end for each in samples} == {End.STUCK}


def test_intervals_cover_in_95_of_100_experiments():
    system, samples = runs(GAMBLER, 200 * 60)
    covered = 0
    for first in range(0, len(samples), 60):
        rich = first_times(system, samples[first : first + 60])[0]
        covered += rich.share.low <= 0.5 <= rich.share.high
    assert 0.9 * 200 <= covered <= 0.99 * 200


def test_the_runs_of_a_seed_have_streams_of_their_own():
    """They are those of SeedSequence.spawn, so no run of a seed is one of another seed."""
    spawned = [chances(3, number).random() for number in range(4)]
    states = [sequence.generate_state(8).tobytes() for sequence in np.random.SeedSequence(3).spawn(4)]
    assert spawned == [random.Random(state).random() for state in states]
    streams = {chances(seed, number).random() for seed in range(50) for number in range(50)}
    assert len(streams) == 2_500


def test_bounds_end_runs():
    _, samples = runs(GAMBLER, 40, 1)
    assert {(each.end, each.steps) for each in samples} == {(End.STEPS, 1)}
    _, samples = runs(DECAY, 40, until=0.5)
    assert {each.end for each in samples} >= {End.TIME, End.STUCK}
    assert all(each.time == 0.5 for each in samples if each.end is End.TIME)


def test_curves_count_what_was_true_by_then():
    _, samples = runs(GAMBLER, 500)
    points = list(shares_until(samples, 0))
    assert points == sorted(points)
    for time, count in points:
        assert count == sum(each.first[0] is not None and each.first[0] <= time for each in samples)


def test_intervals_of_textbooks():
    # Wilson 1927, as Newcombe 1998 tabulates it: 81 of 263, and none of 20.
    assert (share(81, 263).low, share(81, 263).high) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert (share(0, 20).low, share(0, 20).high) == pytest.approx((0.0, 0.1611), abs=5e-5)
    assert isinf(mean([2.0]).high)
    assert mean([1.0, 3.0]).low == pytest.approx(2 - 12.7062)


def test_quantiles_are_those_of_scipy(stats):
    for freedom, confidence in product([*range(1, 30), 199, 200, 201, 10**6], (0.5, 0.9, 0.95, 0.999)):
        expected = stats.t.ppf((1 + confidence) / 2, freedom)
        assert student_quantile(confidence, freedom) == pytest.approx(expected, rel=1e-7)


def test_intervals_of_probabilities_are_those_of_scipy(stats):
    for runs, share_of in product((1, 2, 10, 999, 10**6), (0, 1e-6, 1 / 3, 1 - 1e-6, 1)):
        times = round(runs * share_of)
        expected = stats.binomtest(times, runs).proportion_ci(0.95, method="wilson")
        found = share(times, runs)
        assert (found.low, found.high) == pytest.approx((expected.low, expected.high), abs=1e-12)
