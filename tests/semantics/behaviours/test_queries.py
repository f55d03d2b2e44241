"""Queries, observations, and what L ⊕ L_q does to L."""

from types import MappingProxyType

from hypothesis import given
from hypothesis import strategies as st
from small_missions import aboard, mission

from semantics import hypothesis_strategies
from semantics.behaviours.observations import NOTHING_SEEN, All, Nodes, Observation, Of, Query
from semantics.behaviours.queries import evaluate, overlay
from semantics.state.agents import Agents
from semantics.state.cell_values import Cells
from semantics.state.configuration import Configuration
from semantics.state.initial import Beliefs
from semantics.state.relations import Linked, Parent
from semantics.state.signature import REGION


def look(c: Configuration, query: Query) -> Observation:
    return evaluate(query, c.structure.physical, c.alpha)


def learn(c: Configuration, seen: Observation) -> Configuration:
    return c.with_each(overlay(c.structure.logical, seen))


def of(operators: str, name: str) -> Query:
    query: Query = Nodes((name,))
    for operator in reversed(operators.split()):
        query = Of(operator, query)
    return query


# --- what queries denote ----------------------------------------------------------------------------------------


def test_the_parent_of_the_region_is_the_region():
    c = mission(["sea", "area", "spill"])
    top = look(c, of("CHILDREN PARENT PARENT PARENT PARENT", "spill"))
    assert top.shown == ("sea",)
    assert top.swept.places == (REGION,)


def test_an_absent_host_gives_the_empty_observation():
    c = mission(["base", "u0", "u1"], placed={"u0": None})
    assert look(c, of("CHILDREN PARENT", "u0")) == Observation.of()


def test_linked_to_shows_all_points_of_all_links():
    channels = {"u0": ["wifi", "x"], "gcs0": ["wifi"], "gcs1": ["x"], "u1": ["y"]}
    c = mission(["base", "u0", "u1", "gcs0", "gcs1"], channels=channels)
    seen = look(c, of("LINKED_TO", "u0"))
    assert seen.shown == ("gcs0", "gcs1", "u0")
    assert (seen.swept.nodes, seen.swept.links) == (("u0",), ("wifi", "x"))
    assert seen.links("u0") == {"wifi", "x"}


def test_a_node_that_nothing_is_linked_to_is_the_member_of_what_is_linked_to_it():
    c = mission(["base", "u0"])
    assert look(c, of("LINKED_TO", "u0")).members == ("u0",)
    assert look(c, of("CHILDREN", "u0")).members == ()


def test_an_operator_is_applied_to_the_place_whose_children_are_asked_for_too():
    c = mission(["sea", "area"])
    assert look(c, of("PARENT CHILDREN", "area")).members == ("sea",)


def test_hosted_at_composes_with_other_queries():
    agents = {"a": ("gcs0", ()), "b": ("gcs1", ()), "c": ("u0", ())}
    c = mission(["u0", "gcs0", "gcs1"], agents=agents, channels={"u0": ["w"], "gcs0": ["w"]})
    seen = look(c, of("HOSTED_AT LINKED_TO", "u0"))
    assert (seen.shown, seen.agents) == ((), ("a", "c"))


def test_what_a_carrier_holds_are_its_children():
    c = mission(["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")})
    assert look(c, of("CHILDREN", "ship")).shown == ("crate", "ship")
    assert look(c, of("PARENT", "crate")).shown == ("ship",)


@given(st.data())
def test_operators_compose_pointwise(data):
    world = data.draw(hypothesis_strategies.worlds())
    c = world.initial()
    names = data.draw(st.lists(st.sampled_from(sorted(world.kinds)), min_size=1, max_size=3, unique=True))
    operator = data.draw(st.sampled_from(["PARENT", "CHILDREN", "LINKED_TO"]))
    together = look(c, Of(operator, Nodes(tuple(sorted(names)))))
    apart = [look(c, Of(operator, Nodes((name,)))) for name in names]
    assert set(together.shown) == set().union(*(each.shown for each in apart))
    assert set(together.relations) == set().union(*(each.relations for each in apart))


@given(hypothesis_strategies.structures())
def test_all_shows_exactly_the_abstraction(structure):
    seen = evaluate(All(), structure.physical, Agents(structure.physical.cells))
    physical = structure.physical
    parents = {Parent(name, physical.abstract_parent(name)) for name in physical.entities()}
    links = {Linked(link, name) for name in physical.entities() for link in physical.links(name)}
    assert set(seen.relations) == parents | links
    assert seen.shown == physical.entities()


# --- L ⊕ L_q ----------------------------------------------------------------------------------------------------


def test_a_link_seen_without_a_node_loses_it_and_no_other():
    c = mission(
        ["u0", "u1", "gcs0"], channels={"gcs0": ["w"]}, beliefs=Beliefs({}, {"u0": ["w", "x"], "u1": ["x"]})
    )
    logical = learn(c, look(c, of("LINKED_TO", "gcs0"))).structure.logical
    assert (logical.links("u0"), logical.links("u1"), logical.links("gcs0")) == (("x",), ("x",), ("w",))


def test_a_place_of_which_only_who_is_in_it_is_known_goes_to_the_region():
    c = mission(["sea", "area", "spill"], beliefs=Beliefs({"area": None, "spill": None}))
    seen = look(c, of("HOSTED_AT PARENT", "spill"))
    assert seen.fact("area") == NOTHING_SEEN
    logical = learn(c, seen).structure.logical
    assert (logical.parent("spill"), logical.parent("area")) == ("area", REGION)


@given(st.data())
def test_after_an_observation_the_structure_is_locally_consistent_with_it(data):
    world = data.draw(hypothesis_strategies.worlds())
    c = world.initial(beliefs=data.draw(hypothesis_strategies.beliefs(world)))
    seen = look(c, data.draw(hypothesis_strategies.queries(sorted(world.kinds))))
    after = learn(c, seen).structure
    assert after.locally_consistent(seen.relations, seen.nodes())
    check_only_answers_were_taken(c, seen, after.logical)


def check_only_answers_were_taken(c: Cells, seen: Observation, after) -> None:
    """Only denied relations vanished, border nodes kept theirs, new nodes were shown, and the result is a forest."""
    before = c.structure.logical
    answered = {pair.node for pair in seen.relations if isinstance(pair, Parent)}
    assert set(after.nodes()) == set(before.nodes()) | set(seen.nodes())
    for node in before.nodes():
        old, new = before.parent(node), after.parent(node)
        if new != old and node not in answered:
            assert new == REGION
            assert old in seen.swept.places or on_a_cycle(before, seen, node)
        lost = set(before.links(node)) - set(after.links(node))
        assert node in seen.swept.nodes or lost <= set(seen.swept.links)
        assert set(after.links(node)) - set(before.links(node)) <= seen.links(node)
    for node in after.nodes():
        assert len([place for place, _ in zip(after.ancestors(node), range(50), strict=False)]) < 50


def on_a_cycle(before, seen: Observation, node: str) -> bool:
    """Tell whether a node would be its own ancestor if only the answers were written over L."""
    place = before.parent(node)
    for _ in range(50):
        if place in (None, REGION):
            return False
        if place == node:
            return True
        place = seen.parent(place) or (
            REGION if before.parent(place) in seen.swept.places else before.parent(place)
        )
    return True


def test_what_is_linked_to_the_parent_of_the_region_is_the_region():
    c = mission(["sea", "u0"], channels={"u0": ["w"]})
    assert "sea" in look(c, of("LINKED_TO CHILDREN PARENT PARENT PARENT", "u0")).shown


@given(st.data())
def test_the_same_is_learned_whoever_is_asked_name_by_name(data):
    world = data.draw(hypothesis_strategies.worlds())
    names = sorted(world.kinds)
    unknown = data.draw(st.lists(st.sampled_from(names), unique=True))
    c = world.initial(beliefs=Beliefs(dict.fromkeys(unknown)))
    seen = look(c, data.draw(hypothesis_strategies.queries(names)))
    asked = Observation(
        MappingProxyType(dict(seen.family)), seen.swept
    )  # as the checker has it: no plain family
    assert overlay(c.structure.logical, seen) == overlay(c.structure.logical, asked)


def test_observing_asks_each_name_a_few_times_however_many_there_are():
    class Counted(dict):
        asked = 0

        def get(self, *words):
            Counted.asked += 1
            return super().get(*words)

    names = ["sea", "area", "spill", "base", "u0", "u1", "gcs0", "gcs1"]
    c = mission(names, beliefs=Beliefs(dict.fromkeys(names)))
    seen = look(c, of("CHILDREN", "base"))
    overlay(c.structure.logical, Observation(Counted(seen.family), seen.swept))
    assert Counted.asked <= 3 * len(names)
