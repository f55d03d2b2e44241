from dataclasses import replace
from itertools import permutations

from bigraph_strategies import ALIKE_TO_REFINEMENT, SIGNATURE, bigraphs, cycle, from_graph, shuffled
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import atom, close, ion, merge, nest
from bigraphs.bigraph import Node, assemble, normal
from bigraphs.canonical_form import canonical, equal
from bigraphs.interface import Interface
from bigraphs.relational_bigraphs import from_relations

SMALL = bigraphs(Interface(), Interface(1, ("x",)), max_nodes=5, max_edges=3, controls=("A", "C", "U"))


def isomorphic(one, other):
    """Try every order of anonymous nodes."""
    named = [number for number, node in enumerate(one.nodes) if node.name is not None]
    anonymous = [number for number, node in enumerate(one.nodes) if node.name is None]
    return any(normal(one, [*named, *order]) == other for order in permutations(anonymous))


@given(bigraphs(max_nodes=7, max_edges=3, sharing=True).flatmap(lambda b: st.tuples(st.just(b), shuffled(b))))
def test_the_canonical_form_does_not_depend_on_the_order_of_nodes(pair):
    one, other = pair
    assert canonical(one) == canonical(other)
    assert isomorphic(canonical(one), one) if len(one.nodes) < 6 else True


@given(SMALL, SMALL)
def test_canonical_forms_agree_exactly_where_brute_force_finds_an_isomorphism(one, other):
    assert (canonical(one) == canonical(other)) == isomorphic(one, other)


@given(SMALL.filter(lambda b: len(b.nodes) > 1), st.data())
def test_bigraphs_that_differ_in_one_port_are_told_apart_as_by_brute_force(one, data):
    number = data.draw(st.integers(0, len(one.nodes) - 1))
    node = one.nodes[number]
    links = [*range(one.edges), *one.outer_names]
    ports = tuple(data.draw(st.sampled_from(links)) for _ in node.ports)
    nodes = [
        replace(node, ports=ports) if place == number else other for place, other in enumerate(one.nodes)
    ]
    other = data.draw(
        shuffled(
            assemble(SIGNATURE, nodes, edges=one.edges, outer_names=one.outer_names, regions=one.regions)
        )
    )
    assert equal(one, other) == isomorphic(one, other)


def test_regular_graphs_that_refinement_cannot_tell_apart_are_told_apart():
    assert not any(equal(*map(from_graph, pair)) for pair in ALIKE_TO_REFINEMENT)


def test_large_symmetric_bigraphs_are_canonical_quickly():
    leaves = assemble(SIGNATURE, [Node("A")] * 200)
    assert canonical(leaves) == leaves
    block = close(nest(ion(SIGNATURE, "A"), atom(SIGNATURE, "B", ["x"]) | atom(SIGNATURE, "B", ["x"])), "x")
    blocks = merge(0)
    for _ in range(12):
        blocks = blocks | block
    assert len(canonical(blocks).nodes) == 36
    ring = from_graph(cycle(24))
    assert canonical(ring) == canonical(normal(ring, list(range(23, -1, -1))))


def test_a_bigraph_of_named_nodes_is_its_own_canonical_form():
    named = from_relations({"a": "K", "b": "K"}, {"a": "b"}, {"net": ["a", "b"]})
    assert canonical(named) is named


def test_names_are_not_renamed():
    one = from_relations({"a": "K", "b": "K"}, {"a": "b"}, {})
    other = from_relations({"a": "K", "b": "K"}, {"b": "a"}, {})
    assert not equal(one, other)
