"""Matching of reactions in L, and what they change."""

from itertools import product

from hypothesis import assume, given
from hypothesis import strategies as st
from small_missions import logical_of, mission

from physical import point
from semantics import hypothesis_strategies
from semantics.behaviours.reaction_rules import (
    LinkVariable,
    Match,
    NodeVariable,
    Pattern,
    PlaceVariable,
    Reaction,
    make_match,
    matches,
)
from semantics.control import applicable
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import Placed
from semantics.state.signature import REGION

# --- a naive enumerator -----------------------------------------------------------------------------------------


def domain(term: object, logical: LogicalModel) -> list[str]:
    nodes = list(logical.nodes())
    if isinstance(term, NodeVariable):
        return [node for node in nodes if term.kind in (None, logical.sorting.kind(node))]
    if isinstance(term, PlaceVariable):
        return [*nodes, REGION]
    links = sorted({link for node in nodes for link in logical.links(node)})
    kind = {link: link.split(":")[0] if ":" in link else None for link in links}
    return [
        link
        for link in links
        if (term.kind is None or kind[link] == term.kind) and (term.but is None or kind[link] != term.but)
    ]


def variables_of(pattern: Pattern) -> list[object]:
    terms = [*pattern.nodes, *(term for pair in (*pattern.parents, *pattern.links) for term in pair)]
    return list(dict.fromkeys(term for term in terms if not isinstance(term, str)))


def holds(pattern: Pattern, match: Match, logical: LogicalModel) -> bool:
    nodes = [match[node] for node in pattern.nodes]
    if len(set(nodes)) < len(nodes) or any(logical.parent(node) is None for node in nodes):
        return False
    if any(logical.parent(match[node]) != match[place] for node, place in pattern.parents):
        return False
    if any(match[link] not in logical.links(match[node]) for link, node in pattern.links):
        return False
    for node in pattern.closed:
        inside = [match[child] for child, place in pattern.parents if place == node]
        if any(logical.parent(child) == match[node] and child not in inside for child in logical.nodes()):
            return False
    around = [place for node in nodes for place in logical.ancestors(node)]
    return not any(logical.sorting.signature[logical.sorting.kind(place)].passive for place in around)


def naive_matches(pattern: Pattern, logical: LogicalModel) -> set[Match]:
    variables = variables_of(pattern)
    domains = [domain(variable, logical) for variable in variables]
    size = 1
    for each in domains:
        size *= len(each)
    assume(size <= 5000)
    found = (make_match(dict(zip(variables, values, strict=True))) for values in product(*domains))
    return {match for match in found if holds(pattern, match, logical)}


@given(st.data())
def test_matching_finds_what_a_naive_enumerator_finds(data):
    world = data.draw(hypothesis_strategies.worlds())
    logical = world.initial(beliefs=data.draw(hypothesis_strategies.beliefs(world))).structure.logical
    pattern = data.draw(hypothesis_strategies.patterns(sorted(world.kinds)))
    found = matches(pattern, logical)
    assert set(found) == naive_matches(pattern, logical)
    assert len(set(found)) == len(found)


# --- matching ---------------------------------------------------------------------------------------------------


def test_two_node_variables_stand_for_two_nodes_and_a_place_variable_for_any():
    logical = logical_of("base", "u0", "u1")
    n, m, x = NodeVariable("n", "Uav"), NodeVariable("m", "Uav"), PlaceVariable("x")
    found = matches(Pattern((n, m, "base"), ((n, x), (m, x))), logical)
    assert [[match[n], match[m], match[x]] for match in found] == [["u1", "u0", "base"], ["u0", "u1", "base"]]


def test_nothing_reacts_inside_what_is_passive():
    placed = {"u0": Placed(point(37.15, -8.3))}
    assert logical_of("bunker", "u0", placed=placed).parent("u0") == "bunker"
    assert matches(Pattern(("u0",)), logical_of("bunker", "u0", placed=placed)) == ()
    assert matches(Pattern(("bunker",)), logical_of("bunker", "u0", placed=placed))


def test_link_variables_keep_to_their_kind():
    logical = logical_of("u0", channels={"u0": ["control:gcs0", "wifi"]})
    for term, links in (
        (LinkVariable("c"), ["control:gcs0", "wifi"]),
        (LinkVariable("c", kind="control"), ["control:gcs0"]),
        (LinkVariable("c", but="control"), ["wifi"]),
    ):
        found = matches(Pattern(("u0",), links=((term, "u0"),)), logical)
        assert [match[term] for match in found] == links


def test_a_reaction_that_does_not_involve_the_host_is_not_applicable():
    n = NodeVariable("n", "Uav")
    reaction = Reaction("r", Pattern((n,)), Pattern((n,)))
    c = mission(["u0", "u1"], agents={"a": ("u0", ())})
    assert [match[n] for match in applicable(c, "a", reaction)] == ["u0"]
