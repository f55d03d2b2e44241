"""The automata of processes beside the automaton that they divide, location by location and edge by edge."""

import pytest
from hypothesis import HealthCheck, assume, given
from scale import examples, some_long
from shipped import TIMED
from timed_models import ENDURANCE, questions

from checker import Engine, explore
from checker.engines.zones.automaton_export import division_of, question_of
from checker.engines.zones.explorer import why_global
from semantics.properties.kinds import PropertyKind
from semantics.state.setting import Scheduler
from specs.elaboration import load_mission


def assert_divided(c, asked):
    """Look whether processes have the clocks, deadlines and steps of the reached locations, and share none of them."""
    times = explore(c, engine=Engine.FAST).times
    question = question_of(times, asked)
    division = division_of(times, question)
    whole, states, reached = division.automaton, division.states, set(times.reached.tolist())
    found = division.divided(question.first, question.ages, question.wrong)
    places = [at for at in range(len(whole)) if int(states.behind[at]) in reached]
    for process, local in enumerate(found.processes):
        number = states.numbers[process]
        for at in places:
            indices = division.clocks_of(at, process)
            there = local.automaton.location(number[at])
            assert there.clocks == tuple(whole.location(at).clocks[each - 1] for each in indices)
            deadlines = {
                (indices.index(clock) + 1, most)
                for clock, most, of in whole.deadlines_of(at)
                if of == process
            }
            assert {(clock, most) for clock, most, _ in local.automaton.deadlines_of(number[at])} == deadlines
            late = [
                (indices.index(clock) + 1, *rest)
                for clock, *rest in question.wrong.get(at, ())
                if clock in indices
            ]
            assert list(local.wrong.get(number[at], ())) == late
            for edge in whole.out(at):
                if (
                    process in states.participants.of(edge.footprint)
                    or int(states.behind[edge.target]) not in reached
                ):
                    continue
                assert number[at] == number[edge.target]
                assert [
                    edge.sources[each - 1] for each in division.clocks_of(edge.target, process)
                ] == indices
    tuples = {tuple(number[at] for number in states.numbers) for at in places}
    assert len(tuples) == len(places)


def timed(properties):
    kinds = PropertyKind.WITHIN, PropertyKind.ENDURANCE
    return [each for each in properties if each.kind in kinds]


@pytest.mark.parametrize("name", some_long(TIMED, every=2))
def test_a_shipped_mission_is_divided(name):
    mission = load_mission(name)
    mission = mission.under(Scheduler.PROGRAM_ORDER, mission.setting.control)
    if why_global(mission.initial):
        pytest.skip("it has a single process")
    for asked in (None, *timed(mission.properties)):
        assert_divided(mission.initial, asked)


@examples(90, 6, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_a_generated_mission_is_divided(question):
    c, asked = question
    assume(not why_global(c))
    for each in (None, asked, ENDURANCE):
        assert_divided(c, each)
