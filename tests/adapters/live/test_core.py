import pytest
from live_missions import BETWEEN, EAST, TOUR, WEST, Run, boat, known_of, plan_of, seen

from adapters.live.batch import Batch, GivingBack, Heard, Saying
from adapters.live.core import is_refused, resumed, watch
from adapters.live.overrides import Overrides
from adapters.live.plan import Plan
from adapters.live.reported import MOST_REPORTED
from adapters.plugin import (
    Accepted,
    Aged,
    Doubted,
    Gone,
    GoTo,
    HandOver,
    Hold,
    LinkLost,
    LinkRestored,
    Rebind,
    Rejected,
    Return,
    TakenOver,
)
from physical import PhysicalProperty, polygon
from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from semantics.state.physical_model import InTransit, Placed
from semantics.state.requests import FLY
from semantics.successors import expand

GO = """
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
  observe(CHILDREN(east0))
  react { case obs => display(obs) }
}
"""


def test_nothing_is_commanded_before_the_vehicle_is_heard():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0)
    assert run.rules == ["req_ctr", "req_obs"]
    assert run.commands == []
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.rules[2:] == ["command"]
    assert [(type(told), told.entity, told.name) for told in run.commands] == [(GoTo, "uav0", "east0")]


def test_a_flight_is_committed_where_it_was_seen_to_end_and_not_before():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", BETWEEN, 1.0))
    physical = run.state.configuration.structure.physical
    assert "commit" not in run.rules
    assert isinstance(physical.placement("uav0"), InTransit)
    run.turn(2.0, seen("uav0", (37.011, -8.611), 2.0))
    assert run.rules[-4:] == ["commit", "sense", "rcv_obs", "fun"]
    placement = run.state.configuration.structure.physical.placement("uav0")
    assert isinstance(placement, Placed)
    assert placement.geometry.vertices == ((37.011, -8.611),)
    assert run.state.configuration.structure.logical.parent("uav0") == "east0"
    assert run.state.commanded.flights == {}


def test_what_is_displayed_is_what_was_seen():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert [text for step in run.steps for text in step.transition.shown] == ["{east0, uav0}"]


def test_every_step_is_one_that_the_rules_allow():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(2.0, seen("uav0", EAST, 2.0))
    for step in run.steps:
        if step.sight is None:
            assert step.transition in expand(step.source).transitions


def test_a_position_that_changes_no_relation_is_no_step():
    run = Run(plan_of(TOUR))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    before = run.state.configuration
    run.turn(1.0, seen("uav0", (37.011, -8.651), 1.0), boat((37.031, -8.631), 1.0))
    assert run.steps == []
    assert run.state.configuration is before


def test_of_two_positions_the_newer_wins_in_either_order():
    for first, second in ((1.0, 2.0), (2.0, 1.0)):
        run = Run(plan_of(TOUR))
        run.turn(3.0, seen("uav0", WEST, first), seen("uav0", (37.012, -8.652), second))
        assert run.state.sightings.newest["uav0"].time == 2.0


def test_a_time_stamp_far_in_the_future_is_refused():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 3600.0))
    assert run.state.sightings.newest == {}
    assert run.kinds() == ["trouble"]


def test_a_clock_that_is_wrong_is_told_of_once_however_wrong_it_is():
    run = Run(plan_of(TOUR + GO))
    for ahead in range(6, 60):
        run.turn(0.0, seen("uav0", WEST, float(ahead)))
    assert run.kinds() == ["trouble"]


def test_strangers_with_ever_new_names_fill_no_memory():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, *(boat(EAST, 3600.0, f"stranger{number}") for number in range(MOST_REPORTED + 500)))
    assert run.kinds() == ["trouble"] * MOST_REPORTED
    assert len(run.state.reported.messages) == MOST_REPORTED
    run.turn(1.0, seen("uav0", WEST, 1.0), boat(EAST, 1.0))
    assert "broken assumption" in run.kinds()


def test_another_feed_may_not_speak_of_a_vehicle():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", EAST, 1.0, plugin="ais"))
    assert "commit" not in run.rules
    assert run.kinds() == ["trouble"]


# --- assumptions ---------------------------------------------------------------------------------------


def test_a_boat_that_the_mission_lets_stand_still_breaks_an_assumption_when_it_drifts():
    run = Run(plan_of(TOUR))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, boat(EAST, 1.0))
    assert run.labels == ["⟨env : boat0 is seen in east0⟩"]
    assert run.kinds() == ["broken assumption"]
    assert [type(told) for told in run.commands] == [Hold]
    assert run.state.overrides.suspended


def test_a_drift_that_the_mission_allows_breaks_nothing():
    run = Run(plan_of(TOUR + "environment { boat0 drifts among point (37.005, -8.605) }"))
    run.turn(1.0, boat(EAST, 1.0))
    assert run.rules == ["env"]
    assert run.findings == []


def test_after_a_broken_assumption_no_control_is_served():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, boat(EAST, 0.0))
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert "command" not in run.rules


def test_the_mission_may_say_that_it_goes_on():
    run = Run(plan_of(TOUR + GO, LivePolicy(Fallback.CONTINUE)))
    run.turn(0.0, boat(EAST, 0.0))
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.kinds() == ["broken assumption"]
    assert "command" in run.rules


def test_an_entity_that_nobody_announced_is_seen_and_reported():
    run = Run(plan_of(TOUR + GO, LivePolicy(Fallback.CONTINUE)))
    run.turn(0.0, boat(EAST, 0.0, "mmsi123"))
    assert run.labels[0] == "⟨env : mmsi123 appears in east0⟩"
    assert run.kinds() == ["broken assumption"]
    run.turn(1.0, seen("uav0", WEST, 1.0))
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert [text for step in run.steps for text in step.transition.shown] == ["{east0, mmsi123, uav0}"]


def test_what_is_in_none_of_the_places_is_nobodys_business():
    run = Run(plan_of(TOUR))
    run.turn(0.0, boat((40.0, -8.0), 0.0, "mmsi123"))
    assert (run.steps, run.findings, run.state.sightings.newest) == ([], [], {})


def test_a_spill_takes_its_shape_along():
    text = TOUR.replace("kind Vessel\n", "kind Vessel\n kind OilSpill contains UAV\n").replace(
        "contains Location, Vessel", "contains Location, OilSpill, Vessel"
    )
    spill = "oilSpill0: OilSpill = circle (37.01, -8.61) radius 300 m\n  uav0"
    run = Run(plan_of(text.replace("uav0", spill, 1)))
    ring = polygon([(37.008, -8.652), (37.012, -8.652), (37.012, -8.648), (37.008, -8.648)])
    run.turn(0.0, seen("oilSpill0", EAST, 0.0, "camera", "OilSpill", ()))
    assert run.steps == []
    run.turn(1.0, Heard("camera", PhysicalProperty("oilSpill0", "OilSpill", ring, time=1.0)))
    physical = run.state.configuration.structure.physical
    assert physical.abstract_parent("uav0") == "oilSpill0"
    assert run.kinds() == ["broken assumption"]


# --- hand-over, links, refusals -------------------------------------------------------------------------

HAND = (
    TOUR + "BigActor op hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1)\n observe(LINKED_TO_HOST) }"
)


def test_a_hand_over_is_true_once_the_vehicle_shows_it():
    run = Run(plan_of(HAND))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert [(told.leave, told.join) for told in run.commands if isinstance(told, HandOver)] == [
        ("control:gcs0", "control:gcs1")
    ]
    assert "actuate" not in run.rules
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert "actuate" not in run.rules
    run.turn(2.0, seen("uav0", WEST, 2.0, channels=("control:gcs1",)))
    assert run.rules[-2:] == ["actuate", "sense"]
    assert run.findings == []
    assert run.state.configuration.structure.logical.links("uav0") == ("control:gcs1",)
    assert run.state.commanded.hand_overs == {}


def test_while_a_vehicle_confirms_a_hand_over_others_are_served_unless_the_verdict_is_one_under_fcfs():
    both = HAND + "BigActor z hosted_at gcs1 with_behavior { observe(ALL) }"
    loose, strict = Run(plan_of(both)), Run(plan_of(both, strict=True))
    for run in (loose, strict):
        run.turn(0.0, seen("uav0", WEST, 0.0))
    assert "sense" in loose.rules
    assert "sense" not in strict.rules


def test_a_vehicle_under_another_authority_breaks_an_assumption():
    run = Run(plan_of(TOUR))
    run.turn(0.0, seen("uav0", WEST, 0.0, channels=("control:gcs1",)))
    assert run.kinds()[0] == "broken assumption"


def test_a_link_that_comes_back_is_no_second_broken_assumption():
    run = Run(plan_of(TOUR))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(9.0, seen("uav0", WEST, 9.0, channels=()), reports=[LinkLost("uav0", 9.0, 0.0)])
    run.turn(12.0, seen("uav0", WEST, 12.0), reports=[LinkRestored("uav0", 12.0)])
    assert sorted(run.kinds()) == ["broken assumption", "link restored", "lost link"]
    assert run.labels[-1] == "⟨env : uav0 is on control:gcs0⟩"
    run.turn(13.0, seen("uav0", WEST, 13.0, channels=("control:gcs1",)))
    assert run.findings[-1].message.startswith("uav0 is on control:gcs1; it was not handed there")


@pytest.mark.parametrize(("where", "broken"), [((37.012, -8.612), 1), ((37.012, -8.652), 2)])
def test_what_vanished_and_appears_where_it_was_is_no_second_broken_assumption(where, broken):
    run = Run(plan_of(TOUR + "environment { boat0 drifts among east0, west0 }"))
    run.turn(0.0, Heard("ais", Aged(boat((37.011, -8.611), 0.0).published, 60.0)))
    run.turn(61.0)
    assert run.kinds() == ["broken assumption"]
    run.turn(70.0, boat(where, 70.0))
    assert run.kinds() == ["broken assumption"] * broken
    assert run.labels[-1].startswith("⟨env : boat0 appears in")


def test_a_channel_that_may_drop_drops_and_returns_with_the_link():
    run = Run(plan_of(TOUR + "environment { control:gcs0 drops and returns }"))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(9.0, reports=[LinkLost("uav0", 9.0, 0.0)])
    assert run.labels == ["⟨env : control:gcs0 drops⟩"]
    run.turn(12.0, seen("uav0", WEST, 12.0), reports=[LinkRestored("uav0", 12.0)])
    assert run.labels[1:] == ["⟨env : control:gcs0 returns⟩"]
    assert run.kinds() == ["lost link", "link restored"]


def test_a_refused_command_stays_pending():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    request = run.commands[0].request
    run.turn(1.0, reports=[Rejected(request, "uav0", 1.0, "not armed")])
    assert run.kinds() == ["refused"]
    (pending, *_) = run.state.configuration.eta.all()
    assert isinstance(pending.request, FLY)


def test_a_flight_that_takes_too_long_falls_back_and_is_never_committed():
    late = LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, Fallback.RETURN),))
    run = Run(plan_of(TOUR + GO, late))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert run.again == 60.0
    run.turn(61.0, seen("uav0", BETWEEN, 61.0))
    assert run.kinds() == ["late"]
    assert [type(told) for told in run.commands] == [GoTo, Return]
    run.turn(62.0, seen("uav0", EAST, 62.0))
    assert "commit" not in run.rules
    assert len(run.findings) == 1


# --- vehicles that do otherwise -------------------------------------------------------------------------


def told(run):
    return [type(command).__name__ for command in run.commands]


def test_a_vehicle_that_has_not_shown_that_it_does_what_it_was_told_has_not_arrived():
    run = Run(plan_of(TOUR + GO), willing=False)
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", EAST, 1.0))
    assert "commit" not in run.rules
    run.turn(2.0, reports=[Accepted("a-1", "uav0", 2.0)])
    assert run.rules[-4] == "commit"


def test_a_flight_that_was_refused_is_not_committed_by_where_its_vehicle_comes():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, reports=[Rejected("a-1", "uav0", 1.0, "denied")])
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules


def test_a_vehicle_that_was_taken_over_has_not_arrived_though_the_same_news_show_it_there():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", BETWEEN, 1.0))
    run.turn(2.0, seen("uav0", EAST, 2.0), reports=[TakenOver("uav0", 2.0, "it is in RTL")])
    assert "commit" not in run.rules
    assert [finding.message for finding in run.findings] == [
        "uav0 was taken over: it is in RTL; it gets no commands until `bigactors give-back uav0`"
    ]
    run.turn(3.0, reports=[Rejected("a-1", "uav0", 3.0, "it is in RTL")])
    assert run.kinds() == ["taken over"]


def test_a_vehicle_that_may_have_been_taken_over_arrives_once_it_is_certain_that_it_was_not():
    run = Run(plan_of(TOUR + GO), willing=False)
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, reports=[Accepted("a-1", "uav0", 1.0)])
    run.turn(2.0, seen("uav0", EAST, 2.0), reports=[Doubted("uav0", 2.0)])
    assert "commit" not in run.rules
    run.turn(3.0, reports=[Accepted("a-1", "uav0", 3.0)])
    assert "commit" in run.rules


def test_a_vehicle_on_which_the_mission_falls_back_does_not_arrive_on_its_way_home():
    run = Run(plan_of(TOUR + GO, LivePolicy(Fallback.RETURN)))
    run.turn(0.0, seen("uav0", WEST, 0.0), boat((37.03, -8.63), 0.0))
    run.turn(1.0, boat(WEST, 1.0))
    assert told(run) == ["GoTo", "Return"]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules


def test_what_the_mission_falls_back_on_does_not_overrule_who_has_taken_a_vehicle_over():
    for fallback in (Fallback.HOLD, Fallback.RETURN):
        run = Run(plan_of(TOUR, LivePolicy(fallback)))
        run.turn(0.0, seen("uav0", WEST, 0.0))
        run.turn(1.0, seen("uav0", BETWEEN, 1.0), reports=[TakenOver("uav0", 1.0, "it is in RTL")])
        assert run.kinds() == ["taken over", "broken assumption", "taken over"]
        assert run.commands == []


def test_nothing_is_told_to_a_vehicle_that_was_taken_over_before_it_is_given_back():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, reports=[TakenOver("uav0", 0.0, "it is in RTL")])
    run.turn(1.0, seen("uav0", WEST, 1.0))
    assert run.commands == []
    run.turn(2.0, sayings=[GivingBack("uav0")])
    assert told(run) == ["GiveBack", "GoTo"]
    assert [answer.refusal for answer in run.answers] == [""]
    assert run.state.overrides.taken == {}


def test_a_vehicle_that_is_given_back_is_told_anew_what_it_was_to_do():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    for number, report in enumerate((TakenOver("uav0", 1.0, "x"), Rejected("a-3", "uav0", 2.0, "denied")), 1):
        run.turn(float(number), reports=[report])
        run.turn(number + 0.5, sayings=[GivingBack("uav0")])
    assert [command.request for command in run.commands] == [
        "a-1",
        "give-back-2",
        "a-3",
        "give-back-4",
        "a-5",
    ]
    run.turn(3.0, seen("uav0", EAST, 3.0))
    assert "commit" in run.rules


def test_a_hand_over_that_was_refused_is_told_again_when_the_vehicle_is_given_back():
    run = Run(plan_of(HAND))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, reports=[Rejected("op-1", "uav0", 1.0, "no answer")])
    run.turn(2.0, sayings=[GivingBack("uav0")])
    assert told(run) == ["HandOver", "GiveBack", "HandOver"]


def test_who_was_not_taken_over_is_not_given_back():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0), sayings=[GivingBack("uav0"), GivingBack("uav9")])
    assert [answer.refusal for answer in run.answers] == [
        "uav0 was not taken over here, and has refused nothing",
        "there is no vehicle 'uav9'; there are uav0",
    ]


def test_a_run_that_is_resumed_gives_no_vehicle_back_by_itself():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    again = Run(run.plan)
    again.state = resumed(run.plan, known_of(run.state, overrides=Overrides({"uav0": "it is in RTL"})), 100.0)
    again.turn(101.0, seen("uav0", EAST, 101.0))
    assert again.rules == []


def test_only_a_run_of_which_all_that_is_left_was_refused_has_nothing_left_to_do():
    alone, beside, talking = (
        Run(plan_of(TOUR + GO + more))
        for more in (
            "",
            "BigActor op hosted_at gcs0 with_behavior { observe(ALL) control(HAND uav0 TO gcs1) }",
            'environment { says "go" to a at most once }',
        )
    )
    for run in (alone, beside, talking):
        run.turn(0.0, seen("uav0", WEST, 0.0))
        assert not is_refused(run.state)
        run.turn(1.0, reports=[Rejected("a-1", "uav0", 1.0, "denied")])
    assert [is_refused(run.state) for run in (alone, beside, talking)] == [True, False, False]
    alone.turn(2.0, reports=[TakenOver("uav0", 2.0, "it is in RTL")])
    assert not is_refused(alone.state)


# --- sayings --------------------------------------------------------------------------------------------

TALK = (
    TOUR
    + """
BigActor op hosted_at gcs0 with_behavior { loop { react { case "go" => display("gone") } } }
environment { says "go" to op at most once }
"""
)


def test_what_the_mission_says_may_be_said_is_heard_and_not_too_often():
    run = Run(plan_of(TALK))
    run.turn(0.0)
    run.turn(1.0, sayings=[Saying("op", "go"), Saying("op", "go"), Saying("nobody", "stop")])
    assert run.rules == ["say", "rcv_msg", "fun"]
    assert [bool(answer.refusal) for answer in run.answers] == [False, True, True]
    assert [step.transition.shown for step in run.steps][-1] == ("gone",)


def test_a_member_of_a_family_is_spoken_to_by_its_name():
    family = """
    BigActor op[i] for g in Station hosted_at g with_behavior { loop { react { case ("go", way) => display(way) } } }
    environment { says ("go", [gcs1, gcs0, gcs1]) to op[gcs1] }
    """
    run = Run(plan_of(TOUR + family))
    run.turn(0.0)
    said = "(go, [gcs1, gcs0, gcs1])"
    run.turn(1.0, sayings=[Saying("op[gcs1]", said), Saying("op[1]", said), Saying("op", said)])
    assert run.rules == ["say", "rcv_msg", "fun"]
    assert [step.transition.shown for step in run.steps][-1] == ("[gcs1, gcs0, gcs1]",)
    assert [answer.refusal.partition(";")[0] for answer in run.answers] == [
        "",
        "there is no bigActor 'op[1]'",
        "there is no bigActor 'op'",
    ]


@pytest.mark.parametrize(
    ("said", "heard"),
    [("gcs1", ["gcs1"]), ('"gcs1"', ["a text"]), ("stop", ["a stop"]), ('"stop"', ["a stop"])],
)
def test_an_operator_types_quotes_only_where_a_name_is_said_too(said, heard):
    talk = """
    BigActor op hosted_at gcs0 with_behavior { loop { react {
      case "gcs1" => display("a text") case "stop" => display("a stop") case m: Message => display(m)
    } } }
    environment { says "gcs1" to op says gcs1 to op says "stop" to op }
    """
    run = Run(plan_of(TOUR + talk))
    run.turn(0.0)
    run.turn(1.0, sayings=[Saying("op", "what?"), Saying("op", said)])
    assert run.answers[0].refusal.endswith('may be said now: "gcs1" to op, gcs1 to op, stop to op')
    assert [shown for step in run.steps for shown in step.transition.shown] == heard


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


# --- places that move ---

SPILL = (
    TOUR.replace("kind Vessel\n", "kind Vessel\n kind OilSpill contains UAV\n")
    .replace("contains Location, Vessel", "contains Location, OilSpill, Vessel")
    .replace("  uav0: UAV", "  oilSpill0: OilSpill = circle (37.01, -8.61) radius 300 m\n  uav0: UAV")
)


def test_a_vehicle_is_sent_on_where_its_place_has_drifted_to():
    text = SPILL + (
        "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO oilSpill0) }\n"
        "environment { oilSpill0 drifts among circle (37.012, -8.612) radius 300 m }"
    )
    run = Run(plan_of(text))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    drifted = seen("oilSpill0", (37.013, -8.613), 1.0, "camera", "OilSpill", ())
    run.turn(1.0, drifted)
    first, second = run.commands
    assert first.request == second.request
    assert first.place != second.place
    assert run.findings == []
    run.turn(2.0, seen("uav0", (37.0135, -8.6135), 2.0))
    assert run.rules[-1] == "commit"


def test_a_place_that_drifts_over_a_waiting_vehicle_lets_it_arrive():
    text = SPILL + (
        "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO oilSpill0) }\n"
        "environment { oilSpill0 drifts among circle (37.012, -8.612) radius 300 m }"
    )
    run = Run(plan_of(text))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    run.turn(1.0, seen("uav0", (37.0139, -8.6139), 1.0))
    assert "commit" not in run.rules
    run.turn(2.0, seen("oilSpill0", (37.013, -8.613), 2.0, "camera", "OilSpill", ()))
    assert "commit" not in run.rules  # it goes to where the place was
    run.turn(3.0, seen("uav0", (37.0139, -8.6139), 3.0))  # and here it shows that it goes to where it is
    assert run.rules[-1] == "commit"


def test_what_is_too_old_leaves_p_and_so_does_what_is_said_to_be_gone():
    run = Run(plan_of(TOUR + "environment { boat0 vanishes }"))
    run.turn(0.0, Heard("ais", Aged(boat((37.03, -8.63), 0.0).published, 60.0)))
    run.turn(59.0)
    assert run.steps == []
    run.turn(61.0)
    assert run.labels == ["⟨env : boat0 vanishes⟩"]
    assert run.findings == []
    run.turn(62.0, boat((37.03, -8.63), 62.0))
    assert run.labels[1:] == ["⟨env : boat0 appears in region⟩"]
    run.turn(63.0, Heard("ais", Gone("boat0", 63.0, "ais")))
    assert run.labels[2:] == ["⟨env : boat0 vanishes⟩"]


def test_what_grows_old_and_what_waits_has_longer_while_nobody_listens():
    late = LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, Fallback.RETURN),))
    run = Run(plan_of(TOUR + GO + "environment { boat0 vanishes }", late))
    run.turn(0.0, seen("uav0", WEST, 0.0), Heard("ais", Aged(boat((37.03, -8.63), 0.0).published, 60.0)))
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
    heard = seen("uav0", WEST, 0.0)
    run.turn(0.0, Heard("autopilot", Aged(heard.published, 30.0)))
    run.turn(100.0)
    assert isinstance(run.state.configuration.structure.physical.placement("uav0"), InTransit)
    run.turn(101.0, seen("uav0", EAST, 101.0))
    assert "commit" in run.rules


# --- two at once ---


def test_a_rule_that_moves_two_is_committed_when_both_are_there():
    two = TOUR.replace("  boat0:", "  uav1: UAV = point (37.012, -8.65) linked control:gcs1\n  boat0:")
    text = two + (
        "rule both { west0.(uav0[a] | uav1[b] | $0) || east0.$1 -> west0.$0 || east0.(uav0[a] | uav1[b] | $1) }\n"
        "BigActor a hosted_at uav0 with_behavior { control(both()) }"
    )
    plan = plan_of(text)
    run = Run(Plan(plan.first, {"uav0": "autopilot", "uav1": "autopilot"}))
    other = ("control:gcs1",)
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert run.commands == []
    run.turn(1.0, seen("uav1", (37.012, -8.65), 1.0, channels=other))
    assert sorted(told.entity for told in run.commands) == ["uav0", "uav1"]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules
    run.turn(3.0, seen("uav1", (37.012, -8.612), 3.0, channels=other))
    assert run.rules[-1] == "commit"
    assert run.state.commanded.flights == {}
    assert run.findings == []


# --- resuming -------------------------------------------------------------------------------------------


def after_a_crash(run):
    resumed_run = Run(run.plan)
    resumed_run.state = resumed(run.plan, known_of(run.state), 100.0)
    return resumed_run


def test_a_flight_that_ended_while_nobody_looked_is_committed_once_its_vehicle_shows_that_it_did_what_it_was_told():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    again = after_a_crash(run)
    turn = watch(again.plan, again.state, Batch((seen("uav0", EAST, 101.0),)), 101.0)
    assert turn.steps == ()
    again.state = turn.state
    again.turn(102.0)
    assert again.rules[0] == "commit"
    assert again.commands == []


def test_a_flight_that_goes_on_is_still_ordered_after_a_crash():
    run = Run(plan_of(TOUR + GO))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    again = after_a_crash(run)
    assert (
        again.state.commanded.flights["uav0"].command.place
        == run.state.commanded.flights["uav0"].command.place
    )
    again.turn(101.0, seen("uav0", BETWEEN, 101.0))
    assert again.commands == []


def test_a_hand_over_that_was_done_while_nobody_looked_is_no_broken_assumption():
    run = Run(plan_of(HAND))
    run.turn(0.0, seen("uav0", WEST, 0.0))
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
    assert "nothing shows that uav0 joins or leaves wifi" in run.findings[0].message
    assert run.state.configuration.structure.physical.channels("uav0") == ("control:gcs0",)


def test_an_operator_says_that_a_vehicle_is_heard_from_another_address():
    run = Run(plan_of(TOUR, LivePolicy(Fallback.CONTINUE)))
    run.turn(0.0, reports=[LinkLost("uav0", 0.0, -5.0)])
    for number, at in enumerate(("127.0.0.1:5555", "home", "[::1]:99", "::1", "127.0.0.1:65536")):
        run.turn(float(number), sayings=[GivingBack("uav0", at)])
    no = "' is no HOST:PORT with HOST as a number, such as 192.168.1.7:14555 or [fd00::7]:14555"
    assert [answer.refusal for answer in run.answers] == [
        "", f"'home{no}", "", f"'::1{no}", f"'127.0.0.1:65536{no}",
    ]  # fmt: skip
    assert run.commands == [
        Rebind("operator-1", "uav0", "127.0.0.1:5555"),
        Rebind("operator-2", "uav0", "[::1]:99"),
    ]
    assert [str(step.transition.label) for step in run.steps] == ["⟨env : uav0 is off control:gcs0⟩"]


def test_who_was_taken_over_stays_so_though_an_operator_says_where_it_is():
    run = Run(plan_of(TOUR, LivePolicy(Fallback.CONTINUE)))
    run.turn(0.0, reports=[TakenOver("uav0", 0.0, "it is in RTL"), LinkLost("uav0", 0.0, -5.0)])
    run.turn(1.0, sayings=[GivingBack("uav0", "127.0.0.1:5555")])
    assert run.state.overrides.taken == {"uav0": "it is in RTL"}
    assert run.commands == [Rebind("operator-1", "uav0", "127.0.0.1:5555")]


def test_a_vehicle_has_no_mailbox():
    run = Run(plan_of(TOUR))
    run.turn(0.0, sayings=[Saying("uav0", "go")])
    (answer,) = run.answers
    assert answer.refusal.startswith(
        "there is no bigActor 'uav0', which is a vehicle; the mission does not say"
    )


def test_a_vehicle_is_believed_elsewhere_only_while_its_link_is_lost():
    run = Run(plan_of(TOUR, LivePolicy(Fallback.CONTINUE)))
    said = GivingBack("uav0", "127.0.0.1:5555")
    run.turn(1.0, seen("uav0", WEST, 1.0), sayings=[said])
    run.turn(9.0, reports=[LinkLost("uav0", 9.0, 1.0)], sayings=[said])
    run.turn(10.0, reports=[LinkRestored("uav0", 10.0)], sayings=[said])
    no = "the link to uav0 is not lost; it can be believed elsewhere once it is silent where it was"
    assert [answer.refusal for answer in run.answers] == [no, "", no]
    assert run.commands == [Rebind("operator-1", "uav0", "127.0.0.1:5555")]
