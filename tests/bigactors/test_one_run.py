"""One run of a mission with times: it keeps to them, and to what a check says of when."""

import random

import pytest
from shipped import TIMED

from bigactors.commands.simulate.one_run import OneRun
from checker import replay, to_json
from semantics.properties.propositions import holds
from specs.elaboration import load_mission


def run_by_chance(mission, seed, steps=40):
    run = OneRun(mission.initial)
    chance = random.Random(seed)
    while len(run.taken) < steps and run.take_by_chance(chance):
        pass
    return run


@pytest.mark.parametrize("name", TIMED)
def test_a_run_by_chance_replays_at_its_dates(name):
    mission = load_mission(name)
    for seed in range(5):
        trace = run_by_chance(mission, seed).trace
        assert len(trace.dates) == len(trace.steps) > 3
        assert list(trace.dates) == sorted(trace.dates)
        assert replay(mission.initial, to_json(trace, name, "")) == trace


def test_no_run_is_earlier_or_later_than_a_check_says():
    mission = load_mission("race_in_time")  # in the west at 0:35 at the earliest, at 14:25 at the latest
    (west,) = (each.formula for each in mission.properties if each.name == "in the west")
    first = set()
    for seed in range(60):
        trace = run_by_chance(mission, seed).trace
        after = next(at for at, c in enumerate(trace.configurations[1:]) if holds(west, c))
        first.add(5 * trace.dates[after])
    assert 35 <= min(first) < 200
    assert 600 < max(first) <= 865


def test_what_waits_comes_at_its_time():
    mission = load_mission("race_in_time")  # `after 20 s`, and five seconds to react
    for seed in range(20):
        trace = run_by_chance(mission, seed).trace
        (waited,) = (
            5 * date
            for step, date in zip(trace.steps, trace.dates, strict=True)
            if step.label.rule == "timeout"
        )
        assert 20 <= waited <= 25


def test_a_run_without_times_has_no_dates_and_is_taken_back_step_by_step():
    run = run_by_chance(load_mission("oil_spill"), 1, steps=6)
    assert (len(run.taken), run.dates) == (6, [])
    for _ in range(6):
        run.undo()
    assert (run.at, run.taken, run.shown) == (run.initial, [], [])


def test_a_run_with_times_is_taken_back_too():
    run = OneRun(load_mission("race_in_time").initial)
    first = run.choices()
    run.take(first[0])
    run.undo()
    assert run.choices() == first
    assert run.dates == []
