"""The vehicles' cards: what they say, how much each vehicle needs an operator, and why."""

import pytest
from live_missions import boat
from recorded import BETWEEN, EAST, FLIGHT, WEST, Tape, told, uav

from adapters.live.batch import GivingBack, Ordering
from adapters.live.timing_monitor import flying
from adapters.plugin import GoTo, LinkLost, LinkRestored, Rejected, Status, StatusText, TakenOver
from semantics.live_policy import Fallback


def so(card):
    return card["level"], card["word"], card["why"]


def says(card, **members):
    return card.items() >= members.items()


# --- what the run's own steps make of it


def test_a_vehicle_that_does_what_it_was_told_is_well(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(3, uav(BETWEEN, 3), sayings=[("op", "status")])
    asked = {"text": "FLY(a, MOVE_HOST_TO east0)", "agent": "a", "since": 1000.0, "limit": 100.0}
    order = {"command": "GoTo", "to": "east0", "way": ((37.0099997, -8.61),), "since": 1000.0}
    assert so(tape.card()) == (0, "well", "")
    assert says(
        tape.card(),
        believed="west0",
        actual="region",
        differs=True,
        request=asked | {"fallback": "continue", "given_up": False},
        order=order | {"state": "accepted", "why": ""},
        link={"heard": 1003.0, "lost": False},
        authority=["gcs0"],
    )


def test_a_vehicle_of_which_nothing_is_asked_says_for_whom_it_waits(tape):
    def tells(now):
        status = Status("uav0", now, "autopilot", now, "GUIDED", armed=True, home=(37.01, -8.65))
        tape.recorder.report(status, now)

    tape.turn(0, uav(WEST, 0))
    tells(1000.5)
    assert says(tape.card(), level=0, why="", home=(37.01, -8.65), returning=False)
    tape.turn(60, uav(EAST, 60))
    tells(1060.5)
    assert says(tape.card(), level=0, why='it has no request: op waits for "handover"')


def test_a_vehicle_that_is_not_armed_for_its_flight_is_watched_and_its_own_words_say_why(tape):
    tape.run.willing = False
    tape.turn(0, uav(WEST, 0))
    tape.recorder.report(Status("uav0", 1001.0, "autopilot", 1001.0, "STABILIZE", armed=False), 1001.0)
    tape.turn(14, uav(WEST, 14))
    assert so(tape.card()) == (0, "well", "")
    tape.recorder.report(StatusText("uav0", 1015.0, "PreArm: no compass", 2), 1015.0)
    tape.turn(16, uav(WEST, 16))
    assert so(tape.card()) == (1, "watch", "it has not set out to east0: PreArm: no compass")
    tape.recorder.report(Status("uav0", 1017.0, "autopilot", 1017.0, "GUIDED", armed=True), 1017.0)
    assert so(tape.card()) == (0, "well", "")


def test_before_the_start_a_vehicle_that_refuses_to_arm_is_watched(tape):
    item = {"what": "uav0 is heard", "done": True, "detail": "", "vehicle": "uav0", "fence": None}
    tape.turn(0, uav(WEST, 0))
    for state, card in (
        ("ready", (1, "watch", "it refuses to arm: PreArm: no compass")),
        ("begun", (0, "well", "")),
    ):
        tape.recorder.preflight(
            {"state": state, "by": "", "items": [item | {"refuses": ["PreArm: no compass"]}]}, 1000.5
        )
        assert so(tape.card()) == card


def test_who_pressed_start_is_among_what_was_done_once(tape):
    tape.turn(0, uav(WEST, 0))
    for state, by in (("ready", ""), ("begun", "Ana"), ("begun", "Ana")):
        tape.recorder.preflight({"state": state, "by": by, "items": []}, 1000.5)
    assert [(each["what"], each["by"], each["state"]) for each in tape.actions()] == [
        ("start", "Ana", "confirmed")
    ]


def test_a_vehicle_with_nothing_to_do_says_first_for_whom_its_own_bigactor_waits(tmp_path):
    text = FLIGHT.replace("BigActor a hosted_at uav0", "BigActor z hosted_at uav0")
    text = text.replace("FLY a", "FLY z").replace('send "there" to op', 'react { case "on" => skip }')
    with Tape(tmp_path / "r.mcap", text) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(60, uav(EAST, 60))
        tape.recorder.report(Status("uav0", 1060.5, "autopilot", 1060.5, "GUIDED", armed=True), 1060.5)
        assert so(tape.card()) == (0, "well", 'it has no request: z waits for "on"')


def test_a_vehicle_that_obeys_another_station_has_no_reason_from_the_bigactors_of_this_one(tmp_path):
    with Tape(
        tmp_path / "r.mcap", station={"here": "gcs0", "hosts": {"gcs0": "gcs0", "gcs1": "gcs1"}}
    ) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(60, uav(EAST, 60))
        status = Status("uav0", 1061.0, "autopilot", 1061.0, "GUIDED", armed=True, authority=("gcs1",))
        tape.recorder.report(status, 1061.0)
        assert so(tape.card()) == (0, "well", "")


def test_a_request_that_cannot_be_served_is_wrong(tmp_path):
    text = FLIGHT.replace(
        "  observe(CHILDREN(east0))", '  react { case "on" => control(MOVE_HOST_TO west0) }\n  observe(ALL)'
    )
    with Tape(tmp_path / "r.mcap", text.replace("environment {", 'environment {\n  says "on" to a')) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(60, uav(EAST, 60))
        tape.turn(61, uav(BETWEEN, 61))
        tape.turn(62, sayings=[("a", "on")])
        where = "uav0 is believed in east0 and is in none of the places"
        blocked = f"CTR(a, MOVE_HOST_TO west0) is inconsistent: {where}; it stays pending"
        assert blocked in [alert["message"] for alert in tape.shown()["alarms"].values()]
        assert f"its request is inconsistent: {where}; it stays pending" in tape.card()["why"]


def test_a_request_is_blocked_only_while_l_and_p_block_it(tmp_path):
    text = FLIGHT.replace(
        "  observe(CHILDREN(east0))", '  react { case "on" => control(MOVE_HOST_TO west0) }\n  observe(ALL)'
    )
    with Tape(tmp_path / "r.mcap", text.replace("environment {", 'environment {\n  says "on" to a')) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(60, uav(EAST, 60))
        tape.turn(61, uav(BETWEEN, 61))
        tape.turn(62, sayings=[("a", "on")])
        tape.turn(63, uav(BETWEEN, 63), reports=[TakenOver("uav0", 1063.0, "a pilot flies it")])
        assert "its request is inconsistent" in tape.card()["why"]
        tape.turn(64, uav(EAST, 64))
        card = tape.card()
        assert card["request"]["text"] == "CTR(a, MOVE_HOST_TO west0)"
        assert "inconsistent" not in card["why"]
        assert [each["kind"] for each in tape.shown()["alarms"].values()].count("blocked") == 1
        assert "its request is inconsistent" in tape.card(63)["why"]


def test_a_vehicle_in_the_air_that_no_bigactor_will_ask_for_anything_again_is_watched(tmp_path):
    text = FLIGHT.replace('  react { case "handover" => skip }\n  control(HAND uav0 TO gcs1)\n', "")
    with Tape(tmp_path / "r.mcap", text) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(60, uav(EAST, 60))
        tape.recorder.report(Status("uav0", 1060.5, "autopilot", 1060.5, "GUIDED", armed=True), 1060.5)
        over = "it will get no more requests: every bigActor of the mission has ended"
        assert so(tape.card()) == (1, "watch", over)


def test_the_card_of_an_ended_run_tells_the_last_known_state_and_nothing_that_would_come(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(3, uav(BETWEEN, 3))
    tape.end(70)
    assert so(tape.card()) == (0, "ended", "")
    assert says(tape.card(), link={"heard": 1003.0, "lost": False, "over": True}, believed="west0")
    assert says(tape.card(2), link={"heard": 1000.0, "lost": False}, level=0, word="well")


def test_the_card_of_an_ended_run_keeps_what_went_wrong(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(9, reports=[LinkLost("uav0", 1009.0, 1002.0)])
    tape.end(10)
    assert says(tape.card(), level=3, word="lost")
    assert tape.card()["why"].startswith("the link was lost; broken assumption: ")


def test_arrival_is_what_the_rules_say_it_is_and_where_l_and_p_differ_after_it_is_wrong(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(EAST, 1))
    assert tape.card(0.5)["order"]["state"] == "sent"
    assert tape.card()["order"]["state"] == "arrived"
    assert says(tape.card(), believed="east0", actual="east0", differs=False)
    tape.turn(2, uav(BETWEEN, 2))
    assert says(tape.card(), believed="east0", actual="region", level=3, word="broken")
    reasons = tape.card()["why"].split("; ")
    assert reasons[0].startswith("broken assumption: uav0 ")
    assert reasons[-1] == "its believed and its actual position differ"


def test_a_request_is_watched_from_half_of_its_time_on_and_wrong_when_that_is_over(tape):
    for now in range(0, 121, 4):
        tape.turn(now, uav(WEST if now == 0 else BETWEEN, now))
    assert so(tape.card(50)) == (0, "well", "")
    assert so(tape.card(51)) == (1, "watch", "its request is pending for more than half of 100 s")
    assert so(tape.card(100)) == (2, "wrong", "its request is pending for longer than 100 s")
    (late,) = [each for each in tape.shown()["alerts"].values() if each["wrong"]]
    assert (late["kind"], late["about"]) == ("late", "a")


def test_a_vehicle_is_unknown_taken_over_silent_or_lost_by_what_is_so(tape):
    assert so(tape.card()) == (1, "unknown", "nothing was heard of it yet")
    tape.turn(0, uav(WEST, 0))
    assert so(tape.card()) == (0, "well", "")
    tape.turn(1, uav(WEST, 1), reports=[TakenOver("uav0", 1001.0, "a pilot flies it")])
    meanwhile = "; the time limit of its request, 100 s, still runs"
    assert so(tape.card()) == (3, "taken over", f"taken over: a pilot flies it{meanwhile}")
    assert tape.card()["taken"] == "a pilot flies it"
    tape.turn(2, sayings=[GivingBack("uav0")])
    tape.turn(3, boat(EAST, 1003.0), uav(WEST, 3))
    tape.turn(9, boat((37.04, -8.7), 1009.0), sayings=[("op", "status")])
    assert so(tape.card(7.9)) == (0, "well", "")
    assert so(tape.card(8.1)) == (1, "watch", "nothing was heard of it for more than 5 s")
    tape.turn(10, reports=[LinkLost("uav0", 1010.0, 1003.0)])
    assert says(tape.card(), level=3, word="lost", link={"heard": 1003.0, "lost": True})
    assert tape.card()["why"].startswith("the link is lost; ")
    tape.turn(11, uav(WEST, 11), reports=[LinkRestored("uav0", 1011.0)])
    assert tape.card()["link"] == {"heard": 1011.0, "lost": False}


def test_who_refuses_is_wrong_and_says_why(tape):
    tape.run.willing = False
    tape.turn(0, uav(WEST, 0))
    assert tape.card()["order"]["state"] == "sent"
    tape.turn(1, uav(WEST, 1), reports=[Rejected("a-1", "uav0", 1001.0, "it is not armed")])
    assert so(tape.card()) == (2, "wrong", "it refuses GoTo: it is not armed")
    assert tape.card()["order"]["why"] == "it is not armed"


def test_nothing_is_known_of_the_vehicles_of_a_run_that_was_killed(tape):
    tape.turn(0, uav(WEST, 0))
    tape.turn(1, uav(WEST, 1))
    history = tape.history()
    history.end("the run was killed")
    for view in (history.newest(), history.at(1001.0).forward(1001.0)):
        level, word, why = so(view.sections["vehicles"]["uav0"])
        assert (level, word) == (3, "unknown")
        assert why.startswith("nothing is known of it any more: the run was killed")
    before = history.at(1000.5).forward(1000.5).sections["vehicles"]["uav0"]
    assert so(before) == (0, "well", "")


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


# --- what vehicles and other parts of the project tell


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
    said = {"text": "Low battery", "time": 1002.5, "severity": 2}
    messages = ("status", 1002.0, STATUS), ("said", 1002.5, {"entity": "uav0", **said})
    card = told(tmp_path / "r", *messages)["vehicles"]["uav0"]
    members = ("mode", "armed", "battery", "heading", "authority", "height")
    assert says(card, said=said, **{each: STATUS[each] for each in members})
    assert so(card) == (2, "wrong", "its battery has less than 25 %")
    assert card["link"] == {"heard": 1002.0, "lost": False}


HEARD = {"plugin": "autopilot", "entity": "uav0", "kind": "UAV", "ring": [[370100000, -86500000]]}


def test_a_card_has_the_newest_altitude_and_the_last_change_of_authority(tmp_path):
    def card(name, *more):
        first = HEARD | {"altitude": [120.5, 120.5], "channels": ["control:gcs0", "wifi"]}
        return told(tmp_path / name, ("arrivals", 1002.0, first), *more)["vehicles"]["uav0"]

    later = ("arrivals", 1003.0, HEARD | {"channels": ["control:gcs1"], "altitude": [121.0, 121.0]})
    statuses = [(1004.0, STATUS), (1005.0, {**STATUS, "authority": []}), (1006.0, STATUS)]
    assert says(card("a"), altitude=120, height=None, authority=["gcs0"], handed=None)
    handed = {"time": 1003.0, "from": ["gcs0"], "to": ["gcs1"]}
    assert says(card("b", later), altitude=121.0, authority=["gcs1"], handed=handed)
    boat = ("status", 1003.0, STATUS | {"height": None, "surface": True})
    assert says(card("d", boat), altitude=None, height=None)
    unsure = card("c", *(("status", *each) for each in statuses), later)
    assert unsure["handed"] == handed | {"time": 1004.0}


def test_what_is_no_such_message_is_passed_over(tmp_path):
    topics = "arrivals steps commands reports orders status said stations given_back deadlines flights"
    odd = [None, [], 3, {}, {"entity": 3}, {"entity": "uav0", "ring": [["x", 1]]}, {"requests": []}]
    odd += [{"vehicle": "uav0", "takes": {"to": "x", "since": "noon", "least": 1, "most": []}}]
    odd += [{"agent": "op", "until": "noon"}, {"left_out": [], "notes": {}, "requests": {}, "order": "hold"}]
    odd += [{"command": "GoTo", "request": "x", "entity": "uav0", "ring": [[1, 2], [3]]}]
    view = told(tmp_path / "a", *((topic, 1002.0, data) for topic in topics.split() for data in odd))
    assert view["vehicles"]["uav0"]["level"] == 0
    assert view["entities"]["uav0"]["at"] == (37.01, -8.65)


def test_a_card_stays_as_it_is_while_its_vehicle_is_heard_ten_times_a_second(tmp_path):
    def card(count):
        arrivals = [("arrivals", 1002.0 + tenth / 10, flies(1002.0 + tenth / 10)) for tenth in range(count)]
        return told(tmp_path / f"{count}", *arrivals)["vehicles"]["uav0"]

    def flies(time):
        at = {"ring": [[370100000, -86500000 + round((time - 1002.0) * 1e3)]], "altitude": [time - 900.3] * 2}
        return HEARD | {"time": time, **at}

    first = card(1)
    assert first["link"] == {"heard": 1002, "lost": False}
    assert first == card(8)
    assert first != card(11)


def test_of_several_broken_assumptions_about_a_vehicle_its_card_says_the_newest(tmp_path):
    found = {"kind": "broken assumption", "about": "uav0", "fallback": ""}
    messages = [found | {"message": each} for each in ("it is in west0", "it is in east0", "it has vanished")]
    broken = [("findings", 1002.0 + n, each) for n, each in enumerate(messages)]
    card = told(tmp_path / "a", *broken)["vehicles"]["uav0"]
    assert so(card) == (3, "broken", "broken assumption: it has vanished (and 2 more)")


def test_a_run_that_goes_on_from_one_that_fell_back_is_not_stopped(tmp_path):
    before = {"kind": "broken assumption", "about": "boat0", "message": "it appears", "fallback": "hold"}
    assert told(tmp_path / "a", copied=[("findings", 999.0, before)])["vehicles"]["uav0"]["level"] == 0
    assert told(tmp_path / "b", ("findings", 1002.0, before))["vehicles"]["uav0"]["level"] == 2


# --- what the run gives up


GROUNDING = FLIGHT.replace("FLY a within 100 s: continue", "FLY a within 100 s: hold")


def test_while_a_vehicle_is_held_its_request_runs_out_and_its_agent_is_grounded(tmp_path):
    with Tape(tmp_path / "r.mcap", GROUNDING) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.turn(1, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
        stopped = "no command of a is carried out any more"
        assert tape.card()["request"]["fallback"] == "hold"
        assert tape.card()["why"].endswith(
            f"the time limit of its request, 100 s, still runs; then {stopped}"
        )
        tape.turn(101, uav(WEST, 101))
        assert tape.card()["why"] == (
            f"its request is pending for longer than 100 s; {stopped}; "
            "ordered to hold by the operator (Ana), not confirmed yet"
        )
        (late,) = [each for each in tape.shown()["alarms"].values() if each["kind"] == "late"]
        assert late["consequence"] == f"its vehicles were commanded to hold; {stopped}"
        tape.turn(102, sayings=[GivingBack("uav0")])
        assert tape.run.state.overrides.grounded == {"a"}
        assert not any(isinstance(each, GoTo) for each in tape.turn(103, uav(WEST, 103)).commands)
        assert tape.card()["request"]["given_up"]
        assert [each["notes"] for each in tape.actions() if each["what"] == "give back"] == [
            ["its task was given up: it is commanded to hold"]
        ]


FALLING_BACK = FLIGHT.replace("on broken assumption: continue", "on broken assumption: return")
STOPPED = "all vehicles were commanded to return home; the mission sends no more commands"


def test_after_a_fallback_the_cards_say_that_nothing_is_commanded_any_more(tmp_path):
    with Tape(tmp_path / "r.mcap", FALLING_BACK) as tape:
        tape.turn(0, uav(WEST, 0))
        assert not tape.card()["request"]["given_up"]
        tape.turn(1, uav(BETWEEN, 1), boat(EAST, 1001.0))
        assert tape.run.state.overrides.suspended
        assert says(tape.card(), level=2, why=STOPPED)
        assert tape.card()["request"]["given_up"]
        tape.turn(2, sayings=[Ordering(Fallback.HOLD, "uav0", "Ana")])
        assert tape.card()["why"] == f"{STOPPED}; ordered to hold by the operator (Ana), not confirmed yet"
        tape.turn(3, sayings=[GivingBack("uav0", by="Ana")])
        assert says(tape.card(), level=2, why=STOPPED)
        assert tape.card()["request"]["given_up"]


# --- what an order to return ends


STANDING = FLIGHT.replace("  control(MOVE_HOST_TO east0)\n", '  react { case "go" => skip }\n', 1)
BREAKS = "takes it out of west0, which breaks an assumption of the mission: "
ALL_HOLD = "all vehicles are commanded to hold, and the mission sends no more commands"
INSIDE = (37.011, -8.652)


@pytest.mark.parametrize(
    ("text", "home", "told"),
    [
        pytest.param("hold", BETWEEN, ALL_HOLD, id="it ends the mission"),
        pytest.param("continue", BETWEEN, "this is reported, and the mission goes on", id="it is reported"),
        pytest.param("hold", INSIDE, None, id="its home is within its place"),
        pytest.param("hold", None, None, id="its home is not known"),
    ],
)
def test_what_is_told_of_a_return_before_it_is_ordered_is_what_the_run_does(tmp_path, text, home, told):
    text = STANDING.replace("on broken assumption: continue", f"on broken assumption: {text}")
    with Tape(tmp_path / "r.mcap", text) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.recorder.report(Status("uav0", 1001.0, "autopilot", home=home), 1001.0)
        assert tape.card()["on_return"] == (told and f"{BREAKS}{told}")
        if home is not None:
            tape.turn(2, sayings=[Ordering(Fallback.RETURN, "uav0", "Ana")])
            tape.turn(9, uav(home, 9))
            assert tape.run.state.overrides.suspended == (told == ALL_HOLD)
            assert tape.card()["on_return"] is None or not tape.run.state.overrides.suspended


def test_a_vehicle_in_flight_leaves_no_place_when_it_is_sent_home(tmp_path):
    text = FLIGHT.replace("on broken assumption: continue", "on broken assumption: hold")
    with Tape(tmp_path / "r.mcap", text) as tape:
        tape.turn(0, uav(WEST, 0))
        tape.recorder.report(Status("uav0", 1001.0, "autopilot", home=(37.05, -8.63)), 1001.0)
        tape.turn(2, uav(BETWEEN, 2))
        assert tape.card()["on_return"] is None
