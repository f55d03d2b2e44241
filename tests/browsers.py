"""Chromium for tests by playwright, and pages of which nothing may go wrong in silence."""

import re
import shutil
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

import pytest

PHONE, TABLET, DESK = (
    {"width": 390, "height": 844},
    {"width": 1024, "height": 768},
    {"width": 1440, "height": 900},
)
AXE = Path(__file__).parents[1] / "adapters" / "console" / "page" / "node_modules" / "axe-core" / "axe.min.js"


UNUSED = (
    *("WebUIOmniboxPopup", "WebUIOmniboxAimPopup"),
    *(
        "AvoidUnnecessaryBeforeUnloadCheckSync",
        "DestroyProfileOnBrowserClose",
        "HttpsUpgrades",
        "MediaRouter",
    ),
    *("OptimizationHints", "PaintHolding", "PreconnectToSearch", "ThirdPartyStoragePartitioning"),
)
"""Features of chromium that are switched off.

The first two load pages of suggestions for the address bar of each window, at six times the cost of a small page of
ours. Only the last of several such switches counts, so the others repeat playwright's own.
"""

PATIENCE = 60_000
"""Milliseconds in which whatever a test waits for comes, on the busiest machine."""


def until(page, true, value=None, patience=PATIENCE):
    """Wait until a script says so.

    Playwright's own waiting evaluates the script in the page, which our pages forbid, unless it is true at once.
    """
    end = monotonic() + patience / 1000
    while not page.evaluate(true, value):
        assert monotonic() < end, f"not true in time: {true}"
        page.wait_for_timeout(50)


def playwright():
    """Return playwright; skip the test where it is not installed."""
    return pytest.importorskip("playwright.sync_api", reason="playwright is not installed")


@contextmanager
def chromium(*arguments):
    """Start Debian's chromium; skip the test where it or playwright is not installed."""
    playing = playwright()
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        pytest.skip("there is no chromium")
    with playing.sync_playwright() as started:
        browser = started.chromium.launch(
            executable_path=found,
            args=["--no-sandbox", "--disable-gpu", f"--disable-features={','.join(UNUSED)}", *arguments],
        )
        try:
            yield browser
        finally:
            browser.close()


class Watch:
    """What went wrong in pages: errors, what their policy forbade, and hosts that are not theirs."""

    def __init__(self):
        self.errors, self.others = [], []

    def over(self, page, own):
        """Watch a page, which may ask only what is under one address; return the page."""

        def refuse(route):
            self.others.append(route.request.url)
            route.abort()

        page.route(re.compile(rf"^(?!{re.escape(own)}|data:|blob:)"), refuse)
        page.on("websocket", lambda each: self._judge(each.url, own.replace("http", "ws", 1)))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._hear)
        return page

    def _judge(self, url, own):
        if not url.startswith(own):
            self.others.append(url)

    def _hear(self, message):
        if message.type == "error":  # what the policy forbids is an error there
            self.errors.append(f"{message.text} {message.location.get('url', '')}")

    def forgive(self, *words):
        """Forget errors that say one of some words; return how many there were."""
        before = len(self.errors)
        self.errors = [each for each in self.errors if not any(word in each for word in words)]
        return before - len(self.errors)

    def saw_nothing(self):
        assert not self.errors, self.errors
        assert not self.others, self.others


def says(page, selector, text):
    """Wait until an element says something, as a whole or by a pattern."""
    playwright().expect(page.locator(selector).first).to_have_text(text, timeout=PATIENCE)


def overflow(page):
    """Return how far a page could be moved sideways, in pixels."""
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


SPILLED = """() => [...document.querySelectorAll("button, input, select, label, a, h1, h2, p")].filter((each) => {
  const { right, left, width, height } = each.getBoundingClientRect();
  const moves = ".scroll, .rows, .cm-editor, .leaflet-container, .frame, .unseen, [hidden]";
  const isSeen = each.checkVisibility() && width > 1 && height > 1 && !each.closest(moves);
  return isSeen && (right > innerWidth + 1 || left < -1);
}).map((each) => each.outerHTML.slice(0, 120))"""


def spilled(page):
    """Return what is cut at a side of the page, where nothing can be moved into view."""
    return page.evaluate(SPILLED)


def faults(page):
    """Return the rules that axe finds violated, each with the first elements; skip the test without axe-core."""
    if not AXE.exists():
        pytest.skip("axe-core is not there: `make parts` fetches it")
    page.evaluate(f"{AXE.read_text(encoding='utf-8')};0")
    found = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    return [(each["id"], [node["html"] for node in each["nodes"]][:3]) for each in found["violations"]]
