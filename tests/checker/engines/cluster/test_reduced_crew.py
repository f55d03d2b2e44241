"""Reductions by several workers: the same findings as without, whichever worker decides what is put off."""

from contextlib import nullcontext, suppress

import pytest
from checked_missions import load, start
from everything_found import everything
from hypothesis import given
from hypothesis import strategies as st
from local_crew import LocalCrew, explore_in_threads
from random_formulas import atoms_of
from scale import IS_WHOLE, crossed, examples, long_ones
from test_fast_symmetry import EITHER, FAMILIES
from test_partial_order import BUSY, POR, TEXTS
from test_preserved_runs import compared, drawn

from benchmarks.patrol import mission_text
from checker import Engine, Keeping, Limits, RefusedError, explore
from checker.engines.cluster import explorer, ray_crew, shard
from checker.engines.cluster.divided_paths import NONE, DividedPaths
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Options
from checker.engines.fast.search.crosscheck import Disagreement
from checker.engines.fast.store import row_store
from checker.reduction import Reduced
from semantics.properties.propositions import Inside
from specs import MissionError
from specs.elaboration import load_mission, read_mission


@pytest.fixture(autouse=True, scope="module")
def workers_in_threads():
    """Let the workers be threads, layers take several rounds, and rows be sent more than once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ray_crew, "explore_with_ray", explore_in_threads)
        patch.setattr(explorer, "ROUND", 1)
        patch.setattr(shard, "SENT", 2)
        yield


def counted(found):
    return len(found.configurations), found.transitions, found.allowed, found.depth, found.rules, found.bounds


def alone_and_together(initial, reductions, formulas=(), **options):
    """Return what one process and two workers visit."""
    reduced = Reduced(initial, reductions, formulas)
    return (explore(initial, reduce=reduced, engine=each, **options) for each in (Engine.FAST, Engine.RAY))


@crossed(list(FAMILIES), EITHER)
def test_two_workers_visit_the_representatives_that_one_process_visits(name, variation):
    with suppress(RefusedError) if variation == EITHER["both"] else nullcontext():
        limits = Limits(configurations=2_000)
        alone, found = alone_and_together(FAMILIES[name].initial, variation, limits=limits)
        assert counted(found) == counted(alone)
        if alone.complete:
            assert set(found.configurations) == set(alone.configurations)


@pytest.mark.long
def test_two_workers_fold_representatives(monkeypatch):
    monkeypatch.setattr(row_store, "PLAIN", 0)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 8)
    alone, found = alone_and_together(FAMILIES["more than one bound"].initial, EITHER["symmetry"])
    assert counted(found) == counted(alone)
    assert set(found.configurations) == set(alone.configurations)


@pytest.mark.parametrize(
    "name", ["oil_spill", *long_ones("surveillance", "takeover", "convoy", "rendezvous")]
)
def test_two_workers_visit_of_shipped_missions_as_few_as_one_process_does(name):
    mission = load_mission(name)
    formulas = [each.formula for each in mission.properties if each.formula is not None]
    alone, found = alone_and_together(mission.initial, POR, formulas)
    assert counted(found) == counted(alone)


def test_paths_that_go_round_end_where_those_of_one_process_do(monkeypatch):
    monkeypatch.setattr(explorer, "ROUND", 64)
    mission = read_mission(mission_text(2, 2, together=True))
    formulas = [each.formula for each in mission.properties if each.formula is not None]
    alone, found = alone_and_together(mission.initial, POR, formulas)
    assert counted(found) == counted(alone)
    assert alone.size == 2_652


@pytest.mark.parametrize("variation", ["symmetry", *long_ones("both")])
def test_a_reduced_search_whose_worker_is_lost_goes_on_from_its_checkpoint(variation, tmp_path):
    initial = FAMILIES["see each other"].initial
    reduced = Reduced(initial, EITHER[variation])
    expected = counted(explore(initial, reduce=reduced, engine=Engine.FAST))

    def explored(crew, folder):
        keeping = Keeping(str(tmp_path / folder), every=0.0, doubted=50)
        return counted(Expedition(crew, initial, Options(reduce=reduced, keeping=keeping)).run(()))

    undisturbed = LocalCrew(initial, 3, reduce=reduced)
    assert explored(undisturbed, "whole") == expected
    for call in range(20, undisturbed.calls * 3 // 4, undisturbed.calls // (5 if IS_WHOLE else 3)):
        crew = LocalCrew(initial, 3, dies=((call, call % 3),), reduce=reduced)
        assert explored(crew, str(call)) == expected
        assert crew.revived == 1


@given(TEXTS, st.booleans())
@examples(36, 4)
def test_of_generated_missions_a_reduced_search_by_workers_finds_everything(text, seen):
    with suppress(MissionError):  # some are found wrong before they are run
        initial = load(text).initial
        formulas = [Inside("uav0", "gate0", actually=True)] * seen
        full, _ = everything(initial, formulas, most=300)
        if full is not None:
            assert everything(initial, formulas, Reduced(initial, POR, formulas), 300, Engine.RAY)[0] == full


@given(TEXTS, st.data())
@examples(45, 5)
def test_of_generated_missions_a_reduced_search_by_workers_decides_formulas_of_runs(text, data):
    with suppress(MissionError):
        initial = load(text).initial
        compared(initial, drawn(data, initial, atoms_of(initial)), POR, engine=Engine.RAY)


def test_rows_that_wait_for_others_are_expanded_in_full(monkeypatch):
    initial, away = start(BUSY), [Inside("uav0", "gate0", actually=True)]
    full, _ = everything(initial, away)
    assert everything(initial, away, Reduced(initial, POR, away), engine=Engine.RAY)[0] == full
    monkeypatch.setattr(DividedPaths, "lead_on", lambda *_: NONE)  # each step leads on
    assert everything(initial, away, Reduced(initial, POR, away), engine=Engine.RAY)[0] != full


def test_a_worker_notices_a_successor_that_the_rules_do_not_give(monkeypatch):
    monkeypatch.setattr("checker.reduction.symmetry.MissionSymmetry.representative", lambda _, c: c)
    with pytest.raises(Disagreement):
        tuple(alone_and_together(FAMILIES["look"].initial, EITHER["symmetry"], keeping=Keeping(doubted=30)))
