"""How many frames a second the page draws with a fleet and much traffic: measured and printed, nightly."""

import math
import threading

from page_harness import crowd, world
from scale import soak

VEHICLES, TARGETS, SECONDS = 54, 300, 5
FRAMES = """(seconds) => new Promise((done) => {
  const moments = [];
  const frame = (now) => {
    moments.push(now);
    if (now - moments[0] < 1000 * seconds) return requestAnimationFrame(frame);
    const gaps = moments.slice(1).map((each, n) => each - moments[n]).sort((a, b) => a - b);
    done([gaps.length / (moments.at(-1) - moments[0]) * 1000, gaps[Math.floor(gaps.length * 0.95)]]);
  };
  requestAnimationFrame(frame);
})"""


def moved(entities, tick):
    """Return the positions a moment later: everything goes north east."""
    return {
        name: each | {"at": [each["at"][0] + 1e-5 * tick, each["at"][1] + 1e-5 * tick * math.cos(0.65)]}
        for name, each in entities.items()
    }


@soak
def test_a_fleet_among_ships_moves_smoothly(operates, capsys):
    state = world() | crowd(VEHICLES, VEHICLES + TARGETS)
    ana = operates(state)
    ana.sees_that("document.querySelectorAll('.leaflet-container').length === 1")
    before, after = ana.page.evaluate(FRAMES, SECONDS), None
    ended = threading.Event()

    def fly():
        tick = 0
        while not ended.wait(0.1):  # ten positions a second of each, as a run sends them
            tick += 1
            ana.harness.change(entities=moved(state["entities"], tick))

    flight = threading.Thread(target=fly)
    flight.start()
    try:
        after = ana.page.evaluate(FRAMES, SECONDS)
    finally:
        ended.set()
        flight.join()
    with capsys.disabled():
        for what, (rate, worst) in (("at rest", before), ("all moving ten times a second", after)):
            frames = f"{rate:.0f} frames/s, 95 % within {worst:.0f} ms"
            print(f"\n{VEHICLES} vehicles, {TARGETS} targets, {what}: {frames}")  # noqa: T201 - a measure
    assert after[0] > 0
