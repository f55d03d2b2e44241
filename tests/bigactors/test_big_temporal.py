from itertools import combinations

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bigactors.commands.big.temporal import Decider, graph_of
from bigraphs.claims import ClaimOutcome, WitnessRun, WitnessStep
from bigraphs.examples import example_names, example_text
from bigraphs.exploration import explore
from bigraphs.notation import read_system

HOLDS, VIOLATED, INCOMPLETE = ClaimOutcome.HOLDS, ClaimOutcome.VIOLATED, ClaimOutcome.INCOMPLETE

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
    assert found.run == WitnessRun((WitnessStep(("press",), 1), WitnessStep(("release",), 0)), 0)


def test_a_run_stays_where_nothing_can_happen():
    found = decided(LAMP, "ltl", "[] <> not broken")
    assert found.run == WitnessRun(
        (WitnessStep(("press",), 1), WitnessStep(("break",), 2), WitnessStep((), 2)), 2
    )
    assert decided(LAMP, "ltl", "[] (broken -> X broken)").outcome is HOLDS
    assert decided(LAMP, "ctl", "AG (broken -> AX broken)").outcome is HOLDS


def test_rules_that_make_one_transition_are_different_steps():
    found = explore(LAMP)
    assert (len(found.starts), len(graph_of(found).targets)) == (3, 4)
    assert decided(LAMP, "ltl", "[] not taken toggle").run == WitnessRun((WitnessStep(("toggle",), 1),))
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
        if never.outcome is VIOLATED:
            assert never.run is not None
            assert len(never.run.steps) == min(nx.shortest_path_length(graph, 0, goal) for goal in goals)


@pytest.mark.parametrize(
    ("logic", "text", "outcome"),
    [
        ("ltl", "<> broken", VIOLATED),
        ("ltl", "under weak fairness of break: <> broken", VIOLATED),
        ("ltl", "under strong fairness of break: <> broken", HOLDS),
        ("ltl", "under weak fairness of press and strong fairness of break, release: <> broken", HOLDS),
        ("ltl", "under strong fairness of rules: <> broken", HOLDS),
        ("ctl", "AF broken", VIOLATED),
        ("ctl", "under strong fairness of break: AF broken", HOLDS),
        ("ctl", "under strong fairness of break: EG not broken", VIOLATED),
    ],
)
def test_only_fair_runs_are_asked_about(logic, text, outcome):
    assert decided(LAMP, logic, text).outcome is outcome


def test_a_violated_formula_says_under_which_fairness_it_holds():
    assert decided(LAMP, "ltl", "<> broken").note == (
        "only unfair runs violate it: it holds under strong fairness of rules"
    )
    assert decided(LAMP, "ltl", "[] not broken").note == ""
    assert decided(LAMP, "ctl", "AF broken", max_states=2).note == ""


def test_arguments_tell_the_rules_of_a_name_apart():
    text = """\
atomic fun ctrl Turn(n) = 0; atomic fun ctrl Served(n) = 0;
big turn = Turn(0);
fun big served(n) = Served(n);
fun react serve(n) = Turn(0) --> Served(n);
fun react back(n) = Served(n) --> Turn(0);
begin brs
int n = {1, 2};
init turn;
rules = [ {serve(n), back(n)} ];
preds = { served(n) };
end
"""
    system = read_system(text)
    for fairness, outcome in (
        *((each, VIOLATED) for each in ("weak fairness of serve", "strong fairness of serve(1)")),
        *((f"strong fairness of {each}", HOLDS) for each in ("serve(2)", "serve", "rules")),
    ):
        assert decided(system, "ltl", f"under {fairness}: []<> served(2)").outcome is outcome


NEVER_MENDED = read_system("""\
atomic ctrl Off = 0; atomic ctrl On = 0; atomic ctrl Broken = 0; atomic ctrl Tool = 0;
big off = Off; big on = On; big broken = Broken; big tool = Tool;
react press = Off --> On;
react release = On --> Off;
react mend = Broken | Tool --> Off | Tool;
begin brs init off; rules = [ {press, release, mend} ]; preds = { off, on, broken, tool }; end
""")


def test_fairness_to_what_never_is_is_told():
    found = decided(NEVER_MENDED, "ltl", "under weak fairness of mend, press: []<> on")
    assert found.remarks == ("weak fairness of mend covers no step of any run",)


@pytest.mark.parametrize(
    ("logic", "text", "remark"),
    [
        ("ltl", "broken leads to tool", "vacuous: none of its atoms ever changes"),
        ("ltl", "broken leads to on", "vacuous: 'broken' is never true, so that '<> on' is never needed"),
        ("ctl", "AG (broken -> AF on)", "vacuous: 'broken' is never true, so that 'A <> on' is never needed"),
        ("ctl", "AG (off -> EF on)", "'off' is never needed: it holds without"),
        (
            "ltl",
            "[] (enabled mend -> X off)",
            "vacuous: 'enabled mend' is never true, so that 'X off' is never needed",
        ),
        ("ltl", "[] (tool or broken or not tool)", "vacuous: none of its atoms ever changes"),
        ("ltl", "[] (off -> X on)", None),
    ],
)
def test_what_is_never_needed_is_told(logic, text, remark):
    found = decided(NEVER_MENDED, logic, text)
    assert (found.outcome, found.remarks) == (HOLDS, () if remark is None else (remark,))


def test_a_formula_of_runs_that_holds_has_a_witness():
    found = decided(NEVER_MENDED, "ltl", "[] (off -> X on)")
    assert found.run == WitnessRun((WitnessStep(("press",), 1), WitnessStep(("release",), 0)), 0)
    assert found.note == "a witness of 2 steps, in --json"


@st.composite
def lamps(draw):
    """Two or three lamps of a few colours: each rule turns a lamp of one colour to another, wherever it is."""
    colours = draw(st.integers(2, 3))
    changes = draw(
        st.sets(st.permutations(range(colours)).map(lambda each: tuple(each[:2])), min_size=1, max_size=4)
    )
    first = draw(st.lists(st.integers(0, colours - 1), min_size=1, max_size=3))
    rules = [f"react r{number} = C{one} --> C{other};" for number, (one, other) in enumerate(sorted(changes))]
    names = ", ".join(f"r{number}" for number in range(len(rules)))
    return read_system(
        "".join(f"atomic ctrl C{each} = 0;\n" for each in range(colours))
        + f"big start = {' | '.join(f'C{each}' for each in first)};\nbig wanted = C0;\n"
        + "\n".join(rules)
        + f"\nbegin brs init start; rules = [ {{{names}}} ]; preds = {{ wanted }}; end"
    )


def fair_loop_avoids(found, strong, fair):
    """Say by brute force whether a fair run is in unwanted states only, from some time on."""
    graph, unwanted = found.to_networkx(), [s for s in range(len(found)) if not found.labels[0][s]]
    rules = {(edge.source, edge.target): edge.rules for edge in found.transitions()}
    leaves = {
        state: {rule for (one, _), by in rules.items() if one == state for rule in by} for state in unwanted
    }
    for size in range(1, len(unwanted) + 1):
        for loop in combinations(unwanted, size):
            if not nx.is_strongly_connected(graph.subgraph(loop)):
                continue
            inside = {rule for (one, other), by in rules.items() if {one, other} <= set(loop) for rule in by}
            enabled = [leaves[state] for state in loop]
            owed = set.union(*enabled) if strong else set.intersection(*enabled)
            stays = size == 1 and not leaves[loop[0]]
            if (inside or stays) and not (owed & fair) - inside:
                return True
    return False


@settings(max_examples=60, deadline=None)
@given(lamps(), st.booleans(), st.data())
def test_fair_runs_are_those_of_the_definition(system, strong, data):
    found = explore(system)
    labels = [rule.label for rule in system.rules()]
    fair = data.draw(st.sets(st.sampled_from(labels), min_size=1))
    under = f"under {'strong' if strong else 'weak'} fairness of {', '.join(sorted(fair))}"
    outcome = Decider(found).decide("ltl", f"{under}: []<> wanted").outcome
    assert (outcome is VIOLATED) == fair_loop_avoids(found, strong, fair)
