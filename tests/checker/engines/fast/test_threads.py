"""Several threads: whatever they do at once, everything that one thread finds is found, with the same numbers."""

import threading
from contextlib import suppress
from functools import cache

import pytest
from checked_missions import interrupted_at, load
from hypothesis import given
from hypothesis import strategies as st
from scale import FOLDED, IS_WHOLE, crossed, examples, long_ones, some_of
from shipped import UNTIMED
from swarms import LOOKS, ORBITS, mission, swarms

import checker.limits
from bigactors.cli import main
from checker import Engine, Keeping, Limits, RefusedError, explore
from checker.engines.contract import Options
from checker.engines.fast import explorer
from checker.engines.fast.explorer import explore_fast
from checker.engines.fast.reduce.chosen_rows import REJECTED
from checker.engines.fast.search import chosen_steps, expander, frontier_chunks
from checker.engines.fast.store import row_store, tree_compression
from checker.engines.fast.store.rows import Rows
from checker.reduction import Reduced, Reduction
from semantics import hypothesis_strategies
from semantics.properties.property import watching
from semantics.races.monitor import monitored
from specs.elaboration import load_mission

SOME = Limits(configurations=3_000 if IS_WHOLE else 600)
SEVERAL = (2, 3, 4)


@pytest.fixture(autouse=True)
def small_slices(monkeypatch):
    """Let small missions have many slices, some of which are too large for their batch, and rooms that grow."""
    monkeypatch.setattr(row_store, "FIRST_ROWS", 64)
    monkeypatch.setattr(expander, "BATCH", 64)
    monkeypatch.setattr(frontier_chunks, "FEW", 4)
    monkeypatch.setattr(frontier_chunks, "LATER_ROWS", 3)
    monkeypatch.setattr(frontier_chunks, "WORTH", 1)


KEPT = {"plain": row_store.PLAIN, "folded": 1}
MANNERS = {f"{threads} {kept}": (threads, KEPT[kept]) for kept in KEPT for threads in SEVERAL}


def keep(monkeypatch, plain):
    """Let rows be kept as they are, or fold them all into pieces whose room grows."""
    monkeypatch.setattr(row_store, "PLAIN", plain)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 0)
    monkeypatch.setattr(tree_compression, "FIRST", 4)


@pytest.fixture(params=KEPT.values(), ids=KEPT)
def kept(request, monkeypatch):
    keep(monkeypatch, request.param)


def start(name):
    return load_mission(name).initial


def seen(initial, threads, **options):
    """Return all that an exploration found, and in which order it learned."""
    found = explore(initial, engine=Engine.FAST, threads=threads, **{"limits": SOME, **options})
    inner = found.survey.search
    stored = inner.store.rows
    rows = stored.words[: inner.size * stored.kept]
    numbers = (found.depth, found.expanded, found.transitions, found.rules, found.bounds, found.rule_runs)
    interned = [each.tolist() for each in stored.interned]
    targets = [each for _, _, each in inner.expander.edges(range(inner.expanded))]
    if found.complete and found.reducer is None:  # every transition leads to a row, also of a new packing
        assert sum(map(len, targets)) == found.transitions
        assert all((each >= 0).all() for each in targets)
    graph = found.survey.graph().targets.tolist()
    chosen = inner.choosing and inner.choosing.paths.kept(inner.size, inner.expanded)
    paths = [each.tolist() for each in chosen or ()]
    return (
        rows.tolist(),
        list(map(int, found.origins)),
        numbers,
        inner.model.learned,
        interned,
        graph,
        paths,
    )


@cache
def whole_of(name, _plain):
    """Return what one thread finds in the end, by the way in which rows are kept just now."""
    return seen(start(name), 1, limits=Limits())


@crossed(UNTIMED, MANNERS)
def test_a_mission_is_explored_alike_by_any_number_of_threads(name, variation, monkeypatch):
    threads, plain = variation
    keep(monkeypatch, plain)
    assert seen(start(name), threads) == seen(start(name), 1)


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize("name", ["oil_spill", "takeover"])
def test_a_monitored_mission_is_explored_alike_by_any_number_of_threads(name):
    initial = monitored(start(name))
    assert seen(initial, 2) == seen(initial, 4) == seen(initial, 1)


SWARMS = {name: (body, robots, rest) for name, (body, rest, robots) in ORBITS.items()} | {
    "alike": (LOOKS, 6, "")
}


REDUCTIONS = {
    "symmetry": (Reduction.SYMMETRY,),
    "por": (Reduction.POR,),
    "both": (Reduction.POR, Reduction.SYMMETRY),
}
REDUCED = {
    f"{name} {manner}": (REDUCTIONS[name], *MANNERS[manner]) for manner in MANNERS for name in REDUCTIONS
}


def assert_reduced_alike(initial, reductions, threads, plain):
    with pytest.MonkeyPatch.context() as patch:
        keep(patch, plain)
        alone, several = (
            seen(initial, number, reduce=Reduced(initial, reductions)) for number in (1, threads)
        )
    assert several == alone


@crossed(list(SWARMS), REDUCED, long=FOLDED)
def test_swarms_are_reduced_alike_by_any_number_of_threads(name, variation):
    assert_reduced_alike(mission(*SWARMS[name]).initial, *variation)


@crossed(UNTIMED, REDUCED, long=FOLDED)
def test_missions_are_reduced_alike_by_any_number_of_threads(name, variation):
    with suppress(RefusedError):
        assert_reduced_alike(start(name), *variation)


@given(swarms(), st.sampled_from(some_of(REDUCED, FOLDED)))
@examples(30)
def test_generated_swarms_are_reduced_alike_by_any_number_of_threads(text, variation):
    with suppress(RefusedError):
        assert_reduced_alike(load(text, "").initial, *variation)


@pytest.mark.parametrize("threads", [1, 3])
def test_a_set_whose_path_returns_is_rejected_at_the_turn_of_its_row(monkeypatch, threads):
    """An agent that goes in a circle is chosen again and again: at the end of the circle, others must move, too."""
    ended = []
    store = chosen_steps.store_chosen

    def noted(*given):
        ended.append(store(*given))
        return ended[-1]

    monkeypatch.setattr(chosen_steps, "store_chosen", noted)
    initial = mission("loop { control(MOVE_HOST_TO room0) control(MOVE_HOST_TO dock0) }", 3).initial
    reduced = Reduced(initial, (Reduction.POR,))
    found = explore(initial, engine=Engine.FAST, threads=threads, reduce=reduced)
    known = explore(initial, engine=Engine.REFERENCE, reduce=reduced)
    assert ended.count(REJECTED) > 0
    assert list(found.configurations) == list(known.configurations)
    assert (found.transitions, found.allowed) == (known.transitions, known.allowed)


@given(hypothesis_strategies.initial_configurations(), st.sampled_from([1, 2]))
@examples(60)
def test_generated_missions_are_explored_alike_by_any_number_of_threads(initial, plain):
    limits = Limits(configurations=300)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(row_store, "PLAIN", plain)
        patch.setattr(row_store, "COMPRESSED_FROM", 40)
        assert seen(initial, 3, limits=limits) == seen(initial, 1, limits=limits)


def fleet(uavs):
    """Return UAVs that look around in a row of cells and move on."""
    place = " = box (0.001, {}.0) (0, {}.0)"
    cells = [f"cell{k}: Cell" + place.format(2 * k + 1, 2 * k) for k in range(uavs)]
    bodies = [f"uav{k}: UAV = point (0.0005, {2 * k}.5)" for k in range(uavs)]
    cases = [
        f"case o if cell{k} in o => choose {{ control(MOVE_HOST_TO cell{(k + 1) % uavs}) }} or "
        f"{{ control(MOVE_HOST_TO cell{k - 1 if k else uavs - 1}) }}"
        for k in range(uavs)
    ]
    world = "\n".join((*cells, *bodies))
    agents = [f"BigActor a{k} hosted_at uav{k} with_behavior {{ patrol() }}" for k in range(uavs)]
    patrol = "loop { observe(CHILDREN(PARENT(HOST))) react {\n" + "\n".join(cases) + "\n} }"
    signature = "signature { kind Cell contains UAV kind UAV driven }"
    lines = (signature, f"world {{\n{world}\n}}", f"def patrol() = {{ {patrol} }}", *agents)
    return load("\n".join(lines), "mission fleet\n").initial


@pytest.mark.parametrize("configurations", [40, 1_000])
def test_wide_missions_are_explored_alike_by_any_number_of_threads(monkeypatch, configurations):
    """Most pieces of a row are met by slices before they have a number: they get it where the slices are stored."""
    monkeypatch.setattr(tree_compression, "SHALLOW", 1)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 200)
    limits = Limits(configurations=configurations)
    alone = seen(fleet(12), 1, limits=limits)
    assert configurations == 40 or len(alone[4][1]) > 2  # nodes: by then rows are folded twice
    for threads in SEVERAL if IS_WHOLE else (3,):
        assert seen(fleet(12), threads, limits=limits) == alone


def test_other_threads_expand_slices_and_sift_them(monkeypatch):
    done = set()

    def noted(name):
        do = getattr(frontier_chunks.AllSteps, name)

        def note(self, part):
            done.add((name, threading.current_thread() is threading.main_thread()))
            do(self, part)

        monkeypatch.setattr(frontier_chunks.AllSteps, name, note)

    noted("gather")
    noted("sift")
    alone = seen(start("rendezvous"), 1, limits=Limits())
    assert done == {("gather", True)}
    assert seen(start("rendezvous"), 4, limits=Limits()) == alone
    assert {("gather", False), ("sift", False)} <= done
    assert ("sift", True) not in done


@pytest.fixture
def full_memory(monkeypatch):
    """Let memory be full in the middle of a search, until its rows are in files; return the sizes then."""
    spill, spilled, asked = Rows.spill, [], []

    def noted(rows, folder, used):
        spill(rows, folder, used)
        spilled.append(used)

    def taken():
        asked.append(True)
        return 2 if len(asked) > 20 and not spilled else 0

    monkeypatch.setattr(Rows, "spill", noted)
    monkeypatch.setattr(checker.limits, "memory_taken", taken)
    return spilled


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize("threads", SEVERAL if IS_WHOLE else (3,))
def test_rows_go_over_to_files_under_several_threads(tmp_path, monkeypatch, threads, full_memory):
    monkeypatch.setattr(explorer, "CHUNK", 128)
    limits = Limits(memory=1, spill=str(tmp_path))
    assert seen(start("rendezvous"), threads, limits=limits) == whole_of("rendezvous", row_store.PLAIN)
    assert 100 < full_memory[0] < 18_000


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize("kept", [KEPT["plain"], *long_ones(KEPT["folded"])], ids=KEPT, indirect=True)
@pytest.mark.parametrize(
    "reductions",
    [
        (Reduction.SYMMETRY,),
        pytest.param((Reduction.POR,), marks=pytest.mark.long),
        pytest.param(tuple(Reduction), marks=pytest.mark.long),
    ],
)
def test_reduced_searches_go_over_to_files(tmp_path, monkeypatch, reductions, full_memory):
    monkeypatch.setattr(explorer, "CHUNK", 2)
    loaded = mission(LOOKS, 6, 'check { ltl "all come": F G forall r: Robot . actually r in room0 }')
    initial = watching(loaded.initial, loaded.properties)
    reduced = Reduced(initial, reductions, runs=[each for each in loaded.properties if each.is_of_runs])
    assert reduced.runs  # so that followed transitions are stored
    limits = Limits(memory=1, spill=str(tmp_path))
    found = seen(initial, 3, limits=limits, reduce=reduced)
    assert found == seen(initial, 1, limits=Limits(), reduce=reduced)
    assert 10 < full_memory[0] < len(found[1])


@pytest.mark.long
@pytest.mark.parametrize("threads", SEVERAL if IS_WHOLE else (3,))
def test_without_memory_several_threads_stop_and_say_so(monkeypatch, threads):
    asked = []

    def taken():
        asked.append(True)
        return 2 if len(asked) > 100 else 0

    monkeypatch.setattr(checker.limits, "memory_taken", taken)
    found = explore(start("rendezvous"), engine=Engine.FAST, threads=threads, limits=Limits(memory=1))
    assert [str(bound) for bound in found.bounds] == ["the memory limit of 0 MB"]
    assert 10 < found.expanded < found.size
    whole = explore(start("rendezvous"), engine=Engine.FAST, threads=1)
    assert list(found.configurations) == list(whole.configurations)[: found.size]


@pytest.mark.usefixtures("kept")
@pytest.mark.parametrize(("before", "after"), [(1, 4), (4, 1), (3, 2)] if IS_WHOLE else [(1, 4), (3, 2)])
def test_other_threads_go_on_from_a_checkpoint(tmp_path, before, after):
    initial = start("rendezvous")
    limits, stop = interrupted_at(4_000, Limits())
    keeping = Keeping(str(tmp_path), digest="d")
    cut = explore(
        initial, engine=Engine.FAST, limits=limits, keeping=keeping, threads=before, report=stop, every=0.0
    )
    assert not cut.complete
    resumed = seen(initial, after, keeping=Keeping(str(tmp_path), True, "d"), limits=Limits())
    assert resumed[:2] == whole_of("rendezvous", row_store.PLAIN)[:2]


@pytest.mark.usefixtures("kept")
def test_a_row_with_more_successors_than_a_batch_holds_is_stored_in_its_turn(monkeypatch):
    monkeypatch.setattr(expander, "BATCH", 4)
    few = [seen(start("oil_spill"), threads) for threads in (1, 3)]
    monkeypatch.setattr(expander, "BATCH", 64)
    assert few == [seen(start("oil_spill"), 1)] * 2


def test_the_command_line_passes_the_number_of_threads_on(monkeypatch, capsys):
    asked, explored = [], explore_fast

    def noted(initial, inspect, options: Options):
        asked.append(options.threads)
        return explored(initial, inspect, options)

    monkeypatch.setattr("checker.engines.fast.explorer.explore_fast", noted)
    main(["check", "oil_spill", "--engine", "fast", "--threads", "3", "--no-traces"])
    assert set(asked) == {3}
    assert main(["check", "oil_spill", "--engine", "reference", "--threads", "2"]) == 2
    assert "--threads works with the fast engine only\n  hint: leave --engine out" in capsys.readouterr().err
