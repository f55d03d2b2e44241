"""The search for dated runs: with local time it finds the run that one clock finds, and the run replays."""

from collections import Counter
from unittest.mock import patch

from checked_missions import load
from hypothesis import HealthCheck, assume, given
from hypothesis import strategies as st
from scale import examples
from timed_missions import timed_missions, timed_programs, within
from timed_reports import assert_alike

from checker import Engine, Limits, ZoneClock, check, explore
from checker.engines.zones import first_run
from checker.engines.zones.shortest_run import ShortestRun
from checker.traces import replay, to_json
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Ended, Not
from semantics.timing.dated_runs import DatedRun

WALK, ASK = ShortestRun.groups_at_end, first_run.leads_on


TWO = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) control(MOVE_HOST_TO south0)
}
BigActor b hosted_at uav1 with_behavior {
  control(MOVE_HOST_TO south0) control(MOVE_HOST_TO north0) control(MOVE_HOST_TO south0)
}
scheduler program_order
control timed
timing { UAV flies at 19 m/s to 20 m/s agents react within 5 s }
"""


def explored(c, clock):
    return explore(c, engine=Engine.FAST, clock=clock, limits=Limits(configurations=5_000))


class Impatience:
    """Asks local time after each zone; counts the answers, and the searches begun."""

    def __init__(self):
        self.answers, self.begun = Counter(), 0

    def __enter__(self):
        def walk(route, look, asked, _):
            self.begun += 1
            return WALK(route, look, asked, 1)

        def ask(*about):
            answer = ASK(*about)
            self.answers[answer] += 1
            return answer

        self.patches = (
            patch.object(ShortestRun, "groups_at_end", walk),
            patch.object(first_run, "leads_on", ask),
        )
        for each in self.patches:
            each.start()
        return self

    def __exit__(self, *_):
        for each in self.patches:
            each.stop()


def replayed(found, run):
    """Take the steps of a run at their dates by the clocks of the semantics."""
    dated = DatedRun(found.times.initial)
    for step, date in zip(found.times.transitions(run), run.dates, strict=True):
        dated.take(step.label, step.target, date)
    return dated


def assert_same_runs(c, step=1):
    """Compare the runs to configurations; return the answers of local time, and the number of runs."""
    one, other = (explored(c, clock) for clock in (ZoneClock.LOCAL, ZoneClock.GLOBAL))
    assert (one.times.search.is_local, other.times.search.is_local) == (True, False)
    places = range(0, one.size, step)
    with Impatience() as local:
        runs = [one.times.run_before(place, None) for place in places]
    assert local.begun == len(runs)  # one clock has never been needed for all of it
    for place, run in zip(places, runs, strict=True):
        assert run == one.times.run_before(place, None) == other.times.run_before(place, None)
        assert replayed(one, run).situation.c == one.configurations[place]
    return local.answers


def test_local_time_decides_which_steps_lead_to_a_configuration():
    answers = assert_same_runs(load(TWO).initial, 4)
    assert answers[True] > answers[False] > 0


def test_without_local_time_the_search_has_one_clock():
    """Where local time denies each step, the run is found all the same."""
    found = explored(load(TWO).initial, ZoneClock.LOCAL)
    right = found.times.run_before(found.size - 1, None)
    with Impatience() as local, patch.object(first_run, "leads_on", lambda *_: False):
        assert found.times.run_before(found.size - 1, None) == right
    assert local.begun > 1


@examples(240, 30, deadline=None, suppress_health_check=list(HealthCheck))
@given(timed_missions())
def test_a_generated_mission_has_the_same_runs_in_local_time(c):
    found = explore(c, engine=Engine.FAST, limits=Limits(configurations=400))
    assume(found.complete and found.times.search.is_local)
    assert_same_runs(c, max(found.size // 10, 1))


@examples(240, 30, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.one_of(timed_programs(), timed_missions()), st.integers(0, 5))
def test_a_generated_mission_has_the_same_dated_traces_in_local_time(c, ticks):
    found = explore(c, engine=Engine.FAST, limits=Limits(configurations=400))
    assume(found.complete and found.times.search.is_local)
    ended = Ended(c.alpha.names()[0])
    asked = (
        within(ticks, ended),
        Property(PropertyKind.ENDURANCE, "endurance"),
        Property(PropertyKind.INVARIANT, "invariant", Not(ended)),
        Property(PropertyKind.REACHABLE, "reachable", ended),
        Property(PropertyKind.TIME, "time", ended),
    )
    with Impatience():
        local = check(c, asked, engine=Engine.FAST)
    assert_alike(local, check(c, asked, engine=Engine.FAST, clock=ZoneClock.GLOBAL))
    for trace in (each.trace for verdict in local.verdicts for each in verdict.violations):
        assert replay(c, to_json(trace, "mission", "")).dates == trace.dates
