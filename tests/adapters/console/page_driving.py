"""What tests of the page do and wait for in a browser."""

import time


def has(page, selector, text):
    page.locator(selector, has_text=text).first.wait_for()


def await_acts(harness, page, count):
    """Wait until so many actions were asked for, and a little longer."""
    end = time.monotonic() + 60
    while len(harness.acts()) < count and time.monotonic() < end:
        page.wait_for_timeout(50)
    page.wait_for_timeout(300)
    return harness.acts()


def await_turns(harness, page, count):
    """Wait until so many frames came."""
    end = time.monotonic() + 60
    while len(harness.received) < count and time.monotonic() < end:
        page.wait_for_timeout(20)
    assert len(harness.received) == count


HOLD = ".card [aria-label^='Hold uav0']"


def press_mouse(page, seconds, button=HOLD):
    page.locator(button).hover()
    page.mouse.down()
    page.wait_for_timeout(1_000 * seconds)
    page.mouse.up()


def focused(page, script="e => e.getAttribute('aria-label') || e.textContent"):
    return page.evaluate(f"({script})(document.activeElement)")
