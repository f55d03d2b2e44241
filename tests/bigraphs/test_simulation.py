"""Runs: seeds, times, and which node is which from state to state."""

from itertools import pairwise

from bigraph_strategies import grounds, shuffled
from engine_strategies import solid_rules, system
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical_form import equal
from bigraphs.exploration import explore
from bigraphs.notation import read_big, read_system
from bigraphs.simulation import Bounds, simulate


@given(st.lists(solid_rules(), min_size=1, max_size=2), grounds(max_nodes=5), st.integers(0, 3))
def test_a_node_that_is_kept_has_the_control_that_it_had(rules, initial, seed):
    run = list(simulate(system(initial, *rules), seed, Bounds(4)))
    for before, after in pairwise(run):
        assert len(dict(after.kept)) == len({now for _, now in after.kept}) == len(after.kept)
        for old, new in after.kept:
            assert before.bigraph.nodes[old].control == after.bigraph.nodes[new].control


@given(
    grounds(max_nodes=5).flatmap(lambda b: st.tuples(st.just(b), shuffled(b))),
    st.lists(solid_rules(), max_size=2),
)
def test_a_run_does_not_depend_on_how_a_state_is_written(pair, rules):
    one, other = (list(simulate(system(initial, *rules), 1, Bounds(3))) for initial in pair)
    assert one == other


HOUSE = """
ctrl Room = 0; atomic ctrl Robot = 0; atomic ctrl Lamp = 0;
big start = Room.(Robot | Lamp) | Room.Lamp;
react walk = Room.(Robot | id) | Room.id --> Room.id | Room.(Robot | id);
begin brs init start; rules = [ {walk} ]; end
"""


def test_a_robot_that_walks_stays_the_same_robot():
    first, second = simulate(read_system(HOUSE), 0, Bounds(1))
    kept = dict(second.kept)
    assert len(kept) == 5
    old = next(n for n, node in enumerate(first.bigraph.nodes) if node.control == "Robot")
    assert second.bigraph.nodes[kept[old]].control == "Robot"
    before, after = first.bigraph.nodes[old].parents, second.bigraph.nodes[kept[old]].parents
    assert kept[before[0]] != after[0]  # it is in the other room now, and the rooms are themselves


def test_a_node_that_is_replaced_is_another_one():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0;
    big start = A | B;
    react change = A --> B;
    begin brs init start; rules = [ {change} ]; end
    """
    first, second = simulate(read_system(text), 0, Bounds(1))
    ((old, _),) = second.kept
    assert first.bigraph.nodes[old].control == "B"


def test_the_states_of_a_run_are_states_of_the_whole_system():
    whole = explore(read_system(HOUSE))
    for stage in simulate(read_system(HOUSE), 5, Bounds(6)):
        assert any(equal(stage.bigraph, whole.state(number)) for number in range(len(whole)))


def test_gillespies_method_draws_delays_with_the_mean_of_all_rates():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0;
    big start = A | A;
    react there = A | A -[ 1 ]-> B | B;
    react back = B | B -[ 3 ]-> A | A;
    begin sbrs init start; rules = [ {there, back} ]; end
    """
    run = list(simulate(read_system(text), 11, Bounds(2000)))
    delays = [after.time - before.time for before, after in pairwise(run)]
    assert abs(sum(delays[::2]) / 1000 - 1.0) < 0.1
    assert abs(sum(delays[1::2]) / 1000 - 1 / 3) < 0.04


def test_a_run_ends_at_its_time():
    text = """
    atomic ctrl A = 0;
    big start = A;
    react tick = A -[ 10 ]-> A;
    begin sbrs init start; rules = [ {tick} ]; end
    """
    run = list(simulate(read_system(text), 2, Bounds(1000, 2.0)))
    assert 5 < len(run) < 60
    assert all(stage.time <= 2.0 for stage in run)


def test_an_action_is_drawn_before_its_outcome():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0;
    big start = A;
    action left react many = A -[ 99 ]-> B; end
    action right react few = A -[ 1 ]-> C; end
    begin nbrs init start; rules = [ {many, few} ]; end
    """
    one = read_system(text)
    ends = [list(simulate(one, seed, Bounds(1)))[1].action for seed in range(100)]
    assert 30 < ends.count("left") < 70  # not 99
    assert equal(next(simulate(one, 0, Bounds(0))).bigraph, read_big("A", one.signature))
