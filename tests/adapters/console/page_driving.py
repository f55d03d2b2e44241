"""An operator before a page: actions and observations. No step waits for a time.

The page's clock is the test's: it goes on by itself, and by as much more as a step says. So a press of a second takes
none, and a short press is short on the busiest machine.
"""

import json
from contextlib import contextmanager

from browsers import PATIENCE, playwright, until

HOLD = ".card [aria-label^='Hold uav0']"
SAY = ".sayings button"
SECOND = 1_100
"""Milliseconds of a press that acts."""

KEEPS_WHAT_IS_SAID = """
if (location.port) localStorage["bigactors.name"] ??= NAME;
Object.assign(window, { said: [], hungUp: 0 });
window.WebSocket = class extends WebSocket {
  constructor(...all) {
    super(...all);
    this.addEventListener("close", () => hungUp++);
  }
  send(text) {
    said.push(JSON.parse(text));
    super.send(text);
  }
};
"""


@contextmanager
def by_mouse(page, button):
    page.locator(button).first.hover()
    page.mouse.down()
    yield
    page.mouse.up()


@contextmanager
def by_key(page, button):
    page.locator(button).first.focus()
    page.keyboard.down("Enter")
    yield
    page.keyboard.up("Enter")


@contextmanager
def by_finger(page, button):
    page.locator(button).first.scroll_into_view_if_needed()
    box = page.locator(button).first.bounding_box()
    at = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    touch = page.context.new_cdp_session(page)
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [at]})
    yield
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


class Operator:
    """Who sits before a page of a harness."""

    def __init__(self, page, harness, name):
        self.page, self.harness = page, harness
        page.set_default_timeout(PATIENCE)
        page.clock.install()
        page.add_init_script(KEEPS_WHAT_IS_SAID.replace("NAME", json.dumps(name)))
        page.goto(harness.link)
        self.sees("html[data-drawn]" if harness.begun.is_set() else ".offline")

    # --- what is seen

    def sees(self, selector, text=""):
        self.page.locator(selector, has_text=text).first.wait_for()

    def sees_no(self, selector, text=""):
        self.page.locator(selector, has_text=text).first.wait_for(state="detached")

    def sees_that(self, true, value=None):
        """Wait until a script says so."""
        until(self.page, true, value)

    def count(self, selector):
        return self.page.locator(selector).count()

    def texts(self, selector):
        return self.page.locator(selector).all_inner_texts()

    def box(self, selector):
        return self.page.locator(selector).first.bounding_box()

    def focused(self, script="e => e.getAttribute('aria-label') || e.textContent"):
        return self.page.evaluate(f"({script})(document.activeElement)")

    # --- what is told, and heard of it

    def told(self, **sections):
        """Have the page told of changes, and wait until it has drawn them all."""
        number = self.harness.change(**sections)
        self.sees_that("n => document.documentElement.dataset.drawn === String(n)", number)

    def asked(self):
        """Return what the page has asked for since the last look."""
        said = self.page.evaluate("said.splice(0)")
        return [each.get("action", each) for each in said if each["type"] != "hello"]

    # --- what is done

    def presses(self, *keys):
        for key in keys:
            self.page.keyboard.press(key)

    def clicks(self, selector, text=""):
        self.page.locator(selector, has_text=text).first.click()

    def opens(self, name):
        """Open a vehicle's card in the table."""
        if self.count(f"[data-row={name}]") and not self.count(f".card[data-name={name}]"):
            self.clicks(f"[data-row={name}] .name")
        self.sees(f".card[data-name={name}]")

    def writes(self, field, text, caret):
        """Write a text, move the caret back into it, and return the answer of `caret`."""
        self.page.locator(field).fill("")
        self.page.keyboard.type(text)
        self.page.evaluate(f"document.activeElement.setSelectionRange({caret}, {caret})")
        return [field[1:], text, caret]

    def caret(self):
        return self.focused("e => [e.id, e.value, e.selectionStart]")

    def waits(self, milliseconds):
        self.page.clock.fast_forward(milliseconds)

    def holds(self, button=HOLD, by=by_mouse):
        with by(self.page, button):
            self.waits(SECOND)

    def taps(self, button, by=by_mouse, *, says):
        """Press a button shortly, and read what it says of that, while time stands still."""
        self._stops_the_clock()
        with by(self.page, button):
            self.page.clock.run_for(900)
        self.sees(".notice", says)
        self.page.clock.resume()

    def _stops_the_clock(self):
        now = "Date.now() / 1000"
        try:
            self.page.clock.pause_at(self.page.evaluate(now) + 1)
        except playwright().Error:  # a busy machine needed a second to do so: the clock stands still now
            self.page.clock.pause_at(self.page.evaluate(now) + 1)

    def closes_notices(self):
        self.page.evaluate("document.querySelectorAll('.notice button').forEach((each) => each.click())")
        self.sees_no(".notice")
