"""The reference explorer: exact, shortest first, and never more certain than what it saw."""

import itertools
import sys
from dataclasses import replace

import pytest
from checked_missions import enumerate_naively, load, moves, start
from hypothesis import assume, given
from scale import examples

from checker import Limits, check, explore
from checker.engines.choose import explore_by
from checker.verdicts import Outcome
from physical.wordings import counted
from semantics.hypothesis_strategies import initial_configurations
from semantics.races.monitor import monitored

TWO_MOVERS = moves("gate0", "a", "uav0") + moves("gate0", "b", "uav1")
SLOW = """
BigActor a hosted_at uav0 with_behavior {
  loop { observe(PARENT(HOST)) react { case obs => control(MOVE_HOST_TO gate0) control(MOVE_HOST_TO north0) } }
}
BigActor b hosted_at uav1 with_behavior { loop { observe(PARENT(HOST)) react { case obs => skip } } }
"""
ENDLESS = """
BigActor a hosted_at gcs0 with_behavior { loop { send(SELF, b) } }
BigActor b hosted_at gcs0 with_behavior { }
"""

EXAMPLES = {
    "two movers": TWO_MOVERS,
    "timed": TWO_MOVERS + "control timed",
    "in no line": TWO_MOVERS + "scheduler unordered\ncontrol timed",
    "in one line": TWO_MOVERS + "scheduler fcfs\ncontrol timed",
    "a loop": SLOW,
    "an environment": TWO_MOVERS
    + "environment { gate0 drifts among north0, south0 uav1 leaves mesh and returns }",
}


@pytest.mark.parametrize("text", EXAMPLES.values(), ids=EXAMPLES)
def test_it_equals_a_naive_enumeration_and_its_depths_are_shortest(text):
    c = start(text)
    equals_naive_enumeration(c)
    equals_naive_enumeration(monitored(c))


@examples(25)
@given(initial_configurations(monitored=None))
def test_it_equals_a_naive_enumeration_of_generated_missions(c):
    assume(explore(c, limits=Limits(configurations=150)).complete)
    equals_naive_enumeration(c)


def equals_naive_enumeration(c):
    found = explore(c)
    distances, transitions = enumerate_naively(c)
    assert found.complete
    assert len(found.configurations) == len(set(found.configurations))
    depths = [len(found.path(number)) - 1 for number in range(len(found.configurations))]
    assert dict(zip(found.configurations, depths, strict=True)) == distances
    assert found.depth == max(depths)
    assert found.transitions == len(transitions) == found.rules.total()


def test_each_configuration_is_inspected_once_in_the_order_of_discovery():
    numbers, sources = [], []

    def look(number, configuration, _):
        numbers.append(number)
        sources.append(configuration)

    found = explore(start(SLOW), (look,))
    assert numbers == list(range(len(found.configurations)))
    assert sources == found.configurations


# --- bounds ---------------------------------------------------------------------------------------------------


def test_a_limit_of_configurations_cuts_off_what_is_beyond_and_nothing_if_it_is_just_met():
    whole = explore(start(SLOW))
    most = len(whole.configurations)
    exact = explore(start(SLOW), limits=Limits(configurations=most))
    assert exact.complete
    assert exact.transitions == whole.transitions
    for few in (most - 1, 1):
        found = explore(start(SLOW), limits=Limits(configurations=few))
        assert (found.configurations, *map(str, found.bounds)) == (
            whole.configurations[:few],
            f"the limit of {counted(few, 'configuration')}",
        )


ASKS_ON = "BigActor a hosted_at uav0 with_behavior { loop { observe(PARENT(HOST)) } }"


@pytest.mark.parametrize(
    ("text", "limits", "bound"),
    [
        (SLOW, Limits(seconds=0.0), "the time limit of 0 s"),
        (ASKS_ON, Limits(pending=3), "more than 3 requests or messages of one agent pending"),
        (ENDLESS, Limits(pending=2), "more than 2 requests or messages of one agent pending"),
    ],
)
def test_what_a_bound_cuts_off_is_incomplete(text, limits, bound):
    found = explore(start(text), limits=limits)
    assert list(map(str, found.bounds)) == [bound]
    pending = max(len(c.eta.of("a")) for c in found.configurations)
    waiting = max(len(c.alpha.mailbox(each)) for c in found.configurations for each in c.alpha.names())
    assert max(pending, waiting) == (0 if limits.pending > 3 else limits.pending + 1)


CUT = """
BigActor a hosted_at gcs0 with_behavior { loop { send(SELF, b) } }
BigActor b hosted_at uav0 with_behavior {
  loop { observe(PARENT(HOST)) react { case obs => control(MOVE_HOST_TO gate0) } }
}
BigActor c hosted_at uav1 with_behavior {
  observe(ALL) react { case obs if uav0 in obs => control(MOVE_HOST_TO gate0) }
}
check { local_consistency race_freedom deadlock_freedom arrival invariant "always": true reachable "never": false }
"""


@pytest.mark.parametrize("limits", [Limits(configurations=5), Limits(seconds=0.0), Limits(pending=1)])
def test_what_was_cut_off_never_reads_as_holding(limits):
    mission = load(CUT)
    report = check(mission, limits=limits)
    assert not report.complete
    assert {verdict.outcome for verdict in report.verdicts} == {Outcome.INCOMPLETE}
    assert report.exit_code == 3


def test_a_limit_that_only_the_search_for_stale_observations_meets_is_said_to_be_its():
    text = """
    BigActor a hosted_at uav0 with_behavior {
      observe(CHILDREN(gate0))
      react { case obs if not (uav1 in obs) => control(MOVE_HOST_TO gate0) case obs => skip }
    }
    BigActor b hosted_at uav1 with_behavior {
      loop {
        control(MOVE_HOST_TO gate0)
        control(MOVE_HOST_TO south0)
        observe(PARENT(HOST))
        react { case obs => skip }
      }
    }
    check { local_consistency race_freedom }
    """
    mission = load(text)
    plain = len(explore(mission.initial).configurations)
    report = check(mission.initial, mission.properties, Limits(configurations=plain))
    assert [*map(str, report.bounds)] == [
        f"the limit of {counted(plain, 'configuration')}, in the search for stale observations"
    ]
    assert report.verdicts[0].outcome is Outcome.HOLDS
    assert report.exit_code in (1, 3)


# --- interruption and progress --------------------------------------------------------------------------------


def interrupting(after, interruption):
    calls = []

    def interrupt(*_):
        calls.append(1)
        if len(calls) > after:
            interruption.wish()

    return interrupt


@pytest.mark.parametrize("after", [0, 7])
def test_an_interruption_in_an_inspection_ends_incomplete(after):
    limits = Limits()
    found = explore(start(SLOW), (interrupting(after, limits.interruption),), limits)
    assert list(map(str, found.bounds)) == ["an interruption"]
    assert found.expanded == after + 1
    assert found.transitions == sum(found.rules.values())


def test_an_interruption_while_progress_is_reported_ends_incomplete():
    limits = Limits()
    found = explore(start(SLOW), (), limits, interrupting(3, limits.interruption), every=0.0)
    assert list(map(str, found.bounds)) == ["an interruption"]
    assert len(found.configurations) > 3


def test_an_interrupted_check_ends_at_once_and_decides_nothing(monkeypatch):
    explored = []
    mission = load(SLOW + TWO_MOVERS.replace("BigActor a", "BigActor c").replace("BigActor b", "BigActor d"))

    def once(initial, inspect, options):
        explored.append(initial)
        return explore_by(initial, inspect, replace(options, every=0.0))

    monkeypatch.setattr(sys.modules["checker.check"], "explore_by", once)
    asked = Limits()
    report = check(mission.initial, mission.properties, asked, interrupting(5, asked.interruption))
    assert len(explored) == 1
    assert tuple(map(str, report.bounds)) == ("an interruption",)
    assert {verdict.outcome for verdict in report.verdicts} == {Outcome.INCOMPLETE}


def test_progress_is_reported_as_it_grows():
    seen = []
    found = explore(start(SLOW), report=seen.append, every=0.0)
    assert len(seen) == len(found.configurations)
    for earlier, later in itertools.pairwise(seen):
        assert earlier.configurations <= later.configurations
        assert earlier.transitions < later.transitions
        assert earlier.depth <= later.depth
    assert seen[0].frontier == 1
    assert seen[-1].configurations == len(found.configurations)
    assert seen[-1].depth == found.depth
    explore(start(TWO_MOVERS), report=seen.clear, every=60.0)  # it is done at once
    assert seen


def test_the_monitors_memory_is_not_counted():
    text = SLOW.replace("case obs => control", "case obs if uav1 in obs or uav0 in obs => control")
    mission = load(text + moves("gate0", "c", "uav1"))
    report = check(mission)
    found = explore(mission.initial)
    assert (report.configurations, report.transitions) == (len(found.configurations), found.transitions)
