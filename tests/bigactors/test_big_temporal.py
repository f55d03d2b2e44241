import networkx as nx
import pytest

from bigactors.big_temporal import Decider, graph_of
from bigraphs.examples import example_names, example_text
from bigraphs.exploration import explore
from bigraphs.notation import read_system
from bigraphs.verdicts import Outcome, Run, Step

HOLDS, VIOLATED, INCOMPLETE = Outcome.HOLDS, Outcome.VIOLATED, Outcome.INCOMPLETE

LAMP = read_system("""\
atomic ctrl Off = 0; atomic ctrl On = 0; atomic ctrl Broken = 0;
big off = Off; big on = On; big broken = Broken;
react press = Off --> On;
react toggle = Off --> On;
react release = On --> Off;
react break = On --> Broken;
begin brs init off; rules = [ {press, toggle, release, break} ]; preds = { off, on, broken }; end
""")


def decided(system, logic, text, **limits):
    return Decider(explore(system, **limits)).decide(logic, text)


@pytest.mark.parametrize(
    ("name", "logic", "text", "outcome"),
    [
        ("mobile_ambients", "ltl", "<> delivered", HOLDS),
        ("mobile_ambients", "ltl", "not delivered U delivered", HOLDS),
        ("mobile_ambients", "ltl", "eventually always delivered", HOLDS),
        ("mobile_ambients", "ltl", "taken leave and X taken enter and X X taken dissolve", HOLDS),
        ("mobile_ambients", "ltl", "X X delivered", VIOLATED),
        ("mobile_ambients", "ctl", "A (not delivered U delivered)", HOLDS),
        ("mobile_ambients", "ctl", "AG (delivered -> AG delivered)", HOLDS),
        ("uav_patrol", "ltl", "[]<> together", VIOLATED),
        ("uav_patrol", "ctl", "AG EF together", HOLDS),
        ("uav_patrol", "ctl", "EG together and EG EF not together", HOLDS),
        ("sensor_network", "ctl", "EF AG not unaware", HOLDS),
        ("sensor_network", "ltl", "eventually always not informed", HOLDS),
        ("sensor_network", "ltl", "<> [] not unaware", VIOLATED),
        ("sensor_network", "ctl", "AG (unaware or EF (not informed))", HOLDS),
    ],
)
def test_examples_have_known_answers(name, logic, text, outcome):
    assert decided(read_system(example_text(name)), logic, text).outcome is outcome


def test_a_counterexample_is_a_stem_and_a_loop_of_rules():
    found = decided(LAMP, "ltl", "<> broken")
    assert found.outcome is VIOLATED
    assert found.run == Run((Step(("press",), 1), Step(("release",), 0)), 0)


def test_a_run_stays_where_nothing_can_happen():
    found = decided(LAMP, "ltl", "[] <> not broken")
    assert found.run == Run((Step(("press",), 1), Step(("break",), 2), Step((), 2)), 2)
    assert decided(LAMP, "ltl", "[] (broken -> X broken)").outcome is HOLDS
    assert decided(LAMP, "ctl", "AG (broken -> AX broken)").outcome is HOLDS


def test_rules_that_make_one_transition_are_different_steps():
    found = explore(LAMP)
    assert (len(found.starts), len(graph_of(found).targets)) == (3, 4)
    assert decided(LAMP, "ltl", "[] not taken toggle").run == Run((Step(("toggle",), 1),))
    assert decided(LAMP, "ltl", "<> taken break or [] (on -> taken release)").outcome is HOLDS
    assert decided(LAMP, "ctl", "AG (enabled press <-> off)").outcome is HOLDS


@pytest.mark.parametrize(
    ("logic", "text", "outcome"),
    [
        ("ltl", "[] not broken", INCOMPLETE),
        ("ltl", "[] off", VIOLATED),
        ("ltl", "<> off", INCOMPLETE),
        ("ltl", "[] enabled press", INCOMPLETE),
        ("ctl", "AG EF broken", INCOMPLETE),
        ("ctl", "EF on", INCOMPLETE),
        ("ctl", "EX broken", VIOLATED),
        ("ctl", "AG off", VIOLATED),
    ],
)
def test_an_incomplete_system_never_says_holds(logic, text, outcome):
    assert decided(LAMP, logic, text, max_states=2).outcome is outcome


def test_where_not_even_a_first_state_was_found_nothing_is_decided():
    settling = read_system("""\
atomic ctrl Off = 0; atomic ctrl On = 0;
big off = Off;
react press = Off --> On;
react press_again = On --> On;
begin brs init off; rules = [ (press), {press_again} ]; preds = { off }; end
""")
    found = decided(settling, "ltl", "off", max_time=0)
    assert (found.outcome, found.run) == (INCOMPLETE, None)
    assert decided(settling, "ltl", "not off").outcome is HOLDS


@pytest.mark.parametrize("name", example_names())
def test_reachability_is_what_a_search_of_the_graph_finds(name):
    found = explore(read_system(example_text(name)), max_states=400)
    graph, decider = found.to_networkx(), Decider(found)
    if not found.complete:
        pytest.skip("too large to be compared")
    for predicate, holds in zip(found.system.predicates, found.labels, strict=True):
        goals = {state for state, there in enumerate(holds) if there}
        before = set().union(*(nx.ancestors(graph, goal) for goal in goals)) | goals
        always = decider.decide("ctl", f'AG EF "{predicate.label}"').outcome is HOLDS
        assert always == (before == set(graph))
        never = decider.decide("ltl", f'[] not "{predicate.label}"')
        assert (never.outcome is HOLDS) == (not goals)
        if never.run is not None:
            assert len(never.run.steps) == min(nx.shortest_path_length(graph, 0, goal) for goal in goals)
