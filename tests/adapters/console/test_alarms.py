"""What the page says is wrong, and what follows from it, whatever moment is shown."""

import time

from browsers import PHONE
from page_driving import await_acts, has, press_mouse
from page_harness import Harness, alert, card, world

STOPPED = "all vehicles were told to hold; the mission commands nothing any more"


def fallen():
    """Return a world whose mission has fallen back."""
    state = world()
    broken = alert(time.time() - 5, "broken assumption", "uav1", "uav1 is in none of the places", "hold")
    state["alerts"] = {"1": broken}
    state["alarms"] = {"1": broken | {"consequence": STOPPED}}
    state["mission"]["fallen_back"] = STOPPED
    why = "the mission has fallen back and commands nothing any more: what is said moves no vehicle"
    state["sayings"] = {key: each | {"vain": why} for key, each in state["sayings"].items()}
    return state


def test_an_alarm_of_now_stands_in_the_red_line_while_the_past_is_shown(shown):
    with Harness(world() | {"alerts": {}}) as harness:
        page = shown(harness)
        page.keyboard.press("b")
        has(page, ".badge.past", "PAST")
        lost = world()["alerts"]["2"] | {"consequence": STOPPED}
        harness.set("alarms", {"7": lost})
        has(page, ".alert.standing .now-mark", "NOW")
        has(page, ".alert .message", "nothing was heard for 31 s")
        has(page, ".alert .consequence", STOPPED)
        assert page.locator(".acknowledge").count() == 0
        page.locator(".alert-tools .now").click()
        page.locator(".acknowledge:enabled").click()
        assert await_acts(harness, page, 1) == [{"acknowledge": {"alert": "7"}}]


def test_the_red_line_says_the_consequence_whole_on_a_desk_and_a_phone(shown):
    with Harness(fallen()) as harness:
        for page in (shown(harness), shown(harness, PHONE, has_touch=True)):
            consequence = page.locator(".alert .consequence")
            assert STOPPED in consequence.inner_text()
            cut = "e => e.scrollHeight > e.clientHeight + 1 || e.scrollWidth > e.clientWidth + 1"
            assert not consequence.evaluate(cut)
            line, screen = page.locator(".alerts").bounding_box(), consequence.bounding_box()
            assert screen["y"] >= line["y"]
            assert screen["y"] + screen["height"] <= line["y"] + line["height"]


def test_a_mission_that_has_fallen_back_says_so_when_every_alarm_is_acknowledged(shown):
    with Harness(fallen() | {"alerts": {}, "alarms": {}}) as harness:
        has(shown(harness), ".calm", f"The mission has fallen back: {STOPPED}.")


def test_after_a_fallback_no_word_of_the_mission_is_offered_as_if_it_did_something(shown):
    with Harness(fallen()) as harness:
        page = shown(harness)
        page.locator(".sayings button:disabled").wait_for()
        assert page.locator(".sayings button:enabled").count() == 0
        has(page, ".actions", "What is said to its agents moves no vehicle.")
        assert page.locator(".card[data-name=uav0] [aria-label^='Hold']").is_enabled()
        vain = harness.state["sayings"]['tower "handover"']["vain"]
        said = {"time": time.time(), "by": "Ana", "what": 'say "handover"', "about": "tower"}
        done = {"state": "confirmed", "why": "", "left_out": {}, "notes": [], "answered": time.time()}
        harness.set("actions", {"9": said | done | {"vain": vain}})
        has(page, ".fates li", "heard, but the mission has fallen back")
        assert "done" not in page.locator(".fates li").first.inner_text()


def test_words_to_an_agent_that_commands_nothing_are_offered_with_that_said(shown):
    state = world()
    vain = "the mission has fallen back: nothing that tower orders is carried out any more"
    state["sayings"] = {key: each | {"vain": vain} for key, each in state["sayings"].items()}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".sayings button:enabled", vain)
        harness.set("sayings", state["sayings"])
        press_mouse(page, 1.2, ".sayings button")
        assert await_acts(harness, page, 1) == [{"say": {"agent": "tower", "message": "handover"}}]


def test_each_card_names_how_its_vehicle_is_and_not_only_how_bad_that_is(shown):
    state = world()
    ways = ["lost", "taken over", "broken", "unknown"]
    state["vehicles"] = {f"uav{n}": card(3, word=each, why="because") for n, each in enumerate(ways)}
    with Harness(state) as harness:
        page = shown(harness)
        assert sorted(page.locator(".card .level").all_inner_texts()) == sorted(ways)
        assert [each[2:] for each in page.locator(".tally").all_inner_texts()] == [
            f"1 {each}" for each in ways
        ]
        has(page, ".card[data-name=uav3] .link", "last heard")


def test_of_no_vehicle_is_said_that_it_is_well_when_nothing_is_heard_of_the_run(shown):
    with Harness(world() | {"vehicles": {"uav0": card()}}) as harness:
        page = shown(harness)
        has(page, ".card .level", "well")
        harness.set("clock", {"unread": "it has become shorter than it was"})
        has(page, ".card .level", "unknown")
        has(page, ".card .link", "last heard")
        harness.set("clock", {"unread": None})
        has(page, ".card .level", "well")
        harness.stop_serving()
        has(page, ".card .level", "unknown")
        has(page, ".tally", "1 unknown")


def test_a_run_that_has_ended_as_it_should_leaves_its_vehicles_as_they_were(shown):
    with Harness(world() | {"vehicles": {"uav0": card()}}) as harness:
        page = shown(harness)
        harness.set("clock", {"ended": "the mission is complete"})
        has(page, ".badge.ended", "ENDED")
        harness.stop_serving()
        has(page, ".offline", "The run has ended")
        assert page.locator(".card .level").inner_text() == "well"


def test_the_caption_of_the_picture_has_the_step_that_it_shows(shown):
    state = world()
    state["bigraph"] |= {"drawn": 40, "step": 42}
    with Harness(state) as harness:
        page = shown(harness)
        page.keyboard.press("2")
        has(
            page,
            ".bigraph .tools",
            "after step 40; the moment shown is after step 42, which is not drawn yet",
        )
        page.get_by_role("button", name="Text").click()
        has(page, ".bigraph .tools", "after step 42")
        assert "step 40" not in page.inner_text(".bigraph .tools")
        page.get_by_role("button", name="Text").click()
        harness.set("bigraph", {"drawn": 42})
        page.get_by_text("what is believed, after step 42", exact=True).wait_for()


def test_a_vehicle_that_another_station_has_sent_is_under_way_and_not_astray(shown):
    state = world()
    flies = card(believed="west0", actual="region", differs=True, going="east0", authority=["faro"])
    state["vehicles"] = {"uav0": flies}
    state["entities"]["uav0"] |= {"believed": "west0", "actual": "region", "differs": True}
    with Harness(state) as harness:
        page = shown(harness)
        has(page, ".card .place:not(.differs)", "west0 → under way to east0")
        harness.set("vehicles", {"uav0": flies | {"going": None}})
        has(page, ".card .place.differs", "believed in west0, really outside all named places")


def test_what_an_order_to_return_ends_is_said_before_it_is_pressed(shown):
    ends = "breaks what the mission assumes: all vehicles are told to hold"
    with Harness(world() | {"vehicles": {"uav0": card(on_return=ends)}}) as harness:
        for page in (shown(harness), shown(harness, PHONE, has_touch=True)):
            told = page.locator(".on-return:visible")
            assert ends in told.inner_text()
            assert not told.evaluate("e => e.scrollHeight > e.clientHeight + 1")
            button = page.locator("[aria-label^='Return uav0']:visible")
            assert ends in button.get_attribute("aria-label")
            press_mouse(page, 0.2, "[aria-label^='Return uav0']:visible")
            has(page, ".notice", "Not sent: keep Return uav0 pressed for one second.")
        assert harness.acts() == []


TIP = ".map-tip"


def test_a_tap_on_the_map_leaves_no_tip_that_names_another_vehicle_over_the_orders(shown):
    with Harness(world()) as harness:
        page = shown(harness, PHONE, has_touch=True)
        page.locator("#map .leaflet-container, #map.leaflet-container").first.wait_for()
        page.wait_for_timeout(500)
        page.touchscreen.tap(195, 400)
        page.keyboard.press("j")
        page.locator(".subject").wait_for()
        page.wait_for_timeout(300)
        assert page.locator(TIP).is_hidden()


def test_a_tip_goes_when_the_map_changes_its_size_under_the_pointer(shown):
    with Harness(world()) as harness:
        page = shown(harness, PHONE)
        page.wait_for_timeout(500)
        page.mouse.move(190, 400)
        page.mouse.move(195, 400)
        page.locator(TIP).wait_for()
        page.keyboard.press("j")
        page.locator(".subject").wait_for()
        page.locator(TIP).wait_for(state="hidden")


def test_a_phone_names_each_vehicle_whole_above_its_buttons(shown):
    with Harness(world()) as harness:
        page = shown(harness, PHONE, has_touch=True)
        page.get_by_role("tab", name="Vehicles", exact=True).click()
        page.locator(".card[data-name=uav1] [aria-label^='Give']").wait_for()
        cut = "all => all.filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.textContent)"
        assert page.locator(".card .name").evaluate_all(cut) == []


# --- before the start


def waiting(state, *done):
    """Return the section of a run that waits, with what is done."""
    what = ["the mission is verified", "uav0 is heard", "places and fences fit the vehicles"]
    items = [{"what": each, "done": n in done, "detail": ""} for n, each in enumerate(what)]
    return {"state": state, "by": "", "items": items}


def test_a_run_is_started_from_its_list_and_not_before_all_of_it_is_done(shown):
    with Harness(world() | {"preflight": waiting("waits", 0)}) as harness:
        desk, phone = shown(harness), shown(harness, PHONE, has_touch=True)
        for page in (desk, phone):
            has(page, ".preflight", "Before the start: nothing is commanded yet")
            assert page.locator(".preflight .open").count() == 2
            page.locator(".preflight .start:disabled").wait_for()
        harness.set("preflight", waiting("ready", 0, 1, 2))
        for page in (desk, phone):
            page.locator(".preflight .start:enabled").wait_for()
            box = page.locator(".preflight .start").bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= page.viewport_size["width"]
        press_mouse(desk, 1.2, ".preflight .start")
        assert await_acts(harness, desk, 1) == [{"start": True}]
        has(desk, ".notice.confirmed", "start the run: done")
        harness.set("preflight", {"state": "begun", "by": "Ana"})
        for page in (desk, phone):
            page.locator(".preflight").wait_for(state="detached")


def test_who_only_watches_is_told_that_somebody_has_to_start_the_run(shown):
    with Harness(world() | {"preflight": waiting("ready", 0, 1, 2)}, role="watch") as harness:
        page = shown(harness)
        has(page, ".preflight", "Somebody who may act has to press Start.")
        assert page.locator(".preflight button").count() == 0
