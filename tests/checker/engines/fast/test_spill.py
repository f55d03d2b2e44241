"""Rows in files when memory ends: the same report, and nothing left in the folder."""

import errno
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import checker.engines.fast.explorer
import checker.limits
from checker import Engine, Limits, check, explore
from checker.engines.fast.mapped_arrays import Pages
from checker.limits import memory_taken
from specs.elaboration import load_mission

MISSIONS = Path(__file__).parents[4] / "specs" / "missions"
MEGABYTE = 1_000_000

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory is told of by /proc")


class Memory:
    """What the process is said to take: what anonymous pages would, as if each were a megabyte."""

    def __init__(self, monkeypatch, tmp_path):
        self.in_files = False
        monkeypatch.setattr(checker.limits, "memory_taken", lambda: (1 if self.in_files else 3) * MEGABYTE)
        spill = Pages.spill

        def noted(pages, folder, used):
            self.in_files = True
            assert folder == tmp_path
            spill(pages, folder, used)

        monkeypatch.setattr(Pages, "spill", noted)


def told(report):
    return (
        report.configurations,
        report.transitions,
        report.depth,
        report.rules,
        report.verdicts,
        report.coverage,
    )


def test_with_files_an_exploration_comes_to_the_same_report(tmp_path, monkeypatch):
    mission = load_mission(MISSIONS / "takeover.mission")
    whole = check(mission.initial, mission.properties, engine=Engine.FAST)
    memory = Memory(monkeypatch, tmp_path)
    monkeypatch.setattr(checker.engines.fast.explorer, "CHUNK", 32)
    limits = Limits(memory=2 * MEGABYTE)
    assert not check(mission.initial, mission.properties, limits, engine=Engine.FAST).complete
    limits = Limits(memory=2 * MEGABYTE, spill=str(tmp_path))
    spilled = check(mission.initial, mission.properties, limits)
    assert memory.in_files
    assert spilled.complete
    assert told(spilled) == told(whole)
    assert list(tmp_path.iterdir()) == []


def test_what_files_do_not_help_is_incomplete(tmp_path):
    initial = load_mission(MISSIONS / "rendezvous.mission").initial
    found = explore(initial, engine=Engine.FAST, limits=Limits(memory=1, spill=str(tmp_path)))
    assert list(map(str, found.bounds)) == ["the memory limit of 0 MB"]


def test_the_end_of_the_room_is_a_bound(tmp_path, monkeypatch):
    Memory(monkeypatch, tmp_path)

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    initial = load_mission(MISSIONS / "rendezvous.mission").initial
    found = explore(initial, engine=Engine.FAST, limits=Limits(memory=2 * MEGABYTE, spill=str(tmp_path)))
    assert list(map(str, found.bounds)) == [f"the end of the room in {tmp_path}: No space left on device"]
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
