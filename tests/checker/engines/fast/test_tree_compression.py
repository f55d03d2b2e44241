"""Folded rows against the rows themselves: what is kept of two is equal exactly if they are."""

import numpy as np
import pytest
from checked_missions import visited
from hypothesis import given
from hypothesis import strategies as st
from scale import examples
from shipped import UNTIMED

from checker import Engine, Limits, explore
from checker.engines.fast.store import row_store, tree_compression
from checker.engines.fast.store.origins import Rising
from checker.engines.fast.store.rows import Rows
from specs.elaboration import load_mission

WORDS = st.integers(0, 2**64 - 1) | st.integers(0, 3)


@st.composite
def rows(draw):
    """Draw rows of as many words each, most of which differ from another in a few."""
    width = draw(st.integers(2, 40))
    first = draw(st.lists(WORDS, min_size=width, max_size=width))
    found = [first]
    for _ in range(draw(st.integers(0, 30))):
        row = list(draw(st.sampled_from(found)))
        for at in draw(st.lists(st.integers(0, width - 1), max_size=3)):
            row[at] = draw(WORDS)
        found.append(row)
    return np.array(found, np.uint64)


def folded(whole):
    """Return a folding, and what is kept of each row in it."""
    into = tree_compression.Folding(whole.shape[1])
    kept = np.zeros(tree_compression.PAIR * len(whole), np.uint64)
    done = 0
    while (done := tree_compression.fold_rows(into.folded, whole.ravel(), into.width, kept, done)) < len(
        whole
    ):
        into.reserve()
    return into, kept


@examples(60)
@given(rows())
def test_what_is_kept_is_equal_exactly_where_rows_are_and_unfolds_to_them_in_any_order(whole):
    into, kept = folded(whole)
    pairs = kept.reshape(-1, tree_compression.PAIR)
    assert len(np.unique(pairs, axis=0)) == len(np.unique(whole, axis=0))
    words = np.zeros(whole.size, np.uint64)
    for order in (np.arange(len(whole)), np.arange(len(whole))[::-1]):
        tree_compression.unfold_rows(into.folded, pairs[order].ravel(), into.width, words)
        assert np.array_equal(words.reshape(whole.shape), whole[order])


@examples(60)
@given(rows())
def test_rows_that_are_kept_elsewhere_are_taken_or_refused(whole):
    into, kept = folded(whole)
    size, interned = len(whole), (into.pieces.words, into.nodes.words)
    origins = Rising(size).kept(size).copy()
    for k in range(size):  # all are reached from the first
        origins[k // 64] |= np.uint64(1 << k % 64)
    again = Rows.of(Rising, into.width, size, kept, origins, *interned)
    assert [again.row(k).tolist() for k in range(len(whole))] == whole.tolist()
    broken = kept.copy()
    broken[-1] |= np.uint64(0xFFFF)  # there are not so many pieces or nodes
    twice = tuple(np.concatenate((each, each)) for each in interned)
    for numbers, told in ((broken, interned), (kept, twice), (kept[1:], interned)):
        with pytest.raises(ValueError, match="other rows"):
            Rows.of(Rising, into.width, size, numbers, origins, *told)


def test_many_pieces_and_nodes_find_room():
    random = np.random.default_rng(1)
    whole = random.integers(0, 2**63, (5_000, 44), np.uint64)
    into, kept = folded(whole)
    assert len(into.pieces) > 10 * 5_000
    words = np.zeros(whole.size, np.uint64)
    tree_compression.unfold_rows(into.folded, kept, into.width, words)
    assert np.array_equal(words.reshape(whole.shape), whole)


@pytest.mark.parametrize("name", UNTIMED)
def test_missions_whose_rows_are_all_folded_explore_as_before(name, monkeypatch):
    initial, limits = load_mission(name).initial, Limits(configurations=600)
    plain = explore(initial, limits=limits, engine=Engine.FAST)
    monkeypatch.setattr(row_store, "PLAIN", 1)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 0)
    found = explore(initial, limits=limits, engine=Engine.FAST)
    assert visited(found) == visited(plain)
