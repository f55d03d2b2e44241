"""Features two by two: each is decided as the reference engine decides it without options, or refused by name.

A row of a covering array chooses features of a mission and options of a check, so that every two meet. What is asked
of a row holds for all: the same configurations and verdicts (with times, those of whole ticks), everything shown
replays, what is not supported is refused with a reason, and nothing raises.
"""

from dataclasses import replace

import pytest
from checked_missions import interrupted_at, load
from covering import covering_array, pairs_of, spread
from features import LANGUAGE, NO, OPTIONS, YES, text_of
from option_pairs import spilled_rows
from replaying import assert_replays
from scale import IS_WHOLE, long_if

from checker import CombinationError, Engine, Keeping, Limits, Reduction, ZoneClock, check
from checker.check import reductions_of
from checker.engines.fast import explorer
from checker.engines.fast.store import row_store
from checker.engines.zones import explorer as timed_explorer
from checker.reduction.refusals import RefusedError
from specs.diagnostics import MissionError

MOST = Limits(configurations=20_000)
REDUCTIONS = {NO: (), "por": (Reduction.POR,), "symmetry": (Reduction.SYMMETRY,), "both": tuple(Reduction)}
OF_RUNS = {"ltl": NO, "ctl": NO, "progress": NO}
FACTORS = {**LANGUAGE, **OPTIONS}
UNTIMED = covering_array({key: each for key, each in FACTORS.items() if key != "timing"}, seed=2)
HAVE_ZONES = {"timing": YES, "control": "timed", "engine": "fast", "spawn": NO, "reduction": NO} | OF_RUNS
CHOICES = {**FACTORS, "scheduler": ("program_order", "unordered")}
IN_ZONES = covering_array({key: each for key, each in CHOICES.items() if key not in HAVE_ZONES}, seed=5)
"""Of missions whose zones have local time unless one clock is chosen: every two of their choices meet there, too."""
ARRAY = [{**row, "timing": timing} for timing in (NO, YES) for row in UNTIMED]
ARRAY += [{**row, **HAVE_ZONES} for row in IN_ZONES]
LARGE = (2, 21, 23, 25, 29, 33, 41, 55)
"""The numbers of rows whose missions are too large for the reference engine, so that nothing is compared there."""
LEAST = {key: choices[0] for key, choices in FACTORS.items()} | {"control": "timed"}
APART = (
    {"scheduler": "fcfs", "channels": "leave"},
    {"ltl": "plain", "reduction": NO},
    {"ltl": "plain", "regions": "plain"},
    {"ltl": "plain", "threads": "1", "engine": "fast"},
)
"""What would meet in large rows only meets in small ones of its own."""
ARRAY += [{**LEAST, **choices} for choices in APART]
SEEDS = range(3)
CASES = [(number, seed) for seed in SEEDS for number in range(len(ARRAY)) if number not in LARGE]
COMPARED = [row for number, row in enumerate(ARRAY) if number not in LARGE]
FAST = [row for row in COMPARED if (row["engine"], row["timing"]) == ("fast", NO)]
FEW = [
    pytest.param(ARRAY.index(row), 0, marks=long_if(row["rows"] == "compressed" and row["reduction"] != NO))
    for row in spread(FAST, 5)
]
"""Without times, which whole ticks take long to go through (`engines/timed` compares smaller ones)."""


def test_every_two_choices_meet_in_some_row():
    met = set().union(*map(pairs_of, ARRAY))
    assert len(met) == sum(len(FACTORS[a]) * len(FACTORS[b]) for a in FACTORS for b in FACTORS if a < b)
    allowed = set().union(*(pairs_of(supported(row)) for row in ARRAY))
    assert set().union(*(pairs_of(supported(row)) for row in COMPARED)) == allowed


def supported(row):
    """Return the row without what its mission may not have; each of that is refused by name."""
    if row["timing"] == YES and row["control"] == "atomic":
        refused_by_name(row, "a mission with 'timing' has control that takes time")
        row = {**row, "control": "timed"}
    if row["regions"] != NO and row["control"] == "atomic":
        refused_by_name(row, "nothing is under way")
        row = {**row, "regions": NO}
    if row["timing"] == YES and row != {**row, **OF_RUNS}:
        refused_by_name(row, "timing")
        row = {**row, **OF_RUNS}
    return row


def refused_by_name(row, words):
    with pytest.raises(MissionError) as refused:
        load(text_of(row, 0), "")
    assert any(words in each.message for each in refused.value.diagnostics)


def reduced(mission, row):
    """Return the reductions that a mission allows; what is refused says so with its reason."""
    asked = REDUCTIONS[row["reduction"]]
    allowed = []
    for each in asked:
        if each in reductions_of(mission):
            allowed.append(each)
            continue
        with pytest.raises((CombinationError, RefusedError), match=f"the reduction '{each}' is refused: "):
            check(mission, limits=MOST, reduce=[each])
    return tuple(allowed)


def checked(mission, row, reductions, folder):
    """Check a mission as a row says."""
    engine = Engine(row["engine"])
    options = {"engine": engine, "reduce": reductions}
    if engine is Engine.REFERENCE:
        for more in (
            {"keeping": Keeping(str(folder), digest="d")},
            {"limits": replace(MOST, spill=str(folder))},
            {"threads": int(row["threads"])},
        ):
            with pytest.raises(CombinationError, match="works with the fast"):
                check(mission, **{"limits": MOST, **options, **more})
        return check(mission, limits=MOST, **options)
    options |= {"threads": int(row["threads"]), "clock": ZoneClock(row["clock"])}
    limits = MOST
    if row["spill"] == YES:
        (folder / "spill").mkdir()
        limits = replace(limits, memory=1, spill=str(folder / "spill"))
    if row["resumed"] == YES:
        kept = Keeping(str(folder), digest="d", every=0.0)
        early, stop = interrupted_at(15, limits)
        check(mission, limits=early, report=stop, keeping=kept, **options)
        options["keeping"] = replace(kept, resumed=any(folder.glob("*.checkpoint")))
    return check(mission, limits=limits, **options)


@pytest.fixture
def rows_that_move(monkeypatch):
    """Let memory end until rows are in files, and yield what lets them be compressed amid the search."""
    monkeypatch.setattr(explorer, "CHUNK", 8)
    monkeypatch.setattr(timed_explorer, "CHUNK", 8)

    def compress():
        monkeypatch.setattr(row_store, "PLAIN", 1)
        monkeypatch.setattr(row_store, "COMPRESSED_FROM", 8)

    with spilled_rows():
        yield compress


@pytest.mark.fuzz
@pytest.mark.parametrize(("number", "seed"), CASES if IS_WHOLE else FEW)
def test_features_that_meet_are_decided_as_each_alone(number, seed, tmp_path, rows_that_move):
    row = supported(ARRAY[number])
    mission = load(text_of(row, seed), "")
    right = check(mission, engine=Engine.REFERENCE, limits=MOST)
    assert right.complete  # else nothing is compared
    reductions = reduced(mission, row)
    if row["rows"] == "compressed":
        rows_that_move()
    found = checked(mission, row, reductions, tmp_path)
    assert_replays(right)
    assert_replays(found)
    assert not list(tmp_path.rglob("spill/*"))
    if not reductions:
        assert (found.configurations, found.transitions) == (right.configurations, right.transitions)
        assert found.rules == right.rules
    for one, other in zip(found.verdicts, right.verdicts, strict=True):
        undecided = bool(reductions) and one.note.startswith("not decided under this reduction: ")
        assert undecided or one.outcome is other.outcome, one.property.name
        if not reductions:
            assert (one.count, one.examined, one.note) == (other.count, other.examined, other.note)
