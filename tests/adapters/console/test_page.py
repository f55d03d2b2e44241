"""The console's page in a browser, with a server that shows what a test says."""

import re
import time

import pytest
from browsers import DESK, PHONE, overflow
from page_driving import HOLD, await_acts, await_turns, focused, has, press_mouse
from page_harness import Harness, alert, card, crowd, deed, world

HOSTILE = '<img src=x onerror="document.title=1">"\'&amp;'


# --- what comes from others is text


def hostile(value):
    """Return a state in which each name and text is an attempt at markup."""
    if isinstance(value, dict):
        return {key: hostile(each) for key, each in value.items()}
    if isinstance(value, list):
        return [hostile(each) for each in value]
    return HOSTILE if isinstance(value, str) else value


SECTIONS = ["vehicles", "entities", "agents", "sayings", "actions", "alerts", "steps", "stations", "mission"]


def test_names_and_texts_are_never_markup(shown):
    state = world()
    for section in SECTIONS:
        state[section] = {
            f"{HOSTILE}{key}" if section in ("vehicles", "entities") else key: hostile(value)
            for key, value in state[section].items()
        }
    state["bigraph"]["text"] = HOSTILE
    with Harness(state) as harness:
        page = shown(harness)
        for tab in range(1, 6):
            page.keyboard.press(str(tab))
            page.locator("[role=tabpanel]").wait_for()
        page.locator(".card .name").first.click()
        assert page.locator("img").count() == 0
        assert page.title() == "bigactors console"
        assert HOSTILE in page.locator(".card").first.inner_text()


def test_a_picture_with_a_script_is_a_picture_without_it(shown):
    state = world()
    foul = '<script>document.title=1</script><a href="javascript:1"><text x="9" y="9" onclick="1">uav0</text></a>'
    state["bigraph"]["svg"] = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9" onload="1">{foul}</svg>'
    )
    with Harness(state) as harness:
        page = shown(harness, refused=["inline event handler"])
        page.keyboard.press("2")
        page.locator(".frame svg").wait_for()
        assert page.locator(".frame script, .frame [onclick], .frame [onload], .frame a[href]").count() == 0
        assert page.title() == "bigactors console"


# --- what acts


def press_key(page, seconds):
    page.locator(HOLD).focus()
    page.keyboard.down("Enter")
    page.wait_for_timeout(1_000 * seconds)
    page.keyboard.up("Enter")


def press_finger(page, seconds):
    page.locator(HOLD).scroll_into_view_if_needed()
    box = page.locator(HOLD).bounding_box()
    at = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    touch = page.context.new_cdp_session(page)
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [at]})
    page.wait_for_timeout(1_000 * seconds)
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


TIMED = """() => {
  const on = (kinds, listener) => kinds.forEach((kind) => addEventListener(kind, listener, true));
  on(['pointerdown', 'keydown'], (event) => { window.began = event.timeStamp; });
  on(['pointerup', 'keyup'], (event) => { window.lasted = event.timeStamp - began; });
}"""


def pressed_shortly(page, harness, press):
    """Press until a press was short by the browser's own clock: on a busy machine it may become a long one."""
    page.evaluate(TIMED)
    for _ in range(10):
        harness.received.clear()
        press(page, 0.4)
        page.locator(".notice").first.wait_for()
        acts = await_acts(harness, page, 0)
        if page.evaluate("lasted") < 1_000:
            return acts
    pytest.skip("this machine is too busy for a short press")


@pytest.mark.parametrize("press", [press_mouse, press_key, press_finger])
def test_a_short_press_does_nothing_and_a_long_one_acts_once(shown, press):
    with Harness(world()) as harness:
        page = shown(harness, has_touch=press is press_finger)
        assert pressed_shortly(page, harness, press) == []
        has(page, ".notice", "Not sent: keep Hold uav0 pressed for one second")
        press(page, 1.6)
        assert await_acts(harness, page, 1) == [{"order": {"order": "hold", "vehicle": "uav0"}}]
        has(page, ".notice.sent", "hold uav0: sent, not confirmed yet")


def test_a_press_that_leaves_the_button_does_nothing(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.locator(HOLD).hover()
        page.mouse.down()
        page.mouse.move(10, 10)
        page.wait_for_timeout(1_300)
        page.mouse.up()
        assert harness.acts() == []


def test_a_card_stays_under_the_hand_while_others_get_worse(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.locator(HOLD).hover()
        page.mouse.down()
        before = page.locator(HOLD).bounding_box()
        harness.change({"vehicles": {"boat0": card(3, kind="USV", why="lost")}})
        page.wait_for_timeout(500)
        assert page.locator(HOLD).bounding_box()["y"] == before["y"]
        page.mouse.up()


def top(page, selector):
    return page.locator(selector).bounding_box()["y"]


def test_a_button_stays_under_the_pointer_whatever_grows_shrinks_and_gets_worse_above_it(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        button = ".card [aria-label^='Return boat0']"
        page.locator(button).hover()
        before = top(page, button)
        told = harness.state["vehicles"]
        for name, why in (("uav1", "a long reason; " * 40), ("uav1", ""), ("uav10", ""), ("uav0", "")):
            harness.change({"vehicles": {name: told[name] | {"why": why}, "boat0": card(3, kind="USV")}})
            page.locator(f".card[data-name={name}] .why").filter(has_text=why[:13]).wait_for(
                state="visible" if why else "detached"
            )
            assert top(page, button) == pytest.approx(before, abs=1)
        page.mouse.move(10, 300)
        page.wait_for_function("document.querySelector('.card').dataset.name === 'boat0'")


def test_the_keyboard_goes_through_the_cards_as_they_are_shown(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.locator(".card[data-name=uav1] [aria-label^='Hold']").hover()
        harness.change({"vehicles": {"boat0": card(3, kind="USV", why="lost too")}})
        has(page, ".card", "lost too")
        page.keyboard.press("j")
        assert page.locator(".card.chosen").get_attribute("data-name") == "uav1"


def test_a_notice_follows_its_action_until_the_vehicle_has_confirmed_it(shown):
    with Harness(world()) as harness:
        harness.answers = {"left_out": {"uav1": "it is taken over"}, "notes": []}
        page = shown(harness)
        press_key(page, 1.2)
        has(page, ".notice.sent", "hold uav0: sent, not confirmed yet; not uav1: it is taken over")
        done = {"state": "confirmed", "answered": time.time()}
        harness.set("actions", {"3": harness.state["actions"]["3"] | done})
        has(page, ".notice.confirmed", "hold uav0: confirmed by the vehicle")
        page.locator(".notice button").click()
        page.locator(".notice").wait_for(state="detached")


REFUSED = "it obeys system 252, not gcs0"


def test_a_refused_order_stays_refused_on_its_card_and_in_its_notice_until_the_vehicle_obeys(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        press_key(page, 1.2)
        has(page, ".notice.sent", "hold uav0: sent, not confirmed yet")
        fate = {"state": "refused", "why": REFUSED}
        ordered = {"order": "hold", "by": "Ana", "since": time.time(), **fate}
        harness.set("actions", {"3": harness.state["actions"]["3"] | fate | {"fates": {"uav0": fate}}})
        harness.set("vehicles", {"uav0": card(2, ordered=ordered, taken=f"refuses to hold: {REFUSED}")})
        told = f"refused, and told again: {REFUSED}"
        has(page, ".notice.refused", f"hold uav0: {told}")
        has(page, ".fates .refused", told)
        has(page, "[data-name=uav0] .ordered.refused", f"to hold, by Ana: {told}")
        page.wait_for_timeout(6_500)  # longer than a notice of what is done
        has(page, ".notice.refused", told)
        assert page.locator("[data-name=uav0]", has_text="confirmed").count() == 0
        fate, done = {"state": "confirmed", "why": ""}, {"answered": time.time()}
        harness.set("actions", {"3": harness.state["actions"]["3"] | fate | done | {"fates": {"uav0": fate}}})
        harness.set("vehicles", {"uav0": card(1, ordered=ordered | fate, taken="held by the operator (Ana)")})
        has(page, ".notice.confirmed", "hold uav0: confirmed by the vehicle")
        has(page, "[data-name=uav0] .ordered.confirmed", "to hold, by Ana: confirmed by the vehicle")


def test_an_order_to_all_says_of_each_vehicle_what_became_of_it(shown):
    fates = {"uav0": {"state": "confirmed", "why": ""}, "uav1": {"state": "refused", "why": REFUSED}}
    order = deed(time.time(), "Ana", "hold", "all", "sent") | {"state": "refused", "why": f"uav1: {REFUSED}"}
    with Harness(world() | {"actions": {"1": order | {"fates": fates}}}) as harness:
        page = shown(harness)
        has(page, ".fates .refused", "refused, and told again: uav1")
        has(page, ".fates .aside", "uav0: confirmed by the vehicle")
        has(page, ".fates .aside", f"uav1: refused: {REFUSED}")


def test_an_order_that_ended_unconfirmed_never_reads_as_done(shown):
    over = deed(time.time(), "Ana", "hold", "uav0", "sent") | {"why": "then it was given back"}
    over |= {"answered": time.time(), "fates": {"uav0": {"state": "sent", "why": over["why"]}}}
    with Harness(world() | {"actions": {"1": over}}) as harness:
        has(shown(harness), ".fates .sent", "sent, never confirmed: then it was given back")


def test_nobody_acts_without_a_name(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role(
            "button", name="Look first"
        ).click()  # it is asked at once, and again before an action
        press_mouse(page, 1.2, ".sayings button")
        page.locator("#who-name").fill("Rui")
        assert harness.acts() == []
        page.get_by_role("button", name='say "handover" tower as Rui').click()
        has(page, ".notice.confirmed", 'say "handover" tower: done')
        assert [each["name"] for each in harness.hellos] == ["", "Rui"]
        assert harness.acts() == [{"say": {"agent": "tower", "message": "handover"}}]
        assert harness.state["actions"]["3"]["by"] == "Rui"


def test_letters_of_a_name_are_no_shortcuts_and_what_came_to_be_past_meanwhile_is_not_ordered(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").click()
        press_mouse(page, 1.2, ".sayings button")
        assert focused(page, "e => e.id") == "who-name"
        page.locator(".who-asks h2").click()  # as a thumb that misses the field
        page.keyboard.press("b")
        page.locator("#who-name").fill("Rui")
        assert [each["type"] for each in harness.received] == []
        harness.set("clock", {"live": False, "now": harness.state["clock"]["begin"]})
        has(page, ".badge.past", "PAST")
        page.locator(".who-asks .do").click()
        has(page, ".notice", "Not sent")
        page.wait_for_timeout(200)
        assert harness.acts() == []


def test_who_acts_is_asked_at_the_beginning_and_then_no_more(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.locator("#who-name").fill("Rui")
        page.locator(".who-asks .do", has_text="Act as Rui").click()
        has(page, ".actions", "You act as")
        page.wait_for_function("document.getElementById('who')?.value === 'Rui'")
        assert page.locator("dialog[open]").count() == 0
        press_mouse(page, 0.3, ".sayings button")
        has(page, ".notice", "Not sent: keep say “handover” to tower pressed for one second.")
        press_mouse(page, 1.2, ".sayings button")
        has(page, ".notice.confirmed", 'say "handover" tower: done')
        assert len(harness.acts()) == 1


SENT = {
    "command": "GoTo",
    "to": "searchArea0",
    "way": [[37.0, -8.7]],
    "since": 1.0,
    "state": "accepted",
    "why": "",
}


def test_a_vehicle_that_flies_home_is_shown_on_its_way_there(shown):
    home = card(order=SENT, returning=True, home=[37.09, -8.81], mode="RTL", taken="RTL by itself")
    state = world()
    state["vehicles"] = {"uav0": home}
    state["entities"]["uav0"] |= {"at": [37.0, -8.72], "speed": 20.0}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card .place", "→ flies home")
        has(page, ".card dd", "6.91 nm home, 10 min 40 s or more")
        has(page, ".card dd", "not now, it flies home")


def test_who_is_held_or_whose_mission_has_fallen_back_is_not_said_to_do_what_was_asked(shown):
    state = world()
    flies = state["vehicles"]["uav0"]
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card[data-name=uav0] .request", "flies to spillArea")
        held = {"command": "Hold", "to": "", "way": [], "since": time.time(), "state": "arrived", "why": ""}
        held_in_flight = {"taken": "held by Ana", "order": held, "differs": True, "going": "spillArea"}
        harness.set("vehicles", {"uav0": flies | held_in_flight})
        has(page, ".card[data-name=uav0] .request", "not now: flies to spillArea")
        assert "then it returns" not in page.locator(".card[data-name=uav0]").inner_text()
        has(page, ".card[data-name=uav0] .place:not(.differs)", "left searchArea0, has not arrived anywhere")
        harness.set("vehicles", {"uav0": flies | {"request": flies["request"] | {"given_up": True}}})
        has(page, ".card[data-name=uav0] .request", "given up: flies to spillArea")
        assert page.locator(".card[data-name=uav0] .bar").count() == 0


def test_a_timed_flight_says_how_long_it_has_gone_on_and_how_long_it_still_takes(shown):
    state = world()
    begin = state["clock"]["head"] - 600
    state["clock"] |= {"live": False, "now": begin + 30.5, "begin": begin}
    flight = {"to": "east0", "since": begin, "least": 71.0, "most": 255.0}
    state["vehicles"] = {"uav0": card(order=SENT, flight=flight)}

    def at(seconds):
        harness.set("clock", harness.state["clock"] | {"now": begin + seconds})

    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card dd", "for 30 s, 40 s to 3 min 44 s to go")
        at(100.5)
        has(page, ".card dd", "for 1 min 40 s, at most 2 min 34 s to go")
        at(265.5)
        has(page, ".card dd .bad", "for 4 min 25 s, 10 s longer than it may take")
        harness.set("vehicles", {"uav0": card(order=SENT, flight=flight | {"most": None})})
        has(page, ".card dd", "for 4 min 25 s, it may take any time")
        harness.set("vehicles", {"uav0": card(order=SENT, flight=flight, taken="held by Ana")})
        page.locator(".card dt", has_text="Flight").wait_for(state="detached")


def test_what_is_shown_of_a_vehicle_whose_link_is_lost_is_said_to_be_old(shown):
    state = world()
    state["vehicles"] = {"uav1": state["vehicles"]["uav1"]}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card dd", "when last heard: RTL · armed · heading 092°")
        has(page, ".card dd", "when last heard: 10.1 kn · 119 m above home")
        phone = shown(harness, PHONE)
        has(phone, ".subject", "when last heard: RTL · 119 m")
        why = phone.locator(".subject .why")
        assert "taken over by the fail-safe" in why.inner_text()
        assert why.bounding_box()["y"] < phone.locator(".subject .orders").bounding_box()["y"]


def test_a_recording_that_cannot_be_read_any_further_is_no_end_and_orders_go_on(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        has(page, ".badge.live", "LIVE")
        harness.set("clock", {"unread": "it has become shorter than it was"})
        has(page, ".badge.past", "OLD")
        has(page, ".offline", "the recording cannot be read any further (it has become shorter than it was)")
        press_mouse(page, 1.2)
        assert await_acts(harness, page, 1) == [{"order": {"order": "hold", "vehicle": "uav0"}}]
        harness.set("clock", {"unread": None})
        page.locator(".offline").wait_for(state="detached")


def test_of_what_is_found_at_once_the_cause_is_said_first_and_what_the_run_did_of_itself(shown):
    state = world()
    now = time.time()
    broken = alert(now, "broken assumption", "uav1", "uav1 is not on control:gcs0 any more", "return")
    state["alerts"] = {"1": broken, "2": alert(now, "lost link", "uav1", "nothing was heard of uav1", "")}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".alert .message", "nothing was heard of uav1")
        harness.set("alerts", {"2": state["alerts"]["2"] | {"acknowledged": {"by": "Ana", "time": now}}})
        has(page, ".alert .message", "control:gcs0 any more → all vehicles were told to return home")


def test_how_far_it_is_counts_to_the_edge_of_the_place_where_a_flight_ends(shown):
    state = world()
    state["vehicles"] = {"uav0": card(order=SENT)}
    ring = [[36.9, -8.8], [36.9, -8.6], [37.1, -8.6], [37.1, -8.8]]
    state["places"]["searchArea0"] = {**next(iter(state["places"].values())), "ring": ring}
    state["entities"]["uav0"] |= {"at": [37.0, -8.9], "speed": 20.0}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card dd", "4.81 nm to the edge of searchArea0, 7 min 25 s or more")
        harness.set("entities", {"uav0": harness.state["entities"]["uav0"] | {"at": [37.0, -8.7]}})
        has(page, ".card dd", "in searchArea0")


def test_what_was_shown_stays_when_another_console_takes_the_address(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        harness.token = "another"
        harness.hang_up()
        has(page, ".offline", "another console is at this address now")
        assert page.locator(".card").count() > 0
        assert page.locator(".held:enabled").count() == 0


def test_a_run_that_has_ended_says_why_and_where_it_is_recorded(shown):
    with Harness(world() | {"alerts": {}}) as harness:
        page = shown(harness)
        harness.set("clock", {"ended": "the mission is complete"})
        has(page, ".calm", "The run has ended: the mission is complete. It is recorded in run.mcap.")


def test_while_the_slider_is_moved_all_clocks_show_its_moment(shown):
    state = world()
    begin = state["clock"]["begin"] = 1_800_000_000.0  # 08:00:00 UTC
    state["clock"] |= {"head": begin + 600, "now": begin + 600}
    with Harness(state) as harness:
        page = shown(harness)
        harness.is_slow = True
        page.locator("input[type=range]").evaluate(
            "e => { e.value = 60; e.dispatchEvent(new Event('input')); }"
        )
        has(page, ".ends .shown", "08:01:00 UTC")
        has(page, ".clock .time", "08:01:00")


def test_who_is_waited_for_is_told_and_a_run_that_broke_off_is_no_end(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        has(page, ".verdict.doubted summary", "1 on what proved wrong")
        harness.change(
            {
                "alerts": {key: each | {"wrong": False} for key, each in harness.state["alerts"].items()},
                "sayings": {key: each | {"awaited": True} for key, each in harness.state["sayings"].items()},
            }
        )
        has(page, ".calm.asked", "tower waits for somebody to say “handover”")
        page.locator(".others").click()
        page.locator(".alert-list").wait_for()
        page.keyboard.press("Escape")
        page.locator(".alert-list").wait_for(state="detached")
        harness.set("clock", {"ended": "the run ended without a word: it was killed", "broken_off": True})
        has(page, ".badge.broken", "BROKEN OFF")
        has(page, ".calm.wrong", "it was killed")
        harness.stop_serving()
        has(page, ".offline", "The run broke off")
        has(page, ".badge.broken", "BROKEN OFF")


def test_two_who_act_at_once_see_each_others_actions_and_each_is_done_once(shown):
    with Harness(world()) as harness:
        one, other = shown(harness), shown(harness, name="Rui")
        press_key(one, 1.2)
        press_mouse(other, 1.2, ".sayings button")
        for page in (one, other):
            has(page, ".fates li", "hold uav0 · Ana")
            has(page, ".fates li", 'say "handover" tower · Rui')
            assert page.locator(".fates li").count() == 4
        assert [len(page.locator(".notice").all()) for page in (one, other)] == [1, 1]
        assert len(harness.acts()) == 2


def test_in_the_past_each_order_is_replaced_by_the_way_to_now(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.keyboard.press("b")
        page.locator(".screen.past").wait_for()
        assert page.locator(".held").count() == 0
        page.locator(".card .now").first.click()
        page.locator(HOLD).wait_for()
        assert page.locator(".screen.past").count() == 0
        assert harness.acts() == []


def test_a_change_of_authority_is_marked_and_announced(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        handed = {"time": time.time(), "from": ["porto"], "to": ["gcs1"]}
        order = {"command": "HandOver", "to": "control:gcs1", "way": [], "since": time.time(), "why": ""}
        told = card(authority=["gcs1"], handed=handed, order=order | {"state": "arrived"})
        harness.set("vehicles", {"uav0": told})
        has(page, ".card[data-name=uav0] .changed", "was porto")
        has(page, ".card[data-name=uav0]", "handed to gcs1, done")
        has(page, "[aria-live=polite]", "uav0 is under gcs1 now, before porto")


def test_cards_speak_no_calculus(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        has(page, ".card[data-name=uav0] .request", "flies to spillArea")
        has(page, ".card[data-name=uav0]", "flies to spillArea, accepted")
        has(page, ".card[data-name=uav0] .request", "then it returns home")
        has(page, ".card[data-name=uav10] .place", "believed in spillArea, really in searchArea0")
        texts = " ".join(page.locator(".cards").all_inner_texts())
        assert re.findall(r"FLY|CTR|MOVE_HOST|GoTo|control:|≠", texts) == []


def test_what_was_said_long_ago_is_dimmed(shown):
    said = {"text": "Takeoff", "time": time.time() - 600, "severity": 6}
    with Harness(world() | {"vehicles": {"uav0": card(said=said)}}) as harness:
        has(shown(harness), ".said.quiet", "10 min")


def test_simulated_time_is_said(shown):
    state = world()
    state["clock"]["rate"] = 10
    with Harness(state) as harness:
        has(shown(harness), ".top .simulated", "simulated 10×")


@pytest.mark.parametrize(("role", "mode"), [("watch", "live"), ("act", "replay")])
def test_who_may_not_act_sees_no_button_that_would(shown, role, mode):
    with Harness(world(), role=role, mode=mode) as harness:
        page = shown(harness)
        assert page.locator(".held, .acknowledge").count() == 0
        has(page, ".actions .none", "watch" if role == "watch" else "recording")


def test_what_was_said_as_often_as_it_may_be_cannot_be_said_again(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        assert page.locator(".sayings button:enabled").count() == 1
        harness.set("sayings", {'tower "handover"': {"agent": "tower", "message": "handover", "left": 0}})
        page.locator(".sayings button:disabled").wait_for()


def test_only_a_vehicle_confirms_and_what_is_said_is_done(shown):
    said = {"time": 1.0, "by": "Ana", "what": 'say "handover"', "about": "tower", "state": "confirmed"}
    with Harness(world() | {"actions": {"1": said | {"why": "", "answered": 2.0}}}) as harness:
        page = shown(harness)
        assert page.inner_text(".fates .state") == "done"


def test_what_a_vehicle_did_not_tell_is_left_out(shown):
    silent = card(mode=None, armed=None, heading=None, authority=[], battery=None)
    with Harness(world() | {"vehicles": {"uav0": silent}}) as harness:
        page = shown(harness)
        assert page.locator(".card dt").all_inner_texts() == ["Place", "Request", "Motion"]
        assert page.locator(".battery").count() == 0


def test_what_is_refused_is_said_with_its_reason(shown):
    with Harness(world()) as harness:
        harness.refusal = "nobody listens"
        page = shown(harness)
        press_mouse(page, 1.2, ".sayings button")
        has(page, ".notice.refused", "refused: nobody listens")
        assert harness.acts() == [{"say": {"agent": "tower", "message": "handover"}}]


WATCHES_BUTTON = """() => {
  window.couldBePressed = {};
  const note = () => {
    const button = document.querySelector(".acknowledge");
    const text = document.querySelector(".alert .message").textContent;
    window.couldBePressed[text] ??= button !== null && !button.disabled;
  };
  const whatever = { childList: true, subtree: true, characterData: true };
  new MutationObserver(note).observe(document.querySelector(".alerts"), whatever);
}"""


def test_an_alert_that_takes_anothers_place_is_not_acknowledged_by_a_press_meant_for_that(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.locator(".acknowledge:enabled").wait_for()
        page.evaluate(WATCHES_BUTTON)
        newer = harness.state["alerts"]["2"] | {"time": time.time() + 60, "message": "the newer one"}
        harness.set("alerts", {"9": newer})
        has(page, ".alert .message", "the newer one")
        assert [could for text, could in page.evaluate("couldBePressed").items() if "newer" in text] == [
            False
        ]
        page.locator(".acknowledge:enabled").click()
        assert await_acts(harness, page, 1) == [{"acknowledge": {"alert": "9"}}]


def test_an_alert_stands_until_it_is_acknowledged(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        has(page, ".alert", "nothing was heard for 31 s")
        page.keyboard.press("a")
        page.keyboard.press("Enter")
        assert await_acts(harness, page, 1) == [{"acknowledge": {"alert": "2"}}]
        done = {"by": "Ana", "time": time.time()}
        harness.set("alerts", {"2": harness.state["alerts"]["2"] | {"acknowledged": done}})
        has(page, ".alert", "the move to spillArea")


def test_nothing_moves_when_an_alert_comes_and_goes(shown):
    state = world() | {"alerts": {}}
    alert = world()["alerts"]["2"]
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".alerts", "to be watched")
        before = page.locator("main").bounding_box()
        harness.set("alerts", {"1": alert})
        has(page, ".alert", "nothing was heard")
        assert page.locator("main").bounding_box() == before
        harness.set("alerts", {"1": alert | {"acknowledged": {"by": "Ana", "time": time.time()}}})
        has(page, ".alerts", "to be watched")
        assert page.locator("main").bounding_box() == before
        page.locator(".others").click()
        has(page, ".alert-list", "acknowledged by Ana")


# --- frames


def test_the_page_connects_again_when_the_server_is_back(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        harness.stop_serving()
        has(page, ".offline", "what is shown is of")
        assert page.locator(".held:enabled").count() == 0
        harness.state["vehicles"]["new0"] = card()
        harness.serve_again()
        has(page, ".card", "new0")
        page.locator(".offline").wait_for(state="detached")


def test_a_frame_that_was_lost_makes_the_page_connect_again(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        while not harness.sockets:  # it is counted after the snapshot was sent
            page.wait_for_timeout(10)
        for socket in harness.sockets:
            harness.sockets[socket] += 1
        harness.state["vehicles"]["lost0"] = card()
        harness.set("vehicles", {"late0": card()})
        has(page, ".card", "late0")
        has(page, ".card", "lost0")
        assert len(harness.hellos) == 2


def test_a_wrong_token_is_said_and_another_can_be_given(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.goto("about:blank")
        page.goto(harness.link + "x")
        has(page, ".offline", "the token is not accepted")
        assert page.locator(".card, .timeline, .top, [role=tab]").count() == 0
        page.locator("#token").fill("a-token")
        page.keyboard.press("Enter")
        has(page, ".card", "uav0")


def test_before_a_run_has_begun_the_page_says_what_it_waits_for(shown):
    with Harness(world()) as harness:
        harness.begun.clear()
        page = shown(harness, until=".offline")
        has(page, ".offline", "waiting: the run has not begun")
        harness.begun.set()
        has(page, ".card", "uav0")


# --- the timeline


def test_a_time_that_is_typed_is_shown_and_one_that_is_not_recorded_is_refused(shown):
    state = world()
    begin = state["clock"]["begin"] = 1_800_000_000.0  # 08:00:00 UTC
    state["clock"] |= {"head": begin + 600, "now": begin + 600}
    with Harness(state) as harness:
        page = shown(harness)
        page.keyboard.press("g")
        page.keyboard.type("07:59")
        page.keyboard.press("Enter")
        has(page, ".notice", "“07:59” is no time from 08:00:00 to 08:10:00 UTC")
        page.locator("#goto").fill("08:03:20")
        page.keyboard.press("Enter")
        has(page, ".ends .shown", "08:03:20 UTC")
        page.keyboard.press("b")
        page.keyboard.press("Shift+B")
        await_turns(harness, page, 3)
        sought = [each["time"] - begin for each in harness.received]
        assert sought == pytest.approx([200, 190, 130], abs=0.01)


def test_the_speed_is_chosen_without_playing(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.keyboard.press("Space")
        page.locator("#speed").select_option("5")
        page.locator("#speed").blur()
        page.keyboard.press("Space")
        await_turns(harness, page, 2)
        assert harness.received == [{"type": "pause"}, {"type": "play", "speed": 5}]


# --- without a mouse


def test_everything_that_acts_is_reached_by_tab_and_shows_its_focus(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        reached = set()
        for _ in range(80):
            page.keyboard.press("Tab")
            reached.add(focused(page).strip())
        wanted = page.locator("button:visible:enabled").evaluate_all(
            "all => all.filter(e => e.tabIndex >= 0).map(e => e.getAttribute('aria-label') || e.textContent)"
        )
        assert {each.strip() for each in wanted} <= reached


def test_the_keys_do_what_the_help_says(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.keyboard.press("?")
        page.locator("dialog[open]").wait_for()
        listed = page.locator("dialog dt").all_inner_texts()
        assert {"?", "ESC", "L", "SPACE", "[", "]", "J", "K", "F", "O", "R", "T"} <= {
            x.upper() for x in listed
        }
        page.keyboard.press("Escape")
        page.locator("dialog[open]").wait_for(state="detached")
        page.keyboard.press("j")
        assert page.locator(".card.chosen").get_attribute("data-name") == "uav1"  # the worst
        page.keyboard.press("Space")
        page.keyboard.press(".")
        page.wait_for_function("document.getElementById('speed').value === '2'")
        page.keyboard.press("Space")
        page.keyboard.press("l")
        await_turns(harness, page, 3)
        turns = [each for each in harness.received if each["type"] != "act"]
        assert turns == [{"type": "pause"}, {"type": "play", "speed": 2}, {"type": "live"}]


def test_a_key_just_after_the_help_was_closed_counts(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.keyboard.press("?")
        page.locator("dialog[open]").wait_for()
        focused = page.evaluate(
            "() => { document.querySelector('dialog[open]').close(); const e = document.activeElement;"
            " e.dispatchEvent(new KeyboardEvent('keydown', { key: ' ', bubbles: true })); return e.textContent; }"
        )
        assert focused == "Close"
        await_turns(harness, page, 1)
        assert harness.received == [{"type": "pause"}]


def test_what_was_asked_for_last_counts_before_it_is_answered(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        harness.is_slow = True
        for key in ("Space", "Space", ".", "Space", "l", "Space"):
            page.keyboard.press(key)
        await_turns(harness, page, 6)
        assert harness.received == [
            {"type": "pause"},
            {"type": "play", "speed": 1},
            {"type": "play", "speed": 2},
            {"type": "pause"},
            {"type": "live"},
            {"type": "pause"},
        ]


def test_live_just_after_the_slider_was_moved_stays_live(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.locator("input[type=range]").focus()
        page.evaluate(
            "() => { for (const key of ['Home', 'l']) { const e = document.activeElement;"
            " if (key === 'Home') { e.value = 0; e.dispatchEvent(new Event('input', { bubbles: true })); }"
            " else e.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true })); } }"
        )
        page.wait_for_timeout(400)
        assert [each["type"] for each in harness.received] == ["live"]


def test_letters_that_are_written_are_no_shortcuts(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").click()
        page.locator("#who").type("lara t[")
        page.wait_for_timeout(200)
        assert [each for each in harness.received if each["type"] != "hello"] == []
        assert page.locator("#who").input_value() == "lara t["


def test_a_name_that_is_being_written_stays_when_the_mission_is_told_anew(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").click()
        page.locator("#who").type("la")
        harness.change({"mission": {"station": "coast0"}})
        page.get_by_text("for station coast0").wait_for()
        page.locator("#who").type("ra")
        assert page.locator("#who").input_value() == "lara"
        page.locator("#who").press("Tab")
        page.wait_for_function("() => localStorage['bigactors.name'] === 'lara'")


# --- how it looks


TEXTS = """() => {
  const rgb = (text) => { const n = text.match(/[0-9.]+/g).map(Number); return n.length < 4 ? [...n, 1] : n; };
  const over = ([r, g, b, a], [x, y, z]) => [r * a + x * (1 - a), g * a + y * (1 - a), b * a + z * (1 - a)];
  const paper = (element) => {
    const layers = [];
    for (let e = element; e; e = e.parentElement) {
      layers.push(rgb(getComputedStyle(e).backgroundColor));
      if (layers.at(-1)[3] === 1) break;
    }
    return layers.reduceRight((below, layer) => over(layer, below), [255, 255, 255]);
  };
  const light = (c) => {
    const [r, g, b] = c.map((v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const found = [];
  const all = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (all.nextNode()) {
    const e = all.currentNode.parentElement;
    if (!all.currentNode.data.trim() || e.closest("svg, #map, :disabled, .unseen")) continue;
    if (!e.checkVisibility({ opacityProperty: true })) continue;
    const back = paper(e);
    const [a, b] = [light(over(rgb(getComputedStyle(e).color), back)), light(back)];
    const what = `${e.className}: ${all.currentNode.data.slice(0, 30)}`;
    found.push([(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), what]);
  }
  return found;
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_all_text_has_the_contrast_of_wcag_aa(shown, scheme):
    with Harness(world()) as harness:
        page = shown(harness, color_scheme=scheme)
        page.locator(".others").click()
        for tab in range(1, 6):
            page.keyboard.press(str(tab))
            page.wait_for_timeout(150)
            ratios = page.evaluate(TEXTS)
            assert len(ratios) > 40
            assert [(ratio, what) for ratio, what in ratios if ratio < 4.5] == []


@pytest.mark.parametrize("tab", ["Map", "Vehicles", "Actions", "Bigraph", "Steps", "Agents", "Stations"])
def test_a_phone_shows_each_tab_without_moving_sideways(shown, tab):
    with Harness(world()) as harness:
        page = shown(harness, PHONE, has_touch=True)
        page.get_by_role("tab", name=tab, exact=True).click()
        page.wait_for_timeout(150)
        assert overflow(page) == 0
        inner = "all => all.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.className)"
        assert page.locator(".cards .scroll, .panel").evaluate_all(inner) == []
        timeline = page.locator(".timeline").bounding_box()
        assert timeline["y"] + timeline["height"] <= PHONE["height"]


def test_a_phone_orders_the_only_vehicle_from_its_map(shown):
    with Harness(world() | {"vehicles": {"uav0": card()}}) as harness:
        page = shown(harness, PHONE, has_touch=True)
        page.locator(".subject [aria-label^='Hold uav0']").wait_for()
        assert page.get_by_role("button", name="Follow").is_enabled()
        boxes = [each.bounding_box() for each in page.locator(".top > *:visible, [role=tab]").all()]
        assert [box for box in boxes if box["x"] < 0 or box["x"] + box["width"] > PHONE["width"]] == []


def test_units_are_the_same_on_cards_and_chart(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        has(page, ".card[data-name=uav0]", "10.1 kn · 119 m above home")
        page.keyboard.press("?")
        page.locator("dialog select").select_option("metric")
        page.keyboard.press("Escape")
        has(page, ".card[data-name=uav0]", "5.2 m/s · 119 m above home")
        has(page, ".map-position", "middle of the map: 37.0000")


@pytest.mark.parametrize("size", [DESK, PHONE])
def test_the_screen_is_as_high_as_the_window(shown, size):
    with Harness(world()) as harness:
        page = shown(harness, size)
        assert page.evaluate("document.documentElement.scrollHeight - innerHeight") == 0


def test_a_phone_shows_the_map_first(shown):
    with Harness(world()) as harness:
        page = shown(harness, PHONE, has_touch=True)
        assert page.get_by_role("tab", selected=True).inner_text() == "Map"


def test_a_hundred_vehicles_are_all_there_worst_first(shown):
    state = world() | crowd(100, 1_000, 0)
    with Harness(state) as harness:
        page = shown(harness)
        levels = page.locator(".card").evaluate_all(
            "all => all.map(e => Number(e.className.match(/level-(.)/)[1]))"
        )
        assert len(levels) == 100
        assert levels == sorted(levels, reverse=True)
        assert re.search(r"\b100\b", page.inner_text("#cards-title"))
