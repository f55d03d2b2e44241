"""Saved searches end as if they had never been interrupted; altered ones are refused, or end so too."""

import json
import os
from array import array
from contextlib import suppress
from dataclasses import replace
from functools import cache

import pytest
from bigraph_strategies import grounds
from engine_strategies import solid_rules, system
from explored_systems import GROWING, SYSTEMS, WALK, told
from hypothesis import given, settings
from hypothesis import strategies as st
from scale import IS_WHOLE, crossed, examples, long_ones

from bigraphs import exploration, file_columns, resumption, workers
from bigraphs.algebra import lean
from bigraphs.engine import frontier
from bigraphs.errors import BigraphError
from bigraphs.exploration import ExplorationLimits, Saving, explore, explore_long
from bigraphs.notation import read_system
from bigraphs.saved_search import ARRAYS, SavedSearch
from bigraphs.state_store import StateStore

MANY = int(os.environ.get("BIGACTORS_FUZZ", "0")) // 100
NUMBERS = st.sampled_from([0, 1, 2, 3, 7, 63, 1 << 20, (1 << 31) - 1, (1 << 32) - 1, (1 << 63) - 1, -1, -2])
VALUES = NUMBERS | st.sampled_from(
    [None, True, 1.5, 1e308, "", "x", [], [1], {}, [[[]]], [[1, ["a"], 1, None]]]
)


class Shelf:
    """Keeps saved searches as a file would."""

    def __init__(self):
        self.saved = []

    def write(self, saved):
        arrays = {name: array(kind, saved.arrays[name].tobytes()) for name, kind in ARRAYS.items()}
        self.saved.append(SavedSearch(json.loads(json.dumps(saved.head)), arrays))


def run(one, *, saved=None, shelf=None, most=None, threads=1, watch=lambda _: None, every=1e9, **limits):
    saving = Saving("the shelf", (shelf or Shelf()).write, every, saved)
    return explore_long(one, ExplorationLimits(most, **limits), threads, watch, saving)


def interrupted(one, moment, threads=1):
    """Return why a search ended that was interrupted at some look at the clock, maybe inside a state, and its copy."""
    shelf, looks = Shelf(), iter(range(moment))

    def watch(_):
        if next(looks, None) is None:
            raise KeyboardInterrupt

    found = run(one, shelf=shelf, watch=watch, threads=threads)
    return found.reason, shelf.saved[-1] if shelf.saved else None  # nothing before the first state


def everything(found):
    return list(found.keys), told(found), found.reason


@pytest.fixture
def _often(monkeypatch):
    """Look at the clock at every opportunity, start workers at once, and pack waiting states in small blocks."""
    monkeypatch.setattr(exploration, "LOOK_EVERY", 0.0)
    monkeypatch.setattr(frontier, "BLOCK", 2)
    monkeypatch.setattr(workers, "BEGIN", 0.0)
    monkeypatch.setattr(workers, "LEAST", 0.0)


WAYS = {"repeated": (9.0, 1), "read": (0.0, 1), "read by 3 processes": (0.0, 3)}


@crossed(list(SYSTEMS), WAYS)
@pytest.mark.usefixtures("_often")
def test_a_search_that_was_interrupted_anywhere_goes_on_to_the_same_end(name, variation, monkeypatch):
    one = read_system(SYSTEMS[name][0])
    whole = explore(one)
    seconds, threads = variation
    monkeypatch.setattr(resumption, "REPEATED", seconds)
    for moment in (1, 2, 5, 20, 47, 111) if IS_WHOLE else (2, 20, 47):
        reason, saved = interrupted(one, moment, threads)
        assert reason in ("it was interrupted", "")
        again = run(one, saved=saved, threads=threads)
        assert everything(again) == everything(whole)
        assert again.world.rows[: len(whole.world.rows)] == whole.world.rows


@examples(25)
@given(
    st.lists(solid_rules(sharing=True), min_size=1, max_size=3),
    grounds(max_nodes=5, controls=("A", "B", "Z"), sharing=True),
    st.integers(1, 30),
)
def test_so_it_is_for_generated_systems(rules, initial, most):
    rules = [replace(rule, name=f"r{number}") for number, rule in enumerate(rules)]
    one, shelf = system(lean(initial), *rules), Shelf()
    try:
        whole = explore(one, max_states=60)
    except BigraphError:
        return
    run(one, shelf=shelf, most=most)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(resumption, "REPEATED", 0.0)
        again = run(one, saved=shelf.saved[-1], most=60)
    assert everything(again) == everything(whole)
    assert again.world.rows == whole.world.rows


@pytest.mark.parametrize("seconds", [*long_ones(0.0), 9.0])
@pytest.mark.usefixtures("_often")
def test_so_does_each_of_many_checkpoints_and_what_went_on_is_saved_again(seconds, monkeypatch):
    monkeypatch.setattr(resumption, "REPEATED", seconds)
    one, shelf = read_system(WALK), Shelf()
    whole = run(one, shelf=shelf, every=0.0)
    assert len(shelf.saved) > 20
    for saved in shelf.saved[:: 7 if IS_WHOLE else 14]:
        later = Shelf()
        run(one, saved=saved, shelf=later, most=len(saved.arrays["holding"]) + 5)
        assert everything(run(one, saved=later.saved[-1])) == everything(whole)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.usefixtures("_often")
def test_a_limit_of_states_or_of_time_may_be_raised(threads):
    one, shelf = read_system(GROWING), Shelf()
    run(one, shelf=shelf, most=50, threads=threads)
    again = run(one, saved=shelf.saved[-1], most=90, threads=threads)
    assert everything(again) == everything(explore(one, max_states=90))
    with pytest.raises(BigraphError, match=r"it has \d+ states, more than the limit of 20"):
        run(one, saved=shelf.saved[-1], most=20)
    run(one, shelf=shelf, seconds=0.0)
    assert everything(run(one, saved=shelf.saved[-1], most=90)) == everything(again)


def test_the_time_before_an_interruption_counts():
    shelf = Shelf()
    run(read_system(WALK), shelf=shelf)
    late = shelf.saved[-1]._replace(head={**shelf.saved[-1].head, "seconds": 3600})
    found = run(read_system(WALK), saved=late, seconds=3000.0)
    assert 3600 < found.seconds < 3700
    assert found.complete  # nothing was left to do


def test_an_interruption_while_a_saved_search_is_read_saves_nothing(monkeypatch):
    monkeypatch.setattr(exploration, "LOOK_EVERY", 0.0)
    one, shelf, later = read_system(WALK), Shelf(), Shelf()
    run(one, shelf=shelf)

    def watch(_):
        raise KeyboardInterrupt

    found = run(one, saved=shelf.saved[-1], shelf=later, watch=watch)
    assert found.reason == "it was interrupted"
    assert not later.saved


def test_a_checkpoint_that_cannot_be_written_ends_the_search():
    def write(_):
        raise OSError(28, "No space left on device")

    found = explore_long(
        read_system(WALK), ExplorationLimits(), 1, lambda _: None, Saving("the shelf", write)
    )
    assert found.reason == "the checkpoint can't be written to the shelf: No space left on device"


# --- files instead of memory ----------------------------------------------------------------------------------


@pytest.fixture
def _early(monkeypatch):
    """Let memory end at once, until states move to files."""
    spilled = []
    spill = StateStore.spill

    def spilling(self, folder):
        spilled.append(folder)
        spill(self, folder)

    monkeypatch.setattr(StateStore, "spill", spilling)
    monkeypatch.setattr(exploration, "memory_taken", lambda: 0 if spilled else 2)
    monkeypatch.setattr(file_columns, "TAIL", 5)


@crossed(list(SYSTEMS), {"1 process": 1, "3 processes": 3})
@pytest.mark.usefixtures("_often", "_early")
def test_states_in_files_are_the_same(name, variation, tmp_path):
    one, shelf = read_system(SYSTEMS[name][0]), Shelf()
    found = run(one, shelf=shelf, memory=1, spill=str(tmp_path), threads=variation, every=0.01)
    assert isinstance(found.targets, file_columns.FileColumn)
    whole = explore(one)
    assert everything(found) == everything(whole)
    assert everything(run(one, saved=shelf.saved[len(shelf.saved) // 2])) == everything(whole)
    assert list(tmp_path.iterdir()) == []


def test_memory_that_files_do_not_free_is_a_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(exploration, "LOOK_EVERY", 0.0)
    found = run(read_system(WALK), memory=3_000_000, spill=str(tmp_path))
    assert found.reason == "the memory limit of 3 MB was reached"
    assert run(read_system(WALK), memory=3_000_000).reason == found.reason
    assert run(read_system(WALK), memory=1 << 50).complete


@pytest.mark.usefixtures("_often", "_early")
def test_the_end_of_the_room_in_files_is_a_limit(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "posix_fallocate", full)
    found = run(read_system(WALK), memory=1, spill=str(tmp_path))
    assert found.reason == f"the free space in {tmp_path} ended: No space left on device"


# --- alterations ----------------------------------------------------------------------------------------------


@cache
def example(name):
    """Return a system, the end of its search, and the search when half of the states were expanded."""
    one, shelf = read_system(SYSTEMS[name][0]), Shelf()
    run(one, shelf=shelf, most=max(2, SYSTEMS[name][1] // 2))
    return one, everything(explore(one)), shelf.saved[-1]


def altered(saved, part, way, at, number):
    """Return a saved search of which one array or one value is another."""
    if part not in ARRAYS:
        return saved._replace(head={**saved.head, part: number})
    kind = ARRAYS[part]
    values = list(saved.arrays[part])
    wrapped = number % (1 << 8 * array(kind).itemsize) if kind.isupper() else number
    if way == "put" and values:
        values[at % len(values)] = wrapped
    elif way == "add" and values:
        values[at % len(values)] ^= 1
    elif way == "cut":
        del values[at % (len(values) + 1) :]
    elif way == "swap" and len(values) > 1:
        at %= len(values) - 1
        values[at : at + 2] = values[at + 1], values[at]
    else:
        values.append(wrapped)
    return saved._replace(arrays={**saved.arrays, part: array(kind, values)})


@pytest.mark.parametrize("part", ARRAYS)
@pytest.mark.parametrize("way", ["put", "add", "cut", "swap", "longer"])
def test_each_array_that_was_altered_is_refused_or_has_no_effect(part, way):
    one, end, saved = example("edges")
    for at in range(0, len(saved.arrays[part]), max(1, len(saved.arrays[part]) // (12 if IS_WHOLE else 6))):
        with suppress(BigraphError):
            assert everything(run(one, saved=altered(saved, part, way, at, 1))) == end


@pytest.mark.fuzz
@pytest.mark.parametrize("seconds", [0.0, 9.0])
@settings(max_examples=max(75, MANY))
@given(
    st.sampled_from(["edges", "sharing", "names", "predicates", "weights"]),
    st.sampled_from([*ARRAYS, "seconds", "occurrences", "holding", "kinds"]),
    st.sampled_from(["put", "add", "cut", "swap", "longer"]),
    st.integers(0, 1 << 12),
    NUMBERS,
    VALUES,
)
def test_forged_searches_are_refused_or_end(seconds, name, part, way, at, number, value):  # noqa: PLR0917
    one, end, saved = example(name)
    forged = altered(saved, part, way, at, value if part not in ARRAYS else number)
    with pytest.MonkeyPatch.context() as patch, suppress(BigraphError):
        patch.setattr(resumption, "REPEATED", seconds)
        found = run(one, saved=forged, most=2 * len(end[0]))
        assert (len(found), len(found.targets)) == (len(end[0]), len(end[1][1]))
        if seconds:  # the whole search was compared
            assert everything(found) == end


@pytest.mark.parametrize("name", ["edges", "sharing", "weights"])
def test_random_states_are_expanded_again_where_not_all_are(name, monkeypatch):
    monkeypatch.setattr(resumption, "REPEATED", 0.0)
    one, _, saved = example(name)
    (weight, rules, occurrences, action), *others = saved.head["kinds"]
    kinds = [(weight, rules, occurrences + 1, action), *others]
    with pytest.raises(BigraphError, match="has other transitions"):
        run(one, saved=saved._replace(head={**saved.head, "kinds": kinds}))


def test_a_search_of_another_system_is_refused():
    _, _, saved = example("edges")
    with pytest.raises(BigraphError, match="this checkpoint is damaged"):
        run(read_system(WALK), saved=saved)
