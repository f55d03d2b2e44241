import sys

import numpy as np
import pytest

from bigraphs.resources import memory_taken
from checker.engines.fast.compiled.mapped_arrays import HUGE, Pages


def test_pages_grow_in_place_and_keep_what_was_written():
    pages = Pages(np.uint64, 1000)
    pages.room[999] = 7
    pages.grow(1_000_000)
    assert (pages.room[999], pages.room[999_999]) == (7, 0)


def test_pages_on_which_somebody_still_holds_an_array_grow_all_the_same():
    pages = Pages(np.uint64, 1000)
    pages.room[999] = 7
    held = pages.room[:1000]
    pages.grow(1_000_000)
    pages.room[0] = 5
    assert (held[999], held[0]) == (7, 0)
    assert (pages.room[999], pages.room[0], pages.room[999_999]) == (7, 5, 0)


def test_pages_that_cannot_grow_stay_as_they_were():
    pages = Pages(np.uint64, 1000)
    pages.room[999] = 7
    with pytest.raises(OSError, match="Cannot allocate memory"):
        pages.grow(1 << 43)
    assert pages.room[999] == 7


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is told of by /proc")
def test_room_that_was_never_written_takes_no_memory():
    before = memory_taken()
    pages = Pages(np.uint64, 50_000_000)
    pages.room[:4_000_000] = 1
    assert 32_000_000 <= pages.held(4_000_000) < 32_000_000 + HUGE
    assert memory_taken() - before == pytest.approx(pages.held(4_000_000), abs=2 * HUGE)


def test_pages_hold_no_more_than_their_room():
    assert Pages(np.uint32, 1024).held(1) == 4096
