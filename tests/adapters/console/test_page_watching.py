"""What the page tells who watches a run: stories of operators, with a server that shows what a test says."""

import re
import time

from browsers import PHONE
from page_driving import HOLD, SAY
from page_harness import TOKEN, alert, card, deed, world

UAV0 = ".card[data-name=uav0]"
STOPPED = "all vehicles were commanded to hold; the mission sends no more commands"


# --- a card


def flight(**more):
    """Return an order to fly that a vehicle has accepted."""
    order = {"command": "GoTo", "to": "searchArea0", "way": [[37.0, -8.7]], "since": time.time() - 60}
    return order | {"state": "accepted", "why": ""} | more


def test_a_card_tells_of_a_flight_in_an_operators_words(operates):
    ana = operates()
    reads_no_calculus(ana)
    reads_that_a_request_stands_back_while_its_vehicle_is_held_or_given_up(ana)
    reads_of_one_that_is_not_armed_for_its_flight(ana)
    reads_how_far_it_is_to_the_edge_of_a_place(ana)
    reads_of_a_vehicle_on_its_way_home(ana)
    reads_that_a_boat_sails(ana)
    reads_of_a_flight_that_another_station_ordered(ana)
    reads_how_long_a_timed_flight_takes(ana)


def reads_no_calculus(ana):
    ana.opens("uav0")
    ana.sees(f"{UAV0} .request", "flies to spillArea")
    ana.sees(UAV0, "flies to spillArea, accepted")
    ana.sees(f"{UAV0} .request", "then it returns home")
    assert re.findall(r"FLY|CTR|MOVE_HOST|GoTo|control:|≠", " ".join(ana.texts(".cards"))) == []
    ana.opens("uav10")
    ana.sees(".card[data-name=uav10] .place", "believed in spillArea, really in searchArea0")
    ana.opens("uav0")


def reads_that_a_request_stands_back_while_its_vehicle_is_held_or_given_up(ana):
    flies = ana.harness.state["vehicles"]["uav0"]
    held = flight(command="Hold", to="", way=[], state="arrived")
    on_its_way = {"taken": "held by Ana", "order": held, "differs": True, "going": "spillArea"}
    ana.told(vehicles={"uav0": flies | on_its_way})
    ana.sees(f"{UAV0} .request", "not now: flies to spillArea")
    ana.sees_no(UAV0, "then it returns")
    ana.sees(f"{UAV0} .place:not(.differs)", "left searchArea0, has not arrived anywhere")
    ana.told(vehicles={"uav0": flies | {"request": flies["request"] | {"given_up": True}}})
    ana.sees(f"{UAV0} .request", "given up: flies to spillArea")
    ana.sees_no(f"{UAV0} .bar")


def reads_of_one_that_is_not_armed_for_its_flight(ana):
    sent = {"order": flight(state="sent"), "differs": True, "going": "searchArea0"}
    ana.told(vehicles={"uav0": card(**sent, armed=False)})
    ana.sees(f"{UAV0} .place", "searchArea0 → has not set out to searchArea0")
    ana.told(vehicles={"uav0": card(**sent)})
    ana.sees(f"{UAV0} .place", "searchArea0 → under way to searchArea0")


def reads_how_far_it_is_to_the_edge_of_a_place(ana):
    ring = [[36.9, -8.8], [36.9, -8.6], [37.1, -8.6], [37.1, -8.8]]
    place = ana.harness.state["places"]["searchArea0"] | {"ring": ring}
    far = ana.harness.state["entities"]["uav0"] | {"at": [37.0, -8.9], "speed": 20.0}
    ana.told(vehicles={"uav0": card(order=flight())}, places={"searchArea0": place}, entities={"uav0": far})
    ana.sees(f"{UAV0} dd", "4.81 nm to the edge of searchArea0, 7 min 25 s or more")
    ana.told(entities={"uav0": far | {"at": [37.0, -8.7]}})
    ana.sees(f"{UAV0} dd", "in searchArea0")


def reads_of_a_vehicle_on_its_way_home(ana):
    home = card(order=flight(), returning=True, home=[37.09, -8.81], mode="RTL", taken="RTL by itself")
    at = ana.harness.state["entities"]["uav0"] | {"at": [37.0, -8.72], "speed": 20.0}
    ana.told(vehicles={"uav0": home}, entities={"uav0": at})
    ana.sees(f"{UAV0} .place", "→ flies home")
    ana.sees(f"{UAV0} dd", "6.91 nm home, 10 min 40 s or more")
    ana.sees(f"{UAV0} dd", "not now, it flies home")


def reads_that_a_boat_sails(ana):
    sails = card(kind="USV", order=flight(to="spillArea"))
    ana.told(vehicles={"boat0": sails})
    ana.opens("boat0")
    ana.sees(".card[data-name=boat0]", "sails to spillArea, accepted")
    ana.told(vehicles={"boat0": sails | {"returning": True}})
    ana.sees(".card[data-name=boat0] .place", "→ sails home")
    assert "flies" not in ana.page.locator(".card[data-name=boat0]").inner_text()
    ana.opens("uav0")


def reads_of_a_flight_that_another_station_ordered(ana):
    flies = card(believed="west0", actual="region", differs=True, going="east0", authority=["faro"])
    ana.told(vehicles={"uav0": flies})
    ana.sees(f"{UAV0} .place:not(.differs)", "west0 → under way to east0")
    ana.told(vehicles={"uav0": flies | {"going": None}})
    ana.sees(f"{UAV0} .place.differs", "believed in west0, really outside all named places")


def reads_how_long_a_timed_flight_takes(ana):
    begin = ana.harness.state["clock"]["begin"]
    timed = {"to": "east0", "since": begin, "least": 71.0, "most": 255.0}
    ana.told(vehicles={"uav0": card(order=flight(), flight=timed)})
    for seconds, said in [
        (30.5, "for 30 s, 40 s to 3 min 44 s to go"),
        (100.5, "for 1 min 40 s, at most 2 min 34 s to go"),
        (265.5, "for 4 min 25 s, 10 s longer than it may take"),
    ]:
        ana.told(clock={"live": False, "now": begin + seconds})
        ana.sees(f"{UAV0} dd", said)
    ana.sees(f"{UAV0} dd .bad", "longer than it may take")
    ana.told(vehicles={"uav0": card(order=flight(), flight=timed | {"most": None})})
    ana.sees(f"{UAV0} dd", "for 4 min 25 s, it may take any time")
    ana.told(vehicles={"uav0": card(order=flight(), flight=timed, taken="held by Ana")})
    ana.sees_no(f"{UAV0} dt", "Flight")


def test_a_card_tells_what_its_vehicle_told_and_how_it_is(operates):
    ana = operates()
    reads_what_was_last_heard_of_one_whose_link_is_lost(ana)
    reads_of_a_change_of_authority_and_hears_it_announced(ana)
    reads_only_what_was_told_and_dimmed_what_is_old(ana)
    reads_what_a_return_ends_before_pressing_it(ana)
    reads_how_each_vehicle_is_and_not_only_how_bad_that_is(ana)
    ana.told(clock={"rate": 10})
    ana.sees(".top .simulated", "simulated 10×")
    reads_at_which_step_the_picture_was_drawn(ana)


def reads_what_was_last_heard_of_one_whose_link_is_lost(ana):
    ana.opens("uav1")
    ana.sees(".card[data-name=uav1] dd", "when last heard: RTL · armed · heading 092°")
    ana.told(entities={"uav1": ana.harness.state["entities"]["uav1"]})
    ana.sees(".card[data-name=uav1] dd", "when last heard: 10.1 kn · 119 m above home")


def reads_of_a_change_of_authority_and_hears_it_announced(ana):
    handed = {"time": time.time(), "from": ["porto"], "to": ["gcs1"]}
    order = flight(command="HandOver", to="control:gcs1", way=[], state="arrived")
    ana.opens("uav0")
    ana.told(vehicles={"uav0": card(authority=["gcs1"], handed=handed, order=order)})
    ana.sees(f"{UAV0} .changed", "was porto")
    ana.sees(UAV0, "handed to gcs1, done")
    ana.waits(3_000)
    ana.sees("[aria-live=polite]", "uav0 is under gcs1 now, before porto")


def reads_only_what_was_told_and_dimmed_what_is_old(ana):
    silent = {"mode": None, "armed": None, "heading": None, "authority": [], "battery": None}
    ana.told(vehicles={"uav0": card(**silent)})
    assert ana.texts(f"{UAV0} dt") == ["Place", "Request", "Motion"]
    assert ana.count(f"{UAV0} .battery") == 0
    ana.told(vehicles={"uav0": card(said={"text": "Takeoff", "time": time.time() - 600, "severity": 6})})
    ana.sees(f"{UAV0} .said.quiet", "10 min")


ENDS = "breaks an assumption of the mission: all vehicles are commanded to hold"


def reads_what_a_return_ends_before_pressing_it(ana):
    ana.told(vehicles={"uav0": card(on_return=ENDS)})
    told, button = ana.page.locator(f"{UAV0} .on-return"), f"{UAV0} [aria-label^='Return uav0']"
    assert ENDS in told.inner_text()
    assert not told.evaluate("e => e.scrollHeight > e.clientHeight + 1")
    assert ENDS in ana.page.locator(button).get_attribute("aria-label")
    ana.taps(button, says="Not sent: keep Return uav0 pressed for one second.")
    assert ana.asked() == []


def reads_how_each_vehicle_is_and_not_only_how_bad_that_is(ana):
    words = ["lost", "taken over", "broken", "unknown"]
    names = ["uav0", "uav1", "uav10", "boat0"]
    cards = {name: card(3, word=word, why="because") for name, word in zip(names, words, strict=True)}
    ana.told(vehicles=cards)
    assert sorted(ana.texts(".row .level")) == sorted(words)
    assert sorted(each[2:] for each in ana.texts(".tally")) == sorted(f"1 {each}" for each in words)
    ana.sees("[data-row=boat0] .link", "last heard")


def reads_at_which_step_the_picture_was_drawn(ana):
    ana.presses("2")
    ana.harness.change(bigraph={"drawn": 40})
    later = "after step 40; the moment shown is after step 42, which is not drawn yet"
    ana.sees(".bigraph .tools", later)
    ana.clicks("button", "Text")
    ana.sees(".bigraph .tools", "after step 42")
    ana.sees_no(".bigraph .tools", "step 40")
    ana.clicks("button", "Text")
    ana.harness.change(bigraph={"drawn": 42})
    ana.page.get_by_text("the logical model, after step 42", exact=True).wait_for()


# --- what is wrong


def test_an_alarm_stands_in_the_red_line_until_somebody_has_acknowledged_it(operates):
    ana = operates(world() | {"alerts": {}})
    sees_nothing_move_when_one_comes_and_goes(ana)
    is_told_whom_the_mission_waits_for(ana)
    acknowledges_the_newest_by_its_keys(ana)
    does_not_acknowledge_one_that_has_just_taken_its_place(ana)
    reads_the_cause_first_and_what_the_run_did_of_itself(ana)
    reads_it_also_beside_the_past(ana)


def acknowledged(alert):
    return alert | {"acknowledged": {"by": "Ana", "time": time.time()}}


def sees_nothing_move_when_one_comes_and_goes(ana):
    lost = world()["alerts"]["2"]
    ana.sees(".alerts", "to be watched")
    before = ana.box("main")
    ana.told(alerts={"1": lost})
    ana.sees(".alert", "nothing was heard")
    assert ana.box("main") == before
    ana.told(alerts={"1": acknowledged(lost)})
    ana.sees(".alerts", "to be watched")
    assert ana.box("main") == before
    ana.clicks(".others")
    ana.sees(".alert-list", "acknowledged by Ana")
    ana.presses("Escape")
    ana.sees_no(".alert-list")


def is_told_whom_the_mission_waits_for(ana):
    ana.sees(".verdict.doubted summary", "1 on a broken assumption")
    key, saying = next(iter(ana.harness.state["sayings"].items()))
    ana.told(sayings={key: saying | {"awaited": True}})
    ana.sees(".calm.asked", "tower waits for somebody to say “handover”")


def acknowledges_the_newest_by_its_keys(ana):
    ana.told(alerts={"1": None} | {f"1{key}": each for key, each in world()["alerts"].items()})
    ana.sees(".alert", "nothing was heard for 31 s")
    ana.presses("a", "Enter")
    assert ana.asked() == [{"acknowledge": {"alert": "12"}}]
    ana.told(alerts={"12": acknowledged(ana.harness.state["alerts"]["12"])})
    ana.sees(".alert", "the move to spillArea")


WATCHES_BUTTON = """() => {
  window.couldBePressed = {};
  const note = () => {
    const button = document.querySelector(".acknowledge");
    const text = document.querySelector(".alert .message")?.textContent ?? "";
    window.couldBePressed[text] ??= button !== null && !button.disabled;
  };
  const whatever = { childList: true, subtree: true, characterData: true };
  new MutationObserver(note).observe(document.querySelector(".alerts"), whatever);
}"""


def does_not_acknowledge_one_that_has_just_taken_its_place(ana):
    ana.waits(1_000)
    ana.sees(".acknowledge:enabled")
    ana.page.evaluate(WATCHES_BUTTON)
    newer = ana.harness.state["alerts"]["12"] | {"time": time.time() + 60, "message": "the newer one"}
    ana.told(alerts={"19": newer | {"acknowledged": None}})
    ana.sees(".alert .message", "the newer one")
    could = ana.page.evaluate("couldBePressed")
    assert [each for text, each in could.items() if "newer" in text] == [False]
    ana.waits(1_000)
    ana.clicks(".acknowledge:enabled")
    assert ana.asked() == [{"acknowledge": {"alert": "19"}}]


def reads_the_cause_first_and_what_the_run_did_of_itself(ana):
    now = time.time()
    broken = alert(now, "broken assumption", "uav1", "uav1 is not on control:gcs0 any more", "return")
    lost = alert(now, "lost link", "uav1", "nothing was heard of uav1", "")
    ana.told(alerts=dict.fromkeys(ana.harness.state["alerts"]) | {"31": broken, "32": lost})
    ana.sees(".alert .message", "nothing was heard of uav1")
    ana.told(alerts={"31": broken | {"time": now + 20}})
    ana.told(alerts={"33": alert(now + 10, "late", "uav10", "the move is late", "")})
    ana.sees(".alert .message", "nothing was heard of uav1")
    ana.sees_that("document.title.startsWith('(3) uav1: lost link')")
    ana.told(alerts={"31": broken | {"time": now + 60}})
    ana.sees(".alert .message", "is not on control:gcs0 any more")
    ana.told(alerts={"31": broken, "33": None})
    ana.told(alerts={"32": acknowledged(lost)})
    ana.sees(".alert .message", "control:gcs0 any more → all vehicles were commanded to return home")


def reads_it_also_beside_the_past(ana):
    ana.told(alerts=dict.fromkeys(ana.harness.state["alerts"]))
    ana.presses("b")
    ana.sees(".badge.past", "PAST")
    ana.told(alarms={"7": world()["alerts"]["2"] | {"consequence": STOPPED}})
    ana.sees(".alert.standing .now-mark", "NOW")
    ana.sees(".alert .message", "nothing was heard for 31 s")
    ana.sees(".alert .consequence", STOPPED)
    assert ana.count(".acknowledge") == 0
    ana.clicks(".alert-tools .now")
    ana.clicks(".acknowledge:enabled")
    assert ana.asked()[1:] == [{"type": "live"}, {"acknowledge": {"alert": "7"}}]


def fallen():
    """Return a world whose mission has fallen back."""
    state = world()
    broken = alert(time.time() - 5, "broken assumption", "uav1", "uav1 is in none of the places", "hold")
    state["alerts"] = {"1": broken}
    state["alarms"] = {"1": broken | {"consequence": STOPPED}}
    state["mission"]["fallen_back"] = STOPPED
    why = "the mission has fallen back and sends no more commands: messages move no vehicle"
    state["sayings"] = {key: each | {"vain": why} for key, each in state["sayings"].items()}
    return state


def test_after_a_fallback_the_page_says_so_and_offers_no_word_as_if_it_did_something(operates):
    ana = operates(fallen())
    for each in (ana, operates(ana.harness, size=PHONE, has_touch=True, name="Bo")):
        reads_the_whole_consequence_in_the_red_line(each)
    is_offered_no_word_to_the_mission_but_orders_to_vehicles(ana)
    reads_it_when_every_alarm_is_acknowledged(ana)
    is_offered_words_to_an_agent_that_commands_nothing_with_that_said(ana)


def reads_the_whole_consequence_in_the_red_line(ana):
    consequence = ana.page.locator(".alert .consequence")
    assert STOPPED in consequence.inner_text()
    cut = "e => e.scrollHeight > e.clientHeight + 1 || e.scrollWidth > e.clientWidth + 1"
    assert not consequence.evaluate(cut)
    line, text = ana.box(".alerts"), consequence.bounding_box()
    assert text["y"] >= line["y"]
    assert text["y"] + text["height"] <= line["y"] + line["height"]


def is_offered_no_word_to_the_mission_but_orders_to_vehicles(ana):
    ana.sees(".sayings button:disabled")
    assert ana.count(".sayings button:enabled") == 0
    ana.sees(".actions", "Messages to its agents move no vehicle.")
    ana.opens("uav0")
    assert ana.page.locator(HOLD).is_enabled()
    vain = ana.harness.state["sayings"]['tower "handover"']["vain"]
    ana.told(actions={"9": deed(time.time(), "Ana", 'say "handover"', "tower") | {"vain": vain}})
    ana.sees(".fates li", "heard, but the mission has fallen back")
    assert "done" not in ana.texts(".fates li")[0]


def reads_it_when_every_alarm_is_acknowledged(ana):
    ana.told(alerts={"1": None}, alarms={"1": None})
    ana.sees(".calm", f"The mission has fallen back: {STOPPED}.")


def is_offered_words_to_an_agent_that_commands_nothing_with_that_said(ana):
    vain = "the mission has fallen back: no command of tower is carried out any more"
    saying = ana.harness.state["sayings"]['tower "handover"'] | {"vain": vain}
    ana.told(sayings={'tower "handover"': saying}, mission={"fallen_back": None})
    ana.sees(".sayings button:enabled", vain)
    ana.holds(SAY)
    assert ana.asked() == [{"say": {"agent": "tower", "message": "handover"}}]
    ana.told(sayings={'tower "handover"': saying | {"left": 0}})
    assert ana.count(".sayings button:enabled") == 0


# --- the connection


def test_what_is_shown_is_said_to_be_old_while_nothing_is_heard_and_comes_back_by_itself(operates):
    ana = operates()
    reads_that_the_recording_is_not_read_any_further_and_orders_on(ana)
    loses_the_server_and_finds_it_again_with_what_was_typed(ana)
    misses_a_frame_and_gets_all_of_it(ana)
    sees_what_was_shown_when_another_console_takes_the_address(ana)
    mends_a_token_that_is_refused(ana)


def reads_that_the_recording_is_not_read_any_further_and_orders_on(ana):
    ana.sees(".badge.live", "LIVE")
    ana.sees("[data-row=boat0] .level", "well")
    ana.told(clock={"unread": "it has become shorter than it was"})
    ana.sees(".badge.past", "OLD")
    ana.sees(".offline", "the recording cannot be read any further (it has become shorter than it was)")
    ana.sees("[data-row=boat0] .level", "unknown")
    ana.sees("[data-row=boat0] .link", "last heard")
    ana.opens("uav0")
    ana.holds(HOLD)
    assert ana.asked() == [{"order": {"order": "hold", "vehicle": "uav0"}}]
    ana.told(clock={"unread": None})
    ana.sees_no(".offline")
    ana.sees("[data-row=boat0] .level", "well")


def loses_the_server_and_finds_it_again_with_what_was_typed(ana):
    known = ana.writes("#goto", "lara", 2)
    ana.harness.stop_serving()
    ana.sees(".offline", "this view is of")
    ana.sees(".tally", "4 unknown")
    assert ana.count(".held:enabled") == 0
    ana.harness.state["vehicles"]["new0"] = card()
    ana.harness.serve_again()
    ana.sees(".fleet", "new0")
    ana.sees_no(".offline")
    ana.told(mission={"station": "coast0"}, clock={"live": False, "playing": False})
    ana.sees(".badge.past", "PAST")
    assert ana.caret() == known
    ana.told(clock={"live": True})


def misses_a_frame_and_gets_all_of_it(ana):
    for socket in ana.harness.sockets:
        ana.harness.sockets[socket] += 1
    ana.harness.state["vehicles"]["lost0"] = card()
    before = len(ana.harness.hellos)
    ana.harness.change(vehicles={"late0": card()})
    ana.sees(".fleet", "late0")
    ana.sees(".fleet", "lost0")
    assert len(ana.harness.hellos) == before + 1


def sees_what_was_shown_when_another_console_takes_the_address(ana):
    ana.harness.token = "another"
    ana.harness.hang_up()
    ana.sees(".offline", "another console is at this address now")
    assert ana.count(".fleet") > 0
    assert ana.count(".held:enabled") == 0


def mends_a_token_that_is_refused(ana):
    ana.page.goto("about:blank")
    ana.page.goto(ana.harness.link + "x")
    ana.sees(".offline", "the token is not accepted")
    assert ana.count(".fleet, .timeline, .top, [role=tab]") == 0
    ana.harness.token = TOKEN
    known = ana.writes("#token", "a-tokem", 7)
    ana.presses("Enter")
    ana.sees_that("hungUp === 2")
    ana.sees(".offline", "the token is not accepted")
    assert ana.caret() == known
    ana.presses("Backspace", "n", "Enter")
    ana.sees(".fleet", "uav0")
