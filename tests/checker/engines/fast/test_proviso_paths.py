"""The paths that loops keep against those of the reference."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.reduce.proviso_paths import BLOCK, WORD, SearchPaths, begin_row, end_of, lead_on
from checker.engines.fast.reduce.proviso_paths import intern as number_of
from checker.engines.fast.store.tree_compression import MOST
from checker.reduction import cycle_proviso

PARTS = 70
"""More than one word has bits."""


@njit()
def begin(trails, row):
    begin_row(trails, row)


@njit()
def intern(trails, taken):
    return number_of(trails.sets, taken, True)


@njit()
def lead(trails, row, to, taken):
    lead_on(trails, row, to, number_of(trails.sets, taken, True))


@njit()
def end(trails, row, taken):
    return end_of(trails, row, taken)


def words(parts):
    bits = sum(1 << part for part in parts)
    return np.array([bits & (1 << WORD) - 1, bits >> WORD], np.uint64)


@st.composite
def searches(draw):
    """Draw for each row where it leads on, if it does, with what is taken, and which paths are asked for before."""
    rows = draw(st.integers(2, 60))
    parts = st.frozensets(st.integers(0, PARTS - 1), max_size=3)
    leads = st.none() | st.tuples(st.integers(0, rows - 1), parts)
    return [(draw(leads), draw(st.lists(st.integers(0, rows - 1), max_size=3))) for _ in range(rows)]


def compared(search, apart, room):
    """Compare both, with rows that lie so many apart and room for all sets, or for none of paths made shorter."""
    known, kept = cycle_proviso.Paths(), SearchPaths(3, 2)
    kept.reserve(apart * len(search) + 1)
    if not room:
        for onward, _ in search:
            if onward is not None:
                intern(kept.trails(), words(onward[1]))
        kept.sets.interned.counts[MOST] = len(kept.sets)
    for number, (onward, asked) in enumerate(search):
        for row in range(apart * (number - 1) + 1 if number else 0, apart * number + 1):
            begin(kept.trails(), row)
        for row in asked:
            taken = np.zeros(2, np.uint64)
            found = end(kept.trails(), apart * row, taken)
            expected = known.end(row)
            assert (found, taken.tolist()) == (apart * expected.to, words(expected.taken).tolist())
        if onward is not None and known.end(onward[0]).to != number:  # it would close a cycle
            known.lead(number, *onward)
            lead(kept.trails(), apart * number, apart * onward[0], words(onward[1]))
    assert int(kept.count[0]) == len(known.leads)


@examples(150)
@given(searches(), st.sampled_from((1, 7, BLOCK * WORD + 1)), st.booleans())
def test_paths_end_where_those_of_the_reference_end(search, apart, room):
    compared(search, apart, room)


@pytest.mark.parametrize(("agents", "kind"), [(255, np.uint8), (256, np.uint16)])
def test_who_moved_last_takes_as_many_bytes_as_numbers_of_agents_need(agents, kind):
    kept = SearchPaths(agents, 1)
    kept.reserve(10)
    assert kept.trails().movers.dtype == kind
