"""Canonical keys against the algebra's exact equality."""

from dataclasses import replace

from bigraph_strategies import ALIKE_TO_REFINEMENT, SIGNATURE, cycle, from_graph, grounds, shuffled
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.algebra import atom, close, ion, lean, merge, nest
from bigraphs.bigraph import assemble, normal
from bigraphs.canonical_form import equal
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.labelling import Labelling
from bigraphs.engine.state_arrays import make_state

SMALL = grounds(max_nodes=5, max_edges=3, controls=("A", "B", "U"), names=("x",), sharing=True)


def keys(*bigraphs):
    """Return the canonical keys of bigraphs with one outer face, in one world."""
    first = bigraphs[0]
    world = InternTables(first.signature, first.outer_names, first.regions, sharing=True)
    labelling = Labelling(world)
    return [labelling.canonical(make_state(world, each)) for each in bigraphs]


@given(grounds(max_nodes=8, max_edges=4, sharing=True).flatmap(lambda b: st.tuples(st.just(b), shuffled(b))))
def test_a_key_does_not_depend_on_the_order_of_nodes(pair):
    one, other = keys(*map(lean, pair))
    assert one == other


@given(SMALL.map(lean), SMALL.map(lean))
def test_keys_are_equal_exactly_where_bigraphs_are(one, other):
    if one.outer == other.outer:
        first, second = keys(one, other)
        assert (first == second) == equal(one, other)


@given(SMALL.map(lean).filter(lambda b: len(b.nodes) > 1), st.data())
def test_keys_tell_apart_what_differs_in_one_node(one, data):
    number = data.draw(st.integers(0, len(one.nodes) - 1))
    node = one.nodes[number]
    links = [*range(one.edges), *one.outer_names]
    ports = tuple(data.draw(st.sampled_from(links)) for _ in node.ports)
    nodes = [replace(each, ports=ports) if each is node else each for each in one.nodes]
    other = assemble(SIGNATURE, nodes, edges=one.edges, outer_names=one.outer_names, regions=one.regions)
    other = lean(data.draw(shuffled(other)))
    first, second = keys(one, other)
    assert (first == second) == equal(one, other)


def test_regular_graphs_that_refinement_cannot_tell_apart_are_told_apart():
    for pair in ALIKE_TO_REFINEMENT:
        one, other = keys(*map(from_graph, pair))
        assert one != other


def test_large_symmetric_states_have_keys_quickly():
    block = close(nest(ion(SIGNATURE, "A"), atom(SIGNATURE, "B", ["x"]) | atom(SIGNATURE, "B", ["x"])), "x")
    blocks = merge(0)
    for _ in range(12):
        blocks = blocks | block
    one, other = keys(blocks, normal(blocks, list(range(len(blocks.nodes) - 1, -1, -1))))
    assert one == other
    ring = from_graph(cycle(24))
    one, other = keys(ring, normal(ring, list(range(23, -1, -1))))
    assert one == other
