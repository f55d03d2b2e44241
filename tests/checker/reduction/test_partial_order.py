"""Partial-order reduction: verdicts, findings and what comes to rest are those of the full search."""

from contextlib import suppress
from pathlib import Path

import pytest
from checked_missions import WORLD, load, start, visited
from everything_found import everything, stale_races
from hypothesis import given
from hypothesis import strategies as st
from mission_texts import missions
from random_formulas import atoms_of
from scale import IS_WHOLE, crossed, examples, long_ones
from shipped import UNTIMED

from checker import Engine, Limits, Outcome, Reduction, RefusedError, check, explore
from checker.reduction import Reduced
from checker.reduction.cycle_proviso import NOWHERE, Lead, Paths
from checker.reduction.footprint_slots import NOTHING
from checker.traces import replay, to_json
from semantics import Control, Scheduler, hypothesis_strategies
from semantics.properties.propositions import Inside, Waiting
from semantics.races.monitor import monitored
from specs import MissionError
from specs.elaboration import Variation, load_mission

MISSIONS = Path(__file__).parents[3] / "specs" / "missions"
POR = (Reduction.POR,)

VARIATIONS = {
    f"{scheduler.value} {control.value}": Variation(scheduler=scheduler, control=control)
    for scheduler in (Scheduler.PROGRAM_ORDER, Scheduler.UNORDERED)
    for control in Control
}
LARGE = ("rendezvous", "takeover", "broken_deadlock", "spill_watch", "convoy")
SMALL = [name for name in UNTIMED if name not in LARGE]


def compared(initial, formulas=(), most=3_000):
    """Return how many configurations the full and the reduced search visit, once they found the same."""
    full, whole = everything(initial, formulas, most=most)
    if full is None:
        return None
    reduced, part = everything(initial, formulas, Reduced(initial, POR, formulas), most=most)
    assert reduced == full
    compared_races(initial, most)
    return len(whole.configurations), len(part.configurations)


def compared_races(initial, most=3_000):
    """Return how many configurations both searches for stale observations visit, once they found the same."""
    start = monitored(initial)
    full = stale_races(start, most=most)
    if full is None:
        return None
    messages, part = stale_races(start, Reduced(start, POR), most)
    assert messages == full[0]
    return full[1], part


def asked_of(mission):
    return [each.formula for each in mission.properties if each.kind in ("invariant", "reachable")]


def endless(name, variation):
    """Tell whether it asks again and again before it is served."""
    return name in ("nomad", "search_and_deploy") and variation.scheduler is Scheduler.UNORDERED


@pytest.mark.parametrize("name", [*long_ones("takeover"), "broken_deadlock"])
def test_a_larger_mission_has_the_same_findings(name):
    mission = load_mission(name)
    whole, part = compared(mission.initial, asked_of(mission))
    assert part * 4 <= whole


def test_a_reduced_search_says_so_and_counts_what_it_followed():
    mission = load_mission("rendezvous")
    report, other = (check(mission, reduce=POR, engine=engine) for engine in (Engine.REFERENCE, Engine.FAST))
    assert {each.outcome for each in report.verdicts} == {Outcome.HOLDS}  # as in tests/missions
    assert report.reduced == ("por",)
    assert (report.configurations, report.transitions, report.allowed) == (67, 83, 184)
    said = report.verdicts["race_freedom"].note
    assert said == "searched over 56 configurations with the monitor's memory, reduced by por"
    assert [(each.outcome, each.note, each.examined) for each in other.verdicts] == [
        (each.outcome, each.note, each.examined) for each in report.verdicts
    ]


# --- the fast explorer ----------------------------------------------------------------------------------------


def agreed(initial, formulas=(), most=600):
    """Assert that both explorers choose the same; return whether anything was left out."""
    slow, fast = (
        explore(
            initial,
            limits=Limits(configurations=most),
            engine=engine,
            reduce=Reduced(initial, POR, formulas),
        )
        for engine in (Engine.REFERENCE, Engine.FAST)
    )
    assert visited(fast) == visited(slow)
    assert fast.allowed == slow.allowed
    return fast.transitions < fast.allowed


# --- generated ------------------------------------------------------------------------------------------------


HOSTS = ("uav0", "uav1", "vessel0", "gcs0")
LOOK = "observe(PARENT(HOST)) react { case obs => skip }"
ROUNDS = (
    LOOK,
    "observe(CHILDREN(gate0)) react { case obs => skip }",
    f"control(MOVE_HOST_TO gate0) {LOOK}",
    f"{LOOK} control(MOVE_HOST_TO south0)",
    'react { case "go" => skip after 5 s => skip }',
)


@st.composite
def fleets(draw):
    """Return the text of agents that do the same again and again, some beside one another, and of one that does not."""
    hosts = draw(st.permutations(HOSTS))
    loops = [
        f"BigActor a{k} hosted_at {hosts[k]} with_behavior {{ loop {{ {draw(st.sampled_from(ROUNDS))} }} }}"
        for k in range(2)
    ]
    last = draw(st.sampled_from(['send("go", a0)', "control(MOVE_HOST_TO gate0)", "observe(PARENT(HOST))"]))
    return "\n".join([*loops, f"BigActor last hosted_at {hosts[2]} with_behavior {{ {last} }}\n"])


PROGRAMS = hypothesis_strategies.initial_configurations(
    schedulers=(Scheduler.PROGRAM_ORDER, Scheduler.UNORDERED), monitored=False
)
TEXTS = st.builds(
    "{}{}".format, st.one_of(missions(), fleets()), st.sampled_from(["", "scheduler unordered\n"])
)


def is_reduced_well(initial, formulas):
    """Assert that a reduced search finds the same, ignores nobody, and is the same by both explorers."""
    compared(initial, formulas, most=300)
    assert not ignored(initial, formulas, most=300)
    agreed(initial, formulas, most=120)
    agreed(monitored(initial), most=120)


@given(PROGRAMS, st.data())
@examples(90 if IS_WHOLE else 36)
def test_generated_programs_are_reduced_well(initial, data):
    is_reduced_well(initial, data.draw(st.lists(atoms_of(initial), max_size=2)))


@given(TEXTS, st.booleans())
@examples(60 if IS_WHOLE else 24)
def test_generated_missions_are_reduced_well(text, seen):
    with suppress(MissionError):  # some are found wrong before they are run
        formulas = [Inside("uav0", "gate0", actually=True), Waiting("a1" if "a1" in text else "a")]
        is_reduced_well(load(text).initial, formulas[: 2 * seen])


def test_a_trace_of_a_reduced_search_replays_but_is_not_said_to_be_a_shortest_one():
    mission = load_mission("broken_deadlock")
    (found,) = [v for v in check(mission, reduce=POR).verdicts if v.violations]
    trace = found.violations[0].trace
    assert trace.called == "a trace"
    assert replay(mission.initial, to_json(trace, "m", "d")) == trace


CYCLIC = """
believes { zone0 in gate0  gate0 in region }
rule see(u: UAV) { HOST[c] || u[c] || gate0.(zone0.$1 | $0) -> HOST[c] || u || gate0.(zone0.$1 | $0) }
BigActor a hosted_at gcs1 with_behavior { observe(PARENT(gate0)) react { case o => skip } }
BigActor b hosted_at gcs0 with_behavior { control(see(uav0)) }
check { local_consistency }
"""
"""What a sees takes zone0 out of gate0, where b believes it: they cannot both be in one another."""


def test_who_believes_what_another_sees_to_be_the_other_way_round_is_followed_before_and_after():
    world = WORLD.replace("  gate0:", "  zone0: Location = circle (37.00, -8.70) radius 600 m\n  gate0:")
    mission = load(CYCLIC, world)
    assert compared(mission.initial) == (8, 5)
    (found,) = check(mission.initial, mission.properties[:1], reduce=POR).verdicts[:1]
    assert {each.kind for each in found.violations} == {"inconsistent", "unmatched"}


def test_what_it_does_not_preserve_is_refused():
    mission = load_mission("oil_spill", Variation(scheduler=Scheduler.FCFS))
    with pytest.raises(
        RefusedError, match="'por' is refused: under 'scheduler fcfs' all requests stand in one"
    ):
        check(mission, reduce=POR)


# --- races ----------------------------------------------------------------------------------------------------

SPAWNED = """
def enter() = {
  observe(CHILDREN(gate0))
  react { case o if not (uav1 in o) => control(MOVE_HOST_TO gate0) case o => skip }
}
BigActor a hosted_at gcs0 with_behavior { spawn b hosted_at uav0 with_behavior enter() }
BigActor c hosted_at uav1 with_behavior { enter() }
"""


def test_both_explorers_follow_the_same_steps_where_an_agent_is_yet_to_be_spawned():
    assert agreed(monitored(start(SPAWNED)))


CHANGED = """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react {
    case obs if not (uav1 in obs) => send("go", c) control(MOVE_HOST_TO gate0)
    case obs => skip
  }
}
BigActor c hosted_at uav1 with_behavior { react { case "go" => control(MOVE_HOST_TO gate0) } }
"""
TOLD = """
BigActor a hosted_at gcs0 with_behavior {
  observe(CHILDREN(gate0))
  react {
    case obs if not (uav1 in obs) => send("go", b) send("go", c)
    case obs => skip
  }
}
BigActor b hosted_at uav0 with_behavior { react { case "go" => control(MOVE_HOST_TO gate0) } }
BigActor c hosted_at gcs1 with_behavior { react { case "go" => control(MOVE uav1 TO gate0) } }
"""


# --- the proviso ----------------------------------------------------------------------------------------------

BUSY = """
BigActor a hosted_at gcs0 with_behavior { loop { observe(PARENT(HOST)) react { case obs => skip } } }
BigActor b hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }
"""


ENDING_WAITS = """
BigActor a hosted_at gcs0 with_behavior {
  observe(ALL)
  react {
    case o: Observation => skip
    after 5 s => observe(ALL) react { case "never" => skip }
  }
}
BigActor b hosted_at gcs1 with_behavior { send("go", c) }
BigActor c hosted_at gcs2 with_behavior {
  react {
    case "go" => skip
    after 5 s => react { case "never" => skip }
  }
}
"""


@pytest.mark.parametrize("scheduler", ["program_order", "unordered"])
def test_what_ends_a_wait_is_followed_before_and_after_its_timeout(scheduler):
    full, reduced = compared(start(f"{ENDING_WAITS}scheduler {scheduler}"))
    assert reduced < full


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_a_loop_in_which_a_step_is_put_off_is_no_counterexample(engine):
    text = (
        (MISSIONS / "go_ahead.mission")
        .read_text(encoding="utf-8")
        .replace("strong fairness", "weak fairness")
    )
    mission = load(text, world="")
    found = check(mission, engine=engine, reduce=POR)
    assert [each.outcome for each in found.verdicts if each.property.name == "comes home"] == [
        Outcome.INCOMPLETE
    ]


def test_without_the_proviso_an_agent_that_is_never_done_would_put_off_another_for_ever(monkeypatch):
    initial = start(BUSY)
    away = [Inside("uav0", "gate0", actually=True)]
    assert compared(initial, away) is not None
    monkeypatch.setattr(Paths, "end", lambda *_: Lead(NOWHERE, frozenset()))  # each step leads on
    assert everything(initial, away, Reduced(initial, POR, away))[0] != everything(initial, away)[0]


class Watched(Reduced):
    """Notes whose steps are allowed in each configuration, whose are followed, and where they lead."""

    def __init__(self, *given):
        super().__init__(*given)
        self.allowed, self.followed, self.leads = {}, {}, {}

    def choose(self, c, expansion, *rest):
        found = super().choose(c, expansion, *rest)
        owners = self.ample.owners(c, expansion)
        self.allowed[c] = set(owners)
        self.followed[c] = {
            owner for owner, step in zip(owners, expansion.transitions, strict=True) if step in found.steps
        }
        self.leads[c] = {step.target for step in found.steps}
        return found

    def ignored(self):
        """Return who may take a step somewhere, and takes none anywhere on the way from there."""
        taken = self.followed
        while True:
            more = {c: taken[c].union(*map(taken.__getitem__, self.leads[c])) for c in taken}
            if more == taken:
                return {(owner, c) for c in taken for owner in self.allowed[c] - taken[c]}
            taken = more


def ignored(initial, formulas=(), most=2_000):
    """Return who is ignored by a reduced search; None where it is too large."""
    reduced = Watched(initial, POR, formulas)
    found = explore(initial, limits=Limits(configurations=most), reduce=reduced)
    return reduced.ignored() if found.complete else None


@crossed(UNTIMED, VARIATIONS)
def test_a_mission_is_reduced_well(name, variation):
    mission = load_mission(name, variation)
    if name in SMALL and not endless(name, variation):
        assert compared(mission.initial, asked_of(mission)) is not None
    most = 300 if IS_WHOLE else 150
    agreed(mission.initial, asked_of(mission), most=most)
    agreed(monitored(mission.initial), most=most)
    assert ignored(mission.initial, asked_of(mission), most=2_000 if IS_WHOLE else 500) in (set(), None)


# --- the tests would notice -----------------------------------------------------------------------------------

LATE = """
BigActor a hosted_at vessel0 with_behavior {
  react { case "first" => skip case "second" => control(MOVE_HOST_TO south0) }
}
BigActor b hosted_at uav0 with_behavior { send("first", a) }
BigActor c hosted_at uav1 with_behavior { send("second", a) }
"""
SEEN = """
BigActor a hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0) }
BigActor b hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react { case obs if uav1 in obs => send("seen", a) case obs => skip }
}
"""
AWAY = """
BigActor a hosted_at gcs0 with_behavior { migrate(gcs1) }
environment { internet drops }
"""
DRIFTS = """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react { case obs if uav1 in obs => send("seen", a) case obs => skip }
}
environment { uav1 drifts among gate0 }
"""
TWICE = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }
BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }
"""
PASSED = """
BigActor a hosted_at uav0 with_behavior { let mark = gcs2 control(MOVE_HOST_TO south0 VIA mark) }
environment { gcs2 vanishes }
"""
APART = """
BigActor a hosted_at gcs1 with_behavior { control(DISCONNECT_HOST_FROM gcs0) }
BigActor b hosted_at gcs0 with_behavior {
  migrate(gcs1) observe(CHILDREN(gate0))
  react { case arrived => send("here", c) }
}
BigActor c hosted_at gcs0 with_behavior { choose { migrate(gcs1) } or { skip } react { case "here" => skip } }
"""


MUTATIONS = {
    "what is passed on the way": ("footprints.Footprints.there", 0, PASSED),
    "messages that are delivered": ("footprints.Footprints.mail", (), LATE),
    "where vehicles are": ("footprints.Footprints.where", 0, DRIFTS),
    "channels that drop": ("footprints.Footprints.connected", 0, AWAY),
    "what a control writes": ("footprints.Footprints.control", NOTHING, TWICE),
    "what a look reads": ("footprints.Footprints.sense", NOTHING, SEEN),
    "that controls mark": ("race_footprints.Marks.made", NOTHING, CHANGED),
    "that agents pass marks on": ("race_footprints.Marks._of", NOTHING, CHANGED),
    "that messages carry marks": ("race_footprints.tellers", frozenset(), TOLD),
}


@pytest.mark.parametrize(("what", "nothing", "text"), MUTATIONS.values(), ids=MUTATIONS)
def test_a_footprint_that_leaves_something_out_is_noticed(what, nothing, text, monkeypatch):
    initial = start(text)
    assert compared(initial) is not None
    monkeypatch.setattr(f"checker.reduction.{what}", lambda *_: nothing)
    with pytest.raises(AssertionError):
        compared(initial)


def test_two_that_may_be_at_the_same_two_hosts_may_be_at_different_ones():
    assert compared(start(APART)) is not None


NEVER_ARRIVES = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) observe(HOST) react { case o => send("go", b) } }
BigActor b hosted_at uav1 with_behavior {
  observe(LINKED_TO(uav1)) react { case o: Observation => react { case "go" => skip } }
}
control timed
check { deadlock_freedom arrival }
"""


@pytest.mark.parametrize(
    "event", ["", "environment { gate0 drifts among circle (37.00, -8.70) radius 200 m }"]
)
@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_what_need_not_arrive_is_not_followed_before_others(event, engine):
    mission = load(f"{NEVER_ARRIVES}{event}")
    full, reduced = (check(mission, engine=engine, reduce=each) for each in ((), POR))
    assert [each.outcome for each in reduced.verdicts] == [each.outcome for each in full.verdicts]
    assert Outcome.VIOLATED in {each.outcome for each in full.verdicts}
