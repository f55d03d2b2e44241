"""Strongly connected components, beside networkx's and scipy's."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from checker.engines import strong_components as module
from checker.engines.strong_components import strong_components
from checker.properties.temporal.digraph import rows_of


@st.composite
def graphs(draw):
    size = draw(st.integers(1, 12))
    node = st.integers(0, size - 1)
    edges = sorted(draw(st.lists(st.tuples(node, node), max_size=40)))
    sources, targets = (np.array([each[k] for each in edges], np.int64) for k in (0, 1))
    return rows_of(sources, targets, size)


def grouped(of):
    """Return the nodes of each component."""
    return {frozenset(np.flatnonzero(of == number).tolist()) for number in set(of.tolist())}


@given(graphs(), st.sampled_from([0, 1 << 30]))
def test_components_are_those_of_networkx(graph, compiled_from):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "COMPILED_FROM", compiled_from)
        count, of = strong_components(graph.starts, graph.targets)
    other = nx.DiGraph(zip(graph.sources.tolist(), graph.targets.tolist(), strict=True))
    other.add_nodes_from(range(len(graph.starts) - 1))
    assert grouped(of) == set(map(frozenset, nx.strongly_connected_components(other)))
    assert count == len(grouped(of))
    assert all(of[graph.targets] <= of[graph.sources])


def test_a_long_path_and_a_long_loop_are_divided():
    size = 200_000
    path = rows_of(np.arange(size - 1), np.arange(1, size), size)
    assert strong_components(path.starts, path.targets)[0] == size
    loop = rows_of(np.arange(size), (np.arange(size) + 1) % size, size)
    assert strong_components(loop.starts, loop.targets)[0] == 1


def test_large_components_are_those_of_scipy():
    random = np.random.default_rng(7)
    size, count = 100_000, 130_000
    sources, targets = np.sort(random.integers(0, size, count)), random.integers(0, size, count)
    graph = rows_of(sources, targets, size)
    matrix = csr_matrix((np.ones(count, np.int8), targets, graph.starts), shape=(size, size))
    expected, of = connected_components(matrix, directed=True, connection="strong")
    found = strong_components(graph.starts, graph.targets)
    assert found[0] == expected
    assert len(set(zip(of.tolist(), found[1].tolist(), strict=True))) == expected
