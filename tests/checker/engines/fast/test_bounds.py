"""The compiled loops where no index may leave its array: `make bounds` compiles them with checks of bounds.

Rooms are made small, so that they grow in small missions, and every search is cut at many sizes and gone on with.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from checked_missions import interrupted_at
from local_crew import LocalCrew
from shipped import UNTIMED

import checker.limits
from checker import Engine, Keeping, Limits, check, explore
from checker.engines.cluster import explorer as cluster
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Options
from checker.engines.fast import explorer
from checker.engines.fast.model import learned_model
from checker.engines.fast.search import expander, frontier_chunks
from checker.engines.fast.store import row_store, tree_compression
from checker.engines.fast.store.rows import Rows
from checker.reduction import Reduced, Reduction
from semantics import Scheduler
from semantics.races.monitor import monitored
from specs.elaboration import Variation, load_mission

ROOT = Path(__file__).parents[4]
LIMITS = Limits(configurations=3_000)
FEW = 12
"""Below so many configurations every size is cut at; then each that is a third larger."""

IS_CHECKED = os.environ.get("NUMBA_BOUNDSCHECK") == "1"


def checked(test):
    """Mark a test that runs where the loops are compiled with checks."""
    return pytest.mark.bounds(pytest.mark.skipif(not IS_CHECKED, reason="a long run: `make bounds`")(test))


def of_each_mission(test):
    return checked(pytest.mark.parametrize("name", UNTIMED)(test))


@pytest.fixture(autouse=True)
def small_rooms(monkeypatch):
    """Let rooms grow, batches be too small for a row, and the clock be looked at after every other row."""
    monkeypatch.setattr(row_store, "FIRST_ROWS", 8)
    monkeypatch.setattr(expander, "BATCH", 8)
    monkeypatch.setattr(frontier_chunks, "WORTH", 4)
    monkeypatch.setattr(explorer, "CHUNK", 2)


def sizes(most):
    """Return the sizes at which a search is cut."""
    size = 1
    while size < most:
        yield size
        size = size + 1 if size < FEW else size * 4 // 3


def seen(found):
    return (len(found.configurations), list(map(int, found.origins)), found.depth, found.rules, found.bounds)


def fast(initial, **options):
    return explore(initial, engine=Engine.FAST, **{"limits": LIMITS, **options})


def reduced(mission):
    formulas = [each.formula for each in mission.properties if each.kind in {"invariant", "reachable"}]
    return Reduced(mission.initial, [Reduction.POR], formulas)


def goes_on_from_every_size(initial, folder):
    whole = seen(fast(initial))
    for size in sizes(whole[0]):
        limits, stop = interrupted_at(size, LIMITS)
        fast(initial, limits=limits, keeping=Keeping(str(folder), digest="d"), report=stop, every=0.0)
        resumed = fast(initial, keeping=Keeping(str(folder), True, "d"))
        assert seen(resumed) == whole, f"cut at {size}"


def initials(name):
    """Yield a mission's first configuration under each scheduler, and as races are looked for."""
    for scheduler in Scheduler:
        yield load_mission(name, Variation(scheduler=scheduler)).initial
    yield monitored(load_mission(name).initial)


@checked
def test_the_loops_are_compiled_with_checks_of_bounds():
    with pytest.raises(IndexError):
        learned_model.first_turn(*(np.zeros(0, np.int32) for _ in range(2)), np.zeros(1, np.int32), 1)


@of_each_mission
def test_searches_go_on_from_every_size(tmp_path, name):
    for number, initial in enumerate(initials(name)):
        goes_on_from_every_size(initial, tmp_path / str(number))


@of_each_mission
@pytest.mark.parametrize("shallow", [8, 1], ids=["once", "twice"])
def test_searches_of_folded_rows_go_on_from_every_size(tmp_path, monkeypatch, name, shallow):
    monkeypatch.setattr(row_store, "PLAIN", 1)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 0)
    monkeypatch.setattr(tree_compression, "FIRST", 4)
    monkeypatch.setattr(tree_compression, "SHALLOW", shallow)
    mission = load_mission(name)
    goes_on_from_every_size(mission.initial, tmp_path)
    assert seen(fast(mission.initial, threads=3)) == seen(fast(mission.initial))
    fast(mission.initial, reduce=reduced(mission))


@of_each_mission
def test_searches_stop_at_every_limit_of_configurations(name):
    initial = load_mission(name).initial
    for size in sizes(len(fast(initial).configurations)):
        assert len(fast(initial, limits=Limits(configurations=size)).configurations) == size


@of_each_mission
def test_searches_spill_at_every_size(tmp_path, monkeypatch, name):
    initial = load_mission(name).initial
    whole = seen(fast(initial))
    spill, spilled = Rows.spill, []

    def noted(rows, folder, used):
        spill(rows, folder, used)
        spilled.append(used)

    monkeypatch.setattr(Rows, "spill", noted)
    monkeypatch.setattr(checker.limits, "memory_taken", lambda: 2 if full() else 0)
    for size in sizes(whole[0]):
        reached, spilled[:] = [0], []

        def full(size=size, reached=reached):
            return reached[0] >= size and not spilled

        def note(progress, reached=reached):
            reached[0] = progress.configurations

        limits = Limits(configurations=LIMITS.configurations, memory=1, spill=str(tmp_path))
        found = fast(initial, limits=limits, report=note, every=0.0)
        assert seen(found) == whole, f"spilled at {size}"


@of_each_mission
def test_searches_end_at_every_limit_of_memory(monkeypatch, name):
    initial = load_mission(name).initial
    for size in sizes(len(fast(initial).configurations)):
        reached = [0]
        monkeypatch.setattr(checker.limits, "memory_taken", lambda reached=reached: reached[0])

        def note(progress, reached=reached):
            reached[0] = progress.configurations

        limits = Limits(configurations=LIMITS.configurations, memory=size)
        found = fast(initial, limits=limits, report=note, every=0.0)
        assert len(found.configurations) >= size


@of_each_mission
def test_all_that_is_decided_and_reduced_stays_within_bounds(name):
    mission = load_mission(name)
    wide = check(mission, limits=LIMITS, engine=Engine.FAST)
    reference = check(mission, limits=LIMITS, engine=Engine.REFERENCE)
    assert [each.outcome for each in wide.verdicts] == [each.outcome for each in reference.verdicts]
    found = fast(mission.initial, reduce=reduced(mission))
    assert 1 <= len(found.configurations) <= len(fast(mission.initial).configurations)


@of_each_mission
def test_workers_go_on_from_every_round(tmp_path, monkeypatch, name):
    monkeypatch.setattr(cluster, "ROUND", 7)
    initial = load_mission(name).initial
    whole = Expedition(LocalCrew(initial, 2), initial, Options(LIMITS)).run(())
    for size in sizes(len(whole.configurations)):
        folder = str(tmp_path / str(size))
        crew = LocalCrew(initial, 2)
        keeping = Keeping(folder, every=0.0)
        limits, stop = interrupted_at(size, LIMITS)
        Expedition(crew, initial, Options(limits, stop, 0.0, keeping=keeping)).run(())
        options = Options(LIMITS, keeping=Keeping(folder, True))
        again = Expedition(LocalCrew(initial, 2), initial, options).run(())
        assert len(again.configurations) == len(whole.configurations)
        assert again.transitions == whole.transitions


@pytest.mark.long
def test_a_small_mission_goes_on_from_every_size_within_bounds():
    """The small part of `make bounds` that every run of the tests has."""
    environment = {**os.environ, "NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": ".numba-bounds"}
    chosen = "compiled_with or (go_on_from_every_size and two_gates)"
    line = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        __file__,
        "-m",
        "bounds",
        "-k",
        chosen,
    ]
    ran = subprocess.run(
        line, check=False, env=environment, cwd=ROOT, capture_output=True, text=True, timeout=600
    )
    assert ran.returncode == 0, ran.stdout
    assert "passed" in ran.stdout
    assert "skipped" not in ran.stdout
