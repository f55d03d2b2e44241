"""Exploring with several workers, here in one process: the same as alone, whoever is lost on the way."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from checked_missions import load, visited
from hypothesis import given
from local_crew import LocalCrew, explore_in_threads
from scale import IS_WHOLE, examples, long_ones, some_long

from checker import CheckpointError, Engine, Keeping, Limits, MachineError, check, explore
from checker.engines.archive import read_archive, write_archive
from checker.engines.cluster import checkpoints, explorer, ray_crew, rounds, shard
from checker.engines.cluster.checkpoints import KINDS, SCHEMA
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Options
from checker.engines.fast.store import row_store
from checker.engines.fast.store.rows import Rows
from checker.properties.coverage import Visited
from checker.properties.inspections import Arrival, Computation, DeadlockFreedom, LocalConsistency
from checker.properties.races import ControlRaces
from checker.properties.temporal.decide import kept_graph
from semantics import hypothesis_strategies
from semantics.races.monitor import monitored
from specs.elaboration import load_mission

FEW = ("broken_unrealisable", "nomad", "surveillance", "tanker", "distributed_handover", "takeover")
FEW = FEW if IS_WHOLE else FEW[:4]
LIMITS = Limits(configurations=20_000)


def start(name):
    return load_mission(name).initial


@pytest.fixture
def small_rounds(monkeypatch):
    """Let layers take several rounds, and rows be sent more than once."""
    monkeypatch.setattr(explorer, "ROUND", 1)
    monkeypatch.setattr(shard, "SENT", 2)


def together(initial, workers, inspect=(), limits=LIMITS, **options):
    crew = LocalCrew(initial, workers, limits.pending, reduce=options.get("reduce"))
    return Expedition(crew, initial, Options(limits, **options)).run(inspect)


def inspections():
    return Visited(), DeadlockFreedom(), Arrival(), LocalConsistency(), Computation(), ControlRaces()


def counted(found):
    return (
        len(found.configurations), found.transitions, found.depth, found.expanded, found.rules, found.bounds,
    )  # fmt: skip


def collected(inspect, found):
    """Return what inspections have found, with how far from the first configuration what is shown was found.

    Of more violations than are shown, equally near ones may be others.
    """
    lists = [each.collected for each in inspect[1:]]
    return [
        (
            each.count, each.examined, each.different,
            sorted((kind, len(found.path(finding.at))) for (kind, _), finding in each.first.items()),
            each.example is not None and len(found.path(each.example)),
        )
        for each in lists
    ]  # fmt: skip


@pytest.mark.parametrize(("name", "workers"), some_long(zip(FEW, (2, 5, 3, 2, 3, 5), strict=False)))
@pytest.mark.usefixtures("small_rounds")
def test_workers_visit_together_what_one_process_visits_alone(name, workers):
    for initial in (start(name), monitored(start(name))):
        one, other = inspections(), inspections()
        alone = explore(initial, one, LIMITS, engine=Engine.FAST)
        found = together(initial, workers, other)
        assert counted(found) == counted(alone)
        assert set(found.configurations) == set(alone.configurations)
        assert collected(other, found) == collected(one, alone)
        lengths = [len(found.path(number)) for number in range(len(found.configurations))]
        assert lengths == sorted(lengths)
        assert lengths[-1] == found.depth + 1
        assert (other[0].codes, other[0].passed, other[0].happened) == (
            one[0].codes, one[0].passed, one[0].happened,
        )  # fmt: skip


@given(hypothesis_strategies.initial_configurations())
@examples(25)
def test_workers_visit_of_generated_missions_what_one_process_visits(initial):
    limits = Limits(configurations=60)
    one, other = inspections(), inspections()
    alone = explore(initial, one, limits)
    found = together(initial, 2, other, limits)
    assert (len(found.configurations), found.bounds) == (len(alone.configurations), alone.bounds)
    if alone.complete:
        assert counted(found) == counted(alone)
        assert collected(other, found) == collected(one, alone)


def edges_of(found):
    """Return the transitions between configurations, each with its label."""
    graph, c = kept_graph(found), list(found.configurations)
    assert graph.partial is None
    return [
        (c[source], graph.labels[action], c[target])
        for source, action, target in zip(graph.sources, graph.actions, graph.targets, strict=True)
    ]


@pytest.mark.parametrize("name", ["two_gates", "nomad"])
def test_the_graph_is_that_of_one_process_but_for_numbers(name):
    initial = start(name)
    graphs = [
        {(source, label.rule, label.agent, target) for source, label, target in edges_of(found)}
        for found in (explore(initial, engine=Engine.FAST), together(initial, 3))
    ]
    assert graphs[0] == graphs[1]


@pytest.mark.parametrize("most", [1, 30, 152])
@pytest.mark.usefixtures("small_rounds")
def test_no_more_configurations_are_visited_than_were_allowed(most):
    initial, limits = start("surveillance"), Limits(configurations=most)
    alone, found = explore(initial, limits=limits), together(initial, 3, limits=limits)
    assert (len(found.configurations), found.expanded, found.bounds) == (most, most, alone.bounds)
    assert not found.complete
    assert kept_graph(found).open.any()
    assert together(initial, 3, limits=Limits(configurations=153)).complete  # as many as there are


def test_without_time_or_memory_the_search_is_incomplete():
    initial = start("surveillance")
    assert list(map(str, together(initial, 2, limits=Limits(seconds=-1.0)).bounds)) == [
        "the time limit of -1 s"
    ]
    found = together(initial, 2, limits=Limits(memory=1_000_000))
    assert list(map(str, found.bounds)) == ["the memory limit of 1 MB"]
    assert kept_graph(found).open.tolist() == [True]


@pytest.mark.usefixtures("small_rounds")
def test_rows_of_workers_go_over_to_files(tmp_path, monkeypatch):
    initial, spill, moved = start("surveillance"), Rows.spill, []

    def noted(rows, folder, used):
        spill(rows, folder, used)
        moved.append(used)

    monkeypatch.setattr(Rows, "spill", noted)
    for each in (rounds, shard):
        monkeypatch.setattr(each, "memory_taken", lambda: 0 if moved else 2)
    found = together(initial, 3, limits=replace(LIMITS, memory=1, spill=str(tmp_path)))
    assert counted(found) == counted(together(initial, 3))
    assert len(moved) == 3
    assert sum(moved) < len(found.configurations)
    assert not list(tmp_path.iterdir())


def test_a_folder_without_room_for_the_rows_of_workers_is_a_bound(tmp_path):
    limits = replace(LIMITS, memory=1, spill=str(tmp_path / "missing"))
    [bound] = together(start("surveillance"), 2, limits=limits).bounds
    assert str(bound).endswith("missing: No such file or directory")


@pytest.mark.parametrize("when", [1, 4])
@pytest.mark.usefixtures("small_rounds")
def test_an_interruption_keeps_what_is_whole_and_can_be_gone_on_from(tmp_path, when):
    initial, told, limits = start("surveillance"), [], Limits(LIMITS.configurations)

    def interrupt(progress):
        told.append(progress)
        if len(told) == when:
            limits.interruption.wish()

    found = together(initial, 2, limits=limits, report=interrupt, every=0.0, keeping=Keeping(str(tmp_path)))
    assert list(map(str, found.bounds)) == ["an interruption"]
    assert len(found.configurations) == told[-1].configurations < 153
    resumed = together(initial, 2, keeping=Keeping(str(tmp_path), resumed=True))
    assert visited(resumed) == visited(together(initial, 2))


class Interrupted(LocalCrew):
    """A crew of which a worker is interrupted while rows are on their way."""

    def count(self, worker, method):
        super().count(worker, method)
        if worker and self.calls > 30:
            raise KeyboardInterrupt


@pytest.mark.usefixtures("small_rounds")
def test_what_is_interrupted_while_rows_are_on_their_way_is_not_kept(tmp_path):
    initial = start("surveillance")
    options = Options(LIMITS, keeping=Keeping(str(tmp_path)))
    with pytest.raises(KeyboardInterrupt):
        Expedition(Interrupted(initial, 2), initial, options).run(())
    assert not list(tmp_path.rglob("latest.checkpoint"))


@pytest.mark.parametrize("name", ["two_gates", *long_ones("surveillance", "distributed_handover")])
def test_workers_fold_their_rows(name, tmp_path, monkeypatch):
    initial = start(name)
    alone = explore(initial, engine=Engine.FAST)
    seen = {(c, label.rule, d) for c, label, d in edges_of(alone)}
    monkeypatch.setattr(row_store, "PLAIN", 0)
    monkeypatch.setattr(row_store, "COMPRESSED_FROM", 8)
    monkeypatch.setattr(explorer, "ROUND", 4)
    undisturbed = LocalCrew(initial, 3)
    found = Expedition(undisturbed, initial, Options(LIMITS)).run(())
    assert all(each.shard.store.rows.folded is not None for each in undisturbed.workers)
    for died in (0, undisturbed.calls // 2):
        crew = LocalCrew(initial, 3, dies=((died, 1),) if died else ())
        kept = Keeping(str(tmp_path / str(died)), every=0.0, doubted=30)
        found = Expedition(crew, initial, Options(LIMITS, keeping=kept)).run(())
        assert counted(found) == counted(alone)
        assert {(c, label.rule, d) for c, label, d in edges_of(found)} == seen
        assert crew.revived == bool(died)


WAYS = """
signature { kind Place contains UAV kind UAV driven }
control timed
world {
  west: Place = box (0, 0) (0.01, 0.01)
  prison: Place = box (0, 0.02) (0.01, 0.03)
  east: Place = box (0, 0.04) (0.01, 0.05)
  south: Place = box (-0.05, 0.02) (-0.04, 0.03)
  u0: UAV = point (0.005, 0.005)
  u1: UAV = point (0.005, 0.006)
}
BigActor a hosted_at u0 with_behavior { control(MOVE_HOST_TO east) }
BigActor b hosted_at u1 with_behavior {
  control(MOVE_HOST_TO south)
  let never = 1 if never == 2 { control(MOVE_HOST_TO east) }
}
check {
  invariant "u0": not actually u0 in prison
  invariant "u1": not actually u1 in prison
  invariant "ways": not possibly u0 in south
}
"""
"""u0 may cross the prison, u1 would if it ever went east, and they would meet there."""


@pytest.mark.parametrize("engine", [Engine.FAST, Engine.RAY])
@pytest.mark.usefixtures("small_rounds")
def test_suspected_ways_are_decided_by_all_workers_and_when_resumed(monkeypatch, tmp_path, engine):
    monkeypatch.setattr(ray_crew, "explore_with_ray", explore_in_threads)
    mission = load(WAYS, "")
    expected = check(mission, engine=Engine.REFERENCE, suspected=mission.suspicions).suspected
    assert sorted(way is None for way in expected.values()) == [False, True, True]
    options = {"engine": engine, "suspected": mission.suspicions}
    assert check(mission, **options).suspected == expected
    keeping = Keeping(str(tmp_path), every=0.0)
    before = check(mission, limits=Limits(seconds=0.0), keeping=keeping, **options)
    assert not before.complete
    assert not [way for way in before.suspected.values() if way is None]
    assert check(mission, keeping=replace(keeping, resumed=True), **options).suspected == expected


# --- who is lost ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("every", [0.0, *long_ones(60.0)])
@pytest.mark.usefixtures("small_rounds")
def test_whenever_a_worker_is_lost_nothing_is_lost_with_it(tmp_path, every):
    initial = start("broken_unrealisable")
    undisturbed = LocalCrew(initial, 3)
    expected = visited(Expedition(undisturbed, initial, Options(LIMITS)).run(()))
    for call in range(2, undisturbed.calls, 31):
        folder = tmp_path / str(call)
        crew = LocalCrew(initial, 3, dies=((call, call % 3),))
        keeping = Keeping(str(folder), every=every)
        assert visited(Expedition(crew, initial, Options(LIMITS, keeping=keeping)).run(())) == expected
        assert crew.revived == 1


class Seldom(Expedition):
    """Keeps a checkpoint after every tenth round, and at the end."""

    rounds = 0

    def save(self):
        self.rounds += 1
        if self.rounds % 10 == 0 or self.is_done():
            super().save()


@pytest.mark.parametrize("dies", [((60, 1),), *long_ones((((25, 0), (110, 1), (170, 0), (250, 1)),))])
@pytest.mark.usefixtures("small_rounds")
def test_whoever_was_not_lost_at_first_may_be_lost_later(tmp_path, dies):
    initial = start("distributed_handover")
    expected = visited(together(initial, 2))
    crew = LocalCrew(initial, 2, dies=dies)
    found = Seldom(crew, initial, Options(LIMITS, keeping=Keeping(str(tmp_path), every=0.0))).run(())
    assert visited(found) == expected
    assert crew.revived == len(dies)
    again = together(initial, 2, keeping=Keeping(str(tmp_path), resumed=True))
    assert visited(again) == expected


@pytest.mark.usefixtures("small_rounds")
def test_a_crew_that_was_lost_altogether_is_followed_by_another(tmp_path, monkeypatch):
    initial = start("nomad")
    undisturbed = LocalCrew(initial, 2)
    found = Expedition(undisturbed, initial, Options(LIMITS)).run(())
    expected, keeping = visited(found), LocalCrew(initial, 2)
    kept = Keeping(str(tmp_path / "kept"), every=0.0)
    Expedition(keeping, initial, Options(LIMITS, keeping=kept)).run(())
    for call in (30, 90, keeping.calls * 2 // 3):  # on a busy machine there are more or fewer calls
        folder = str(tmp_path / str(call))
        crew = LocalCrew(initial, 2, dies=((call, 0),))
        monkeypatch.setattr(crew, "revive", lambda: None)  # it stays dead
        with pytest.raises(MachineError, match="lost 6 times without a checkpoint between"):
            Expedition(crew, initial, Options(LIMITS, keeping=Keeping(folder, every=0.0))).run(())
        crew = LocalCrew(initial, 2)
        resumed = Expedition(crew, initial, Options(LIMITS, keeping=Keeping(folder, resumed=True))).run(())
        assert visited(resumed) == expected
    rounds, again = (each.called[0].count("exchange") for each in (undisturbed, crew))
    assert again < rounds // 2


def test_what_was_found_under_a_limit_of_time_is_not_explored_otherwise(tmp_path):
    initial, limits = start("surveillance"), Limits(seconds=-1.0)
    crew = LocalCrew(initial, 2)
    found = Expedition(crew, initial, Options(limits)).run(())
    crew.lost = {0, 1}
    with pytest.raises(MachineError, match="its rows were not kept"):
        list(found.configurations)
    crew = LocalCrew(initial, 2)
    found = Expedition(crew, initial, Options(limits, keeping=Keeping(str(tmp_path)))).run(())
    crew.lost = {0, 1}
    assert list(found.configurations) == [initial]


@pytest.mark.usefixtures("small_rounds")
def test_in_a_temporary_folder_nothing_is_kept_of_what_ends_before_a_checkpoint_is_due(tmp_path):
    initial = start("broken_unrealisable")
    expected = visited(together(initial, 2))
    crew = LocalCrew(initial, 2)
    options = Options(LIMITS, keeping=Keeping(str(tmp_path)))
    found = Expedition(crew, initial, options, is_temporary=True).run(())
    assert not list(tmp_path.rglob("*.checkpoint"))
    crew.lost = {1}
    assert visited(found) == expected  # all was explored once more
    assert crew.revived == 1


# --- checkpoints ----------------------------------------------------------------------------------------------


def kept(folder, workers=2, name="oil_spill", digest="d", limits=LIMITS, resumed=True):
    initial = start(name)
    keeping = Keeping(str(folder), resumed=resumed, digest=digest)
    return together(initial, workers, limits=limits, keeping=keeping)


@pytest.mark.parametrize(
    "other", [{"digest": "e"}, {"workers": 3}, {"limits": Limits(configurations=7)}, {"name": "tanker"}]
)
def test_a_checkpoint_of_something_else_is_refused(tmp_path, other):
    kept(tmp_path, resumed=False)
    said = (
        "differ from those recorded in it"
        if "name" in other
        else "of another mission, variation, limit, version or"
    )
    with pytest.raises(CheckpointError, match=said):
        kept(tmp_path, **other)


@pytest.mark.parametrize("part", ["rows", "origins", "packing", "places", "sizes", "digests", "learned"])
def test_a_checkpoint_whose_parts_do_not_fit_together_is_refused(tmp_path, part):
    kept(tmp_path, resumed=False)
    [path] = (tmp_path / "exploration-ray").glob("shard-*-0.checkpoint")
    head, arrays = read_archive(path, SCHEMA, KINDS)
    arrays[part] = arrays[part][:-1] if part != "learned" else arrays[part] + 1000
    write_archive(path, head, KINDS, list(arrays.values()))
    with pytest.raises(CheckpointError, match="damaged"):
        kept(tmp_path)


@pytest.mark.usefixtures("small_rounds")
def test_a_column_that_is_unknown_after_a_checkpoint_has_its_first_value_in_all_rows(tmp_path, monkeypatch):
    """No worker writes where a column that it does not know would be: the process could die of that."""
    translate, unknown = checkpoints.kernel.translate, []

    def looked_at(rows, first, count, width, read, columns, *more):
        unknown.extend(np.flatnonzero(read.numbers[read.varying] >= len(columns) // 3))
        translate(rows, first, count, width, read, columns, *more)

    initial, limits = start("oil_spill"), Limits(LIMITS.configurations)
    stop = lambda told: told.configurations < 9 or limits.interruption.wish()  # noqa: E731 - as short as that
    first, refused = tmp_path / "first", 0
    together(initial, 2, limits=limits, report=stop, every=0.0, keeping=Keeping(str(first), digest="d"))
    monkeypatch.setattr(checkpoints.kernel, "translate", looked_at)
    [path] = first.rglob("shard-*-0.checkpoint")
    head, arrays = read_archive(path, SCHEMA, KINDS)
    size = len(arrays["sizes"])
    for column in range(size):
        folder = shutil.copytree(first, tmp_path / str(column))
        places = arrays["places"].copy().reshape(size, -1)
        places[column] ^= 1
        changed = {**arrays, "places": places.ravel()}
        write_archive(folder / path.relative_to(first), head, KINDS, list(changed.values()))
        try:
            kept(folder)
        except CheckpointError:
            refused += 1
    assert 0 < refused < size
    assert not unknown
