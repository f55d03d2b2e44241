"""Pairs of features of an exploration, each really run on a mission made for it, and held to the reference engine.

`python -m benchmarks.matrix` prints what `marked` returns; `test_capabilities.py` holds it to the table.
"""

import tempfile
from dataclasses import replace
from itertools import combinations
from pathlib import Path

from checker import CombinationError, Engine, Interruption, Keeping, Limits, Outcome, Reduction, check
from checker.engines.capabilities import Feature, Why, pair_of
from checker.engines.contract import Cluster
from specs.elaboration import read_mission

FEATURES = tuple(
    each for each in Feature if each not in (Feature.WORKERS, Feature.RESUME, Feature.MEMORY, Feature.MODEL)
)
ENGINES = {Feature.REFERENCE: Engine.REFERENCE, Feature.FAST: Engine.FAST, Feature.RAY: Engine.RAY}
PAIRS = tuple(pair for pair in combinations(FEATURES, 2) if not {*pair} <= {*ENGINES})
REDUCTIONS = {Feature.POR: Reduction.POR, Feature.SYMMETRY: Reduction.SYMMETRY}
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


def text_of(robots, rooms, runs, timing):
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
{TIMING if timing else ""}
"""


def marked(one, other):
    """Run a pair; return "✓", the table's reason where it is refused, or the difference from the reference engine.

    Properties of runs stay incomplete where the table says so, and nowhere else.
    """
    asked = {one, other}
    expected = pair_of(one, other)
    if asked >= {Feature.TIMING, Feature.RUNS}:
        return expected.reason  # the language refuses it (LS613)
    timing, runs = Feature.TIMING in asked, Feature.RUNS in asked
    rooms = 1 if timing else 1 + PAIRS.index((one, other)) % 2
    mission = read_mission(text_of(2, rooms, runs, timing))
    right = check(mission, engine=Engine.REFERENCE)
    try:
        found = run(mission, asked)
    except CombinationError as refused:
        if expected is None or not expected.why.is_refusal or str(refused) != expected.reason:
            return f"refused, not by the table: {refused}"
        return expected.reason
    if expected is not None and expected.why.is_refusal:
        return f"accepted, against the table: {expected.reason}"
    return differing(mission, asked, found, right) or ("✓" if expected is None else f"✓ {expected.reason}")


def run(mission, asked):
    """Check a mission with some features; a search with checkpoints is interrupted, and goes on."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "spill").mkdir()
        limits = Limits(
            memory=1 << 40 if Feature.SPILL in asked else None,
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
        }
        for resumed in range(3 if Feature.CHECKPOINT in asked else 0):  # each goes one layer further
            early = replace(limits, interruption=Interruption())
            early.interruption.wish()
            check(mission, limits=early, keeping=replace(kept, resumed=resumed > 0), **options)
        kept = replace(kept, resumed=Feature.CHECKPOINT in asked)
        return check(mission, limits=limits, keeping=kept, **options)


def differing(mission, asked, found, right):
    """Return how a report differs from the reference engine's, "" if it does not."""
    pair = pair_of(*asked)
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
