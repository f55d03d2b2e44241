"""Checkpoints of reduced explorations: what was cut goes on to the configurations, counts and paths of an uncut one."""

from contextlib import suppress

import pytest
from checked_missions import interrupted_at, load
from hypothesis import given
from hypothesis import strategies as st
from scale import FOLDED, IS_WHOLE, crossed, examples, long_if
from shipped import UNTIMED
from swarms import LOOKS, ORBITS, mission, swarms

from checker import CheckpointError, Engine, Keeping, Limits, RefusedError, Stop, explore
from checker.engines.fast import explorer
from checker.engines.fast.store import row_store
from checker.reduction import Reduced, Reduction
from semantics.properties.property import watching
from specs.elaboration import load_mission

POR, SYMMETRY = (Reduction.POR,), (Reduction.SYMMETRY,)
REDUCTIONS = {"por": POR, "symmetry": SYMMETRY, "both": POR + SYMMETRY}
SWARMS = {name: (body, robots, rest) for name, (body, rest, robots) in ORBITS.items()} | {
    "alike": (LOOKS, 5, "")
}
MOST = 2_000 if IS_WHOLE else 400


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    """Let a small search be cut in the middle, repeatedly."""
    monkeypatch.setattr(explorer, "CHUNK", 8)


KEPT = {"plain": row_store.PLAIN, "folded": 1}
MANNERS = {
    f"{name} {kept}": (reductions, KEPT[kept]) for kept in KEPT for name, reductions in REDUCTIONS.items()
}


def keep(monkeypatch, plain):
    """Let rows be kept as they are, or fold them all."""
    monkeypatch.setattr(row_store, "PLAIN", plain)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 0)


def searched(initial, reductions, runs=(), **options):
    reduced = Reduced(initial, reductions, runs=runs) if reductions else None
    limits = options.pop("limits", Limits(configurations=MOST))
    return explore(initial, engine=Engine.FAST, reduce=reduced, limits=limits, **options)


def seen(found):
    """Return everything that an exploration found."""
    numbers = (found.depth, found.expanded, found.transitions, found.allowed, found.rules)
    graph = found.survey.graph()
    edges = (graph.starts.tolist(), graph.targets.tolist())
    return list(found.configurations), list(map(int, found.origins)), numbers, edges


def assert_goes_on(initial, reductions, folder, cuts, threads=1, runs=()):
    """Cut an exploration at some sizes, go on each time, and compare its end with that of an uncut one."""
    whole = searched(initial, reductions, runs)
    for at in cuts:
        limits, stop = interrupted_at(at, Limits(configurations=MOST))
        keeping = Keeping(folder, True, "d")
        cut = searched(
            initial, reductions, runs, limits=limits, keeping=keeping, report=stop, every=0.0, threads=threads
        )
        assert any(bound.stop is Stop.INTERRUPTION for bound in cut.bounds) or at >= whole.size
    found = searched(initial, reductions, runs, keeping=Keeping(folder, True, "d"), threads=threads)
    assert seen(found) == seen(whole)
    assert found.bounds == whole.bounds
    return whole


@crossed(list(SWARMS), MANNERS, long=FOLDED)
def test_what_was_cut_goes_on(tmp_path, monkeypatch, name, variation):
    reductions, plain = variation
    keep(monkeypatch, plain)
    initial = mission(*SWARMS[name]).initial
    with suppress(RefusedError):
        whole = assert_goes_on(initial, reductions, str(tmp_path), (2, 9, 30), threads=3)
        assert whole.size > 5


@pytest.mark.parametrize(
    ("reductions", "plain"),
    [pytest.param(*manner, id=key, marks=long_if(FOLDED in key)) for key, manner in MANNERS.items()],
)
def test_followed_transitions_are_kept_for_properties_of_runs(tmp_path, monkeypatch, reductions, plain):
    keep(monkeypatch, plain)
    there = "forall r: Robot . actually r in room0"
    loaded = mission(LOOKS, 4, f'check {{ ltl "all come": F G {there} }}')
    runs = [each for each in loaded.properties if each.is_of_runs]
    initial = watching(loaded.initial, loaded.properties)
    whole = assert_goes_on(initial, reductions, str(tmp_path), (5, 20), runs=runs)
    assert whole.reducer.runs == tuple(runs)


@crossed(UNTIMED, REDUCTIONS)
def test_missions_that_ship_go_on(tmp_path, name, variation):
    with suppress(RefusedError):
        assert_goes_on(load_mission(name).initial, variation, str(tmp_path), (5, 40))


@given(text=swarms(), reductions=st.sampled_from(list(REDUCTIONS.values())), at=st.integers(1, 60))
@examples(20)
def test_generated_swarms_go_on(tmp_path_factory, text, reductions, at):
    with suppress(RefusedError):
        assert_goes_on(load(text, "").initial, reductions, str(tmp_path_factory.mktemp("kept")), (at, 2 * at))


@pytest.mark.parametrize(("before", "after"), [(POR, SYMMETRY), (SYMMETRY, POR + SYMMETRY), (POR, ())])
def test_a_checkpoint_of_another_reduction_is_refused(tmp_path, before, after):
    initial = mission(*SWARMS["alike"]).initial
    searched(initial, before, keeping=Keeping(str(tmp_path), digest="d"))
    with pytest.raises(CheckpointError, match="of another mission, variation, limit or version"):
        searched(initial, after, keeping=Keeping(str(tmp_path), True, "d"))
