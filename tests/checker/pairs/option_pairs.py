"""Pairs of features of an exploration, each really run on a mission made for it, and held to the reference engine.

`python -m benchmarks.matrix` prints what `marked` returns; `test_capabilities.py` holds it to the table.
"""

import contextlib
import json
import tempfile
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from unittest.mock import patch

from local_crew import explore_in_threads

import checker.limits
from bigactors.cli import main
from bigraphs import SystemModel, find_matches
from bigraphs.examples import example_text
from bigraphs.notation import read_system
from checker import (
    CombinationError,
    Engine,
    Interruption,
    Keeping,
    Limits,
    Outcome,
    Reduction,
    check,
    explore,
)
from checker.engines.capabilities import Feature, Why, pair_of
from checker.engines.cluster import ray_crew, rounds, shard
from checker.engines.contract import Cluster
from checker.engines.fast.store import row_store
from checker.engines.fast.store.rows import Rows
from checker.engines.zones import explorer as zones
from specs.elaboration import read_mission

FEATURES = tuple(
    each
    for each in Feature
    if each not in (Feature.WORKERS, Feature.RESUME, Feature.MEMORY, Feature.MODEL, Feature.ATOMIC)
)
ENGINES = {Feature.REFERENCE: Engine.REFERENCE, Feature.FAST: Engine.FAST, Feature.RAY: Engine.RAY}
PAIRS = tuple(pair for pair in combinations(FEATURES, 2) if not {*pair} <= {*ENGINES})
REDUCTIONS = {Feature.POR: Reduction.POR, Feature.SYMMETRY: Reduction.SYMMETRY}
WRONG = "✗ "
RUNS = """
  ltl "stays": [] ((exists x: Robot . actually x in room0) -> [] exists x: Robot . actually x in room0)
  ltl "leaves": <> exists x: Robot . actually x in room0
  ctl "may leave": AG EF exists x: Robot . actually x in room0
  progress"""
TIMING = """
control timed
timing {
  tick 10 s
  Robot flies at 20 m/s to 25 m/s
  agents react within 10 s
  sense within 10 s
}"""


def text_of(robots, rooms, runs, timing, ways=False):
    """Return a mission of some robots that are alike, which look, and go to rooms in turn."""
    world = [
        f"  room{i}: Room = box ({37.2 + i / 10:.1f}, -8.6) ({37.15 + i / 10:.2f}, -8.7)"
        for i in range(rooms)
    ]
    world += [f"  robot{i}: Robot = point (37.05, -8.65) linked mesh" for i in range(robots)]
    goes = " ".join(f"control(MOVE_HOST_TO room{i})" for i in range(rooms))
    agents = "\n".join(f"BigActor a{i} hosted_at robot{i} with_behavior {{ look() }}" for i in range(robots))
    return f"""signature {{ kind Room contains Robot kind Robot driven }}
world {{
  hall: Room = box (37.1, -8.6) (37, -8.7)
{chr(10).join(world)}
}}
def look() = {{ observe(PARENT(HOST)) react {{ case obs => {goes} }} }}
{agents}
check {{
  local_consistency
  deadlock_freedom
  race_freedom
  reachable "there": exists x: Robot . actually x in room0
  invariant "one at a time": not exists x, y: Robot . x != y and actually x in room0 and actually y in room0{
        RUNS if runs else ""
    }
}}
{TIMING if timing else "control timed" if ways else ""}
"""


def marked(one, other):
    """Run a pair; return "✓", the table's reason where it is refused, or `WRONG` and the difference from the reference.

    A pair of two engines, or in the other order, is "–".

    Properties of runs stay incomplete where the table says so, and nowhere else.
    """
    if (one, other) not in PAIRS:
        return "–"
    asked = {one, other}
    expected = pair_of(one, other)
    if asked >= {Feature.TIMING, Feature.RUNS}:
        return expected.reason  # the language refuses it (LS613)
    timing, runs = Feature.TIMING in asked, Feature.RUNS in asked
    ways = Feature.WAYS in asked
    rooms = 1 if timing else 1 + PAIRS.index((one, other)) % 2
    mission = read_mission(text_of(2, rooms, runs, timing, ways))
    right = check(mission, engine=Engine.REFERENCE, times=timing, ways=ways)
    try:
        found = run(mission, asked)
    except CombinationError as refused:
        if expected is None or not expected.why.is_refusal or str(refused) != expected.reason:
            return f"{WRONG}refused, not by the table: {refused}"
        return expected.reason
    if expected is not None and expected.why.is_refusal:
        return f"{WRONG}accepted, against the table: {expected.reason}"
    difference = differing(mission, asked, found, right)
    if difference:
        return f"{WRONG}{difference}"
    return "✓" if expected is None else f"✓ {expected.reason}"


@contextlib.contextmanager
def spilled_rows():
    """Let memory end until rows are in files; yield the moves to files."""
    moves, spill = [], Rows.spill

    def noted(*given):
        spill(*given)
        moves.append(given)

    def taken():
        return 0 if moves else 2

    with contextlib.ExitStack() as patches:
        patches.enter_context(patch.object(Rows, "spill", noted))
        for each in (checker.limits, rounds, shard):
            patches.enter_context(patch.object(each, "memory_taken", taken))
        yield moves


def run(mission, asked):
    """Check a mission with some features; memory ends for a search that may spill, one with checkpoints is resumed."""
    with patch.object(zones, "CHUNK", 8):
        if Feature.SPILL not in asked:
            return _run(mission, asked)
        with spilled_rows() as moves, patch.object(ray_crew, "explore_with_ray", explore_in_threads):
            report = _run(mission, asked)
        assert moves
        return report


def _run(mission, asked):
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "spill").mkdir()
        limits = Limits(
            memory=1 if Feature.SPILL in asked else None,
            spill=f"{folder}/spill" if Feature.SPILL in asked else None,
        )
        kept = Keeping(
            folder if Feature.CHECKPOINT in asked else None,
            digest="pair",
            every=0.0,
            doubted=50 if Feature.PARANOID in asked else 0,
        )
        options = {
            "engine": next((ENGINES[each] for each in asked if each in ENGINES), Engine.FAST),
            "reduce": [REDUCTIONS[each] for each in asked if each in REDUCTIONS],
            "threads": 2 if Feature.THREADS in asked else None,
            "cluster": Cluster(2) if Feature.RAY in asked else None,
            "times": Feature.TIMING in asked,
            "ways": Feature.WAYS in asked,
        }
        for resumed in range(3 if Feature.CHECKPOINT in asked else 0):  # each goes one layer further
            early = replace(limits, interruption=Interruption())
            early.interruption.wish()
            again = replace(kept, resumed=resumed > 0)
            assert not check(mission, limits=early, keeping=again, **options).complete
        kept = replace(kept, resumed=Feature.CHECKPOINT in asked)
        return check(mission, limits=limits, keeping=kept, **options)


def differing(mission, asked, found, right):
    """Return how a report differs from the reference engine's, "" if it does not."""
    pair = pair_of(*asked)
    if found.schedule != right.schedule:
        return "other times of flights than by the reference engine"
    if found.corridors != right.corridors:
        return "other ways of flights than by the reference engine"
    for one, other in zip(found.verdicts, right.verdicts, strict=True):
        undecided = one.outcome is Outcome.INCOMPLETE and pair is not None and pair.why is Why.UNDECIDED
        if one.outcome is not other.outcome and not (undecided and one.note.startswith("not decided")):
            return (
                f"{one.property.name}: {one.outcome.value}, and {other.outcome.value} by the reference engine"
            )
    reductions = [REDUCTIONS[each] for each in asked if each in REDUCTIONS]
    alone = check(mission, engine=Engine.REFERENCE, reduce=reductions) if reductions else right
    counts, expected = ((each.configurations, each.transitions, each.complete) for each in (found, alone))
    return "" if counts == expected else f"{counts}, and {expected} by the reference engine"


def folded(other):
    """Run a pair of the fast engine and another feature with rows folded from the start; return its mark.

    The engine Ray then runs in this process, with properties of runs.
    """
    pair = (other, Feature.RUNS) if other is Feature.RAY else (Feature.FAST, other)
    seen, is_compressed = [], row_store.RowStore._is_compressed

    def noted(rows, packing):
        seen.append(is_compressed(rows, packing))
        return seen[-1]

    with (
        patch.object(row_store, "PLAIN", 0),
        patch.object(row_store, "COMPRESSED_FROM", 8),
        patch.object(row_store.RowStore, "_is_compressed", noted),
        patch.object(ray_crew, "explore_with_ray", explore_in_threads),
    ):
        mark = marked(*pair)
    return mark if any(seen) or not mark.startswith("✓") else "✓ rows stay plain"


LTL, CTL = "[] <> together", "AG EF together"
BIG = {
    Feature.THREADS: ["--threads", "2"],
    Feature.CHECKPOINT: ["--checkpoint", "kept"],
    Feature.SPILL: ["--spill", "spilled", "--max-memory", "4G"],
    Feature.RUNS: ["--ltl", LTL, "--ctl", CTL],
}
"""The words by which `bigactors big` has a feature."""


def of_system(other, name="uav_patrol"):
    """Explore a system of bigraphs with a feature, by the command line; return the mark, "–" without such an option."""
    if other not in BIG:
        return "–"
    model = SystemModel(read_system(example_text(name)))
    right = explore(model)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        words = ["big", "check" if other is Feature.RUNS else "full", name, *BIG[other], "--json"]
        if other is Feature.CHECKPOINT:
            main([*words, "early.json", "--max-states", "3"])
            words.insert(-1, "--resume")
        if main([*words, "found.json"]) == 2:
            return "not built yet"
        found = json.loads(Path("found.json").read_text())
    if other is Feature.RUNS:
        (predicate,) = model.machine.system.predicates
        together = {predicate.label: lambda state: any(find_matches(predicate.pattern, model.bigraph(state)))}
        expected = [right.ltl(LTL, **together).outcome.value, right.ctl(CTL, **together).outcome.value]
        values = [each["outcome"] for each in found["verdicts"]]
        return "✓" if values == expected else f"{WRONG}{values}, and {expected} by the model"
    states, transitions = len(found["states"]), len(found["transitions"])
    counts = (len(right.states), right.transitions)
    return (
        "✓"
        if (states, transitions) == counts
        else f"{WRONG}{states}, {transitions}, and {counts} by the model"
    )
