"""What became of what operators did: orders until vehicles confirm them, words, and alarms until they are seen."""

import pytest
from live_missions import boat
from recorded import BETWEEN, EAST, FLIGHT, WEST, Tape, told, uav

from adapters.live.batch import Acknowledging, GivingBack, Ordering
from adapters.plugin import Accepted, Hold, LinkLost, LinkRestored, Rejected, Sent, TakenOver
from semantics.live_policy import Fallback

HELD = Ordering(Fallback.HOLD, "uav0", "Ana")
OBEYS = "it obeys system 252, not gcs0"


def stands(tape):
    """Return how much the vehicle needs an operator, what has taken it over, and the order to it that stands."""
    card = tape.card()
    return card["level"], card["taken"], card["ordered"]


def fated(state, why=""):
    """Return what stands in an action and on a card of an order that one vehicle was given."""
    ordered = {"order": "hold", "by": "Ana", "since": 1001.0, "state": state, "why": why}
    return {"state": state, "why": why, "fates": {"uav0": {"state": state, "why": why}}}, ordered


def test_an_order_is_asked_sent_then_confirmed_by_the_vehicle_until_it_is_given_back(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[HELD])
    order = {"time": 1001.0, "by": "Ana", "what": "hold", "about": "uav0"}
    order |= {"left_out": {}, "notes": [], "vain": None, "answered": None}
    asked, ordered = fated("asked")
    waits = "ordered to hold by the operator (Ana), not confirmed yet"
    assert tape.actions() == [{**order, **asked}]
    assert stands(tape) == (1, waits, ordered)
    assert tape.card()["why"].endswith("; the time limit of its request, 100 s, still runs")
    assert (tape.card()["order"]["command"], tape.card()["order"]["state"]) == ("Hold", "asked")
    tape.turn(2, reports=[Sent("operator-2", "uav0", 1002.0)])
    sent, ordered = fated("sent")
    assert tape.actions() == [{**order, **sent}]
    assert (stands(tape), tape.card()["order"]["state"]) == ((1, waits, ordered), "sent")
    tape.turn(3, uav(WEST, 3), reports=[Accepted("operator-2", "uav0", 1003.0)])
    confirmed, ordered = fated("confirmed")
    assert tape.actions() == [{**order, **confirmed, "answered": 1003.0}]
    assert stands(tape) == (1, "held by the operator (Ana)", ordered)
    assert tape.card()["order"]["state"] == "accepted"
    tape.turn(4, sayings=[GivingBack("uav0", by="Bo")])
    _, back = tape.actions()
    assert (back["what"], back["by"], back["state"]) == ("give back", "Bo", "confirmed")
    assert (stands(tape), tape.card()["order"]["command"]) == ((0, None, None), "GoTo")


def test_a_refused_order_never_reads_as_done_until_the_vehicle_obeys_after_all(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[HELD])
    tape.turn(2, reports=[Sent("operator-2", "uav0", 1002.0), Rejected("operator-2", "uav0", 1002.0, OBEYS)])
    refused, ordered = fated("refused", OBEYS)
    words = f"refuses to hold, as the operator (Ana) ordered: {OBEYS}"
    for now in (2, 8):  # it is told again then, and has not answered yet
        if now > 2:
            assert any(isinstance(each, Hold) for each in tape.turn(now, uav(WEST, now)).commands)
            tape.turn(now, reports=[Sent("operator-2", "uav0", 1000.0 + now)])
        assert tape.actions()[0].items() >= {**refused, "answered": None}.items()
        assert stands(tape) == (2, words, ordered)
        assert tape.card()["why"].startswith(f"{words}; ")
        assert tape.card()["order"]["state"] == "refused"
    tape.turn(9, uav(WEST, 9), reports=[Accepted("operator-2", "uav0", 1009.0)])
    confirmed, ordered = fated("confirmed")
    assert tape.actions()[0].items() >= {**confirmed, "answered": 1009.0}.items()
    assert stands(tape) == (1, tape.run.state.overrides.taken["uav0"], ordered)  # the run's own words
    assert tape.card()["taken"] == "held by the operator (Ana)"


@pytest.mark.parametrize(
    ("then", "what"),
    [
        ({"sayings": [GivingBack("uav0", by="Bo")]}, "given back"),
        ({"sayings": [Ordering(Fallback.RETURN, "uav0", "Bo")]}, "ordered to return"),
        ({"reports": [TakenOver("uav0", 1003.0, "a pilot flies it")]}, "taken over: a pilot flies it"),
    ],
)
def test_an_order_that_ends_before_it_is_confirmed_says_so_and_stands_no_more(tape, then, what):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[HELD])
    tape.turn(2, reports=[Rejected("operator-2", "uav0", 1002.0, OBEYS)])
    tape.turn(3, uav(WEST, 3), **then)
    ended = {"state": "refused", "why": f"{OBEYS}; then it was {what}", "answered": 1003.0}
    assert tape.actions()[0].items() >= ended.items()
    ordered = tape.card()["ordered"]
    assert ordered is None or ordered["order"] == "return"


def test_an_order_that_the_run_or_the_vehicle_refuses_says_so(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.HOLD, "nobody", "Ana"), Ordering(Fallback.RETURN, None, "Ana")])
    tape.turn(2, reports=[Rejected("operator-2", "uav0", 1002.0, "it has no home")])
    of_run, of_vehicle = tape.actions()
    assert (of_run["state"], of_run["fates"], of_run["answered"]) == ("refused", {}, 1001.0)
    assert (of_vehicle["what"], of_vehicle["about"]) == ("return", "all")
    assert (of_vehicle["state"], of_vehicle["why"]) == ("refused", "it has no home")


def test_a_change_of_address_that_is_refused_says_why(tmp_path):
    rebind = {"command": "Rebind", "request": "operator-7", "entity": "uav0", "at": "127.0.0.1:9"}
    given = {"vehicle": "uav0", "by": "Ana", "at": "127.0.0.1:9", "refusal": ""}
    why = {"report": "Rejected", "request": "operator-7", "entity": "uav0", "time": 1003.0, "reason": "no"}
    heard = {"report": "LinkRestored", "entity": "uav0", "time": 1003.0}
    told_so = [("commands", 1002.0, rebind), ("given_back", 1002.0, given)]
    for name, reports, fate in [
        ("a", [], ("sent", "", None)),
        ("b", [why], ("refused", "no", 1003.0)),
        ("c", [heard], ("confirmed", "", 1003.0)),
    ]:
        more = [("reports", 1003.0, each) for each in reports]
        (action,) = told(tmp_path / name, *told_so, *more)["actions"].values()
        assert action["what"] == "is at 127.0.0.1:9"
        assert (action["state"], action["why"], action["answered"]) == fate


def test_an_order_overrules_who_has_taken_a_vehicle_over_and_is_overruled_so(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(WEST, 1), reports=[TakenOver("uav0", 1001.0, "a pilot flies it")])
    tape.turn(2, sayings=[Ordering(Fallback.HOLD, "uav0")])
    assert stands(tape)[:2] == (1, "ordered to hold by the operator, not confirmed yet")
    tape.turn(3, uav(WEST, 3), reports=[TakenOver("uav0", 1003.0, "it is in RTL")])
    assert stands(tape)[:2] == (3, "it is in RTL")


def test_an_order_to_all_is_confirmed_when_all_have_confirmed_it_and_says_who_was_left_out(tmp_path):
    requests = {"uav0": "hold-1", "uav1": "hold-2"}
    order = {"order": "hold", "vehicle": None, "by": "Ana", "requests": requests, "refusal": ""}
    order |= {"left_out": {"uav2": "a pilot flies it"}, "notes": ["uav0 is not heard"]}
    done = {"report": "Accepted", "request": "hold-1", "entity": "uav0", "time": 1003.0}
    also = done | {"request": "hold-2", "entity": "uav1"}
    refused = done | {"report": "Rejected", "reason": "it is on the ground"}

    def action(name, *reports):
        more = [("reports", 1003.0 + n, each) for n, each in enumerate(reports)]
        return told(tmp_path / name, ("orders", 1002.0, order), *more)["actions"]["1"]

    one = action("a", done)
    assert (one["about"], one["state"]) == ("all", "asked")
    assert one["fates"]["uav0"] == {"state": "confirmed", "why": ""}
    assert (one["left_out"], one["notes"]) == (order["left_out"], order["notes"])
    other = action("b", refused)
    assert (other["state"], other["why"]) == ("refused", "uav0: it is on the ground")
    assert other["fates"]["uav1"] == {"state": "asked", "why": ""}
    assert action("c", done, also)["state"] == "confirmed"


# --- what is wrong, and what follows from it


FALLING_BACK = FLIGHT.replace("on broken assumption: continue", "on broken assumption: return")
STOPPED = "all vehicles were commanded to return home; the mission sends no more commands"


def test_what_is_said_after_a_fallback_is_told_to_be_in_vain(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1, sayings=[("op", "status")])
        tape.turn(2, uav(BETWEEN, 2), boat(EAST, 1002.0))
        tape.turn(3, sayings=[("op", "status")])
        vain = "the mission has fallen back and sends no more commands: messages move no vehicle"
        assert [each["vain"] for each in tape.actions()] == [None, vain]
        for shown, said, stopped in ((tape.shown(), vain, STOPPED), (tape.shown(1), None, None)):
            assert {each["vain"] for each in shown["sayings"].values()} == {said}
            assert shown["mission"]["fallen_back"] == stopped


def test_an_alarm_has_its_consequence_whichever_finding_had_it_until_it_is_acknowledged(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(5, reports=[LinkLost("uav0", 1005.0, 1001.0)])
        tape.turn(6, uav(BETWEEN, 6), boat(EAST, 1006.0), reports=[LinkRestored("uav0", 1006.0)])
        alarms = tape.shown()["alarms"]
        kinds = {each["kind"]: each["consequence"] for each in alarms.values()}
        assert kinds["lost link"] == kinds["broken assumption"] == STOPPED
        alerts = {(each["kind"], each["wrong"]): key for key, each in tape.shown()["alerts"].items()}
        assert ("link restored", False) in alerts
        lost = alerts["lost link", True]
        tape.turn(7, sayings=[Acknowledging(int(lost), "Ana")])
        shown = tape.shown()
        assert lost not in shown["alarms"]
        assert shown["alerts"][lost]["acknowledged"] == {"by": "Ana", "time": 1007.0}
        assert [(each["what"], each["about"]) for each in tape.actions()] == [("acknowledge", "uav0")]


def test_the_consequence_of_a_lost_link_and_of_a_take_over_is_as_it_is_now(tape):
    def consequences():
        return {each["kind"]: each["consequence"] for each in tape.shown()["alarms"].values()}

    tape.turn(0, uav(WEST, 0))
    tape.turn(5, reports=[LinkLost("uav0", 1005.0, 1000.0), TakenOver("uav0", 1005.0, "a pilot flies it")])
    decides = "its autopilot decides, and orders reach it once it is heard"
    kept = "the mission does not command it until it is given back"
    assert consequences().items() >= {"lost link": decides, "taken over": kept}.items()
    tape.turn(6, uav(WEST, 6), reports=[LinkRestored("uav0", 1006.0)], sayings=[GivingBack("uav0")])
    given = {"lost link": "it is heard again", "taken over": "it was given back"}
    assert consequences().items() >= given.items()


def test_what_is_wrong_now_is_shown_beside_each_earlier_moment_of_a_run_that_goes_on(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1000.0)])
    before = tape.shown(1)
    assert before["alerts"] == {}
    assert {each["kind"] for each in before["alarms"].values()} >= {"lost link"}
    tape.end(11)
    assert tape.shown(1)["alarms"] == {}
