"""Bounds hold for what comes after exploring, too: nothing is said to hold that was not looked at to the end."""

from importlib import import_module

import pytest

import checker.engines.fast.explorer
import checker.limits
from checker import Engine, Keeping, Limits, Outcome, check, explore
from checker.engines.fast.search import crosscheck
from checker.limits import GRACE, BoundMet, bounded, look
from specs.elaboration import load_mission

CHECK = import_module("checker.check")  # its name is taken by the function
DAY = Limits(seconds=86_400.0)


class Clock:
    """A clock that stands until it is told to go."""

    def __init__(self, monkeypatch):
        self.now = 0.0
        monkeypatch.setattr(checker.limits, "monotonic", lambda: self.now)

    def jumps_before(self, monkeypatch, place, name):
        within = getattr(place, name)

        def late(*words, **named):
            self.now += 2 * 86_400.0
            return within(*words, **named)

        monkeypatch.setattr(place, name, late)


@pytest.fixture
def clock(monkeypatch):
    return Clock(monkeypatch)


def test_time_counts_from_when_it_began_with_what_was_spent_before(clock):
    with bounded(Limits(seconds=10.0, spent=4.0)):
        with bounded(Limits(seconds=1.0)):
            clock.now = 2.0
            with pytest.raises(BoundMet):
                look()
        clock.now = 6.0
        look()
        clock.now = 6.5
        with pytest.raises(BoundMet, match="the time limit of 10 s"):
            look()
    look()


def test_an_interruption_is_a_bound_a_little_later():
    limits = Limits()
    limits.interruption.wish()
    with bounded(limits):
        look()
        limits.interruption.wished -= GRACE
        with pytest.raises(BoundMet, match="an interruption"):
            look()


def test_what_is_doubted_is_bounded():
    mission = load_mission("surveillance")
    expander = explore(mission.initial, engine=Engine.FAST).survey.search.expander
    with bounded(Limits(seconds=-1.0)), pytest.raises(BoundMet):
        crosscheck.crosscheck(expander, [0])


def test_what_was_explored_and_not_looked_at_does_not_hold(clock, monkeypatch):
    mission = load_mission("oil_spill")
    whole = check(mission.initial, mission.properties, DAY, engine=Engine.FAST)
    clock.jumps_before(monkeypatch, checker.engines.fast.explorer, "inspect_fast")
    clock.now = checker.engines.fast.explorer.time.monotonic()
    report = check(mission.initial, mission.properties, DAY, engine=Engine.FAST)
    assert "the time limit of 86400 s, in the examination of the explored configurations" in map(
        str, report.bounds
    )
    assert (report.configurations, report.transitions) == (whole.configurations, whole.transitions)
    decided_by_text = {each.property for each in report.verdicts if "by ownership" in each.note}
    outcomes = {each.outcome for each in report.verdicts if each.property not in decided_by_text}
    assert outcomes == {Outcome.INCOMPLETE}
    assert report.exit_code == 3
    assert not report.coverage.complete


def wishing_before(monkeypatch, place, name, limits):
    """Let the user have asked for the end long ago when something begins."""
    within = getattr(place, name)

    def late(*words, **named):
        limits.interruption.wish()
        limits.interruption.wished -= GRACE
        return within(*words, **named)

    monkeypatch.setattr(place, name, late)


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
@pytest.mark.parametrize("bound", ["the time limit of 86400 s", "an interruption"])
def test_temporal_properties_are_not_decided_when_a_bound_was_met(clock, monkeypatch, engine, bound):
    mission = load_mission("surveillance")
    asked = [each for each in mission.properties if each.kind in ("ltl", "ctl", "progress")]
    assert asked
    limits = Limits(seconds=86_400.0)
    if bound == "an interruption":
        wishing_before(monkeypatch, CHECK._Check, "decide_temporal", limits)
    else:
        clock.jumps_before(monkeypatch, CHECK._Check, "decide_temporal")
    report = check(mission.initial, asked, limits, engine=engine)
    assert {each.outcome for each in report.verdicts} == {Outcome.INCOMPLETE}
    assert {each.note for each in report.verdicts} == {f"not decided: {bound} was met"}
    assert report.exit_code == 3


def test_an_interruption_in_looking_at_what_was_explored_ends_the_check(monkeypatch):
    mission, limits = load_mission("oil_spill"), Limits()
    wishing_before(monkeypatch, checker.engines.fast.explorer, "inspect_fast", limits)
    report = check(mission, limits=limits, engine=Engine.FAST)
    assert str(report.bounds[0]) == "an interruption, in the examination of the explored configurations"
    assert report.exit_code == 3


def test_after_an_interruption_one_checkpoint_is_written_at_most(monkeypatch, tmp_path):
    mission, limits = load_mission("oil_spill"), Limits()
    monkeypatch.setattr(checker.engines.fast.explorer, "CHUNK", 1)
    saved = []

    def save(search, *_):
        saved.append(search.expanded)
        limits.interruption.wish()

    monkeypatch.setattr(checker.engines.fast.explorer, "save", save)
    keeping = Keeping(str(tmp_path), every=0.0)
    found = explore(mission.initial, limits=limits, engine=Engine.FAST, keeping=keeping)
    assert list(map(str, found.bounds)) == ["an interruption"]
    assert saved == [1]


def test_the_time_that_the_first_explorer_took_is_not_given_twice(monkeypatch):
    mission = load_mission("takeover")
    monkeypatch.setattr(CHECK, "PATIENCE", 0.01)
    given = []
    explore_by = CHECK.explore_by

    def noted(initial, inspections, options):
        given.append((options.engine, options.limits.spent))
        return explore_by(initial, inspections, options)

    monkeypatch.setattr(CHECK, "explore_by", noted)
    check(mission.initial, (), Limits(seconds=60.0))
    assert [engine for engine, _ in given] == [Engine.REFERENCE, Engine.FAST]
    assert given[0][1] == 0.0 < given[1][1]


def test_deciding_may_take_longer_than_the_patience_with_the_first_explorer(clock, monkeypatch):
    mission = load_mission("surveillance")
    monkeypatch.setattr(CHECK, "PATIENCE", 3_600.0)
    clock.jumps_before(monkeypatch, CHECK._Check, "decide_temporal")
    report = check(mission)
    assert "not decided" not in " ".join(each.note for each in report.verdicts)
    assert Outcome.INCOMPLETE not in {each.outcome for each in report.verdicts}


def test_what_is_not_counted_puts_the_end_off():
    limits = Limits(seconds=2.0, spent=0.5)
    assert limits.end(1.4) is None
    assert limits.end(1.6) is not None
    limits.uncounted.seconds = 20.0
    assert limits.end(21.4) is None
    assert limits.end(21.6) is not None
    assert Limits(seconds=2.0).uncounted.seconds == 0
