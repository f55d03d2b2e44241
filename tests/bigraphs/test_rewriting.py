from dataclasses import replace

import pytest
from bigraph_strategies import PLAIN, SIGNATURE, grounds, rules, shuffled
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import atom, close, ion, lean, merge, nest, placing, substitution
from bigraphs.bigraph import check
from bigraphs.canonical_form import canonical, equal
from bigraphs.errors import BigraphError
from bigraphs.instantiation import instantiate
from bigraphs.notation import read_bgm
from bigraphs.rewriting import rewrite, successors
from bigraphs.rules import matches, rule

SLOT, ONE = merge(1), merge(0)
MOVE = "l0_Location.(u0_UAV[n] | $0) || l1_Location.$1 -> l0_Location.$0 || l1_Location.(u0_UAV[n] | $1);"


def node(control, inside=SLOT, name=None):
    return nest(ion(SIGNATURE, control, (), name), inside)


@given(rules(), grounds(max_nodes=7, controls=PLAIN))
def test_rewriting_keeps_bigraphs_well_formed_and_their_outer_face(given_rule, target):
    for _, found in successors(given_rule, target):
        check(found)
        assert found.outer == target.outer
        assert not found.sites


@given(rules(), grounds(max_nodes=5, controls=PLAIN))
def test_the_identity_rule_changes_nothing_but_idle_edges(given_rule, target):
    same = rule(given_rule.redex, given_rule.redex)
    for match in matches(same, target):
        assert equal(rewrite(same, match), lean(target))


@given(rules(), grounds(max_nodes=5, controls=PLAIN), st.data())
def test_the_set_of_successors_does_not_depend_on_the_order_of_nodes(given_rule, target, data):
    other = data.draw(shuffled(target))
    found = {canonical(result) for _, result in successors(given_rule, target)}
    assert found == {canonical(result) for _, result in successors(given_rule, other)}


def paper(world):
    """Return a rule of the paper, and a state, both with named nodes."""
    system = read_bgm(f"{MOVE} {world};")
    return next(system.rules()).reaction(), system.initial


def test_the_rule_of_the_paper_moves_the_vehicle_and_keeps_its_link():
    move, world = paper("l0_Location.(u0_UAV[n] | u1_UAV[m]) | l1_Location")
    (found,) = [result for _, result in successors(move, world)]
    assert found == paper("l0_Location.u1_UAV[m] | l1_Location.u0_UAV[n]")[1]


def test_a_variable_keeps_the_name_of_the_node_that_it_matched():
    move, world = paper("a_Location.(x_UAV[n] | y_UAV[n]) | b_Location")
    of_any = replace(move, node_variables=frozenset({"l0", "l1", "u0"}))
    assert {result for _, result in successors(of_any, world)} == {
        paper(f"a_Location.{stays}_UAV[n] | b_Location.{goes}_UAV[n]")[1] for stays, goes in ("yx", "xy")
    }


def test_sites_are_dropped_moved_and_copied_as_the_instantiation_says():
    target = node("A", atom(SIGNATURE, "B", ["x"])) | node("P", ONE)
    copy = rule(node("A"), node("A") | node("A"), (0, 0))
    (found,) = [result for _, result in successors(copy, target)]
    twice = node("A", atom(SIGNATURE, "B", ["x"]))
    assert equal(found, twice | twice | node("P", ONE))
    drop = rule(node("A"), node("A", ONE), ())
    (found,) = [result for _, result in successors(drop, target)]
    assert equal(found, (node("A", ONE) | node("P", ONE)) // close_nothing("x"))


def close_nothing(name):
    return substitution(name, ())


def test_copies_share_their_links():
    target = node("A", close(atom(SIGNATURE, "C", ["x", "y"]), "y"))
    copy = rule(node("A"), node("A") | node("A"), (0, 0))
    (found,) = [result for _, result in successors(copy, target)]
    assert found.edges == 1


def test_copying_a_named_node_is_refused():
    target = node("A", atom(SIGNATURE, "A", name="one"))
    copy = rule(node("A"), node("P") | node("P"), (0, 0))
    with pytest.raises(BigraphError, match="the rule would copy one:A"):
        list(successors(copy, target))


def test_a_dropped_site_leaves_what_other_places_hold_too():
    both = (node("A") * node("P")) @ placing([{0, 1}], 2) @ atom(SIGNATURE, "A", name="s")
    drop = rule(node("A"), node("A", ONE), ())
    (found,) = [result for match, result in successors(drop, both) if match.nodes != (0,)]
    assert [str(each) for each in found.nodes] == ["s:A", "P", "A"]
    assert len(found.nodes[0].parents) == 1


def test_the_parameter_is_instantiated_region_by_region():
    parameter = atom(SIGNATURE, "A") // atom(SIGNATURE, "P")
    assert equal(instantiate(parameter, (1, 0), 2), atom(SIGNATURE, "P") // atom(SIGNATURE, "A"))
    assert instantiate(parameter, (0, 1), 2) is parameter
    assert equal(instantiate(parameter, (1,), 2), atom(SIGNATURE, "P"))
