"""The engine's search against the naive enumerator and against a SAT solver."""

from dataclasses import replace
from itertools import pairwise

import pytest
from bigraph_strategies import PLAIN, SIGNATURE, grounds
from engine_strategies import solid_redexes, targets
from hypothesis import given, settings
from hypothesis import strategies as st
from naive_matching import naive_matches

from bigraphs.algebra import atom, close, ion, merge, nest
from bigraphs.bigraph import assemble
from bigraphs.engine.contexts import PlaceContexts
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import check_solid, compile_pattern
from bigraphs.engine.state_arrays import make_state
from bigraphs.errors import BigraphError
from bigraphs.matching import find_matches

SLOT, ONE = merge(1), merge(0)


def engine_matches(redex, target, *, sharing=False):
    """Return (nodes, links) of every occurrence, twins in order."""
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=sharing)
    pattern = compile_pattern(world, redex)
    state = make_state(world, target)
    around = PlaceContexts(state, passive=True)
    names = [*target.outer_names, *range(target.edges)]
    found = Matcher(world, pattern).find(state)
    assert len(set(found)) == len(found)
    return pattern, {
        (each.nodes, tuple(names[link] for link in each.links))
        for each in found
        if around.admits(pattern, each)
    }


def in_order(pattern, redex, matches):
    """Keep of (nodes, links) those whose twins are in order, links as the engine numbers them."""
    return {
        (nodes, tuple(links[link] for link in (*redex.outer_names, *range(redex.edges))))
        for nodes, links in matches
        if all(nodes[a] < nodes[b] for group in pattern.twins for a, b in pairwise(group))
    }


@given(solid_redexes(max_nodes=3), targets(max_nodes=6, max_edges=2))
def test_occurrences_are_those_of_the_naive_enumerator(redex, target):
    naive = [(match.nodes, dict(match.links)) for match in naive_matches(redex, target)]
    for sharing in (False, True):
        pattern, found = engine_matches(redex, target, sharing=sharing)
        assert found == in_order(pattern, redex, naive)


@st.composite
def redexes_in_places_of_their_own(draw):
    """Draw a redex and a target where its nodes are in no place but each other, as far as they can be."""
    redex = draw(solid_redexes(max_nodes=3, sharing=True))
    nodes = [
        replace(node, parents=tuple(place for place in node.parents if place >= 0) or (~0,))
        for node in redex.nodes
    ]
    return redex, assemble(SIGNATURE, nodes, edges=redex.edges, outer_names=redex.outer_names)


@settings(deadline=None)
@given(
    st.tuples(solid_redexes(max_nodes=2, sharing=True), targets(max_nodes=4, sharing=True))
    | redexes_in_places_of_their_own()
)
def test_occurrences_in_shared_places_are_those_of_the_naive_enumerator_and_of_the_reference(pair):
    redex, target = pair
    pattern, found = engine_matches(redex, target, sharing=True)
    naive = naive_matches(redex, target, sharing=True)
    assert found == in_order(pattern, redex, [(match.nodes, dict(match.links)) for match in naive])
    assert set(find_matches(redex, target)) == naive


@given(solid_redexes(max_nodes=5), grounds(max_nodes=12, max_edges=4, controls=PLAIN))
def test_occurrences_are_those_of_a_sat_solver(redex, target):
    sat_matching = pytest.importorskip("sat_matching", reason="python-sat is not installed")
    pattern, found = engine_matches(redex, target)
    models = [
        (nodes, dict(zip((*range(redex.edges), *redex.outer_names), links, strict=True)))
        for nodes, links in sat_matching.sat_matches(redex, target)
    ]
    assert found == in_order(pattern, redex, models)


@given(solid_redexes(max_nodes=3), targets(max_nodes=7), st.data())
def test_what_is_found_at_touched_nodes_is_what_has_one_of_them(redex, target, data):
    world = InternTables(SIGNATURE, target.outer_names, target.regions, sharing=False)
    matcher = Matcher(world, compile_pattern(world, redex))
    state = make_state(world, target)
    touched = data.draw(st.integers(0, (1 << len(target.nodes)) - 1))
    found = matcher.find_at(state, touched)
    assert len(set(found)) == len(found)
    assert set(found) == {each for each in matcher.find(state) if each.mask & touched}


@pytest.mark.parametrize(
    ("redex", "reason"),
    [
        (SLOT, "has no node to look for"),
        (ion(SIGNATURE, "A") // SLOT, "region 1 of it has no node"),
        (ion(SIGNATURE, "A") | SLOT, "site 1 of it is directly in a region"),
        (nest(ion(SIGNATURE, "A"), merge(2)), "sites 0 and 1 of it are side by side"),
    ],
)
def test_a_redex_that_is_not_solid_is_refused_with_its_reason(redex, reason):
    with pytest.raises(BigraphError, match=reason):
        check_solid(redex, "it")


def test_equal_empty_nodes_side_by_side_are_found_once():
    three = atom(SIGNATURE, "A") | atom(SIGNATURE, "A") | atom(SIGNATURE, "A")
    pair = close(atom(SIGNATURE, "B", ["x"]) | atom(SIGNATURE, "B", ["x"]), "x")
    assert len(engine_matches(atom(SIGNATURE, "A") | atom(SIGNATURE, "A"), three)[1]) == 3
    assert len(engine_matches(pair, pair | three)[1]) == 1
