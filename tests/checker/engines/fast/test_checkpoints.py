"""Checkpoints that were altered, cut short or exchanged: refused, or gone on with; never a crash."""

import os
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from checked_missions import interrupted_at
from hypothesis import given, settings
from hypothesis import strategies as st
from local_crew import LocalCrew
from scale import IS_WHOLE
from swarms import LOOKS, mission

from checker import CheckpointError, Engine, Keeping, Limits, Stop, explore
from checker.engines.archive import read_archive, write_archive
from checker.engines.cluster import checkpoints as shards
from checker.engines.cluster.explorer import Expedition
from checker.engines.contract import Options
from checker.engines.fast import explorer
from checker.engines.fast.search import checkpoint
from checker.reduction import Reduced, Reduction
from specs.elaboration import load_mission

MISSION = Path(__file__).parents[4] / "specs" / "missions" / "two_gates.mission"
LIMITS = Limits(configurations=20_000)
MANY = int(os.environ.get("BIGACTORS_FUZZ", "0")) // 100
NUMBERS = st.sampled_from(
    [0, 1, 2, 7, 63, 64, 1 << 31, (1 << 32) - 1, 1 << 40, (1 << 63) - 1, -1, -2, -(1 << 63)]
)
VALUES = NUMBERS | st.sampled_from(
    [None, True, 1e308, float("nan"), float("inf"), "", "x", [], [1], {}, [[[]]]]
)


@cache
def initial():
    return load_mission(MISSION).initial


@cache
def whole():
    return len(explore(initial(), engine=Engine.FAST, limits=LIMITS).configurations)


def resume_fast(folder):
    return explore(initial(), engine=Engine.FAST, limits=LIMITS, keeping=Keeping(folder, True, "d"))


def resume_cluster(folder):
    return Expedition(LocalCrew(initial(), 2), initial(), Options(LIMITS, keeping=Keeping(folder, True))).run(
        ()
    )


@cache
def kept_fast():
    """Return the files of a checkpoint of a search that was cut."""
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(explorer, "CHUNK", 8)
        keeping = Keeping(folder, digest="d")
        limits, stop = interrupted_at(20, LIMITS)
        explore(initial(), engine=Engine.FAST, limits=limits, keeping=keeping, report=stop, every=0.0)
        return files_of(folder)


@cache
def kept_cluster():
    with TemporaryDirectory() as folder:
        limits, stop = interrupted_at(20, LIMITS)
        options = Options(limits, stop, 0.0, keeping=Keeping(folder, every=0.0))
        Expedition(LocalCrew(initial(), 2), initial(), options).run(())
        return files_of(folder)


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in Path(folder).rglob("*.checkpoint")}


@cache
def swarm():
    return mission(LOOKS, 5).initial


def explore_reduced(folder, limits=LIMITS, **options):
    reduced = Reduced(swarm(), tuple(Reduction))
    keeping = Keeping(folder, True, "d")
    return explore(swarm(), engine=Engine.FAST, limits=limits, keeping=keeping, reduce=reduced, **options)


@cache
def kept_reduced():
    """Return the files of a checkpoint of a reduced search that was cut."""
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(explorer, "CHUNK", 8)
        limits, stop = interrupted_at(12, LIMITS)
        explore_reduced(folder, limits, report=stop, every=0.0)
        return files_of(folder)


ENGINES = {
    "fast": (kept_fast, resume_fast),
    "reduced": (kept_reduced, explore_reduced),
    "cluster": (kept_cluster, resume_cluster),
}


def resumed(engine, files, alter=None):
    with TemporaryDirectory() as folder:
        for name, data in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        if alter is not None:
            alter(Path(folder))
        return ENGINES[engine][1](folder)


@pytest.mark.parametrize("engine", ENGINES)
def test_what_was_not_altered_is_gone_on_with(engine):
    with TemporaryDirectory() as folder:
        size = len(explore_reduced(folder).configurations) if engine == "reduced" else whole()
    assert len(resumed(engine, ENGINES[engine][0]()).configurations) == size


@st.composite
def damaged(draw, files):
    """Return files of which one has bytes flipped, left out, exchanged or put in."""
    name = draw(st.sampled_from(sorted(files)))
    data = bytearray(files[name])
    at, to = (draw(st.integers(0, len(data) - 1)) for _ in range(2))
    way = draw(st.sampled_from(["flip", "cut", "exchange", "put in", "double"]))
    if way == "flip":
        data[at] ^= draw(st.integers(1, 255))
    elif way == "cut":
        del data[at:]
    elif way == "exchange":
        data[at : at + 8], data[to : to + 8] = data[to : to + 8], data[at : at + 8]
    else:
        data[at:at] = data if way == "double" else draw(st.binary(min_size=1, max_size=9))
    return {**files, name: bytes(data)}


@pytest.mark.fuzz
@pytest.mark.parametrize("engine", ENGINES)
@settings(max_examples=max(30, MANY))
@given(data=st.data())
def test_damaged_files_are_refused(engine, data):
    files = ENGINES[engine][0]()
    altered = data.draw(damaged(files))
    if altered == files:
        return
    with pytest.raises(CheckpointError):
        resumed(engine, altered)


def test_files_of_workers_that_were_exchanged_are_refused():
    files = kept_cluster()
    one, other = sorted(name for name in files if "shard" in name)
    with pytest.raises(CheckpointError, match="number of workers"):
        resumed("cluster", {**files, one: files[other], other: files[one]})


def parts_of(path):
    """Return the schema and the arrays of a file."""
    if path.name.startswith("shard"):
        return shards.SCHEMA, shards.KINDS
    return (shards.SCHEMA, {}) if path.name == shards.LATEST else (checkpoint.SCHEMA, checkpoint.KINDS)


@st.composite
def forgeries(draw, names):
    """Return what alters a file and works out its digest anew."""
    name = draw(st.sampled_from(names))
    which, at, number = draw(st.integers(0, 1 << 16)), draw(st.integers(0, 1 << 16)), draw(NUMBERS)
    way, value = draw(st.sampled_from(["head", "put", "add", "cut", "swap"])), draw(VALUES)

    def alter(folder):
        path = folder / name
        schema, kinds = parts_of(path)
        head, arrays = read_archive(path, schema, kinds)
        if way == "head" or not arrays:
            head[sorted(set(head) - {"schema"})[which % (len(head) - 1)]] = value
        else:
            forge(arrays, sorted(kinds)[which % len(kinds)], way, at, number)
        write_archive(path, head, kinds, [arrays[each] for each in kinds])

    return alter


def forge(arrays, part, way, at, number):
    array = arrays[part]
    wrapped = np.array([number & ((1 << 64) - 1)], np.uint64).astype(array.dtype)[0]
    if way == "put" and len(array):
        array[at % len(array)] = wrapped
    elif way == "add" and len(array):
        with np.errstate(over="ignore"):
            array[at % len(array)] += array.dtype.type(1)
    elif way == "cut":
        arrays[part] = array[: at % (len(array) + 1)]
    else:
        arrays[part] = array[::-1].copy()


@pytest.mark.fuzz
@pytest.mark.parametrize("engine", ENGINES)
@settings(max_examples=max(20, MANY))
@given(data=st.data())
def test_forged_files_are_refused_or_gone_on_with(engine, data):
    files = ENGINES[engine][0]()
    alter = data.draw(forgeries(sorted(files)))
    with suppress(CheckpointError):
        found = resumed(engine, files, alter)
        assert next(iter(found.origins)) == 0
        assert 1 <= len(found.configurations) <= LIMITS.configurations


def with_arrays(change):
    """Return what changes the arrays of a checkpoint as somebody would who works out its digest anew."""

    def alter(folder):
        path = folder / "exploration.checkpoint"
        head, arrays = read_archive(path, checkpoint.SCHEMA, checkpoint.KINDS)
        change(arrays)
        write_archive(path, head, checkpoint.KINDS, list(arrays.values()))

    return alter


@pytest.mark.parametrize(("part", "number"), [("counts", 1 << 40), ("state", -1), ("origins", 1 << 31)])
def test_numbers_that_no_search_has_are_told(part, number):
    with pytest.raises(CheckpointError, match="this checkpoint is damaged"):
        resumed("fast", kept_fast(), with_arrays(lambda arrays: arrays[part].__setitem__(-1, number)))


@pytest.mark.parametrize("at", range(40 if IS_WHOLE else 5))
def test_counts_that_are_not_those_of_the_rows_are_told(at):
    """Whoever alters a count and works out the digest anew changes no report."""

    def change(arrays):
        taken = np.flatnonzero(arrays["counts"])
        arrays["counts"][taken[at % len(taken)]] += 1 - 2 * (at % 2)

    with pytest.raises(CheckpointError, match="this checkpoint is damaged"):
        resumed("fast", kept_fast(), with_arrays(change))


def test_a_count_that_was_moved_to_another_transition_is_told():
    def change(arrays):
        arrays["counts"][np.flatnonzero(arrays["counts"])[:2]] += (-1, 1)

    with pytest.raises(CheckpointError, match="its counts of transitions are wrong"):
        resumed("fast", kept_fast(), with_arrays(change))


def test_of_many_rows_the_first_and_the_last_bound_the_counts(monkeypatch):
    monkeypatch.setattr(checkpoint, "RECOUNTED", 6)
    assert len(resumed("fast", kept_fast()).configurations) == whole()


def test_a_pipe_in_the_place_of_a_checkpoint_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "exploration.checkpoint")
    with pytest.raises(CheckpointError, match="this checkpoint can't be read: this is a pipe, not a file"):
        resume_fast(str(tmp_path))


def test_a_checkpoint_that_says_a_key_twice_is_refused():
    def alter(folder):
        path = folder / "exploration.checkpoint"
        data = path.read_bytes()
        at = data.index(b'"depth": ')
        about = data[data.index(b"\n") + 1 :]
        twice = data[data.index(b"\n") + 1 : at] + b'"depth": 1, ' + data[at:]
        first = data[: data.index(b"\n")].split()
        length = int(first[-1]) + len(twice) - len(about)
        path.write_bytes(b" ".join([*first[:-1], b"%d" % length]) + b"\n" + twice)

    with pytest.raises(CheckpointError, match="the key 'depth' is there twice in one object"):
        resumed("fast", kept_fast(), alter)


def test_a_checkpoint_that_cannot_be_written_is_a_bound(tmp_path):
    (tmp_path / "exploration.checkpoint").mkdir()
    (tmp_path / "exploration.checkpoint" / "in the way").touch()
    found = explore(initial(), engine=Engine.FAST, limits=LIMITS, keeping=Keeping(str(tmp_path), digest="d"))
    [bound] = found.bounds
    assert bound.stop is Stop.NO_CHECKPOINT
    assert str(bound).startswith("a checkpoint that can't be written to ")
    assert not found.complete
