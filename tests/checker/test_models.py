"""Models of a user's own: the same search, the same formulas, and missions and systems as models among them."""

import importlib.util

import pytest
from repository import ROOT

from bigactors.commands.big.temporal import Decider
from bigraphs import SystemModel
from bigraphs import explore as explore_system
from bigraphs.errors import NotationError
from bigraphs.examples import example_names, example_text
from bigraphs.notation import read_system
from checker import (
    CombinationError,
    Engine,
    Limits,
    MissionModel,
    Outcome,
    check,
    explore,
)
from checker.engines.capabilities import UNSUPPORTED, Feature
from semantics import Label
from specs.elaboration import load_mission

SPEC = importlib.util.spec_from_file_location("philosophers", ROOT / "examples" / "philosophers.py")
philosophers = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(philosophers)


class Counter:
    """It counts up to a number, from which it may go back to the start; or it breaks."""

    initial = 0

    def __init__(self, most):
        self.most = most

    def successors(self, state):
        if state == "broken":
            return []
        steps = [("up", state + 1)] if state < self.most else [("back", 0)]
        return [*steps, ("break", "broken")]


def table(seats, *, last_is_left_handed=False):
    return philosophers.Table(seats, last_is_left_handed=last_is_left_handed)


def naive(model):
    """Return the distance of each state, and the number of transitions."""
    distances, layer, transitions = {model.initial: 0}, [model.initial], 0
    while layer:
        after = []
        for state in layer:
            for _, target in model.successors(state):
                transitions += 1
                if target not in distances:
                    distances[target] = distances[state] + 1
                    after.append(target)
        layer = after
    return distances, transitions


@pytest.mark.parametrize(
    "model", [Counter(4), table(3), table(5, last_is_left_handed=True)], ids=["counter", "three", "five"]
)
def test_all_states_are_found_by_shortest_paths(model):
    found, (distances, transitions) = explore(model), naive(model)
    assert found.complete
    assert {state: len(found.run_to(number)) for number, state in enumerate(found.states)} == distances
    assert (found.transitions, found.rules.total(), found.depth) == (
        transitions,
        transitions,
        max(distances.values()),
    )
    for number, state in enumerate(found.states):
        at = model.initial
        for step in found.run_to(number):
            labels = {(getattr(label, "rule", label), target) for label, target in model.successors(at)}
            assert step in labels
            at = step.state
        assert at == state


def test_states_and_deadlocks_are_asked_for_by_functions():
    found = explore(Counter(3))
    assert found.no_deadlock().run == (("break", "broken"),)
    assert found.no_deadlock(lambda state: state == "broken").outcome is Outcome.HOLDS
    assert found.reachable(lambda state: state == 2).run == (("up", 1), ("up", 2))
    assert found.reachable(lambda state: state == 9).outcome is Outcome.VIOLATED
    assert found.always(lambda state: state != 1).run == (("up", 1),)
    assert found.always(lambda state: state != 9).outcome is Outcome.HOLDS


def test_formulas_name_functions_rules_and_groups():
    found, hungry = explore(table(3, last_is_left_handed=True)), {"fed": lambda state: state[0] == 2}
    unfair = found.ltl("<> fed", **hungry)
    assert (unfair.outcome, unfair.loop) == (Outcome.VIOLATED, 0)
    assert unfair.note == "only unfair runs violate it: it holds under strong fairness of rules"
    states = [found.states[0], *(step.state for step in unfair.run)]
    assert states[unfair.loop] == states[-1]
    assert found.ltl("under strong fairness of p0, p1, p2: <> fed", **hungry).outcome is Outcome.HOLDS
    assert found.ltl("[] (taken eat0 -> fed)", **hungry).outcome is Outcome.HOLDS
    assert found.ctl("AG EF fed", **hungry).outcome is Outcome.HOLDS
    assert explore(table(3)).ctl("AG EF fed", **hungry).outcome is Outcome.VIOLATED
    with pytest.raises(NotationError, match="unknown predicate 'fedd'"):
        found.ltl("<> fedd", **hungry)
    with pytest.raises(NotationError, match="unknown rule 'eat9'"):
        found.ltl("<> taken eat9")


def test_a_run_stays_where_nothing_is_possible():
    found = explore(Counter(1)).ltl("[] <> start", start=lambda state: state == 0)
    assert found.run[: found.loop][-1].label == "break"
    assert [step.label for step in found.run[found.loop :]] == [""]


# --- limits, interruption, progress -----------------------------------------------------------------------------------


@pytest.mark.parametrize("limits", [Limits(configurations=5), Limits(seconds=0.0), Limits(memory=1)])
def test_what_a_limit_leaves_out_is_never_decided(limits):
    found = explore(table(4, last_is_left_handed=True), limits=limits)
    assert not found.complete
    assert len(found.states) <= 5
    assert found.always(lambda _: True).outcome is Outcome.INCOMPLETE
    assert found.reachable(lambda _: False).outcome is Outcome.INCOMPLETE
    assert found.no_deadlock().outcome is Outcome.INCOMPLETE
    assert found.ltl("true").outcome is Outcome.INCOMPLETE
    assert found.ctl("AG true").outcome is Outcome.INCOMPLETE


def test_an_interruption_ends_it_and_progress_is_reported():
    limits, seen = Limits(), []

    def report(progress):
        seen.append(progress.configurations)
        if progress.configurations > 20:
            limits.interruption.wish()

    found = explore(table(5), limits=limits, report=report, every=0.0)
    assert list(map(str, found.bounds)) == ["an interruption"]
    assert seen == sorted(seen)
    assert 20 < seen[-1] <= len(found.states)


def test_an_interruption_ends_the_decision_of_a_formula(monkeypatch):
    monkeypatch.setattr("checker.limits.GRACE", 0.0)
    limits = Limits()
    found = explore(table(3), limits=limits)
    limits.interruption.wish()
    verdict = found.ltl("<> fed", fed=lambda state: state[0] == 2)
    assert (verdict.outcome, verdict.note) == (Outcome.INCOMPLETE, "not decided: an interruption was met")


# --- missions and systems as models -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["oil_spill", "handover", "broken_deadlock", "look_before_entry_racy"])
def test_a_mission_as_a_model_has_the_counts_of_a_check(name):
    mission = load_mission(name)
    report, found = check(mission, engine=Engine.REFERENCE), explore(MissionModel(mission.initial))
    counts = (report.configurations, report.transitions, report.depth, report.rules)
    assert (len(found.states), found.transitions, found.depth, dict(sorted(found.rules.items()))) == counts
    assert all(found.ltl(f"[] not taken {rule}").outcome is Outcome.VIOLATED for rule in found.rules)


@pytest.mark.parametrize("name", sorted({*example_names()} - {"uav_patrol"}))
def test_a_system_as_a_model_has_the_counts_of_its_transition_system(name):
    system = read_system(example_text(name))
    right, found = explore_system(system), explore(SystemModel(system))
    assert right.complete
    assert (len(found.states), found.transitions, found.depth) == (
        len(right),
        len(right.targets),
        max(len(right.path_to(state)) - 1 for state in range(len(right))),
    )
    assert found.ctl("AG EX true").outcome is Outcome(
        Decider(right).decide("ctl", "AG EX true").outcome.value
    )
    stuck = any(not right.leaving(state) for state in range(len(right)))
    assert (found.no_deadlock().outcome is Outcome.VIOLATED) == stuck


# --- refusals ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", [Engine.FAST, Engine.RAY])
def test_another_engine_is_refused_by_the_table(engine):
    row = next(
        pair for pair in UNSUPPORTED if {pair.one, pair.other} == {Feature.MODEL, Feature[engine.name]}
    )
    with pytest.raises(CombinationError, match="learn the rules of missions") as refused:
        explore(Counter(2), engine=engine)
    assert (str(refused.value), refused.value.remedy) == (row.reason, row.remedy)


def test_inspections_are_refused():
    with pytest.raises(TypeError, match="inspections are about configurations"):
        explore(Counter(2), [print])


def test_a_label_may_be_a_word():
    assert set(explore(Counter(1)).graph.labels) == {
        Label("up", "up"), Label("back", "back"), Label("break", "break")
    }  # fmt: skip


def test_a_mission_is_explored_from_its_initial_configuration():
    mission = load_mission("oil_spill")
    assert explore(mission).size == explore(mission.initial).size == 34
    with pytest.raises(TypeError, match="explore takes a mission, a configuration, or a model"):
        explore("oil_spill")
