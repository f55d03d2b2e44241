"""Forms: what is worked out for one rule serves those that differ in their controls, and no others."""

from dataclasses import replace

from bigraph_strategies import PLAIN, SIGNATURE, grounds
from engine_strategies import solid_rules
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import lean
from bigraphs.canonical_form import canonical
from bigraphs.engine.automorphisms import symmetries
from bigraphs.engine.intern_tables import InternTables, has_sharing
from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import compile_pattern
from bigraphs.engine.rule_forms import Forms
from bigraphs.engine.state_arrays import make_state
from bigraphs.notation import read_system


@given(st.lists(solid_rules(sharing=True), min_size=1, max_size=4))
def test_what_a_form_knows_is_what_each_of_its_rules_says(rules):
    forms = Forms()
    for rule in rules:
        tidy = forms.tidy(rule)
        assert tidy == replace(rule, redex=canonical(lean(rule.redex)), reactum=canonical(lean(rule.reactum)))
        shared = any(map(has_sharing, (tidy.redex, tidy.reactum)))
        world = InternTables(SIGNATURE, (), 1, sharing=shared)
        pattern = compile_pattern(world, tidy.redex)
        assert forms.symmetries(tidy, pattern) == symmetries(tidy, pattern)


@given(st.lists(solid_rules(), min_size=1, max_size=4), grounds(max_nodes=6, controls=PLAIN))
def test_plans_of_a_form_find_what_plans_of_ones_own_find(rules, target):
    def world():
        return InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)

    shared = world()
    for rule in rules:
        alone = world()
        found = [
            Matcher(each, compile_pattern(each, rule.redex)).find(make_state(each, target))
            for each in (shared, alone)
        ]
        assert found[0] == found[1]


def test_a_thousand_instances_have_one_form_and_one_plan():
    machine = Machine(
        read_system("""
            ctrl Room = 0; atomic fun ctrl N(n) = 0; fun react up(n) = Room.(N(n) | id) --> Room.(N(n + 1) | id);
            big zero = Room.(N(0) | N(0));
            begin brs int n = [0 : 1 : 999]; init zero; rules = [ {up(n)} ]; end
        """)
    )
    placings = {id(reaction.matcher.plan(0)) for reaction in machine.reactions}
    # a control's place in the alphabet is a part of the form, and whether a rule's two Ns are one
    assert len(machine.world.plans) == len(placings) <= 2


def test_two_symmetric_nodes_are_not_taken_for_two_others_that_are_none():
    machine = Machine(
        read_system("""
            ctrl Room = 0; atomic fun ctrl N(n) = 1;
            fun react meet(n, m) =
              Room.(N(n){x} | id) || Room.(N(m){y} | id) --> Room.(N(n){x} | id) || Room.(N(m){y} | id);
            big two = /a /b (Room.N(1){a} | Room.N(2){b});
            begin brs int n = {1, 2}; int m = {1, 2}; init two; rules = [ {meet(n, m)} ]; end
        """)
    )
    known = {each.label: len(each.representatives.symmetries) for each in machine.reactions}
    assert known == {"meet(1,1)": 1, "meet(1,2)": 0, "meet(2,1)": 0, "meet(2,2)": 1}
