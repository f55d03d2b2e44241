from itertools import pairwise
from math import prod

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bigraphs.exploration import explore
from bigraphs.likeliest import decisions, likeliest_run
from bigraphs.notation import read_system


@st.composite
def chains(draw, kind="pbrs"):
    """A walk of a token among places, with random weights; of an nbrs with two actions."""
    places = draw(st.integers(2, 5))
    moves = draw(
        st.sets(st.tuples(st.integers(0, places - 1), st.integers(0, places - 1)), min_size=1, max_size=9)
    )
    rules = []
    for number, (one, other) in enumerate(sorted(moves)):
        weight = draw(st.integers(1, 5))
        rules.append(f"react r{number} = P{one} -[ {weight} ]-> P{other};")
    names = ", ".join(f"r{number}" for number in range(len(rules)))
    if kind == "nbrs":
        cut = draw(st.integers(1, len(rules)))
        halves = [rules[:cut], rules[cut:]]
        rules = [f"action a{n} {' '.join(half)} end" for n, half in enumerate(halves) if half]
    text = (
        "".join(f"atomic ctrl P{each} = 0;\n" for each in range(places))
        + f"big start = P0;\nbig goal = P{places - 1};\n"
        + "\n".join(rules)
        + f"\nbegin {kind} init start; rules = [ {{{names}}} ]; preds = {{ goal }}; end"
    )
    return explore(read_system(text))


def chances(found):
    """Return the probability of each pair of states, of an sbrs in its embedded chain."""
    out = {}
    for each in found.transitions():
        out.setdefault(each.source, []).append(each)
    return {
        (each.source, each.target): each.weight / sum(other.weight for other in leaving)
        for leaving in out.values()
        for each in leaving
    }


@pytest.mark.parametrize("kind", ["pbrs", "sbrs"])
@settings(max_examples=60, deadline=None)
@given(st.data())
def test_no_path_is_likelier(kind, data):
    found = data.draw(chains(kind))
    goals = set(found.states_with(0))
    run, chance = likeliest_run(found, goals), chances(found)
    graph = found.to_networkx()
    paths = [path for goal in goals for path in ([[0]] if goal == 0 else nx.all_simple_paths(graph, 0, goal))]
    if run is None:
        assert not paths
        return
    assert run.chance == pytest.approx(max(prod(chance[pair] for pair in pairwise(path)) for path in paths))
    assert run.chance == pytest.approx(prod(run.chances))
    states = [0, *(each.target for each in run.transitions)]
    assert states[-1] in goals
    assert [(each.source, each.target) for each in run.transitions] == list(pairwise(states))
    assert list(run.chances) == pytest.approx([chance[pair] for pair in pairwise(states)])


WALK = explore(
    read_system("""\
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0; atomic ctrl D = 0;
big start = A; big goal = D;
react ab = A -[1]-> B; react ac = A -[3]-> C; react bd = B -[1]-> D; react cd = C -[1]-> D; react cb = C -[4]-> B;
begin pbrs init start; rules = [ {ab, ac, bd, cd, cb} ]; preds = { goal }; end
""")
)


def test_the_likeliest_run_by_hand():
    run = likeliest_run(WALK, set(WALK.states_with(0)))
    assert [each.rules for each in run.transitions] == [("ac",), ("cb",), ("bd",)]
    assert run.chances == (0.75, 0.8, 1.0)
    assert run.chance == pytest.approx(0.6)


def test_a_run_stays_within():
    (b,) = {each.target for each in WALK.transitions() if each.rules == ("ab",)}
    run = likeliest_run(WALK, set(WALK.states_with(0)), set(range(len(WALK))) - {b})
    assert [each.rules for each in run.transitions] == [("ac",), ("cd",)]
    assert likeliest_run(WALK, set()) is None


@settings(max_examples=40, deadline=None)
@given(chains("nbrs"), st.data())
def test_a_strategy_leaves_its_choices_alone(found, data):
    actions = {
        state: sorted({each.action for each in found.transitions() if each.source == state})
        for state in range(len(found))
    }
    strategy = [data.draw(st.integers(0, max(0, len(each) - 1))) for each in actions.values()]
    run = likeliest_run(found, set(found.states_with(0)), None, strategy)
    for each in run.transitions if run else ():
        assert each.action == actions[each.source][strategy[each.source]]
    for state, action in decisions(found, strategy).items():
        assert len(actions[state]) == 2
        assert action == actions[state][strategy[state]]
