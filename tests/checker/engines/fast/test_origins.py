"""Origins are told as they were noted, however they are kept."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.store.origins import BLOCK, WORD, Elsewhere, Rising, note_origin


@njit()
def note_all(origins, told):
    for number in range(1, len(told)):
        note_origin(origins, number, told[number])


def noted(kind, told):
    """Return the origins of a search, noted by a loop."""
    origins = kind(len(told))
    note_all(origins.loops, np.array(told))
    return origins


@st.composite
def searches(draw):
    """Draw the origins of a search: none decreases, and all but the first are of a row before."""
    found = [0]
    for leap in draw(st.lists(st.sampled_from((0, 0, 0, 1, 2, 100)), max_size=400)):
        found.append(min(found[-1] + leap, len(found) - 1))
    return found


@examples(60)
@given(searches())
def test_origins_are_told_as_they_were_noted(told):
    for kind in (Rising, Elsewhere):
        origins = noted(kind, told)
        assert origins.rows >= len(told)
        assert [origins.origin(number, len(told)) for number in range(len(told))] == told
        again = kind(len(told))
        again.restore(origins.kept(len(told)), len(told))
        assert [again.origin(number, len(told)) for number in range(len(told))] == told


def test_origins_are_told_while_more_are_noted():
    told = [0, *np.arange(20_000) // 3]
    origins = Rising(len(told))
    for size in (1, 2, 3 * BLOCK * WORD, len(told)):
        note_all(origins.loops, np.array(told[:size]))
        some = range(0, size, max(size // 100, 1))
        assert [origins.origin(number, size) for number in some] == [told[number] for number in some]


@examples(60)
@given(searches(), st.data())
def test_bits_that_no_search_has_set_are_refused(told, data):
    bits = noted(Rising, told).kept(len(told)).copy()
    at = data.draw(st.integers(0, WORD * len(bits) - 1))
    bits[at // WORD] ^= np.uint64(1 << at % WORD)
    with pytest.raises(ValueError, match="from a later one"):
        Rising(len(told)).restore(bits, len(told))
    with pytest.raises(ValueError, match="from a later one"):
        Rising(len(told)).restore(bits[1:], len(told))


def test_a_row_that_is_reached_from_itself_is_refused():
    bits = noted(Rising, [0, 0]).kept(2).copy()
    bits[0] = 0b101  # 1 is reached from 1
    with pytest.raises(ValueError, match="from a later one"):
        Rising(2).restore(bits, 2)


@pytest.mark.parametrize("kind", [Rising, Elsewhere])
def test_what_a_row_more_takes_is_what_all_take(kind):
    origins, rows = kind(1 << 24), 1 << 23
    assert origins.bytes_each * rows == pytest.approx(origins.held(rows), rel=0.01)
