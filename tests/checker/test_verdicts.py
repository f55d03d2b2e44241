"""Reports as values: verdicts by name, and what all that a user meets looks like on one line."""

import pytest

from bigraphs.exploration import explore as explore_system
from bigraphs.notation import read_system
from checker import Limits, Verdicts, check, explore
from specs.elaboration import load_mission


@pytest.fixture(scope="module")
def report():
    return check(load_mission("look_before_entry_racy"))


def test_verdicts_are_a_sequence_that_is_looked_up_by_name_too(report):
    race = report.verdicts["race_freedom"]
    assert race is report.verdicts[1]
    assert race.outcome.value == "violated"
    assert "race_freedom" in report.verdicts
    assert race in report.verdicts
    assert "race" not in report.verdicts
    assert report.verdicts[:2] == tuple(report.verdicts)[:2]


@pytest.mark.parametrize(
    ("name", "instead"),
    [
        ("race_fredom", "did you mean 'race_freedom'?"),
        ("nothing alike", "there are local_consistency, race_freedom, deadlock_freedom, computation"),
    ],
)
def test_a_property_that_was_not_asked_for_is_said_with_those_that_were(report, name, instead):
    with pytest.raises(KeyError) as caught:
        report.verdicts[name]
    assert str(caught.value) == f"no verdict on '{name}': {instead}"
    with pytest.raises(KeyError, match="there are none"):
        Verdicts()[name]


def test_a_mission_is_checked_for_what_it_asks_with_its_notes():
    mission = load_mission("harbour_watch")
    by_parts = check(mission.initial, mission.properties, notes=mission.notes)
    whole = check(mission)
    assert (whole.verdicts, whole.notes) == (by_parts.verdicts, by_parts.notes)
    assert [each.property for each in check(mission, mission.properties[:1]).verdicts] == [
        mission.properties[0]
    ]


def test_a_configuration_is_not_checked_for_nothing():
    with pytest.raises(TypeError, match="a configuration has no properties"):
        check(load_mission("handover").initial)


def met(name):
    """Yield what a user meets of a mission."""
    mission = load_mission(name)
    report = check(mission)
    yield from (mission, mission.source, mission.setting, mission.initial, *mission.properties, report)
    yield explore(mission.initial)
    yield mission.initial.structure.logical.bigraph()
    for verdict in report.verdicts:
        yield from (verdict, *verdict.violations)
        for trace in (verdict.witness, *(each.trace for each in verdict.violations)):
            if trace is not None:
                yield from (trace, *trace.steps, *trace.configurations, *(step.label for step in trace.steps))


@pytest.mark.parametrize("name", ["broken_unrealisable", "harbour_watch", "oil_spill", "surveillance"])
def test_what_a_user_meets_is_a_line_of_bounded_length(name):
    shown = {repr(each) for each in met(name)}
    assert [line for line in shown if len(line) > 260 or "\n" in line] == []


def test_a_line_says_what_it_is_and_how_large(report):
    mission = load_mission("look_before_entry_racy")
    race = report.verdicts["race_freedom"]
    trace = race.violations[0].trace
    assert repr(mission) == "<ElaboratedMission look_before_entry_racy agents=2 entities=5 properties=4>"
    assert repr(report) == "<Report holds=3 violated=1 incomplete=0 configurations=53 complete=True>"
    assert repr(race) == "<Verdict race_freedom violated violations=2>"
    assert repr(trace) == "<Trace a shortest trace, 12 steps>"
    assert repr(trace.steps[0]) == "<Step ⟨req_obs : a, observe(CHILDREN(gate0))⟩>"
    assert repr(mission.initial) == (
        "⟨a@uav0 at observe (line 18), b@uav1 at observe (line 26) | uav0 in north0, uav1 in south0 | ∅⟩"
    )


def test_an_incomplete_exploration_names_its_bound():
    found = explore(load_mission("oil_spill").initial, limits=Limits(configurations=5))
    assert repr(found).endswith(" complete=False: the limit of 5 configurations>")
    found = explore(load_mission("oil_spill").initial, limits=Limits(configurations=1))
    assert repr(found).endswith(" complete=False: the limit of 1 configuration>")


def test_a_system_of_bigraphs_is_a_line_too():
    system = read_system(
        "atomic ctrl A = 0; atomic ctrl B = 0; big s = A; react turn = A --> B;"
        "begin brs init s; rules = [ {turn} ]; end"
    )
    assert repr(system.initial) == "<Bigraph nodes=1 links=0 regions=1 sites=0>"
    assert repr(explore_system(system)) == "<TransitionSystem states=2 transitions=1 complete=True>"
