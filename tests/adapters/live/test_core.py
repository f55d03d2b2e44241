import pytest
from live_missions import (
    BESIDE,
    BETWEEN,
    EAST,
    TOUR,
    TWO,
    WEST,
    Run,
    aged,
    boat,
    flying,
    known_of,
    plan_of,
    seen,
)

from adapters.live.batch import Batch, GivingBack, Heard
from adapters.live.core import is_refused, resumed, watch
from adapters.live.operator_findings import MOST_REPORTED
from adapters.live.overrides import Overrides
from adapters.live.plan import Plan
from adapters.plugin import (
    Accepted,
    Doubted,
    Gone,
    GoTo,
    HandOver,
    LinkLost,
    LinkRestored,
    Rejected,
    TakenOver,
)
from physical import PhysicalProperty, polygon
from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from semantics.state.physical_model import InTransit, Placed
from semantics.state.requests import FLY

GO = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(east0))
  react { case obs => display(obs) }
}
"""
LATE = LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, Fallback.RETURN),))
GOES_ON = LivePolicy(Fallback.CONTINUE)


def test_nothing_is_commanded_before_the_vehicle_is_heard():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0)
    assert run.rules == ["req_ctr", "req_obs"]
    assert run.commands == []
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.rules[2:] == ["command"]
    assert [(type(told), told.entity, told.name) for told in run.commands] == [(GoTo, "uav0", "east0")]


def test_a_flight_is_committed_where_it_was_seen_to_end_and_not_before():
    run = flying(TOUR + GO)
    run.turn(1.0, seen("uav0", BETWEEN, 1.0))
    assert "commit" not in run.rules
    assert isinstance(run.state.configuration.structure.physical.placement("uav0"), InTransit)
    run.turn(2.0, seen("uav0", (37.011, -8.611), 2.0))
    assert run.rules[-4:] == ["commit", "sense", "rcv_obs", "fun"]
    placement = run.state.configuration.structure.physical.placement("uav0")
    assert isinstance(placement, Placed)
    assert placement.geometry.vertices == ((37.011, -8.611),)
    assert run.state.configuration.structure.logical.parent("uav0") == "east0"
    assert run.state.commanded.flights == {}


def test_a_position_that_changes_no_relation_is_no_step():
    run = flying()
    before = run.state.configuration
    run.turn(1.0, seen("uav0", (37.011, -8.651), 1.0), boat((37.031, -8.631), 1.0))
    assert run.steps == []
    assert run.state.configuration is before


def test_a_time_stamp_far_in_the_future_is_refused_and_told_of_once_however_wrong_it_is():
    run = Run(plan_of(TOUR + GO))
    for ahead in (*range(6, 60), 3600):
        run.turn(0.0, seen("uav0", WEST, float(ahead)))
    assert run.state.sightings.newest == {}
    assert run.kinds() == ["trouble"]


def test_strangers_with_ever_new_names_fill_no_memory():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, *(boat(EAST, 3600.0, f"stranger{number}") for number in range(MOST_REPORTED + 500)))
    assert run.kinds() == ["trouble"] * MOST_REPORTED
    assert len(run.state.reported.messages) == MOST_REPORTED
    run.turn(1.0, seen("uav0", WEST, 1.0), boat(EAST, 1.0))
    assert "broken assumption" in run.kinds()


def test_another_feed_may_not_speak_of_a_vehicle():
    run = flying(TOUR + GO)
    run.turn(1.0, seen("uav0", EAST, 1.0, plugin="ais"))
    assert "commit" not in run.rules
    assert run.kinds() == ["trouble"]


# --- assumptions ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("drifts", ["", "environment { boat0 drifts among point (37.005, -8.605) }"])
def test_a_boat_that_drifts_breaks_an_assumption_where_the_mission_lets_it_stand_still(drifts):
    run = flying(TOUR + drifts)
    run.turn(1.0, boat(EAST, 1.0))
    assert run.rules == ["env"]
    assert (run.kinds(), run.told) == (([], []) if drifts else (["broken assumption"], ["Hold"]))
    assert run.state.overrides.suspended != bool(drifts)


@pytest.mark.parametrize(("policy", "served"), [(LivePolicy(), False), (GOES_ON, True)])
def test_after_a_broken_assumption_no_control_is_served_unless_the_mission_goes_on(policy, served):
    run = Run(plan_of(TOUR + GO, policy))
    run.turn(0.0, boat(EAST, 0.0))
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.kinds() == ["broken assumption"]
    assert ("command" in run.rules) == served


def test_an_entity_that_nobody_announced_is_seen_and_reported():
    run = Run(plan_of(TOUR + GO, GOES_ON))
    run.turn(
        0.0, boat(EAST, 0.0, "mmsi123"), boat((40.0, -8.0), 0.0, "mmsi124")
    )  # the latter in none of the places
    assert run.labels[0] == "⟨env : mmsi123 appears in east0⟩"
    assert run.kinds() == ["broken assumption"]
    assert run.state.sightings.newest.keys() == {"mmsi123"}
    for now, at in ((1.0, WEST), (2.0, EAST)):
        run.turn(now, seen("uav0", at, now))
    assert run.shown == ["{east0, mmsi123, uav0}"]


SPILL = (
    TOUR.replace("kind Vessel\n", "kind Vessel\n kind OilSpill contains UAV\n")
    .replace("contains Location, Vessel", "contains Location, OilSpill, Vessel")
    .replace("  uav0: UAV", "  oilSpill0: OilSpill = circle (37.01, -8.61) radius 300 m\n  uav0: UAV")
)


def spill(at, time):
    return seen("oilSpill0", at, time, "camera", "OilSpill", ())


def test_a_spill_takes_its_shape_along():
    run = Run(plan_of(SPILL))
    ring = polygon([(37.008, -8.652), (37.012, -8.652), (37.012, -8.648), (37.008, -8.648)])
    run.turn(0.0, spill(EAST, 0.0))
    assert run.steps == []
    run.turn(1.0, Heard("camera", PhysicalProperty("oilSpill0", "OilSpill", ring, time=1.0)))
    assert run.state.configuration.structure.physical.abstract_parent("uav0") == "oilSpill0"
    assert run.kinds() == ["broken assumption"]


# --- hand-over, links, refusals -------------------------------------------------------------------------

HAND = (
    TOUR + "BigActor op hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1)\n observe(LINKED_TO_HOST) }"
)


def test_a_hand_over_is_true_once_the_vehicle_shows_it():
    run = flying(HAND)
    told = [(told.leave, told.join) for told in run.commands if isinstance(told, HandOver)]
    assert told == [("control:gcs0", "control:gcs1")]
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert "actuate" not in run.rules
    run.turn(2.0, seen("uav0", WEST, 2.0, channels=("control:gcs1",)))
    assert run.rules[-2:] == ["actuate", "sense"]
    assert run.findings == []
    assert run.state.configuration.structure.logical.links("uav0") == ("control:gcs1",)
    assert run.state.commanded.hand_overs == {}


@pytest.mark.parametrize("strict", [False, True])
def test_while_a_vehicle_confirms_a_hand_over_others_are_served_unless_the_verdict_is_one_under_fcfs(strict):
    run = flying(HAND + "BigActor z hosted_at gcs1 with_behavior { observe(ALL) }", strict=strict)
    assert ("sense" in run.rules) != strict


def test_a_link_that_comes_back_is_no_second_broken_assumption_but_another_authority_is_one():
    run = flying()
    run.turn(9.0, seen("uav0", WEST, 9.0, channels=()), reports=[LinkLost("uav0", 9.0, 0.0)])
    run.turn(12.0, seen("uav0", WEST, 12.0), reports=[LinkRestored("uav0", 12.0)])
    assert sorted(run.kinds()) == ["broken assumption", "link restored", "lost link"]
    assert run.labels[-1] == "⟨env : uav0 is on control:gcs0⟩"
    run.turn(13.0, seen("uav0", WEST, 13.0, channels=("control:gcs1",)))
    assert run.findings[-1].message.startswith("uav0 is on control:gcs1; the mission neither links it there")


@pytest.mark.parametrize(("where", "broken"), [((37.012, -8.612), 1), ((37.012, -8.652), 2)])
def test_what_vanished_and_appears_where_it_was_is_no_second_broken_assumption(where, broken):
    run = Run(plan_of(TOUR + "environment { boat0 drifts among east0, west0 }"))
    run.turn(0.0, aged(boat((37.011, -8.611), 0.0), 60.0))
    run.turn(61.0)
    assert run.kinds() == ["broken assumption"]
    run.turn(70.0, boat(where, 70.0))
    assert run.kinds() == ["broken assumption"] * broken
    assert run.labels[-1].startswith("⟨env : boat0 appears in")


def test_a_channel_that_may_drop_drops_and_returns_with_the_link():
    run = flying(TOUR + "environment { control:gcs0 drops and returns }")
    run.turn(9.0, reports=[LinkLost("uav0", 9.0, 0.0)])
    run.turn(12.0, seen("uav0", WEST, 12.0), reports=[LinkRestored("uav0", 12.0)])
    assert run.labels == ["⟨env : control:gcs0 drops⟩", "⟨env : control:gcs0 returns⟩"]
    assert run.kinds() == ["lost link", "link restored"]


def test_a_refused_command_stays_pending_and_is_not_committed_by_where_its_vehicle_comes():
    run = flying(TOUR + GO)
    run.turn(1.0, reports=[Rejected(run.commands[0].request, "uav0", 1.0, "not armed")])
    assert run.kinds() == ["refused"]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules
    (pending, *_) = run.state.configuration.eta.all()
    assert isinstance(pending.request, FLY)


def test_a_flight_that_takes_too_long_falls_back_and_is_never_committed():
    run = flying(TOUR + GO, LATE)
    assert run.again == 60.0
    run.turn(61.0, seen("uav0", BETWEEN, 61.0))
    run.turn(62.0, seen("uav0", EAST, 62.0))
    assert (run.kinds(), run.told) == (["late"], ["GoTo", "Return"])
    assert "commit" not in run.rules


# --- vehicles that do otherwise -------------------------------------------------------------------------


@pytest.mark.parametrize("before", [(), (Accepted("a-1", "uav0", 1.0), Doubted("uav0", 2.0))])
def test_a_vehicle_that_has_not_shown_that_it_does_what_it_was_told_has_not_arrived(before):
    run = flying(TOUR + GO, willing=False)
    run.turn(1.0, reports=before[:1])
    run.turn(2.0, seen("uav0", EAST, 2.0), reports=before[1:])
    assert "commit" not in run.rules
    run.turn(3.0, reports=[Accepted("a-1", "uav0", 3.0)])
    assert run.rules[-4] == "commit"


def test_a_vehicle_on_which_the_mission_falls_back_does_not_arrive_on_its_way_home():
    run = flying(TOUR + GO, LivePolicy(Fallback.RETURN))
    run.turn(1.0, boat(WEST, 1.0))
    assert run.told == ["GoTo", "Return"]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules


def test_a_hand_over_that_was_refused_is_told_again_when_the_vehicle_is_given_back():
    run = flying(HAND)
    run.turn(1.0, reports=[Rejected("op-1", "uav0", 1.0, "no answer")])
    run.turn(2.0, sayings=[GivingBack("uav0")])
    assert run.told == ["HandOver", "GiveBack", "HandOver"]


def test_a_run_that_is_resumed_gives_no_vehicle_back_by_itself():
    again = after_a_crash(flying(TOUR + GO), overrides=Overrides({"uav0": "it is in RTL"}))
    again.turn(101.0, seen("uav0", EAST, 101.0))
    assert again.rules == []


@pytest.mark.parametrize(
    ("more", "refused"),
    [
        ("", True),
        ("BigActor op hosted_at gcs0 with_behavior { observe(ALL) control(HAND uav0 TO gcs1) }", False),
        ('environment { says "go" to a at most once }', False),
    ],
)
def test_only_a_run_of_which_all_that_is_left_was_refused_has_nothing_left_to_do(more, refused):
    run = flying(TOUR + GO + more)
    assert not is_refused(run.state)
    run.turn(1.0, reports=[Rejected("a-1", "uav0", 1.0, "denied")])
    assert is_refused(run.state) == refused
    run.turn(2.0, reports=[TakenOver("uav0", 2.0, "it is in RTL")])
    assert not is_refused(run.state)


def test_an_agent_that_never_waits_does_not_keep_others_from_going_on():
    text = TOUR + (
        "BigActor a hosted_at gcs0 with_behavior { loop { observe(ALL)\n react { case x => skip } } }\n"
        "BigActor b hosted_at gcs0 with_behavior { observe(ALL)\n react { case x => display(x) } }"
    )
    run = Run(plan_of(text))
    run.turn(0.0)
    assert any(step.transition.label.agent == "b" and step.transition.shown for step in run.steps)
    taken = len(run.steps)
    assert taken < 400
    assert 0.0 < run.again < 0.2
    run.turn(0.01)
    assert len(run.steps) <= taken + 3


DRIFTING = SPILL + (
    "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO oilSpill0) }\n"
    "environment { oilSpill0 drifts among circle (37.012, -8.612) radius 300 m }"
)


@pytest.mark.parametrize("waits", [False, True])
def test_a_vehicle_is_sent_on_where_its_place_has_drifted_to_though_that_is_over_it(waits):
    run = flying(DRIFTING)
    at = (37.0139, -8.6139) if waits else (37.0135, -8.6135)
    run.turn(1.0, *([seen("uav0", at, 1.0)] * waits))
    run.turn(2.0, spill((37.013, -8.613), 2.0))
    assert "commit" not in run.rules  # it goes to where the place was
    first, second = run.commands
    assert first.request == second.request
    assert first.place != second.place
    assert run.findings == []
    run.turn(3.0, seen("uav0", at, 3.0))  # and here it shows that it goes to where it is
    assert run.rules[-1] == "commit"


def test_what_is_too_old_leaves_p_and_so_does_what_is_said_to_be_gone():
    run = Run(plan_of(TOUR + "environment { boat0 vanishes }"))
    run.turn(0.0, aged(boat((37.03, -8.63), 0.0), 60.0))
    run.turn(59.0)
    assert run.steps == []
    run.turn(61.0)
    assert run.labels == ["⟨env : boat0 vanishes⟩"]
    assert run.findings == []
    run.turn(62.0, boat((37.03, -8.63), 62.0))
    assert run.labels[1:] == ["⟨env : boat0 appears in region⟩"]
    run.turn(63.0, Heard("ais", Gone("boat0", 63.0, "ais")))
    assert run.labels[2:] == ["⟨env : boat0 vanishes⟩"]


@pytest.mark.parametrize(
    ("clause", "again", "looked", "broken"),
    [
        ("observe may miss Vessel", False, ", missing boat0", []),
        ("observe may miss Vessel", True, "", []),
        ("boat0 vanishes observe may miss Vessel", False, "", []),
        ("", False, "", ["broken assumption"]),
    ],
)
def test_what_is_no_longer_seen_is_missed_where_the_mission_says_so(clause, again, looked, broken):
    there = TOUR.replace("point (37.03, -8.63)", "point (37.015, -8.615)")
    run = Run(plan_of(f"{there}{GO}environment {{ {clause} }}", GOES_ON))
    run.turn(0.0, seen("uav0", WEST, 0.0), aged(boat((37.015, -8.615), 0.0), 60.0))
    run.turn(61.0)
    assert run.kinds() == broken
    physical = run.state.configuration.structure.physical
    assert ("boat0" in physical) == clause.startswith("observe")
    run.turn(62.0, seen("uav0", EAST, 62.0), *([boat((37.015, -8.615), 62.0)] if again else []))
    assert f"⟨sense : OBS(a, CHILDREN(east0)){looked}⟩" in run.labels
    assert ("boat0" in run.shown[0]) == again
    assert run.kinds() == broken


def test_what_grows_old_and_what_waits_has_longer_while_nobody_listens():
    run = Run(plan_of(TOUR + GO + "environment { boat0 vanishes }", LATE))
    run.turn(0.0, seen("uav0", WEST, 0.0), aged(boat((37.03, -8.63), 0.0), 60.0))
    run.turn(150.0, missed=100.0)
    assert run.kinds() == ["trouble"]
    assert run.findings[0].message.startswith("this process did not listen for 100 s")
    assert "⟨env : boat0 vanishes⟩" not in run.labels
    assert run.again == 160.0
    run.turn(161.0)
    assert run.kinds() == ["trouble", "late"]
    assert "⟨env : boat0 vanishes⟩" in run.labels


def test_a_vehicle_in_flight_that_is_not_heard_stays_in_transit():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, aged(seen("uav0", WEST, 0.0), 30.0))
    run.turn(100.0)
    assert isinstance(run.state.configuration.structure.physical.placement("uav0"), InTransit)
    run.turn(101.0, seen("uav0", EAST, 101.0))
    assert "commit" in run.rules


def test_a_rule_that_moves_two_is_committed_when_both_are_there():
    text = TWO + (
        "rule both { west0.(uav0[a] | uav1[b] | $0) || east0.$1 -> west0.$0 || east0.(uav0[a] | uav1[b] | $1) }\n"
        "BigActor a hosted_at uav0 with_behavior { control(both()) }"
    )
    run = Run(Plan(plan_of(text).first, {"uav0": "autopilot", "uav1": "autopilot"}))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert run.commands == []
    run.turn(1.0, seen("uav1", BESIDE, 1.0))
    assert sorted(told.entity for told in run.commands) == ["uav0", "uav1"]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules
    run.turn(3.0, seen("uav1", (37.012, -8.612), 3.0))
    assert run.rules[-1] == "commit"
    assert run.state.commanded.flights == {}
    assert run.findings == []


# --- resuming -------------------------------------------------------------------------------------------


def after_a_crash(run, **known):
    again = Run(run.plan)
    again.state = resumed(run.plan, known_of(run.state, **known), 100.0)
    return again


def test_a_flight_is_still_ordered_after_a_crash_and_committed_once_its_vehicle_shows_that_it_did_what_it_was_told():
    run = flying(TOUR + GO)
    again = after_a_crash(run)
    before, after = (each.state.commanded.flights["uav0"].command for each in (run, again))
    assert before.place == after.place
    turn = watch(again.plan, again.state, Batch((seen("uav0", EAST, 101.0),)), 101.0)
    assert turn.steps == ()
    again.state = turn.state
    again.turn(102.0)
    assert again.rules[0] == "commit"
    between = after_a_crash(run)
    between.turn(101.0, seen("uav0", BETWEEN, 101.0))
    assert again.commands == between.commands == []


def test_a_hand_over_that_was_done_while_nobody_looked_is_no_broken_assumption():
    run = flying(HAND)
    again = after_a_crash(run)
    again.turn(101.0, seen("uav0", WEST, 101.0, channels=("control:gcs1",)))
    assert again.findings == []
    assert "actuate" in again.rules
    assert again.commands == []


def test_a_channel_that_nothing_shows_to_be_joined_is_never_committed():
    text = TOUR.replace(
        "boat0: Vessel = point (37.03, -8.63)", "boat0: Vessel = point (37.03, -8.63) linked wifi"
    )
    run = Run(plan_of(text + "BigActor a hosted_at uav0 with_behavior { control(CONNECT_HOST_TO boat0) }"))
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert "actuate" not in run.rules
    assert run.kinds() == ["blocked"]
    assert "no report can confirm that uav0 joins or leaves wifi" in run.findings[0].message
    assert run.state.configuration.structure.physical.channels("uav0") == ("control:gcs0",)
