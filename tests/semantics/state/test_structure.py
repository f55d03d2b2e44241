"""Consistency of S, local and whole; L₀; and what can be said of a configuration."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_missions import aboard, figure_2, mission, run

from semantics import hypothesis_strategies
from semantics.behaviours.program import VariableOf
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, watching
from semantics.properties.propositions import (
    Always,
    And,
    Ended,
    HasPending,
    HostedAt,
    Inside,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    VariableIs,
    Waiting,
    holds,
)
from semantics.state.initial import Beliefs
from semantics.state.relations import Linked, Parent
from semantics.state.signature import REGION

# --- consistency ------------------------------------------------------------------------------------------------


def test_belief_may_be_coarser_than_fact_and_not_finer():
    s = mission(["sea", "area", "spill"], beliefs=Beliefs({"spill": "sea"})).structure
    assert s.locally_consistent((Parent("spill", "sea"),))
    finer = mission(["sea", "area", "crate"], beliefs=Beliefs({"crate": "area"})).structure
    assert not finer.locally_consistent((Parent("crate", "area"),))


def test_local_consistency_requires_the_part_to_be_believed():
    s = mission(["sea", "area", "spill"]).structure
    assert not s.locally_consistent((Parent("spill", "sea"),))
    assert s.consistent((Parent("spill", "sea"),))
    assert not s.locally_consistent((), ("nowhere",))


def test_a_region_contains_everything_that_is_there():
    here = mission(["base", "u0"], beliefs=Beliefs({"u0": REGION})).structure
    gone = mission(["base", "u0"], placed={"u0": None}, beliefs=Beliefs({"u0": REGION})).structure
    assert here.locally_consistent((Parent("u0", REGION),))
    assert not gone.locally_consistent((Parent("u0", REGION),))


def test_parent_means_contains_or_carries_and_linked_means_connected():
    s = mission(
        ["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")}, channels={"ship": ["w"]}
    ).structure
    assert s.consistent(
        (Parent("crate", "ship"), Parent("crate", "sea"), Parent("ship", "sea"), Linked("w", "ship"))
    )
    assert not s.consistent((Linked("w", "crate"),))


@given(hypothesis_strategies.structures())
def test_local_consistency_with_a_part_follows_from_that_with_the_whole(structure):
    relations = structure.relations()
    if structure.locally_consistent(relations):
        assert all(structure.locally_consistent((each,)) for each in relations)
    assert all(structure.believes(each) for each in relations)


# --- the first configuration ------------------------------------------------------------------------------------


@given(st.data())
def test_belief_begins_as_the_abstraction(data):
    c = data.draw(hypothesis_strategies.worlds()).initial()
    logical, physical = c.structure.logical, c.structure.physical
    assert logical.nodes() == physical.entities()
    for name in physical.entities():
        assert logical.parent(name) == physical.abstract_parent(name)
        assert logical.links(name) == physical.links(name)


def test_an_absent_entity_is_not_believed_unless_the_mission_says_so():
    assert "u0" not in mission(["base", "u0"], placed={"u0": None}).structure.logical
    said = mission(["base", "u0"], placed={"u0": None}, beliefs=Beliefs({"u0": "base"}))
    assert said.structure.logical.parent("u0") == "base"


# --- propositions -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formula", "first", "moved"),
    [
        (Inside("u0", "base"), True, False),
        (Inside("u0", "area"), False, True),
        (Inside("u0", "area", actually=True), False, True),
        (Inside("spill", REGION), True, True),
        (Inside("spill", REGION, directly=True), False, False),
        (LinkedWith("u0", "w"), False, False),
        (Present("u0"), True, True),
        (Known("nowhere"), False, False),
        (HasPending("a"), False, False),
        (Ended("a"), False, False),
        (Waiting("a"), False, False),
        (HostedAt("a", "u0"), True, True),
        (VariableIs(VariableOf("a", ("obs",)), 1), False, False),
        (And((Present("u0"), Not(Inside("u0", "area")))), True, False),
        (Or((Always(False), Inside("u0", "area"))), False, True),
    ],
)
def test_propositions_of_figure_2_before_and_after_its_first_move(formula, first, moved):
    c = watching(figure_2(), [Property(PropertyKind.INVARIANT, "i", formula)])
    assert (holds(formula, c), holds(formula, run(c, "req_ctr", "actuate"))) == (first, moved)


def test_a_pending_request_is_told_by_its_word():
    c = run(figure_2(), "req_ctr")
    assert holds(HasPending("a"), c)
    assert holds(HasPending("a", "CTR"), c)
    assert not holds(HasPending("a", "OBS"), c)


def test_two_nodes_are_linked_by_any_link_they_share():
    c = mission(
        ["u0", "u1", "gcs0"],
        channels={"u0": ["w"], "u1": ["w"], "gcs0": ["v"]},
        beliefs=Beliefs({}, {"u1": []}),
    )
    assert holds(LinkedWith("u0", "u1", actually=True), c)
    assert not holds(LinkedWith("u0", "u1"), c)
    assert not holds(LinkedWith("u0", "gcs0", actually=True), c)
