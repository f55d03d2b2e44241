"""What is exported for TChecker, judged by TChecker: `make time-oracle`, where TCHECKER names its `tck-reach`."""

import os

import pytest
from hypothesis import HealthCheck, assume, given
from scale import examples
from shipped import TIMED
from timed_models import (
    ENDURANCE,
    agree,
    asked_of_tchecker,
    found_by_tchecker,
    questions,
    reached_by_tchecker,
    timed_verdicts,
)

from checker import Engine, check, explore
from checker.engines.zones.automaton_export import model_of
from checker.engines.zones.explorer import why_global
from checker.engines.zones.tchecker import tchecker_text
from semantics.state.setting import Scheduler
from specs.elaboration import load_mission

pytestmark = pytest.mark.skipif("TCHECKER" not in os.environ, reason="TCHECKER names no program `tck-reach`")


def under_program_order(name):
    mission = load_mission(name)
    return mission.under(Scheduler.PROGRAM_ORDER, mission.setting.control)


@pytest.mark.parametrize("algorithm", ["covreach", "concur19"])
@pytest.mark.parametrize("name", TIMED)
def test_it_comes_to_the_same_verdicts_of_a_shipped_mission(tmp_path, name, algorithm):
    mission = load_mission(name)
    agree(mission.initial, mission.properties, lambda model: judged(model, tmp_path, algorithm))


@examples(200, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_it_comes_to_the_same_verdicts_of_generated_missions(tmp_path_factory, question):
    c, asked = question
    folder = tmp_path_factory.mktemp("tchecker")
    agree(c, (asked, ENDURANCE), lambda model: judged(model, folder, "covreach"))


def judged(model, folder, algorithm):
    return found_by_tchecker(tchecker_text(model), folder, algorithm)


# --- a process for each one of local time


def assert_same(c, asked, folder):
    """Look whether TChecker reaches as many tuples of local states as locations, and comes to the same verdicts."""
    times = explore(c, engine=Engine.FAST).times
    verdicts = timed_verdicts(check(c, asked).verdicts)
    whole, *texts = (
        tchecker_text(model_of(times, each, "a mission", divided=True))
        for each in (None, *(verdict.property for verdict in verdicts))
    )
    for algorithm in ("reach", "concur19"):
        assert len(reached_by_tchecker(whole, folder, algorithm)) == len(times.reached)
        for text, verdict in zip(texts, verdicts, strict=True):
            assert found_by_tchecker(text, folder, algorithm) is verdict.outcome


@pytest.mark.parametrize(
    "name", [name for name in TIMED if not why_global(under_program_order(name).initial)]
)
def test_the_processes_of_a_shipped_mission_reach_the_same(tmp_path, name):
    mission = under_program_order(name)
    assert_same(mission.initial, mission.properties, tmp_path)


@examples(200, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_the_processes_of_a_generated_mission_reach_the_same(tmp_path_factory, question):
    c, asked = question
    assume(not why_global(c))
    assert_same(c, (asked, ENDURANCE), tmp_path_factory.mktemp("tchecker"))


# --- what its algorithm of local time misreads

URGENT = """
system:urgent
event:early
event:late
event:on
process:p
clock:1:x
location:p:begun{initial: : invariant: x<=5}
location:p:urgent{urgent:}
location:p:wrong{labels: wrong}
edge:p:begun:urgent:early{provided: x==0}
edge:p:begun:urgent:late{provided: x==5}
edge:p:urgent:wrong:on{provided: x==5}
"""

SET = """
system:set
event:set
event:on
process:p
clock:1:x
location:p:begun{initial:}
location:p:set{invariant: x<=0}
location:p:wrong{labels: wrong}
edge:p:begun:set:set{do: x=5}
edge:p:set:wrong:on{}
"""


@pytest.mark.parametrize(("text", "is_reachable"), [(URGENT, True), (SET, False)])
def test_local_time_misreads_urgent_locations_and_clocks_that_are_set_to_a_value(
    tmp_path, text, is_reachable
):
    """So neither is written."""
    for algorithm, right in (("reach", True), ("covreach", True), ("concur19", False)):
        said = asked_of_tchecker(text, tmp_path, "-a", algorithm, "-l", "wrong")
        assert ("REACHABLE true" in said) is (is_reachable is right)
