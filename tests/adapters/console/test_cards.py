"""The vehicles' cards: how much each needs an operator, and why."""

import pytest
from live_missions import boat, mission, seen
from recorded import BETWEEN, EAST, FLIGHT, WEST, Tape, rules_of_once, uav, written

from adapters.console.history import History
from adapters.live.batch import Acknowledging, GivingBack, Ordering
from adapters.live.timing import flying
from adapters.plugin import Accepted, GoTo, Hold, LinkLost, LinkRestored, Rejected, Sent, Status, TakenOver
from bigactors.missions import digest_of
from semantics.live_policy import Fallback

RUN = {
    "schema": "bigactors.run/1",
    "mission": "tour.mission",
    "text": FLIGHT,
    "digest": digest_of(mission(FLIGHT)),
    "version": "0",
    "verified": True,
    "vehicles": {"uav0": "autopilot"},
}


@pytest.fixture
def tape(tmp_path):
    with Tape(tmp_path / "r.mcap") as begun:
        yield begun


def level(tape, at=None):
    card = tape.card(at)
    return card["level"], card["why"]


def test_a_vehicle_that_does_what_it_was_told_is_well(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(3, uav(BETWEEN, 3), sayings=[("op", "status")])
    card = tape.card()
    assert (card["level"], card["why"]) == (0, "")
    assert (card["believed"], card["actual"], card["differs"]) == ("west0", "region", True)
    assert card["request"] == {
        "text": "FLY(a, MOVE_HOST_TO east0)",
        "agent": "a",
        "since": 1000.0,
        "limit": 100.0,
        "fallback": "continue",
        "given_up": False,
    }
    assert card["order"] == {
        "command": "GoTo",
        "to": "east0",
        "way": ((37.0099997, -8.61),),
        "since": 1000.0,
        "state": "accepted",
        "why": "",
    }
    assert card["link"] == {"heard": 1003.0, "lost": False}
    assert card["authority"] == ["gcs0"]


def test_a_vehicle_of_which_nothing_is_asked_says_for_whom_it_waits(tape):
    def says(now):
        status = Status("uav0", now, "autopilot", now, "GUIDED", armed=True, home=(37.01, -8.65))
        tape.recorder.report(status, now)

    tape.turn(0, uav(WEST, 0))
    says(1000.5)
    assert (*level(tape), tape.card()["home"], tape.card()["returning"]) == (0, "", (37.01, -8.65), False)
    tape.turn(60, uav(EAST, 60))
    says(1060.5)
    assert level(tape) == (0, 'nothing is asked of it: op waits for "handover"')


def test_arrival_is_what_the_rules_say_it_is(tape):
    tape.turn(0, uav(WEST, 0))
    assert tape.card()["order"]["state"] == "sent"
    tape.turn(1, uav(EAST, 1))
    assert tape.card(0.5)["order"]["state"] == "sent"
    card = tape.card()
    assert card["order"]["state"] == "arrived"
    assert (card["believed"], card["actual"], card["differs"]) == ("east0", "east0", False)


def test_a_request_is_watched_from_half_of_its_time_on_and_wrong_when_that_is_over(tape):
    for now in range(0, 121, 4):
        tape.turn(now, uav(WEST if now == 0 else BETWEEN, now))
    assert level(tape, 50) == (0, "")
    assert level(tape, 51) == (1, "its request stands for more than half of 100 s")
    assert level(tape, 100) == (2, "its request stands for longer than 100 s")
    (late,) = [each for each in tape.history().newest().sections["alerts"].values() if each["wrong"]]
    assert (late["kind"], late["about"]) == ("late", "a")


def test_a_link_is_watched_when_it_is_silent_and_lost_when_the_plugin_says_so(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(9, seen("boat0", (37.04, -8.7), 1009.0, "ais", "Vessel", ()), sayings=[("op", "status")])
    assert level(tape, 4.9) == (0, "")
    assert level(tape, 5.1) == (1, "nothing was heard of it for more than 5 s")
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1000.0)])
    lost = tape.card()
    assert lost["level"] == 3
    assert lost["why"].startswith("the link is lost; ")
    assert lost["link"] == {"heard": 1000.0, "lost": True}
    tape.turn(11, uav(WEST, 11), reports=[LinkRestored("uav0", 1011.0)])
    assert tape.card()["link"] == {"heard": 1011.0, "lost": False}


def test_who_was_taken_over_is_lost_until_given_back(tmp_path):
    with Tape(tmp_path / "r.mcap") as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1, uav(WEST, 1), reports=[TakenOver("uav0", 1001.0, "a pilot flies it")])
        card = tape.card()
        assert (card["level"], card["why"], card["taken"]) == (
            3,
            "taken over: a pilot flies it; the 100 s of its request run on meanwhile",
            "a pilot flies it",
        )


def test_who_refuses_is_wrong_and_says_why(tape):
    tape.run.willing = False
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(WEST, 1), reports=[Rejected("a-1", "uav0", 1001.0, "it is not armed")])
    assert level(tape) == (2, "it refuses GoTo: it is not armed")
    assert tape.card()["order"]["why"] == "it is not armed"


def test_where_l_and_p_differ_without_a_flight_is_watched(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(EAST, 1))
    tape.turn(2, uav(BETWEEN, 2))
    card = tape.card()
    assert (card["believed"], card["actual"], card["level"]) == ("east0", "region", 3)
    broken, differing = card["why"].split("; ", 1)[0], card["why"].rsplit("; ", 1)[1]
    assert broken.startswith("broken assumption: uav0 ")
    assert differing == "where it is believed to be and where it is differ"


# --- what other parts of the project record -------------------------------------------------------------


def told(path, *messages, copied=()):
    """Return the view of a run in which a vehicle says of itself what it says; `copied` is of the run before it."""
    arrival = {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "ring": [[370100000, -86500000]]}
    writer = written(path, RUN, [*copied, ("arrivals", 1001.0, arrival), *messages])
    history = History(path, rules_of_once)
    while history.read_on(1.0):
        pass
    writer.close()
    return history.newest().sections


STATUS = {
    "plugin": "autopilot",
    "entity": "uav0",
    "time": 1002.0,
    "mode": "GUIDED",
    "armed": True,
    "battery": {"percent": 24, "volts": 11.1},
    "heading": 270.0,
    "authority": ["gcs1"],
    "heard": 1002.0,
    "height": 101.5,
    "home": [37.01, -8.65],
    "returning": False,
}


def test_what_a_vehicle_says_of_itself_is_on_its_card(tmp_path):
    said = {"entity": "uav0", "time": 1002.5, "text": "Low battery", "severity": 2}
    card = told(tmp_path / "r", ("status", 1002.0, STATUS), ("said", 1002.5, said))["vehicles"]["uav0"]
    members = ("mode", "armed", "battery", "heading", "authority", "height", "said")
    assert {key: card[key] for key in members} == {
        "mode": "GUIDED",
        "armed": True,
        "battery": {"percent": 24.0, "volts": 11.1},
        "heading": 270.0,
        "authority": ["gcs1"],
        "height": 101.5,
        "said": {"text": "Low battery", "time": 1002.5, "severity": 2},
    }
    assert (card["level"], card["why"]) == (2, "its battery has less than 25 %")
    assert card["link"] == {"heard": 1002.0, "lost": False}


def test_a_card_has_the_newest_altitude_and_the_last_change_of_authority(tmp_path):
    higher = {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "ring": [[370100000, -86500000]]}
    higher |= {"altitude": [120.5, 120.5], "channels": ["control:gcs0", "wifi"]}
    later = ("arrivals", 1003.0, {**higher, "channels": ["control:gcs1"], "altitude": [121.0, 121.0]})
    card = told(tmp_path / "a", ("arrivals", 1002.0, higher))["vehicles"]["uav0"]
    assert (card["altitude"], card["height"], card["authority"], card["handed"]) == (
        120,
        None,
        ["gcs0"],
        None,
    )
    card = told(tmp_path / "b", ("arrivals", 1002.0, higher), later)["vehicles"]["uav0"]
    assert (card["altitude"], card["authority"]) == (121.0, ["gcs1"])
    assert card["handed"] == {"time": 1003.0, "from": ["gcs0"], "to": ["gcs1"]}
    unsure = {**STATUS, "authority": []}
    statuses = [("status", 1004.0, STATUS), ("status", 1005.0, unsure), ("status", 1006.0, STATUS)]
    card = told(tmp_path / "c", ("arrivals", 1002.0, higher), *statuses, later)["vehicles"]["uav0"]
    assert card["handed"] == {"time": 1004.0, "from": ["gcs0"], "to": ["gcs1"]}


def actions(tape):
    return list(tape.history().newest().sections["actions"].values())


def fated(state, why=""):
    """Return what stands in an action and on a card of an order that one vehicle was given."""
    ordered = {"order": "hold", "by": "Ana", "since": 1001.0, "state": state, "why": why}
    return {"state": state, "why": why, "fates": {"uav0": {"state": state, "why": why}}}, ordered


def test_an_order_is_asked_sent_then_confirmed_by_the_vehicle_until_it_is_given_back(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
    order = {"time": 1001.0, "by": "Ana", "what": "hold", "about": "uav0"}
    order |= {"left_out": {}, "notes": [], "vain": None}
    asked, ordered = fated("asked")
    assert actions(tape) == [{**order, **asked, "answered": None}]
    card = tape.card()
    told = "told to hold by the operator (Ana), not confirmed yet"
    assert (card["level"], card["taken"], card["ordered"]) == (1, told, ordered)
    assert card["why"].endswith("; the 100 s of its request run on meanwhile")
    assert (card["order"]["command"], card["order"]["state"]) == ("Hold", "asked")
    tape.turn(2, reports=[Sent("operator-2", "uav0", 1002.0)])
    sent, ordered = fated("sent")
    assert actions(tape) == [{**order, **sent, "answered": None}]
    card = tape.card()
    assert (card["taken"], card["ordered"], card["order"]["state"]) == (told, ordered, "sent")
    tape.turn(3, uav(WEST, 3), reports=[Accepted("operator-2", "uav0", 1003.0)])
    confirmed, ordered = fated("confirmed")
    assert actions(tape) == [{**order, **confirmed, "answered": 1003.0}]
    card = tape.card()
    assert (card["level"], card["taken"], card["ordered"]) == (1, "held by the operator (Ana)", ordered)
    assert card["order"]["state"] == "accepted"
    tape.turn(4, sayings=[GivingBack("uav0", by="Bo")])
    assert [(each["what"], each["by"], each["state"]) for each in actions(tape)][1:] == [
        ("give back", "Bo", "confirmed")
    ]
    card = tape.card()
    assert (card["level"], card["taken"], card["ordered"], card["order"]["command"]) == (
        0,
        None,
        None,
        "GoTo",
    )


OBEYS = "it obeys system 252, not gcs0"


def test_a_refused_order_never_reads_as_done_until_the_vehicle_obeys_after_all(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
    tape.turn(2, reports=[Sent("operator-2", "uav0", 1002.0), Rejected("operator-2", "uav0", 1002.0, OBEYS)])
    refused, ordered = fated("refused", OBEYS)
    words = f"refuses to hold, as the operator (Ana) ordered: {OBEYS}"
    for now in (2, 8):  # it is told again then, and has not answered yet
        if now > 2:
            assert any(isinstance(each, Hold) for each in tape.turn(now, uav(WEST, now)).commands)
            tape.turn(now, reports=[Sent("operator-2", "uav0", 1000.0 + now)])
        assert actions(tape)[0].items() >= {**refused, "answered": None}.items()
        card = tape.card()
        assert (card["level"], card["taken"], card["ordered"]) == (2, words, ordered)
        assert card["why"].startswith(f"{words}; ")
        assert card["order"]["state"] == "refused"
    tape.turn(9, uav(WEST, 9), reports=[Accepted("operator-2", "uav0", 1009.0)])
    confirmed, ordered = fated("confirmed")
    assert actions(tape)[0].items() >= {**confirmed, "answered": 1009.0}.items()
    card = tape.card()
    assert (card["level"], card["taken"], card["ordered"]) == (1, "held by the operator (Ana)", ordered)
    assert card["taken"] == tape.run.state.overrides.taken["uav0"]  # the run's own words


def ended(order):
    return {"state": "refused", "why": f"{OBEYS}; then it was {order}", "answered": 1003.0}


@pytest.mark.parametrize(
    ("then", "what"),
    [
        ({"sayings": [GivingBack("uav0", by="Bo")]}, "given back"),
        ({"sayings": [Ordering(Fallback.RETURN, "uav0", "Bo")]}, "told to return"),
        ({"reports": [TakenOver("uav0", 1003.0, "a pilot flies it")]}, "taken over: a pilot flies it"),
    ],
)
def test_an_order_that_ends_before_it_is_confirmed_says_so_and_stands_no_more(tape, then, what):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
    tape.turn(2, reports=[Rejected("operator-2", "uav0", 1002.0, OBEYS)])
    tape.turn(3, uav(WEST, 3), **then)
    assert actions(tape)[0].items() >= ended(what).items()
    ordered = tape.card()["ordered"]
    assert ordered is None or ordered["order"] == "return"


def test_an_order_that_the_run_refuses_is_refused_at_once_and_stands_for_no_vehicle(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.HOLD, "nobody", "Ana")])
    (action,) = actions(tape)
    assert (action["state"], action["fates"], action["answered"]) == ("refused", {}, 1001.0)
    assert tape.card()["ordered"] is None


def test_a_change_of_address_that_is_refused_says_why(tmp_path):
    rebind = {"command": "Rebind", "request": "operator-7", "entity": "uav0", "at": "127.0.0.1:9"}
    given = {"vehicle": "uav0", "by": "Ana", "at": "127.0.0.1:9", "refusal": ""}
    why = {"report": "Rejected", "request": "operator-7", "entity": "uav0", "time": 1003.0, "reason": "no"}
    told_so = [("commands", 1002.0, rebind), ("given_back", 1002.0, given)]
    (action,) = told(tmp_path / "a", *told_so)["actions"].values()
    assert (action["what"], action["state"], action["answered"]) == ("is at 127.0.0.1:9", "sent", None)
    (action,) = told(tmp_path / "b", *told_so, ("reports", 1003.0, why))["actions"].values()
    assert (action["state"], action["why"], action["answered"]) == ("refused", "no", 1003.0)
    heard = {"report": "LinkRestored", "entity": "uav0", "time": 1003.0}
    (action,) = told(tmp_path / "c", *told_so, ("reports", 1003.0, heard))["actions"].values()
    assert (action["state"], action["answered"]) == ("confirmed", 1003.0)


def test_an_order_that_the_vehicle_refuses_says_why(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, sayings=[Ordering(Fallback.RETURN, None, "Ana")])
    tape.turn(2, reports=[Rejected("operator-2", "uav0", 1002.0, "it has no home")])
    (action,) = actions(tape)
    assert (action["what"], action["about"]) == ("return", "all")
    assert (action["state"], action["why"]) == ("refused", "it has no home")


def test_an_order_overrules_who_has_taken_a_vehicle_over_and_is_overruled_so(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(WEST, 1), reports=[TakenOver("uav0", 1001.0, "a pilot flies it")])
    tape.turn(2, sayings=[Ordering(Fallback.HOLD, "uav0")])
    card = tape.card()
    assert (card["level"], card["taken"]) == (1, "told to hold by the operator, not confirmed yet")
    tape.turn(3, uav(WEST, 3), reports=[TakenOver("uav0", 1003.0, "it is in RTL")])
    card = tape.card()
    assert (card["level"], card["taken"]) == (3, "it is in RTL")


HOLD = {"order": "hold", "vehicle": "uav0", "by": "Ana", "requests": {"uav0": "hold-1"}, "refusal": ""}
DONE = {"report": "Accepted", "request": "hold-1", "entity": "uav0", "time": 1003.0}


def test_an_order_to_all_is_confirmed_when_all_have_confirmed_it(tmp_path):
    both = {**HOLD, "vehicle": None, "requests": {"uav0": "hold-1", "uav1": "hold-2"}}
    view = told(tmp_path / "a", ("orders", 1002.0, both), ("reports", 1003.0, DONE))
    assert (view["actions"]["1"]["about"], view["actions"]["1"]["state"]) == ("all", "asked")
    assert view["actions"]["1"]["fates"]["uav0"] == {"state": "confirmed", "why": ""}
    no = {**DONE, "report": "Rejected", "reason": "it is on the ground"}
    view = told(tmp_path / "c", ("orders", 1002.0, both), ("reports", 1003.0, no))
    action = view["actions"]["1"]
    assert (action["state"], action["why"]) == ("refused", "uav0: it is on the ground")
    assert action["fates"]["uav1"] == {"state": "asked", "why": ""}
    also = {**DONE, "request": "hold-2", "entity": "uav1"}
    view = told(
        tmp_path / "b", ("orders", 1002.0, both), ("reports", 1003.0, DONE), ("reports", 1004.0, also)
    )
    assert view["actions"]["1"]["state"] == "confirmed"


def test_an_order_to_all_says_who_was_left_out_and_why(tmp_path):
    some = {**HOLD, "vehicle": None, "left_out": {"uav1": "a pilot flies it"}, "notes": ["uav0 is not heard"]}
    (action,) = told(tmp_path / "a", ("orders", 1002.0, some))["actions"].values()
    assert (action["left_out"], action["notes"]) == ({"uav1": "a pilot flies it"}, ["uav0 is not heard"])


GROUNDING = FLIGHT.replace("FLY a within 100 s: continue", "FLY a within 100 s: hold")


def test_while_a_vehicle_is_held_its_request_runs_out_and_its_agent_is_grounded(tmp_path):
    with Tape(tmp_path / "r.mcap", GROUNDING) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
        assert tape.card()["request"]["fallback"] == "hold"
        meanwhile = (
            "the 100 s of its request run on meanwhile; then nothing that a orders is carried out any more"
        )
        assert tape.card()["why"].endswith(meanwhile)
        tape.turn(101, uav(WEST, 101))
        stopped = "nothing that a orders is carried out any more"
        assert tape.card()["why"] == (
            f"its request stands for longer than 100 s; {stopped}; "
            "told to hold by the operator (Ana), not confirmed yet"
        )
        tape.turn(102, sayings=[GivingBack("uav0")])
        assert tape.run.state.overrides.grounded == {"a"}
        assert not any(isinstance(each, GoTo) for each in tape.turn(103, uav(WEST, 103)).commands)
        assert tape.card()["request"]["given_up"]
        assert [each["notes"] for each in actions(tape) if each["what"] == "give back"] == [
            ["what it was to do was given up: it is told to hold"]
        ]


FALLING_BACK = FLIGHT.replace("on broken assumption: continue", "on broken assumption: return")
STOPPED = "all vehicles were told to return home; the mission commands nothing any more"


def test_after_a_fallback_the_cards_say_that_nothing_is_commanded_any_more(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        assert not tape.card()["request"]["given_up"]
        tape.turn(1, uav(BETWEEN, 1), boat(EAST, 1001.0))
        assert tape.run.state.overrides.suspended
        card = tape.card()
        assert (card["level"], card["why"], card["request"]["given_up"]) == (2, STOPPED, True)
        tape.turn(2, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
        assert tape.card()["why"] == f"{STOPPED}; told to hold by the operator (Ana), not confirmed yet"
        tape.turn(3, sayings=[GivingBack("uav0", by="Ana")])
        assert (level(tape), tape.card()["request"]["given_up"]) == ((2, STOPPED), True)


def test_what_is_said_after_a_fallback_is_told_to_be_in_vain(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1, sayings=[("op", "status")])
        tape.turn(2, uav(BETWEEN, 2), boat(EAST, 1002.0))
        tape.turn(3, sayings=[("op", "status")])
        shown = tape.history().newest().sections
        vain = "the mission has fallen back and commands nothing any more: what is said moves no vehicle"
        assert [each["vain"] for each in shown["actions"].values()] == [None, vain]
        assert {each["vain"] for each in shown["sayings"].values()} == {vain}
        assert shown["mission"]["fallen_back"] == STOPPED
        before = tape.history().at(1001.0).forward(1001.0).sections
        assert {each["vain"] for each in before["sayings"].values()} == {None}
        assert before["mission"]["fallen_back"] is None


def test_an_alarm_has_its_consequence_whichever_finding_had_it(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(5, reports=[LinkLost("uav0", 1005.0, 1001.0)])
        tape.turn(6, uav(BETWEEN, 6), boat(EAST, 1006.0))
        shown = tape.history().newest().sections
        kinds = {each["kind"]: each["consequence"] for each in shown["alarms"].values()}
        assert kinds["lost link"] == kinds["broken assumption"] == STOPPED
        (lost,) = [key for key, each in shown["alarms"].items() if each["kind"] == "lost link"]
        tape.turn(7, sayings=[Acknowledging(int(lost), "Ana")])
        assert lost not in tape.history().newest().sections["alarms"]


LATE = FLIGHT.replace("FLY a within 100 s: continue", "FLY a within 100 s: hold")


def test_what_follows_from_a_late_request_is_told_of_its_agent(tmp_path):
    with Tape(tmp_path / "r.mcap", LATE) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(101, uav(WEST, 101))
        (alarm,) = tape.history().newest().sections["alarms"].values()
        told_to = "its vehicles were told to hold; nothing that a orders is carried out any more"
        assert (alarm["kind"], alarm["consequence"]) == ("late", told_to)


def test_what_is_wrong_now_is_shown_beside_each_earlier_moment_of_a_run_that_goes_on(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1000.0)])
    before = tape.history().at(1001.0).forward(1001.0).sections
    assert before["alerts"] == {}
    assert {each["kind"] for each in before["alarms"].values()} >= {"lost link"}
    tape.end(11)
    assert tape.history().at(1001.0).forward(1001.0).sections["alarms"] == {}


def word(card):
    return card["level"], card["word"]


def test_a_vehicle_is_lost_taken_over_or_broken_by_what_is_so(tape):
    assert word(tape.card()) == (1, "unknown")
    assert tape.card()["why"] == "nothing was heard of it yet"
    tape.turn(0, uav(WEST, 0))
    assert word(tape.card()) == (0, "well")
    tape.turn(1, uav(WEST, 1), reports=[TakenOver("uav0", 1001.0, "its pilot has taken over")])
    assert word(tape.card()) == (3, "taken over")
    tape.turn(2, sayings=[GivingBack("uav0")])
    tape.turn(3, boat(EAST, 1003.0), uav(WEST, 3))
    assert word(tape.card()) == (0, "well")
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1003.0)])
    assert word(tape.card()) == (3, "lost")


def test_a_vehicle_that_broke_an_assumption_is_broken_and_not_lost(tmp_path):
    broken = {"kind": "broken assumption", "about": "uav0", "message": "it strayed", "fallback": ""}
    card = told(tmp_path / "a", ("findings", 1002.0, broken))["vehicles"]["uav0"]
    assert word(card) == (3, "broken")


@pytest.mark.parametrize("at", [None, 1001.0])
def test_nothing_is_known_of_the_vehicles_of_a_run_that_was_killed(tape, at):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(WEST, 1))
    history = tape.history()
    history.end("the run was killed")
    view = history.newest() if at is None else history.at(at).forward(at)
    card = view.sections["vehicles"]["uav0"]
    assert word(card) == (3, "unknown")
    assert card["why"].startswith("nothing is known of it any more: the run was killed")
    assert word(history.at(1000.5).forward(1000.5).sections["vehicles"]["uav0"]) == (0, "well")


TIMED = FLIGHT.replace(
    "live {", "timing { uav0 flies at 18 m/s to 25 m/s }\nscheduler fcfs\ncontrol timed\nlive {"
)


def test_a_card_has_the_times_of_the_flight_that_the_run_watches(tmp_path):
    with Tape(tmp_path / "r.mcap", TIMED) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(30, uav(BETWEEN, 30))
        assert tape.card()["flight"] == {"to": "east0", "since": 1000.0, "least": 71.0, "most": 255.0}
        (watched,) = flying(tape.run.state.due.timers)
        assert tape.card()["flight"]["least"] == watched.least
        tape.turn(100, uav(EAST, 100))
        assert tape.card()["flight"] is None
        assert tape.card(at=30)["flight"] is not None


def test_of_several_broken_assumptions_about_a_vehicle_its_card_says_the_newest(tmp_path):
    broken = [
        (
            "findings",
            1002.0 + n,
            {"kind": "broken assumption", "about": "uav0", "message": each, "fallback": ""},
        )
        for n, each in enumerate(("it is in west0", "it is in east0", "it has vanished"))
    ]
    card = told(tmp_path / "a", *broken)["vehicles"]["uav0"]
    assert card["why"] == "broken assumption: it has vanished (and 2 more)"


def test_a_run_that_goes_on_from_one_that_fell_back_is_not_stopped(tmp_path):
    before = {"kind": "broken assumption", "about": "boat0", "message": "it appears", "fallback": "hold"}
    assert told(tmp_path / "a", copied=[("findings", 999.0, before)])["vehicles"]["uav0"]["level"] == 0
    assert told(tmp_path / "b", ("findings", 1002.0, before))["vehicles"]["uav0"]["level"] == 2


def test_a_finding_that_is_wrong_stands_until_it_is_acknowledged(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1000.0)])
    tape.turn(11, uav(WEST, 11), reports=[LinkRestored("uav0", 1011.0)])
    alerts = tape.history().newest().sections["alerts"]
    kinds = {key: (each["kind"], each["wrong"]) for key, each in alerts.items()}
    (lost,) = [key for key, each in kinds.items() if each == ("lost link", True)]
    assert ("link restored", False) in kinds.values()
    tape.turn(12, sayings=[Acknowledging(int(lost), "Ana")])
    seen_by = tape.history().newest().sections["alerts"][lost]["acknowledged"]
    assert seen_by == {"by": "Ana", "time": 1012.0}
    assert [(each["what"], each["about"]) for each in actions(tape)] == [("acknowledge", "uav0")]


def test_what_is_no_such_message_is_passed_over(tmp_path):
    topics = (
        "arrivals",
        "steps",
        "commands",
        "reports",
        "orders",
        "status",
        "said",
        "stations",
        "given_back",
        "deadlines",
        "flights",
    )
    odd = [None, [], 3, {}, {"entity": 3}, {"entity": "uav0", "ring": [["x", 1]]}, {"requests": []}]
    odd += [{"vehicle": "uav0", "takes": {"to": "x", "since": "noon", "least": 1, "most": []}}]
    odd += [{"agent": "op", "until": "noon"}, {"left_out": [], "notes": {}, "requests": {}, "order": "hold"}]
    odd += [{"command": "GoTo", "request": "x", "entity": "uav0", "ring": [[1, 2], [3]]}]
    view = told(tmp_path / "a", *((topic, 1002.0, data) for topic in topics for data in odd))
    assert view["vehicles"]["uav0"]["level"] == 0
    assert view["entities"]["uav0"]["at"] == (37.01, -8.65)


def test_a_card_stays_as_it_is_while_its_vehicle_is_heard_ten_times_a_second(tmp_path):
    def card(count):
        arrivals = [("arrivals", 1002.0 + tenth / 10, flies(1002.0 + tenth / 10)) for tenth in range(count)]
        return told(tmp_path / f"{count}", *arrivals)["vehicles"]["uav0"]

    def flies(time):
        at = {"ring": [[370100000, -86500000 + round((time - 1002.0) * 1e3)]], "altitude": [time - 900.3] * 2}
        return {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "time": time, **at}

    first = card(1)
    assert first["link"] == {"heard": 1002, "lost": False}
    assert first == card(8)
    assert first != card(11)


AT_HOME = FLIGHT.replace("  control(MOVE_HOST_TO east0)\n", '  react { case "go" => skip }\n', 1)
HOME = {
    "mode": "AUTO",
    "armed": True,
    "heading": None,
    "battery": None,
    "authority": ["gcs0"],
    "height": 50.0,
}


def on_return(tmp_path, home, text, *more):
    """Return what is said of an order to return to a vehicle that stands in west0."""
    tmp_path.mkdir()
    with Tape(tmp_path / "r.mcap", text) as tape:
        tape.turn(0, uav(WEST, 0))
        status = Status("uav0", 1001.0, "autopilot", home=home)
        tape.recorder.report(status, 1001.0)
        for each in more:
            tape.turn(2, each)
        return tape, tape.card()["on_return"]


STANDING = AT_HOME.replace("on broken assumption: continue", "on broken assumption: hold")


def test_what_a_return_breaks_is_told_before_it_is_ordered(tmp_path):
    _, said = on_return(tmp_path / "a", BETWEEN, STANDING)
    assert said == (
        "takes it out of west0, which breaks what the mission assumes: "
        "all vehicles are told to hold, and the mission commands nothing any more"
    )
    _, said = on_return(tmp_path / "b", BETWEEN, AT_HOME)
    assert said.endswith("that is reported, and the mission goes on")
    assert on_return(tmp_path / "c", (37.011, -8.652), STANDING)[1] is None
    assert on_return(tmp_path / "d", None, STANDING)[1] is None


def test_what_is_told_of_a_return_is_what_the_run_does(tmp_path):
    for folder, home in (("a", BETWEEN), ("b", (37.011, -8.652))):
        (tmp_path / folder).mkdir()
        with Tape(tmp_path / folder / "r.mcap", STANDING) as tape:
            tape.turn(0, uav(WEST, 0))
            tape.recorder.report(Status("uav0", 1001.0, "autopilot", home=home), 1001.0)
            said = tape.card()["on_return"]
            tape.turn(2, sayings=[Ordering(Fallback.RETURN, "uav0", "Ana")])
            tape.turn(9, uav(home, 9))
            assert tape.run.state.overrides.suspended == (said is not None)
            assert tape.card()["on_return"] is None or not tape.run.state.overrides.suspended


def test_a_vehicle_in_flight_leaves_no_place_when_it_is_sent_home(tmp_path):
    text = FLIGHT.replace("on broken assumption: continue", "on broken assumption: hold")
    assert on_return(tmp_path / "a", (37.05, -8.63), text, uav(BETWEEN, 2))[1] is None
