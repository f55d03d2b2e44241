"""Rows and their origins have room for the same number, whatever happens to either."""

import errno
import os

import numpy as np
import pytest
from checked_missions import interrupted_at, load
from scale import IS_WHOLE

from checker import Engine, Keeping, Limits, explore
from checker.engines.fast import explorer
from checker.engines.fast.store.rows import Rows

HOPS = """signature { kind Location contains UAV  kind UAV driven }
world {
  p0: Location = box (37.02, -8.78) (37, -8.8)
  p1: Location = box (37.02, -8.74) (37, -8.76)
  p2: Location = box (37.02, -8.7) (37, -8.72)
  p3: Location = box (37.02, -8.66) (37, -8.68)
  p4: Location = box (37.02, -8.62) (37, -8.64)
"""
MOST = 168_717


def hops():
    """Return four UAVs that each hop twice among five places, and look around after each hop."""
    uavs = "".join(f"  u{i}: UAV = point (37.01, {-8.79 + 0.04 * i:.2f}) linked vhf\n" for i in range(4))
    text = ""
    for i in range(4):
        moves = (
            f"control(MOVE_HOST_TO p{(i + step) % 5}) observe(CHILDREN(PARENT(HOST))) react {{ case o => skip }}"
            for step in (1, 2)
        )
        text += f"BigActor a{i} hosted_at u{i} with_behavior {{ {' '.join(moves)} }}\n"
    return load(f"{text}control timed\n", f"{HOPS}{uavs}}}\n").initial


def test_rows_have_room_for_as_many_words_as_origins_however_they_grow():
    rows = Rows(1, 1024)
    rows.words[1023], rows.origins.room[1] = 7, 5
    rows.widen(3)
    assert rows.room == 1024
    assert len(rows.words) >= 3 * 1024
    rows.reserve(1025)
    assert rows.room >= 2048
    assert len(rows.words) >= 3 * rows.room
    assert rows.origins.rows >= rows.room
    assert (rows.words[1023], rows.origins.room[1]) == (7, 5)


def test_rows_that_find_no_room_stay_as_they_were(tmp_path, monkeypatch):
    rows = Rows(1, 1024)
    rows.spill(tmp_path, 0)

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    for grow in (lambda: rows.widen(2), lambda: rows.reserve(2048)):
        with pytest.raises(OSError, match="No space left"):
            grow()
        assert (rows.width, rows.room) == (1, 1024)


def test_pages_that_find_no_memory_keep_their_numbers():
    rows = Rows(1, 1024)
    rows.words[5] = 7
    with pytest.raises((OSError, MemoryError, OverflowError, ValueError)):
        rows.reserve(1 << 56)
    assert (rows.room, rows.words[5]) == (1024, 7)


@pytest.mark.parametrize("at", [1_500, 20_000] if IS_WHOLE else [1_500])
def test_what_is_resumed_has_room_for_rows_that_are_wider_than_at_first(tmp_path, monkeypatch, at):
    monkeypatch.setattr(explorer, "CHUNK", 64)
    limits, stop = interrupted_at(at, Limits())
    keeping = Keeping(str(tmp_path), digest="hops")
    cut = explore(hops(), (), limits, stop, 0.0, Engine.FAST, keeping=keeping)
    assert list(map(str, cut.bounds)) == ["an interruption"]
    assert at <= len(cut.configurations) < MOST
    resumed = explore(hops(), engine=Engine.FAST, keeping=Keeping(str(tmp_path), True, "hops"))
    store = resumed.survey.search.store
    assert (len(resumed.configurations), resumed.transitions) == (MOST, 776_753)
    assert store.rows.width == store.packing.words == 2
    assert store.rows.room >= MOST
    assert len(store.rows.words) >= 2 * store.rows.room
    origins = np.array(resumed.origins)
    assert np.all(origins[1:] < np.arange(1, store.size))


def test_a_batch_has_room_for_what_every_agent_does():
    world = "signature { kind Location }\nworld { p0: Location = box (37.02, -8.78) (37, -8.8) }\n"
    agents = (f"BigActor a{k} hosted_at p0 with_behavior {{ let x = {k} }}\n" for k in range(257))
    found = explore(load("".join(agents), world).initial, engine=Engine.FAST, limits=Limits(configurations=2))
    assert len(found.configurations) == 2
    assert len(found.survey.search.expander.batch.leaves) == 2 * 257
