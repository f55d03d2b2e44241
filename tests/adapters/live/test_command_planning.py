"""An operator takes a vehicle: it holds or returns at once, and the mission does not overrule it."""

import pytest
from live_missions import BETWEEN, EAST, TOUR, TWO, WEST, Run, boat, flying_two, known_of, plan_of, seen

from adapters.live.batch import Acknowledging, GivingBack, Heard, Ordering
from adapters.live.core import is_refused, resumed
from adapters.live.overrides import Fate, StandingOrder
from adapters.live.plan import Plan
from adapters.plugin import (
    Arrived,
    GoTo,
    Hold,
    LinkLost,
    LinkRestored,
    Presence,
    Return,
    Status,
    StatusText,
    TakenOver,
)
from bigactors.vehicle_lines import vehicle_line
from physical import PhysicalProperty, box
from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from semantics.state.station_partition import Parting, parted

GO = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) observe(CHILDREN(east0)) }"
HAND = "BigActor op hosted_at gcs0 with_behavior { control(HAND uav0 TO gcs1) }"
HOLD, RETURN = Fallback.HOLD, Fallback.RETURN
ANA = "the operator (Ana)"


def ordered(vehicle="uav0", what=HOLD, by="Ana"):
    return Ordering(what, vehicle, by)


def flying(text=TOUR + GO, precautions=None, **more):
    run = Run(plan_of(text, precautions), **more)
    run.turn(0.0, seen("uav0", WEST, 0.0))
    return run


@pytest.mark.parametrize(("what", "kind"), [(HOLD, Hold), (RETURN, Return)])
def test_a_vehicle_that_an_operator_orders_is_told_at_once_and_its_request_stands_pending(what, kind):
    run = flying()
    turn = run.turn(1.0, seen("uav0", BETWEEN, 1.0), sayings=[ordered(what=what)])
    assert turn.commands == (kind("operator-2", "uav0"),)
    assert turn.answers[0].refusal == ""
    assert turn.answers[0].requests == {"uav0": "operator-2"}
    assert run.state.overrides.taken == {"uav0": f"ordered to {what.value} by {ANA}, not confirmed yet"}
    assert [f.message for f in turn.findings] == [
        f"uav0 is ordered to {what.value} by {ANA}; the mission does not command it until `bigactors give-back uav0`"
    ]
    run.turn(2.0, seen("uav0", EAST, 2.0))
    assert "commit" not in run.rules
    assert not is_refused(run.state)


def test_an_order_replaces_what_the_same_turn_was_to_tell_the_vehicle():
    run = flying()
    moved = PhysicalProperty(
        "east0", "Location", box((37.02, -8.59), (37.00, -8.61)), time=1.0, source="places"
    )
    turn = run.turn(1.0, Heard("places", moved))
    assert [type(each) for each in turn.commands] == [GoTo]
    run = flying()
    turn = run.turn(1.0, Heard("places", moved), sayings=[ordered()])
    assert turn.commands == (Hold("operator-2", "uav0"),)


def test_the_other_vehicles_and_agents_go_on():
    goes = GO + "BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO east0) }"
    run = flying_two(TWO + goes)
    run.turn(1.0, sayings=[ordered()])
    run.turn(2.0, seen("uav0", EAST, 2.0), seen("uav1", (37.012, -8.612), 2.0))
    assert [label for label in run.labels if "commit" in label] == ["⟨commit : FLY(b, MOVE_HOST_TO east0)⟩"]


def test_an_order_to_all_tells_all_but_those_that_someone_else_has_taken_over():
    run = flying_two(TWO)
    run.turn(1.0, reports=[TakenOver("uav1", 1.0, "it is in RTL")])
    turn = run.turn(2.0, sayings=[ordered(None, RETURN)])
    left_out = "uav1 was taken over, and an order to all does not overrule that: it is in RTL"
    assert turn.commands == (Return("operator-1", "uav0"),)
    assert turn.answers[0].refusal == ""
    assert turn.answers[0].left_out == {"uav1": left_out}
    message = f"uav0 is ordered to return by {ANA}; {left_out}; the mission does not command it until"
    (finding,) = turn.findings
    assert (finding.about, finding.message) == ("", f"{message} `bigactors give-back VEHICLE`")
    turn = run.turn(3.0, sayings=[ordered(None, HOLD)])
    assert [each.entity for each in turn.commands] == ["uav0"]


@pytest.mark.parametrize("held", [False, True])
def test_an_order_does_not_overrule_what_its_operator_cannot_know_of_yet(held):
    run = flying()
    run.turn(1.0, sayings=[ordered()] * held)
    turn = run.turn(2.0, reports=[TakenOver("uav0", 2.0, "it is in RTL")], sayings=[ordered()])
    assert turn.commands == ()
    why = "uav0 was taken over just now: it is in RTL; order it again to overrule that"
    assert turn.answers[0].refusal == why


@pytest.mark.parametrize("owner", ["stations", "autopilot"])
def test_a_vehicle_under_another_stations_authority_is_ordered_there(owner):
    first = parted(plan_of(TOUR + GO).first, Parting("gcs1", {"gcs0": "gcs0", "uav0": "gcs0"}, {}, {}))
    run = Run(Plan(first, {"uav0": owner}, peers="stations"))
    for vehicle in ("uav0", None):
        turn = run.turn(0.0, seen("uav0", WEST, 0.0, owner), sayings=[ordered(vehicle)])
        assert turn.commands == ()
        assert turn.answers[0].refusal == "uav0 is under the authority of gcs0: order it there"


def test_there_is_no_order_to_what_is_no_vehicle():
    turn = flying().turn(1.0, sayings=[ordered("boat0")])
    assert turn.answers[0].refusal == "there is no vehicle 'boat0'; there are uav0"


HELD, SENT, BACK = ordered(), ordered(what=RETURN), GivingBack("uav0", by="Ben")
TAKEN, DRIFT = TakenOver("uav0", 1.0, "it is in RTL"), boat(WEST, 1.0)
HOLDS, RETURNS = (f"ordered to {what} by {ANA}, not confirmed yet" for what in ("hold", "return"))
ANEW = "uav0 was given back by Ben, and is commanded again"
OVERRULES = "this order overrules the take-over of uav0: it is in RTL"
FOR_ITSELF = "uav0 was taken over: it is in RTL"
TOLD = {
    "twice, and another after it": (GO, None, [[HELD], [HELD], [SENT]], "Hold Hold Return", RETURNS, ""),
    "to who was taken over": (GO, None, [[TAKEN], [HELD]], "GiveBack Hold", HOLDS, OVERRULES),
    "given back": (GO, None, [[HELD], [BACK]], "Hold GiveBack GoTo", "", ANEW),
    "at once, in its order": (GO, None, [[HELD, BACK, SENT]], "GiveBack Return", RETURNS, ""),
    "given back and held at once": (GO, None, [[TAKEN], [BACK, HELD]], "GiveBack Hold", HOLDS, ""),
    "ended by a pilot": (GO, None, [[HELD], [TAKEN]], "Hold", "it is in RTL", FOR_ITSELF),
    "amid a hand-over": (HAND, None, [[HELD], [BACK]], "Hold GiveBack HandOver", "", ANEW),
    "while the mission is suspended": (GO, LivePolicy(HOLD), [[DRIFT], [SENT]], "Hold Return", RETURNS, ""),
    "given back meanwhile": (
        GO,
        LivePolicy(RETURN),
        [[HELD], [DRIFT], [BACK]],
        "Hold GiveBack Return",
        None,
        "",
    ),
}


@pytest.mark.parametrize(("text", "policy", "events", "told", "taken", "said"), TOLD.values(), ids=TOLD)
def test_what_an_operator_orders_is_told(text, policy, events, told, taken, said):
    run = flying(TOUR + text, policy)
    for now, each in enumerate(events, 1):
        heard = [moved for moved in each if moved is DRIFT]
        reports = [taken for taken in each if taken is TAKEN]
        run.turn(
            float(now), *heard, reports=reports, sayings=[word for word in each if word not in (DRIFT, TAKEN)]
        )
    assert run.told[1:] == told.split()
    assert taken is None or run.state.overrides.taken == ({"uav0": taken} if taken else {})
    assert taken in (HOLDS, RETURNS) or run.state.overrides.orders == {}
    assert any(said in message for message in run.messages())


def test_a_hand_over_that_a_fall_back_ends_is_told_again_if_its_agent_is_still_served():
    run = Run(plan_of(TOUR + GO + HAND, LivePolicy(HOLD, (TimeLimit("FLY", "a", 5.0, HOLD),))))
    run.turn(0.0, seen("uav0", WEST, 0.0))
    assert sorted(run.told) == ["GoTo", "HandOver"]
    run.turn(6.0, seen("uav0", BETWEEN, 6.0))
    run.turn(7.0, seen("uav0", BETWEEN, 7.0))
    assert run.told[2:] == ["Hold", "HandOver"]
    run.turn(8.0, seen("uav0", BETWEEN, 8.0, channels=("control:gcs1",)))
    assert run.rules[-1] == "actuate"


@pytest.mark.parametrize("fallback", [HOLD, RETURN])
def test_what_the_mission_falls_back_on_does_not_overrule_an_operator(fallback):
    other = RETURN if fallback is HOLD else HOLD
    run = flying(precautions=LivePolicy(fallback, (TimeLimit("FLY", None, 5.0, fallback),)))
    run.turn(1.0, sayings=[ordered(what=other)])
    run.turn(2.0, boat(WEST, 2.0))
    run.turn(10.0)
    assert {"broken assumption", "late"} <= set(run.kinds())
    assert run.told == ["GoTo", type(run.commands[-1]).__name__]
    assert run.told[-1] == other.value.capitalize()
    why = f"{ANA} ordered it to {other.value}"
    assert f"uav0 is not commanded to {fallback.value}: {why}" in run.messages()


def test_a_vehicle_that_is_not_heard_is_told_when_it_is_and_the_operator_knows():
    run = flying()
    run.turn(1.0, reports=[LinkLost("uav0", 1.0, 0.0)])
    turn = run.turn(2.0, sayings=[ordered()])
    assert turn.commands == (Hold("operator-3", "uav0"),)
    assert "uav0 is silent: it gets the order once it is heard" in turn.findings[0].message
    run.turn(3.0, seen("uav0", BETWEEN, 3.0), reports=[LinkRestored("uav0", 3.0)])
    assert run.told == ["GoTo", "Hold", "Hold"]  # the first for the assumption that the lost link broke


def test_a_resumed_run_keeps_the_operators_order():
    run = flying()
    run.turn(1.0, sayings=[ordered()])
    known = known_of(run.state, overrides=run.state.overrides)
    again = Run(run.plan)
    again.state = resumed(run.plan, known, 100.0)
    again.turn(101.0, seen("uav0", EAST, 101.0), reports=[Arrived("operator-2", "uav0", 101.0)])
    assert again.rules == []
    assert again.kinds() == ["confirmed"]
    assert again.state.overrides.orders == {
        "uav0": StandingOrder(Hold("operator-2", "uav0"), "Ana", Fate.CONFIRMED)
    }


def test_a_finding_is_acknowledged_by_its_number_if_there_is_one():
    run = flying()
    for finding in (1, 0, -1):
        run.turn(1.0, sayings=[Acknowledging(finding, "Ana")])
    assert run.refusals == [f"there is no finding {n}; there are 0" for n in (1, 0, -1)]
    run.turn(2.0, reports=[TakenOver("uav0", 2.0, "x")])
    run.turn(3.0, sayings=[Acknowledging(1), Acknowledging(2)])
    assert [answer.refusal for answer in run.answers[3:]] == ["", "there is no finding 2; there are 1"]
    assert run.state.reported.count == len(run.findings) == 1


def test_what_vehicles_and_stations_say_for_people_alone_changes_nothing():
    own = (
        Status("uav0", 1.0, "autopilot", 1.0, "LOITER", True, None, 90.0, ("gcs0",)),
        StatusText("uav0", 1.0, "Mission: 1 Takeoff", 6),
        Presence("gcs1", 1.0, reached=True, heard=1.0),
    )
    ends = []
    for reports in ((), own):
        run = Run(plan_of(TOUR + GO))
        for now, at in ((0.0, WEST), (1.0, BETWEEN), (2.0, EAST)):
            run.turn(now, seen("uav0", at, now), reports=reports)
        ends.append((run.state, run.labels, run.commands, run.findings))
    assert ends[0][1:] == ends[1][1:]
    assert ends[0][0].configuration == ends[1][0].configuration


@pytest.mark.parametrize("fallback", [Return, Hold])
def test_a_vehicle_that_is_given_back_after_its_time_limit_is_flown_by_the_fallback_and_not_by_nobody(
    fallback,
):
    then = RETURN if fallback is Return else HOLD
    run = flying(precautions=LivePolicy(limits=(TimeLimit("FLY", "a", 60.0, then),)))
    run.turn(10.0, seen("uav0", BETWEEN, 10.0), sayings=[ordered()])
    run.turn(100.0, seen("uav0", BETWEEN, 100.0))  # meanwhile the limit is over, and the operator is obeyed
    assert run.told[-1] == "Hold"
    turn = run.turn(110.0, seen("uav0", BETWEEN, 110.0), sayings=[GivingBack("uav0", by="Ana")])
    assert [type(command).__name__ for command in turn.commands] == ["GiveBack", fallback.__name__]
    (given,) = (each for each in turn.findings if each.kind == "given back")
    assert given.message == (
        f"uav0 was given back by Ana; its task was given up: it is commanded to {then.value}"
    )


SENT_HOME = [
    (LivePolicy(RETURN, (TimeLimit("FLY", "a", 60.0, HOLD),)), 2.0),
    (LivePolicy(HOLD, (TimeLimit("FLY", "a", 60.0, RETURN),)), 90.0),
]


@pytest.mark.parametrize(("precautions", "drifts"), SENT_HOME)
def test_who_was_told_to_return_does_not_stop_on_its_way_home(precautions, drifts):
    run = flying(TWO + GO, precautions)
    run.turn(1.0, seen("uav0", BETWEEN, 1.0))
    for now in (drifts, 70.0, 100.0) if drifts < 70.0 else (70.0, drifts, 100.0):
        run.turn(now, seen("uav0", BETWEEN, now), *([boat(WEST, now)] if now == drifts else []))
    assert {"broken assumption", "late"} <= set(run.kinds())
    assert run.told[-1] == "Return"
    assert "Hold" not in run.told
    kept = "uav0 is not commanded to hold: it was commanded to return before"
    assert [finding.message for finding in run.findings if finding.kind == "trouble"] == [kept]
    turn = run.turn(110.0, seen("uav0", BETWEEN, 110.0), sayings=[ordered(), GivingBack("uav0")])
    assert [type(command).__name__ for command in turn.commands][-1] == "Return"


def test_a_vehicle_that_was_told_to_return_breaks_no_assumption_on_its_way_home():
    run = flying(TWO + GO, LivePolicy(RETURN))
    run.turn(60.0, seen("uav0", EAST, 60.0))
    run.turn(61.0, seen("uav0", EAST, 61.0), boat(WEST, 61.0))
    assert run.kinds().count("broken assumption") == 1
    run.turn(70.0, seen("uav0", BETWEEN, 70.0))
    assert run.state.configuration.structure.logical.parent("uav0") == "east0"
    told_home = "ordered to return by the mission, not confirmed yet"
    assert vehicle_line("uav0", run.state, None, 70.0) == f"uav0 {told_home}, is in none of the places"
    run.turn(80.0, seen("uav0", WEST, 80.0))
    assert run.kinds().count("broken assumption") == 1
    assert run.state.configuration.structure.physical.abstract_parent("uav0") == "west0"


def test_who_sends_a_vehicle_home_that_is_to_stay_is_told_what_follows_and_is_named_as_the_cause():
    run = flying(TWO + GO, LivePolicy(HOLD))
    run.turn(60.0, seen("uav0", EAST, 60.0))
    turn = run.turn(61.0, seen("uav0", EAST, 61.0), sayings=[ordered(what=RETURN)])
    (answer,) = turn.answers
    assert answer.notes == (
        "the mission assumes that uav0 stays in east0: when it leaves, all vehicles are commanded to hold",
    )
    run.turn(70.0, seen("uav0", BETWEEN, 70.0))
    (broken,) = (each.message for each in run.findings if each.kind == "broken assumption")
    assert broken.endswith("left its place: ordered to return by the operator (Ana), not confirmed yet")
    again = flying(TWO + GO, LivePolicy(HOLD))
    (answer,) = again.turn(10.0, seen("uav0", BETWEEN, 10.0), sayings=[ordered(what=RETURN)]).answers
    assert answer.notes == ()
