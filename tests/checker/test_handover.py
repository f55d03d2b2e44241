"""The change from the reference engine to the fast one."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from checker import Engine, check, handover
from checker.handover import Compilation, Handover
from checker.limits import Limits, Stop
from checker.reduction.refusals import Reduction
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[2]

COLD = """
import time
from checker.handover import Compilation, Handover
from specs.elaboration import load_mission

mission = load_mission("go_ahead")
compilation = Compilation(mission.initial, mission.properties, (), 1, False, False)
assert not compilation.is_done()
with Handover(0.0, compilation) as change:
    assert not change.is_due()
    assert change.is_waiting
    while not change.is_due():
        time.sleep(0.1)
    assert change.uncounted.seconds > 1.0
assert compilation.is_done()
print("compiled")
"""


def job(mission: str = "go_ahead", *reductions: Reduction) -> Compilation:
    loaded = load_mission(mission)
    return Compilation(loaded.initial, loaded.properties, reductions, 1, times=False, ways=False)


@pytest.mark.parametrize(
    "known",
    [job(), job("oil_spill_timed"), job("go_ahead", Reduction.POR)],
    ids=["untimed", "timed", "reduced"],
)
def test_compiled_loops_take_over_at_once(known):
    check(
        known.initial,
        known.properties,
        Limits(configurations=50),
        engine=Engine.FAST,
        reduce=known.reductions,
    )
    with Handover(0.0, known) as change:
        assert change.is_due()
        assert not change.is_waiting


def test_nothing_takes_over_before_its_time():
    with Handover(3_600.0, job()) as change:
        assert not change.is_due()


def test_a_single_core_compiles_in_this_process(monkeypatch):
    monkeypatch.setattr(handover, "_has_cores", lambda: False)
    monkeypatch.setattr(Compilation, "is_done", lambda _: False)
    with Handover(0.0, job()) as change:
        assert change.is_due()
        assert not change.is_waiting


def test_a_compilation_that_cannot_begin_does_not_hold_the_check_up(monkeypatch):
    monkeypatch.setattr(Compilation, "is_done", lambda _: False)
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    with Handover(0.0, job()) as change:
        assert change.is_due()


def test_a_check_that_cannot_be_sent_is_compiled_in_this_process(monkeypatch):
    monkeypatch.setattr(Compilation, "is_done", lambda _: False)
    with Handover(0.0, job()._replace(properties=(lambda: None,))) as change:
        assert change.is_due()
        assert not change.is_waiting


def test_the_reference_engine_goes_on_while_loops_are_compiled(monkeypatch):
    monkeypatch.setattr(Compilation, "is_done", lambda _: False)
    mission = load_mission("go_ahead")
    monkeypatch.setattr(sys.modules["checker.check"], "PATIENCE", 0.0)
    decided = check(mission, limits=Limits(seconds=60.0))
    alone = check(mission, engine=Engine.REFERENCE)
    assert decided.complete
    assert Stop.OVERTAKEN not in {bound.stop for bound in decided.bounds}
    assert [(each.outcome, each.note) for each in decided.verdicts] == [
        (each.outcome, each.note) for each in alone.verdicts
    ]


def test_loading_the_loops_counts_towards_no_limit(monkeypatch):
    monkeypatch.setattr(Compilation, "is_done", lambda _: not time.sleep(0.5))
    with Handover(0.0, job()) as change:
        assert change.is_due()
        assert change.uncounted.seconds >= 0.5


@pytest.mark.long
def test_a_check_without_compiled_loops_decides_within_its_limit(tmp_path):
    """See the hook of pre-commit, after an installation, on one core and on all."""
    for cores in ({0}, os.sched_getaffinity(0)):
        env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / str(len(cores))), "PYTHONPATH": str(ROOT)}
        words = ("check", "--no-traces", "--max-time", "60", "oil_spill_timed")
        done = subprocess.run(
            [sys.executable, "-m", "bigactors", *words],
            env=env,
            capture_output=True,
            text=True,
            check=False,
            preexec_fn=lambda cores=cores: os.sched_setaffinity(0, cores),
        )
        assert done.returncode == 0, done.stdout


@pytest.mark.long
def test_the_loops_are_compiled_in_another_process(tmp_path):
    env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", COLD], env=env, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "compiled\n"


def test_a_bound_that_only_the_reference_engine_meets_does_not_end_the_check(monkeypatch):
    monkeypatch.setattr(Compilation, "is_done", lambda _: False)
    monkeypatch.setattr(sys.modules["checker.check"], "PATIENCE", 0.0)
    monkeypatch.setattr(handover, "_has_cores", lambda: True)
    report = check(
        load_mission("oil_spill_timed"), limits=Limits(configurations=1_000)
    )  # 376 zones, more ticks
    assert report.complete
