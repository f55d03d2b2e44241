"""Symmetry in the fast explorer: it visits what the reference explorer visits, in the same order."""

from contextlib import nullcontext, suppress
from math import comb

import pytest
from checked_missions import load, visited
from hypothesis import given
from hypothesis import strategies as st
from scale import crossed, examples
from shipped import UNTIMED
from swarms import AROUND, BASE, LOOKS, ORBITS, mission, swarm, swarms
from test_symmetry import BOTH, LATE, SYMMETRY

from benchmarks.patrol import COUNTS, mission_text
from checker import Engine, Keeping, Limits, RefusedError, check, explore
from checker.engines.fast.search.crosscheck import Disagreement
from checker.reduction import Reduced
from checker.traces import replay, to_json
from specs.elaboration import load_mission

EITHER = {"symmetry": SYMMETRY, "both": BOTH}


def assert_alike(initial, reductions=SYMMETRY, most=None):
    fast, slow = (
        explore(
            initial, reduce=Reduced(initial, reductions), engine=engine, limits=Limits(configurations=most)
        )
        for engine in (Engine.FAST, Engine.REFERENCE)
    )
    assert visited(fast) == visited(slow)
    assert fast.allowed == slow.allowed


TOLD = "BigActor base hosted_at gcs0 with_behavior { react { case a: Message => react { case b: Message => skip } } }"
FAMILIES = {name: mission(body, robots, rest) for name, (body, rest, robots) in ORBITS.items()} | {
    "see each other": mission("observe(CHILDREN(dock0)) react { case o => control(MOVE_HOST_TO room0) }", 4),
    "observations in one mailbox": mission(
        "observe(CHILDREN(dock0)) react { case o => send o to base }", 2, TOLD
    ),
    "unordered lines": mission(f"{LOOKS} observe(PARENT(HOST))", 2, "scheduler unordered"),
    "one queue": mission(LOOKS, 3, "scheduler fcfs"),
    "in time": mission(LOOKS, 3, f"control timed\n{BASE}"),
    "more than one bound": mission(LOOKS, 6),
}


@crossed(list(FAMILIES), EITHER)
def test_it_visits_what_the_reference_explorer_visits(name, variation):
    with suppress(RefusedError) if variation == BOTH else nullcontext():
        assert_alike(FAMILIES[name].initial, variation, most=300)


@given(text=swarms(), reductions=st.sampled_from([SYMMETRY, BOTH]))
@examples(18)
def test_generated_swarms_are_visited_alike(reductions, text):
    with suppress(RefusedError) if reductions == BOTH else nullcontext():
        assert_alike(load(text, "").initial, reductions, most=200)


@crossed(UNTIMED, EITHER)
def test_missions_that_ship_are_visited_alike_or_refused(name, variation):
    with suppress(RefusedError):
        assert_alike(load_mission(name).initial, variation, most=200)


def crates(count, text):
    """Return a mission with so many more entities that host nobody."""
    there = "".join(f"  c{k}: Crate = point (37.04, -8.70)\n" for k in range(count))
    return load(text.replace("}\ndef", f"{there}}}\ndef"), "").initial


def test_entities_and_robots_are_exchanged_side_by_side():
    around = "environment { c0 vanishes c1 vanishes c2 vanishes }"
    assert_alike(crates(3, swarm("observe(CHILDREN(room0)) react { case o => skip }", 2, around)))


# --- counts that do not come from either explorer -------------------------------------------------------------------


def size(initial, *reductions):
    reduced = Reduced(initial, reductions) if reductions else None
    return len(explore(initial, reduce=reduced, engine=Engine.FAST).configurations)


@pytest.mark.parametrize("robots", [2, 10, 15])
def test_robots_apart_are_counted_as_a_multiset(robots):
    assert size(mission(LOOKS, 1).initial) == 7
    assert size(mission(LOOKS, robots).initial, *SYMMETRY) == comb(robots + 6, robots)


def patrol(agents):
    return load(mission_text(agents, 2, together=True), "").initial


@pytest.mark.long
def test_the_patrol_is_counted_by_burnsides_lemma():
    one, two, three = (size(patrol(agents)) for agents in (1, 2, 3))
    assert one == COUNTS[1, 2, False][0]  # as SPIN counts it
    # An exchange leaves a configuration as it is where those exchanged are in one state: as if there were one of them.
    assert 2 * size(patrol(2), *SYMMETRY) == two + one
    assert 6 * size(patrol(3), *SYMMETRY) == three + 3 * two + 2 * one


# --- verdicts ---------------------------------------------------------------------------------------------------------


def verdicts(loaded, engine, reductions=SYMMETRY, **more):
    report = check(loaded, engine=engine, reduce=reductions, **more)
    told = [
        (
            each.outcome,
            each.count,
            each.examined,
            [(one.message, one.trace) for one in each.violations],
            each.witness,
        )
        for each in report.verdicts
    ]
    return told, report.configurations, report.transitions


ASKED = {
    "where robots vanish": LATE.replace("robot2 vanishes ", ""),
    "of races": "check { race_freedom deadlock_freedom local_consistency }",
    "where words are said": AROUND[1],
    "where a channel drops": AROUND[2],
    "where robots leave": AROUND[4],
}


@crossed(list(ASKED), EITHER)
def test_verdicts_and_traces_are_those_of_the_reference_explorer(name, variation):
    loaded = mission(LOOKS, 2, ASKED[name])
    fast = verdicts(loaded, Engine.FAST, variation)
    assert fast == verdicts(loaded, Engine.REFERENCE, variation)
    assert fast == verdicts(loaded, Engine.FAST, variation, keeping=Keeping(doubted=30))
    for *_, found, witness in fast[0]:
        for trace in [trace for _, trace in found] + ([witness] if witness else []):
            assert replay(loaded.initial, to_json(trace, "m", "d")) == trace


def test_a_paranoid_check_notices_what_does_not_represent(monkeypatch):
    loaded = mission(LOOKS, 3, LATE)
    monkeypatch.setattr("checker.reduction.symmetry.MissionSymmetry.representative", lambda _, c: c)
    with pytest.raises(Disagreement):
        verdicts(loaded, Engine.FAST, keeping=Keeping(doubted=30))
