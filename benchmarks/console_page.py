"""Measure how smoothly the console's page draws a crowd: frames a second in headless Chromium, each update counted.

`python benchmarks/console_page.py [--vehicles 100] [--entities 1000] [--seconds 10]`. The server of the page's tests
says where everybody is ten times a second; the page is the whole one, with its cards and its map.
"""

import argparse
import sys
import threading
import time
from pathlib import Path

TESTS = Path(__file__).parents[1] / "tests"
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "adapters" / "console")]

from browsers import DESK, chromium  # noqa: E402 - found by the line before
from page_harness import Harness, crowd, world  # noqa: E402

from bigactors.terminal import say  # noqa: E402

RATE = 10.0
COUNTING = """seconds => new Promise(resolve => {
  let frames = 0, begin = 0;
  const each = (now) => {
    begin ||= now; frames += 1;
    if (now - begin < seconds * 1000) requestAnimationFrame(each);
    else resolve([(frames - 1) / ((now - begin) / 1000), document.querySelectorAll('.card').length]);
  };
  requestAnimationFrame(each);
})"""


def measure(vehicles: int, entities: int, seconds: float) -> tuple[float, float]:
    """Return frames a second, and updates a second that were sent meanwhile."""
    with (
        Harness(world() | crowd(vehicles, vehicles + entities, time.time())) as harness,
        chromium() as browser,
    ):
        page = browser.new_page(viewport=DESK)
        page.add_init_script("if (location.port) localStorage['bigactors.name'] ??= 'Ana'")
        page.goto(harness.link)
        page.locator(".card").first.wait_for()
        ends, sent = threading.Event(), []

        def move() -> None:
            while not ends.is_set():
                due = time.monotonic() + 1 / RATE
                now = time.time()
                clock = harness.state["clock"] | {"now": now, "head": now}
                harness.change(crowd(vehicles, vehicles + entities, now) | {"clock": clock})
                sent.append(now)
                time.sleep(max(0.0, due - time.monotonic()))

        threading.Thread(target=move, daemon=True).start()
        page.wait_for_timeout(2_000)
        before = len(sent)
        frames, cards = page.evaluate(COUNTING, seconds)
        updates = len(sent) - before
        ends.set()
        assert cards == vehicles, f"{cards} cards of {vehicles} vehicles"
        return frames, updates / seconds


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vehicles", type=int, default=100)
    parser.add_argument("--entities", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    for _ in range(options.turns):
        frames, updates = measure(options.vehicles, options.entities, options.seconds)
        say(
            f"{options.vehicles} vehicles, {options.entities} others: {frames:.1f} frames a second at "
            f"{updates:.1f} updates a second"
        )


if __name__ == "__main__":
    main()
