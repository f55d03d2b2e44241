"""Rows in files when memory ends: what bounds them, and what they take (the same reports: `pairs`)."""

import errno
import os
import sys

import numpy as np
import pytest

import checker.limits
from bigraphs.resources import memory_taken
from checker import Engine, Limits, explore
from checker.engines.fast.compiled.mapped_arrays import Pages
from specs.elaboration import load_mission

MEGABYTE = 1_000_000

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is told of by /proc")


def test_what_files_do_not_help_and_the_end_of_the_room_are_bounds(tmp_path, monkeypatch):
    initial = load_mission("rendezvous").initial
    found = explore(initial, engine=Engine.FAST, limits=Limits(memory=1, spill=str(tmp_path)))
    assert list(map(str, found.bounds)) == ["the memory limit of 0 MB"]
    monkeypatch.setattr(checker.limits, "memory_taken", lambda: 3 * MEGABYTE)

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    found = explore(initial, engine=Engine.FAST, limits=Limits(memory=2 * MEGABYTE, spill=str(tmp_path)))
    assert list(map(str, found.bounds)) == [
        f"the end of the free space in {tmp_path}: No space left on device"
    ]
    assert found.expanded < 18_051


def test_pages_keep_their_numbers_in_a_file_and_grow_there(tmp_path):
    pages = Pages(np.uint32, 1_000)
    pages.room[:1_000] = np.arange(1_000)
    pages.spill(tmp_path, 1_000)
    pages.grow(5_000_000)
    pages.room[4_999_999] = 7
    assert pages.spilled
    assert pages.room[:1_000].tolist() == list(range(1_000))
    assert not pages.room[1_000:4_999_999].any()
    assert list(tmp_path.iterdir()) == []


@linux
def test_what_is_in_files_is_not_counted_as_memory(tmp_path):
    before = memory_taken()
    pages = Pages(np.uint64, 8_000_000)
    pages.room[:] = 1
    assert memory_taken() > before + 50 * MEGABYTE
    pages.spill(tmp_path, 8_000_000)
    assert memory_taken() < before + 30 * MEGABYTE
    assert int(pages.room.sum()) == 8_000_000
