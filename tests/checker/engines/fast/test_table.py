"""The visited set finds every row again, whatever its size, and takes little room."""

import numpy as np
import pytest

from checker import Limits
from checker.engines.fast.compiled.table import (
    ENTERED,
    alone,
    bits_for,
    find,
    hashed,
    most_in,
    rebuild,
    slots_for,
)
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search import expander
from checker.engines.fast.search.row_search import RowSearch
from specs.elaboration import load_mission

WIDTH = 2


def rows(count, seed=0):
    return np.random.default_rng(seed).integers(0, 1 << 63, WIDTH * count, dtype=np.uint64)


def one_by_one(work, parts):
    """Do some work part by part, the last first, as threads might."""
    return [work(range(part, part + 1)) for part in reversed(range(parts))]


def found(words, table, target, k):
    mixed = np.uint64(hashed(target, WIDTH * k, WIDTH))
    return find(words, table, target, k, mixed, WIDTH, np.uint32(bits_for(len(table))))


@pytest.mark.parametrize("count", [1, 1000, ENTERED, ENTERED + 1])
def test_a_table_that_is_filled_finds_each_row_and_no_other(count):
    words, others = rows(count), rows(count, seed=1)
    slots = next(slots for slots in range(count, 3 * count) if most_in(slots) >= count)
    table = np.zeros(slots, np.uint32)
    rebuild(words, count, WIDTH, table, alone)
    assert np.count_nonzero(table) == count
    some = range(0, count, max(count // 1000, 1))
    assert [found(words, table, words, k) for k in some] == list(some)
    assert all(table[-found(words, table, others, k) - 1] == 0 for k in some)


def test_a_table_is_filled_alike_whoever_fills_its_parts():
    count = 20_000
    words, slots = rows(count), count * 3 // 2
    tables = [np.zeros(slots, np.uint32) for _ in range(2)]
    for table, share in zip(tables, (alone, one_by_one), strict=True):
        rebuild(words, count, WIDTH, table, share)
    assert np.array_equal(*tables)
    assert np.count_nonzero(tables[0]) == count


def test_a_table_takes_at_most_nine_bytes_a_row_each_time_when_it_grows():
    rows = 1_000_000
    for _ in range(12):
        slots = slots_for(rows)
        assert 4 * slots <= 9 * rows
        assert most_in(slots) >= 1.49 * rows
        rows = most_in(slots) + 1


@pytest.mark.parametrize("budget", range(100_000, 310_000, 30_000))
def test_a_table_grows_by_less_where_memory_ends_so_that_rows_have_it(budget, monkeypatch):
    monkeypatch.setattr(expander, "BATCH", 256)
    initial = load_mission("rendezvous").initial
    search = RowSearch(Learner(initial.setting, initial.state, Limits().pending), None)
    store = search.store
    row = 8 * store.packing.words + 4
    store.left = lambda: budget - row * store.size - store.table.room.nbytes
    while store.left() >= 0:
        assert search.expanded < search.size
        search.advance(min(search.expanded + 16, search.size), search.size)
    fullest = budget / (row + 4 * 3 / 2)
    assert search.size > 0.93 * fullest
