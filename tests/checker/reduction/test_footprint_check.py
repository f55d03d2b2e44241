"""What rules read and write lies within what reductions say of them, and it is noticed where it doesn't."""

from contextlib import suppress
from dataclasses import replace
from itertools import chain

import pytest
from checked_missions import WORLD, load, start
from hypothesis import given
from hypothesis import strategies as st
from scale import IS_WHOLE, crossed, examples
from shipped import UNTIMED
from test_partial_order import CHANGED, POR, PROGRAMS, SPAWNED, TEXTS, VARIATIONS, asked_of, atoms_of

from checker import Engine, Keeping, Limits, Outcome, check, explore
from checker.engines.contract import sample
from checker.reduction import Ample
from checker.reduction.footprint_check import Drift, outside, unheeded
from checker.reduction.footprint_slots import NOTHING
from semantics import control
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.reaction_rules import CONTROL_AUTHORITY
from semantics.control import PREMISES, Obstacle, Premise
from semantics.properties import propositions
from semantics.properties.propositions import Ended, HasPending, HostedAt, Inside, Known, Waiting
from semantics.races.monitor import monitored
from semantics.state.requests import CTR
from semantics.successors import expand
from specs import MissionError
from specs.elaboration import load_mission


def outside_of(initial, formulas=(), most=60, count=5):
    """Return what lies outside in a sample of configurations, with the monitor's memory and without."""
    found = set()
    for begin, asked in ((initial, formulas), (monitored(initial), ())):
        configurations = explore(begin, limits=Limits(configurations=most)).configurations
        ample = Ample(begin, asked)
        for number in sample(len(configurations), count):
            found.update(outside(ample, configurations[number]))
    return found


@crossed(UNTIMED, VARIATIONS)
def test_nothing_lies_outside_in_a_mission(name, variation):
    mission = load_mission(name, variation)
    assert outside_of(mission.initial, asked_of(mission), most=200, count=6) == set()


@given(PROGRAMS, st.data())
@examples(40)
def test_nothing_lies_outside_in_generated_programs(initial, data):
    assert outside_of(initial, data.draw(st.lists(atoms_of(initial), max_size=2))) == set()


@given(TEXTS)
@examples(15)
def test_nothing_lies_outside_in_generated_missions(text):
    with suppress(MissionError):  # some are found wrong before they are run
        initial = load(text).initial
        assert (
            outside_of(initial, [Inside("uav0", "gate0", actually=True), Ended(initial.alpha.names()[0])])
            == set()
        )


LOADED = """
BigActor a hosted_at vessel0 with_behavior { control(MOVE_HOST_TO gate0) control(PUT drifter0 IN gate0) }
BigActor b hosted_at gcs0 with_behavior { observe(CHILDREN(gate0)) react { case o if drifter0 in o => skip } }
environment { vessel0 vanishes }
"""
MOVED_AND_HANDED = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }
BigActor b hosted_at gcs0 with_behavior {
  observe(CHILDREN(PARENT(HOST)))
  react { case o if uav0 in o => control(HAND uav0 TO gcs0) case o => skip }
}
control timed
"""
BOARDS = """
BigActor a hosted_at vessel0 with_behavior { control(MOVE_HOST_TO vessel1) }
BigActor b hosted_at vessel1 with_behavior { control(MOVE_HOST_TO gate0) }
"""
BOARDED = WORLD.replace("carries Drifter", "carries Vessel, Drifter").replace(
    "  gate0:", "  vessel1: Vessel = point (36.974, -8.69)\n  gate0:"
)
MISSED = """
BigActor a hosted_at uav0 with_behavior { observe(LINKED_TO(uav0)) react { case o => skip } }
BigActor b hosted_at vessel0 with_behavior { control(PUT drifter0 IN south0) }
environment { observe may miss vessel0 }
"""
RACING = """
rule enter(v: Vessel) { v || gate0 -> gate0.v }
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react { case o => let n = size(o) control(MOVE_HOST_TO gate0) send(("seen", n), c) }
}
BigActor b hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }
BigActor c hosted_at vessel0 with_behavior {
  observe(LINKED_TO(uav1))
  react { case o: Observation if size(o) < 9 => react { case (w, n) if n == 1 => control(enter(vessel0)) } }
}
"""
ASKED = """
BigActor a hosted_at gcs0 with_behavior {
  observe(LINKED_TO(uav1)) react { case o => let n = size(o) send(("seen", n), c) control(HAND uav0 TO gcs1) }
}
BigActor b hosted_at gcs1 with_behavior { control(HAND uav1 TO gcs2) }
BigActor c hosted_at uav0 with_behavior {
  observe(CHILDREN(PARENT(LINKED_TO(gcs1))))
  react { case o: Observation if size(o) < 9 => react { case (w, n) if n == 4 => control(MOVE_HOST_TO gate0) } }
}
"""
OF_B = [Waiting("b"), HostedAt("b", "uav0"), HasPending("b"), Ended("b"), Known("uav0")]


@pytest.mark.parametrize(
    ("text", "formulas", "world"),
    [
        (LOADED, (), WORLD),
        (MOVED_AND_HANDED, (), WORLD),
        (BOARDS, (), BOARDED),
        (MISSED, (), WORLD),
        (RACING, (), WORLD),
        (ASKED, (), WORLD),
        (SPAWNED, OF_B, WORLD),
    ],
    ids=[
        "what is carried goes with its carrier",
        "links of what moves",
        "what may be in what it boards",
        "what is missed with its carrier",
        "what others have seen in a place that may have to be empty",
        "what others have seen of links",
        "who is spawned",
    ],
)
def test_nothing_lies_outside_of(text, formulas, world):
    assert outside_of(start(text, world), formulas, most=400, count=60) == set()


LOOKS_TWICE = """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0)) observe(LINKED_TO(uav0))
  react { case o if uav1 in o => skip } control(MOVE_HOST_TO gate0) send("in", b)
  react { case p => control(HAND uav0 TO gcs0) }
}
BigActor b hosted_at gcs0 with_behavior { react { case "in" => control(MOVE uav0 TO south0) } }
BigActor c hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0) }
"""


@pytest.mark.parametrize("variation", ["", "scheduler unordered", "control timed"])
def test_nothing_lies_outside_of_a_search_that_begins_in_the_middle(variation):
    found = explore(start(f"{LOOKS_TWICE}{variation}\n")).configurations
    for number in sample(len(found), 40):
        begin = found[number]
        asked = OF_B if number % 2 else ()
        begin = begin if number % 2 else monitored(begin)
        ample = Ample(begin, asked)
        for c in (begin, *(step.target for step in expand(begin).transitions)):
            assert set(outside(ample, c)) == set()


BUSY = """
BigActor mover hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) control(MOVE uav0 TO north0) }
BigActor sailor hosted_at vessel0 with_behavior { control(MOVE_HOST_TO gate0) }
environment {
  drifter0 vanishes
  uav0 leaves mesh and returns
  uav1 leaves control:gcs0 and returns
  internet drops and returns
}
"""
BUSY_WORLD = WORLD.replace("linked control:gcs1, mesh", "linked control:gcs0, mesh")
REQUESTS = {
    "MOVE_HOST_TO": ("uav0", "MOVE_HOST_TO gate0 VIA north0"),
    "MOVE": ("uav0", "MOVE uav1 TO gate0"),
    "PUT": ("vessel0", "PUT drifter0 IN gate0"),
    "HAND": ("uav0", "HAND uav1 TO gcs1"),
    "CONNECT_HOST_TO": ("uav0", "CONNECT_HOST_TO gcs1"),
    "DISCONNECT_HOST_FROM": ("uav0", "DISCONNECT_HOST_FROM vessel0"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_nothing_lies_outside_where_others_change_all_that_a_command_may_read(name):
    host, request = REQUESTS[name]
    asking = f"BigActor a hosted_at {host} with_behavior {{ control({request}) }}"
    most, count = (400, 40) if IS_WHOLE else (200, 20)
    assert outside_of(start(BUSY + asking, BUSY_WORLD), most=most, count=count) == set()


# --- the rules drift ------------------------------------------------------------------------------------------

AUTHORISED = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) }
environment { uav0 leaves control:gcs0 }
check { deadlock_freedom }
"""


@pytest.fixture
def premise(monkeypatch):
    """Put one premise more before every control: a host that L has on a control authority must be on one in P."""

    def has_authority(c, request, _):
        host = c.alpha.host(request.agent)
        believed = [each for each in c.structure.logical.links(host) if each.startswith(CONTROL_AUTHORITY)]
        return not believed or any(c.structure.physical.connected(each, host) for each in believed)

    premise = Premise("a's host on an authority", has_authority, Obstacle.INCONSISTENT)
    monkeypatch.setitem(PREMISES, CTR, (*PREMISES[CTR], premise))


def verdict(reduce=(), **options):
    mission = load(AUTHORISED)
    found = check(mission, reduce=reduce, **options).verdicts
    return next(each.outcome for each in found if each.property.kind == "deadlock_freedom")


def test_reductions_lose_a_violation_that_a_premise_more_makes(premise):  # noqa: ARG001  # it is there
    assert verdict() is Outcome.VIOLATED
    assert verdict(POR) is Outcome.HOLDS  # which is wrong, and why there is a crosscheck


def test_a_premise_more_is_noticed(premise):  # noqa: ARG001  # it is there
    assert outside_of(start(AUTHORISED)) == {
        "actuate of 'a' reads ('channels', 'uav0'), which its footprint leaves out",
        "hindered of 'a' reads ('channels', 'uav0'), which its footprint leaves out",
    }


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_a_paranoid_check_stops_at_a_premise_more(premise, engine):  # noqa: ARG001  # it is there
    with pytest.raises(Drift, match="actuate of 'a' reads") as found:
        verdict(POR, engine=engine, keeping=Keeping(doubted=100))
    assert "in the configuration" in str(found.value)


def test_what_more_is_written_is_noticed(monkeypatch):
    def moving_all(c, request):
        for found in control.realisations(c, request):
            yield replace(found, physical=found.physical | c.structure.physical.joining("uav1", frozenset()))

    monkeypatch.setattr("semantics.rules.realisations", moving_all)
    assert outside_of(start(AUTHORISED)) == {
        "actuate of 'a' writes ('channels', 'uav1'), which its footprint leaves out",
    }


def test_what_more_a_property_reads_is_noticed(monkeypatch):
    mission = start(AUTHORISED)
    assert outside_of(mission, [Inside("uav0", "gate0")]) == set()
    monkeypatch.setattr("semantics.properties.propositions._believed_places", propositions._actual_places)
    assert outside_of(mission, [Inside("uav0", "gate0")]) == {
        "the property 'uav0 in gate0' reads ('placement', 'uav0'), which is not taken for visible"
    }


UNHEEDED = {
    "what is asked": ("_asked", lambda _: (), "'a' may ask for ('in', 'uav1')"),
    "which slots are used": ("_slots", lambda *_: frozenset(), "may ask for ('slot parent', 'uav0')"),
    "who is told": ("_whom", lambda _: frozenset(), "passes an observation on to 'c'"),
}


@pytest.mark.parametrize("forgotten", UNHEEDED)
def test_it_is_noticed_that_the_race_monitor_forgets_what_may_be_asked(forgotten, monkeypatch):
    what, instead, words = UNHEEDED[forgotten]
    initial = monitored(start(CHANGED))
    assert not list(chain(*map(unheeded, explore(initial).configurations)))
    monkeypatch.setattr(f"semantics.races.relevance.{what}", instead)
    configurations = explore(monitored(start(CHANGED))).configurations
    assert any(words in each for c in configurations for each in unheeded(c))
    with pytest.raises(Drift, match="which the race monitor forgets"):
        explore(monitored(start(CHANGED)), engine=Engine.FAST, keeping=Keeping(doubted=100))


FORGOTTEN = {
    "what comes of a program": ("actor_footprints.Actors._asked_by", NOTHING, "which no footprint contains"),
    "what a look adds": ("footprints.Footprints.telling", NOTHING, "writes ('ready', 'a')"),
    "who waits for mail": ("footprints.Footprints.waiting", NOTHING, "reads ('mailbox', 'c')"),
    "whom mail wakes": ("footprints.Footprints.mail", (), "writes ('mail', 'c'"),
    "where entities are": ("footprints.Footprints.where", 0, "reads ('placement', "),
    "that controls mark": ("race_footprints.Marks.made", NOTHING, "marks ("),
    "that agents pass marks on": ("race_footprints.Marks._of", NOTHING, "keeps ("),
}


@pytest.mark.parametrize(("what", "nothing", "words"), FORGOTTEN.values(), ids=FORGOTTEN)
def test_a_footprint_that_leaves_something_out_is_noticed(what, nothing, words, monkeypatch):
    monkeypatch.setattr(f"checker.reduction.{what}", lambda *_: nothing)
    assert any(words in each for each in outside_of(start(CHANGED), most=400, count=100))
