"""Timed searches that were cut go on, and those whose memory is full move to files: to the same configurations."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from checked_missions import interrupted_at
from scale import IS_WHOLE, crossed
from shipped import TIMED
from swarms import LOOKS, mission
from timed_missions import with_timing

import checker.limits
from checker import CheckpointError, Engine, Keeping, Limits, explore
from checker.engines.archive import read_archive, write_archive
from checker.engines.fast.store import row_store
from checker.engines.timed.original_times import OriginalTimes
from checker.engines.zones import explorer, timed_automaton_of, timed_checkpoint
from checker.reduction import Reduced, Reduction
from semantics.state.setting import Scheduler
from semantics.timing.intervals import Interval
from semantics.timing.timing import Motion, Timing
from specs.elaboration import load_mission

LIMITS = Limits(configurations=20_000)
CUTS = (3, 20, 60, 200) if IS_WHOLE else (3, 60)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    """Let a small search be cut in the middle, and its rooms grow."""
    monkeypatch.setattr(explorer, "CHUNK", 8)
    monkeypatch.setattr(timed_automaton_of, "MARGIN", 16)
    monkeypatch.setattr(timed_automaton_of.Network, "margin", 16)


LOCAL = [f"{name} under program_order" for name in ("relay_timed", "oil_spill_timed")]
"""Missions that are searched in local time."""


def searched(name, limits=LIMITS, **options):
    name, _, scheduler = name.partition(" under ")
    mission = load_mission(name)
    if scheduler:
        mission = mission.under(Scheduler(scheduler), mission.setting.control)
    return explore(mission.initial, engine=Engine.FAST, limits=limits, **options)


def seen(found):
    numbers = (found.depth, found.expanded, found.transitions, found.rules, found.bounds)
    zones = (found.times.shown if isinstance(found.times, OriginalTimes) else found.times).search
    matrices = [(place, matrix.tolist()) for place, matrix in zones]
    return list(found.configurations), list(map(int, found.origins)), numbers, matrices


def cut(name, folder, at):
    limits, stop = interrupted_at(at, LIMITS)
    return searched(name, limits, keeping=Keeping(folder, True, "d"), report=stop, every=0.0)


@cache
def whole_of(name):
    return seen(searched(name))


@crossed([*TIMED, *LOCAL], {"plain": False, "folded": True})
def test_what_was_cut_goes_on(tmp_path, monkeypatch, name, variation):
    whole = whole_of(name)
    if variation:
        monkeypatch.setattr(row_store, "PLAIN", 0)
        monkeypatch.setattr(row_store, "COMPRESSED_FROM", 5)
    for at in CUTS:
        found = cut(name, str(tmp_path), at)
        assert found.bounds or len(found.configurations) == len(whole[0])
    assert seen(searched(name, keeping=Keeping(str(tmp_path), True, "d"))) == whole
    assert seen(searched(name, keeping=Keeping(str(tmp_path), True, "d"))) == whole  # from its end


@pytest.mark.parametrize("name", [*TIMED, *LOCAL])
def test_what_fills_memory_goes_over_to_files(tmp_path, monkeypatch, name):
    whole, spill, moved = whole_of(name), timed_automaton_of.Network.spill, []

    def noted(network, folder):
        moved.append(network.size)
        spill(network, folder)

    monkeypatch.setattr(timed_automaton_of.Network, "spill", noted)
    monkeypatch.setattr(checker.limits, "memory_taken", lambda: 0 if moved else 2)
    assert seen(searched(name, Limits(configurations=20_000, memory=1, spill=str(tmp_path)))) == whole
    assert not moved or moved[0] < len(whole[0])
    assert moved or len(whole[3]) <= 8  # zones
    assert not list(tmp_path.iterdir())


def altered(folder, change):
    path = Path(folder) / "exploration.timed.checkpoint"
    head, arrays = read_archive(path, timed_checkpoint.SCHEMA, timed_checkpoint.KINDS)
    change(head, arrays)
    write_archive(path, head, timed_checkpoint.KINDS, list(arrays.values()))


def twice(_, arrays):
    arrays["left"] = np.concatenate((arrays["left"], arrays["left"][:1]))


def early(_, arrays):
    arrays["left"] = arrays["left"][::-1].copy()


def beyond(_, arrays):
    arrays["left"][0] = 1 << 40


def fewer(head, _):
    head["size"] -= 1


def other(_, arrays):
    arrays["rows"][-1] ^= np.uint64(1)


@pytest.mark.parametrize("change", [twice, early, beyond, fewer, other], ids=lambda each: each.__name__)
def test_a_checkpoint_that_was_altered_is_refused(change):
    with TemporaryDirectory() as folder:
        cut("handover_timed", folder, 60)
        altered(folder, change)
        with pytest.raises(CheckpointError, match="this checkpoint is damaged"):
            searched("handover_timed", keeping=Keeping(folder, True, "d"))


def test_a_checkpoint_of_another_mission_is_refused(tmp_path):
    cut("handover_timed", str(tmp_path), 60)
    with pytest.raises(CheckpointError, match="of another mission, variation, limit or version"):
        searched("handover_timed", keeping=Keeping(str(tmp_path), True, "e"))


# --- under symmetry ---------------------------------------------------------------------------------------------------

SPEEDS = tuple((f"robot{number}", Motion((40.0, 60.0))) for number in range(3))
ALIKE = with_timing(
    mission(LOOKS, 3, "control timed\nscheduler fcfs").initial, Timing(60_000, SPEEDS, (), Interval(0, 1))
)


def reduced(limits=LIMITS, **options):
    return explore(
        ALIKE, engine=Engine.FAST, limits=limits, reduce=Reduced(ALIKE, [Reduction.SYMMETRY]), **options
    )


def cut_reduced(folder, at):
    limits, stop = interrupted_at(at, LIMITS)
    return reduced(limits, keeping=Keeping(folder, True, "d"), report=stop, every=0.0)


@pytest.mark.parametrize(
    "folded", [False, pytest.param(True, marks=pytest.mark.long)], ids=["plain", "folded"]
)
def test_a_search_of_representatives_that_was_cut_goes_on(tmp_path, monkeypatch, folded):
    whole = seen(reduced())
    if folded:
        monkeypatch.setattr(row_store, "PLAIN", 0)
        monkeypatch.setattr(row_store, "COMPRESSED_FROM", 5)
    for at in CUTS:
        assert cut_reduced(str(tmp_path), at).bounds
    kept = Keeping(str(tmp_path), True, "d")
    assert seen(reduced(keeping=kept)) == whole
    with pytest.raises(CheckpointError, match="of another mission, variation, limit or version"):
        explore(ALIKE, engine=Engine.FAST, limits=LIMITS, keeping=kept)


def test_a_search_of_representatives_that_fills_memory_goes_over_to_files(tmp_path, monkeypatch):
    whole, spill, moved = seen(reduced()), timed_automaton_of.Network.spill, []

    def noted(network, folder):
        moved.append(network.size)
        spill(network, folder)

    monkeypatch.setattr(timed_automaton_of.Network, "spill", noted)
    monkeypatch.setattr(checker.limits, "memory_taken", lambda: 0 if moved else 2)
    assert seen(reduced(Limits(configurations=20_000, memory=1, spill=str(tmp_path)))) == whole
    assert moved
    assert moved[0] < len(whole[0])
