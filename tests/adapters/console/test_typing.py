"""What is typed into the page: it belongs to its input, whatever is drawn meanwhile."""

import pytest
from page_driving import await_turns, focused, has
from page_harness import Harness, world

PRESSES_AND_TYPES = """async ([button, field]) => {
  [...document.querySelectorAll("button")].find((each) => each.textContent.trim() === button).click();
  await new Promise((done) => setTimeout(done));
  document.querySelector(field).focus();
  return document.activeElement.id;
}"""
"""Presses a button, and goes to a field in the next task: sooner than a frame is drawn on a quiet machine."""


def test_a_dialog_that_was_closed_keeps_no_key_for_itself(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").wait_for()
        assert page.evaluate(PRESSES_AND_TYPES, ["Look first", "#who"]) == "who"


def test_keys_that_follow_the_one_that_opens_a_dialog_are_no_shortcuts(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        opened = page.evaluate("""async () => {
          const event = (key) => new KeyboardEvent("keydown", { key, bubbles: true });
          const press = (key) => document.activeElement.dispatchEvent(event(key));
          press("?");
          await new Promise((done) => setTimeout(done));
          press("b");
          return document.querySelectorAll("dialog[open]").length;
        }""")
        page.wait_for_timeout(200)
        assert (opened, harness.received) == (1, [])


CARET = "e => [e.id, e.value, e.selectionStart]"


def typed(page, field, text, caret):
    page.locator(field).focus()
    page.keyboard.type(text)
    page.evaluate(f"document.activeElement.setSelectionRange({caret}, {caret})")
    return [field[1:], text, caret]


FIELDS = pytest.mark.parametrize("field", ["#who", "#goto"])


@FIELDS
def test_what_is_typed_stays_with_its_caret_while_the_connection_is_lost_and_comes_again(shown, field):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").click()
        known = typed(page, field, "lara", 2)
        harness.stop_serving()
        has(page, ".offline", "Not connected")
        assert focused(page, CARET) == known
        harness.state["vehicles"]["new0"] = world()["vehicles"]["uav0"]
        harness.serve_again()
        has(page, ".card", "new0")
        assert focused(page, CARET) == known


@FIELDS
def test_what_is_typed_stays_with_its_caret_whatever_is_told(shown, field):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        page.get_by_role("button", name="Look first").click()
        known = typed(page, field, "lara", 2)
        for section in ("mission", "clock", "vehicles", "sayings", "actions", "agents", "alerts"):
            harness.set(section, dict(harness.state[section]))
        harness.change({"mission": {"station": "coast0"}, "clock": {"live": False, "playing": False}})
        has(page, ".badge.past", "PAST")
        assert focused(page, CARET) == known
        harness.set("clock", {"live": True, "ended": "the mission is complete"})
        has(page, ".badge.ended", "ENDED")
        assert focused(page, CARET) == known


def test_a_name_that_is_asked_for_stays_with_its_caret_whatever_is_told(shown):
    with Harness(world()) as harness:
        page = shown(harness, name="")
        known = typed(page, "#who-name", "lara", 2)
        harness.stop_serving()
        page.locator(".offline").wait_for()
        harness.serve_again()
        harness.change({"mission": {"station": "coast0"}})
        page.locator(".offline").wait_for(state="detached")
        assert focused(page, CARET) == known
        page.keyboard.press("Enter")
        page.wait_for_function("() => localStorage['bigactors.name'] === 'lara'")


def test_a_token_that_is_refused_can_be_mended(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        page.goto("about:blank")
        page.goto(harness.link + "x")
        known = typed(page, "#token", "a-tokem", 7)
        page.keyboard.press("Enter")
        while len(harness.hellos) < 3:
            page.wait_for_timeout(20)
        has(page, ".offline", "the token is not accepted")
        assert focused(page, CARET) == known
        page.keyboard.press("Backspace")
        page.keyboard.type("n")
        page.keyboard.press("Enter")
        has(page, ".card", "uav0")


def test_a_slider_that_is_moved_again_at_once_stays_where_it_is_put(shown):
    with Harness(world()) as harness:
        page = shown(harness)
        harness.is_slow = True
        moved = """(to) => { const e = document.querySelector("input[type=range]"); e.value = to;
          e.dispatchEvent(new Event("input", { bubbles: true })); }"""
        page.evaluate(moved, 100)
        page.evaluate("document.querySelector('input[type=range]').dispatchEvent(new Event('change'))")
        page.evaluate(moved, 200)
        await_turns(harness, page, 2)
        page.wait_for_timeout(500)
        assert float(page.locator("input[type=range]").input_value()) == 200
