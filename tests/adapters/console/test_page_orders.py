"""Who acts on the page, and what is shown of it: stories of operators, with a server that shows what a test says."""

import time

from browsers import PHONE
from page_driving import HOLD, SAY, SECOND, by_finger, by_key, by_mouse
from page_harness import card, deed, world

SAID = {"say": {"agent": "tower", "message": "handover"}}
HELD = {"order": {"order": "hold", "vehicle": "uav0"}}


def test_an_order_is_offered_where_it_has_an_effect_and_says_beforehand_what_it_overrules(operates):
    ana = operates()
    ana.opens("uav0")
    ana.sees(f"{HOLD}:enabled")
    ana.told(vehicles={"uav0": card(authority=["faro"])})
    ana.sees(".card .orders", "obeys faro: order it there")
    assert ana.count(".card .held") == 0
    fails_safe = card(3, taken="it said 'Battery 1 is low'; it is in RTL", authority=["faro", "porto"])
    ana.told(vehicles={"uav0": fails_safe})
    ana.sees(".card .on-return", "Each order overrules the pilot or the fail-safe")
    ana.sees(f"{HOLD}:enabled")
    held = {"order": "hold", "by": "Ana", "since": time.time(), "state": "confirmed", "why": ""}
    ana.told(vehicles={"uav0": fails_safe | {"ordered": held}})
    ana.sees_no(".card .on-return")


# --- a name


def test_an_operator_is_asked_who_they_are_before_anything_is_done_in_their_name(operates):
    ana = operates(name="")
    gives_a_name_that_no_loss_of_the_server_takes_from_their_hand(ana)
    acts_under_it_and_is_asked_no_more(ana)
    writes_another_name_as_a_text_of_which_no_letter_is_a_shortcut(ana)
    sees_that_what_is_written_stays_whatever_is_told(ana)
    is_asked_again_without_a_name_and_what_became_past_meanwhile_is_not_sent(ana)
    does_nothing_and_writes_on_at_once_elsewhere(ana)
    sends_it_under_the_name_that_is_given(ana)


def loses_the_server_and_finds_it_again(ana):
    ana.harness.stop_serving()
    ana.sees(".offline", "Not connected")
    ana.harness.serve_again()
    ana.sees_no(".offline")


def gives_a_name_that_no_loss_of_the_server_takes_from_their_hand(ana):
    known = ana.writes("#who-name", "lara", 2)
    loses_the_server_and_finds_it_again(ana)
    ana.told(mission={"station": "coast0"})
    assert ana.caret() == known
    ana.sees(".who-asks .do", "Act as lara")
    ana.presses("Enter")
    ana.sees(".actions", "You act as")
    ana.sees_that("document.getElementById('who')?.value === 'lara'")
    ana.sees_no("dialog[open]")


def acts_under_it_and_is_asked_no_more(ana):
    ana.taps(SAY, says="Not sent: keep say “handover” to tower pressed for one second.")
    ana.holds(SAY)
    ana.sees(".notice.confirmed", 'say "handover" tower: done')
    assert ana.asked() == [SAID]


def writes_another_name_as_a_text_of_which_no_letter_is_a_shortcut(ana):
    ana.page.locator("#who").fill("")
    ana.presses(*"la")
    ana.told(mission={"station": "coast1"})
    ana.sees(".who", "for station coast1")
    ana.presses(*"ra", "Space", *"t[")
    assert (ana.focused("e => e.value"), ana.asked()) == ("lara t[", [])
    ana.presses("Tab")
    ana.sees_that("localStorage['bigactors.name'] === 'lara t['")


def sees_that_what_is_written_stays_whatever_is_told(ana, field="#who"):
    """Take in everything anew, the past, the end, and a lost connection."""
    known = ana.writes(field, "lara", 2)
    state = ana.harness.state
    ana.told(**{section: dict(state[section]) for section in ("vehicles", "sayings", "actions", "agents")})
    ana.told(mission={"station": "coast0"}, clock={"live": False, "playing": False})
    ana.sees(".badge.past", "PAST")
    ana.told(clock={"live": True, "ended": "the mission is complete"})
    ana.sees(".badge.ended", "ENDED")
    assert ana.caret() == known
    ana.told(clock={"ended": None})
    loses_the_server_and_finds_it_again(ana)
    assert ana.caret() == known


def is_asked_again_without_a_name_and_what_became_past_meanwhile_is_not_sent(ana):
    ana.page.locator("#who").fill("")
    ana.presses("Tab")
    ana.holds(SAY)
    assert ana.focused("e => e.id") == "who-name"
    ana.clicks(".who-asks h2")  # as a thumb that misses the field
    ana.presses("b")
    ana.page.locator("#who-name").fill("Rui")
    ana.told(clock={"live": False, "now": ana.harness.state["clock"]["begin"]})
    ana.sees(".badge.past", "PAST")
    ana.clicks(".who-asks .do")
    ana.sees(".notice", "Not sent")
    assert ana.asked() == []


PRESSES_AND_GOES_ON = """async () => {
  [...document.querySelectorAll("button")].find((each) => each.textContent.trim() === "Do nothing").click();
  await new Promise((done) => setTimeout(done));
  document.querySelector("#who").focus();
  return document.activeElement.id;
}"""
"""Presses a button, and goes to a field in the next task: sooner than a frame is drawn on a quiet machine."""


def does_nothing_and_writes_on_at_once_elsewhere(ana):
    ana.told(clock={"live": True})
    ana.holds(SAY)
    assert ana.page.evaluate(PRESSES_AND_GOES_ON) == "who"
    ana.sees(".notice", "Nothing was sent.")
    assert ana.asked() == []


def sends_it_under_the_name_that_is_given(ana):
    ana.holds(SAY)
    ana.page.locator("#who-name").fill("Rui")
    ana.page.get_by_role("button", name='say "handover" tower as Rui').click()
    ana.sees(".fates li", 'say "handover" tower · Rui')
    assert ana.texts(".fates .state")[0] == "done"  # only a vehicle confirms
    assert [each["name"] for each in ana.harness.hellos][-2:] == ["", "Rui"]
    assert ana.asked() == [SAID]


# --- a press, and what becomes of its order


def test_only_a_long_press_orders_by_mouse_key_and_finger(operates):
    ana = operates(has_touch=True)
    ana.opens("uav0")
    for press in (by_mouse, by_key, by_finger):
        presses_shortly_and_is_told_to_press_longer(ana, press)
        presses_for_a_second_and_orders_once(ana, press)
    leaves_the_button_and_orders_nothing(ana)
    orders_all_and_gives_one_back(ana)
    is_refused_and_reads_why(ana)


def presses_shortly_and_is_told_to_press_longer(ana, press):
    ana.taps(HOLD, press, says="Not sent: keep Hold uav0 pressed for one second")
    assert ana.asked() == []
    ana.closes_notices()


def presses_for_a_second_and_orders_once(ana, press):
    ana.holds(HOLD, press)
    ana.sees(".notice.sent", "hold uav0: sent, not confirmed yet")
    assert ana.asked() == [HELD]
    ana.closes_notices()


def leaves_the_button_and_orders_nothing(ana):
    with by_mouse(ana.page, HOLD):
        ana.page.mouse.move(10, 10)
        ana.waits(SECOND)
    assert ana.asked() == []


def orders_all_and_gives_one_back(ana):
    for which in ("hold", "return"):
        ana.holds(f"[aria-label^='{which.title()} all']")
        ana.sees(".notice.sent", f"{which} all: sent, not confirmed yet")
    ana.opens("uav1")
    ana.holds("[aria-label^='Give back uav1']")
    ana.sees(".notice.confirmed", "give back uav1: done")
    orders = [{"order": {"order": each, "vehicle": None}} for each in ("hold", "return")]
    assert ana.asked() == [*orders, {"give_back": {"vehicle": "uav1"}}]
    ana.closes_notices()


def is_refused_and_reads_why(ana):
    ana.harness.refusal = "nobody listens"
    ana.holds(SAY)
    ana.sees(".notice.refused", "refused: nobody listens")
    assert ana.asked() == [SAID]


def test_several_are_chosen_in_the_table_and_ordered_at_once(operates):
    ana = operates()
    rows = ana.page.locator(".fleet .row").evaluate_all(
        "all => all.map((e) => e.getBoundingClientRect().height)"
    )
    assert rows == [46, 46, 46, 46]
    assert [each.split()[-1] for each in ana.texts(".fleet .name")] == ["uav1", "uav10", "uav0", "boat0"]
    for name in ("uav0", "uav10"):
        ana.page.get_by_label(f"choose {name} for").check()
    ana.holds(".several [aria-label^='Hold uav10, uav0']")
    ana.sees(".notice.sent", "hold uav10, uav0: sent, not confirmed yet")
    ana.sees(".fates .aside", "uav10: sent, not confirmed yet")
    several = {"order": {"order": "hold", "vehicle": ["uav10", "uav0"]}}
    assert ana.asked() == [several]
    ana.holds(".several [aria-label^='Give back uav10, uav0']")
    ana.sees(".notice.confirmed", "give back uav0: done")
    assert ana.asked() == [{"give_back": {"vehicle": each}} for each in ("uav10", "uav0")]
    ana.page.get_by_label("all", exact=True).check()
    ana.sees(".several", "4 chosen")


def test_an_order_is_followed_until_its_vehicle_has_confirmed_it(operates):
    ana = operates()
    ana.opens("uav0")
    orders_and_sees_it_confirmed(ana)
    orders_again_and_sees_it_refused(ana)
    sees_the_refusal_stay_until_the_vehicle_obeys(ana)
    reads_of_each_vehicle_what_became_of_an_order_to_all(ana)
    never_reads_as_done_what_ended_unconfirmed(ana)


def change_of_last(ana, **values):
    """Return the last action with other values, by its number."""
    number, action = list(ana.harness.state["actions"].items())[-1]
    return {number: action | values}


def orders_and_sees_it_confirmed(ana):
    ana.harness.answers = {"left_out": {"uav1": "it is taken over"}, "notes": []}
    ana.holds(HOLD, by_key)
    ana.sees(".notice.sent", "hold uav0: sent, not confirmed yet; not uav1: it is taken over")
    ana.told(actions=change_of_last(ana, state="confirmed", answered=time.time()))
    ana.sees(".notice.confirmed", "hold uav0: confirmed by the vehicle")
    ana.clicks(".notice button")
    ana.sees_no(".notice")


REFUSED = "it obeys system 252, not gcs0"
TOLD_AGAIN = f"refused, and repeated: {REFUSED}"


def orders_again_and_sees_it_refused(ana):
    ana.harness.answers = {}
    ana.holds(HOLD, by_key)
    ana.sees(".notice.sent", "hold uav0: sent, not confirmed yet")
    fate = {"state": "refused", "why": REFUSED}
    ordered = {"order": "hold", "by": "Ana", "since": time.time(), **fate}
    refusing = card(2, ordered=ordered, taken=f"refuses to hold: {REFUSED}")
    ana.told(actions=change_of_last(ana, **fate, fates={"uav0": fate}), vehicles={"uav0": refusing})
    ana.sees(".notice.refused", f"hold uav0: {TOLD_AGAIN}")
    ana.sees(".fates .refused", TOLD_AGAIN)
    ana.sees("[data-name=uav0] .ordered.refused", f"to hold, by Ana: {TOLD_AGAIN}")


def sees_the_refusal_stay_until_the_vehicle_obeys(ana):
    ana.waits(60_000)  # longer than a notice of what is done, and of what is not confirmed
    ana.sees(".notice.refused", TOLD_AGAIN)
    assert "confirmed" not in ana.page.locator(".card[data-name=uav0]").inner_text()
    fate = {"state": "confirmed", "why": ""}
    obeys = ana.harness.state["vehicles"]["uav0"] | {"taken": "held by the operator (Ana)"}
    done = change_of_last(ana, **fate, answered=time.time(), fates={"uav0": fate})
    ana.told(actions=done, vehicles={"uav0": obeys | {"ordered": obeys["ordered"] | fate}})
    ana.sees(".notice.confirmed", "hold uav0: confirmed by the vehicle")
    ana.sees("[data-name=uav0] .ordered.confirmed", "to hold, by Ana: confirmed by the vehicle")


def reads_of_each_vehicle_what_became_of_an_order_to_all(ana):
    fates = {"uav0": {"state": "confirmed", "why": ""}, "uav1": {"state": "refused", "why": REFUSED}}
    order = deed(time.time(), "Ana", "hold", "all", "sent") | {"state": "refused", "why": f"uav1: {REFUSED}"}
    ana.told(actions={"8": order | {"fates": fates}})
    ana.sees(".fates .refused", "refused, and repeated: uav1")
    ana.sees(".fates .aside", "uav0: confirmed by the vehicle")
    ana.sees(".fates .aside", f"uav1: refused: {REFUSED}")


def never_reads_as_done_what_ended_unconfirmed(ana):
    over = deed(time.time(), "Ana", "hold", "uav0", "sent") | {"why": "then it was given back"}
    fate = {"state": "sent", "why": over["why"]}
    ana.told(actions={"9": over | {"answered": time.time(), "fates": {"uav0": fate}}})
    ana.sees(".fates .sent", "sent, never confirmed: then it was given back")


def test_two_who_act_at_once_see_each_others_actions_and_each_is_done_once(operates):
    one = operates()
    other = operates(one.harness, name="")
    other.clicks("button", "Look first")  # a name is asked for at once, and again before an action
    one.opens("uav0")
    one.holds(HOLD, by_key)
    other.holds(SAY)
    other.page.locator("#who-name").fill("Rui")
    other.clicks(".who-asks .do", 'say "handover" tower as Rui')
    for each in (one, other):
        each.sees(".fates li", "hold uav0 · Ana")
        each.sees(".fates li", 'say "handover" tower · Rui')
        each.sees(".notice")
        assert (each.count(".fates li"), each.count(".notice")) == (4, 1)
    assert one.asked() + other.asked() == [HELD, SAID]


# --- a run, from before its start to its end


def test_a_run_is_started_from_its_list_and_shown_to_its_end(operates):
    ana = operates(world() | {"vehicles": {"uav0": card()}, "alerts": {}}, has_begun=False)
    ana.sees(".offline", "waiting: the run has not begun")
    ana.harness.begun.set()
    ana.sees(".card", "uav0")
    bo = operates(ana.harness, size=PHONE, has_touch=True, name="Bo")
    read_what_is_still_to_be_done(ana, bo)
    start_it_when_all_is_done(ana, bo)
    sees_it_break_off_which_is_no_end(ana)
    sees_it_end_as_it_should(ana)


def waiting(state, *done):
    """Return the section of a run that waits, with what is done."""
    what = ["the mission is verified", "uav0 is heard", "places and fences fit the vehicles"]
    items = [{"what": each, "done": n in done, "detail": ""} for n, each in enumerate(what)]
    items[1] |= {"vehicle": "uav0", "fence": "as given", "refuses": ["PreArm: Compass not calibrated"]}
    return {"state": state, "by": "", "items": items}


def read_what_is_still_to_be_done(ana, bo):
    ana.harness.change(preflight=waiting("waits", 0))
    for each in (ana, bo):
        each.sees(".preflight", "Before the start: nothing is commanded yet")
        each.sees(".preflight .start:disabled")
        assert each.count(".preflight .open") == 3  # and a station is not reached
        each.sees(".preflight .open", "station lagos is reached: not yet")
        each.sees(".preflight tr.open", "not heard")


def start_it_when_all_is_done(ana, bo):
    ana.harness.change(preflight=waiting("ready", 0, 1, 2))
    for each in (ana, bo):
        each.sees(".preflight .start:enabled")
        (row,) = each.texts(".preflight tbody tr")
        for what in (
            "uav0",
            "37°00.000′N 008°42.000′W",
            "GUIDED, armed",
            "78 %",
            "as given",
            "Compass not calibrated",
        ):
            assert what in row
        assert (
            each.count(".held:not(.start), .sayings, #note") == 0
        )  # the run takes nothing else before its start
        box = each.box(".preflight .start")
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= each.page.viewport_size["width"]
    ana.holds(".preflight .start")
    ana.sees(".notice.confirmed", "start the run: done")
    assert ana.asked() == [{"start": True}]
    ana.harness.change(preflight={"state": "begun", "by": "Ana"})
    for each in (ana, bo):
        each.sees_no(".preflight")
    ana.sees(HOLD)


def sees_it_break_off_which_is_no_end(ana):
    ana.told(clock={"ended": "the run ended without a message: it was killed", "broken_off": True})
    ana.sees(".badge.broken", "BROKEN OFF")
    ana.sees(".calm.wrong", "it was killed")
    ana.harness.stop_serving()
    ana.sees(".offline", "The run broke off")
    ana.sees(".badge.broken", "BROKEN OFF")


def sees_it_end_as_it_should(ana):
    ana.harness.state["clock"] |= {"ended": "the mission is complete", "broken_off": False}
    ana.harness.serve_again()
    ana.sees(".badge.ended", "ENDED")
    ana.sees(".calm", "The run has ended: the mission is complete. It is recorded in run.mcap.")
    ana.harness.stop_serving()
    ana.sees(".offline", "The run has ended")
    ana.sees(".actions .none", "The run has ended: nothing can be done any more.")
    assert ana.texts(".card .level") == ["well"]


def test_who_may_not_act_sees_no_button_that_would(operates):
    ana = operates(world() | {"preflight": waiting("ready", 0, 1, 2)}, role="watch")
    ana.sees(".preflight", "Somebody who may act has to press Start.")
    ana.sees(".actions .none", "watch")
    assert ana.count(".preflight button, .held, .acknowledge") == 0
    ana.harness.role, ana.harness.mode = "act", "replay"
    ana.harness.hang_up()
    ana.sees(".actions .none", "recording")
    assert ana.count(".held, .acknowledge") == 0
