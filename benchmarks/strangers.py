"""Measure what entities cost that the mission does not name: AIS vessels that drift into its places, about, and out.

Each of two receivers hears 500 vessels. A vessel comes into a place, moves to another, moves out of all places, and is
heard no more, so that it goes. What has come once stays known, so the number of known entities grows from turn to turn.
Each of these events has a turn of its own, and is recorded. The median of a hundred is printed, by the number of known
entities; then what each event costs more for one more that is known. `python -m benchmarks.strangers`.
"""

import argparse
import os
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from statistics import linear_regression, median

from adapters.live.core import advance, started
from adapters.live.loop import settle
from adapters.live.state import Batch, Heard, LiveState, Plan
from adapters.live.unannounced import SHARE
from adapters.plugin import Aged
from adapters.recording.writing import Recorder
from benchmarks.wire import mission_text
from bigactors.terminal import say
from bigactors.watchers import Tape
from physical import PhysicalProperty, point
from semantics.behaviours.observations import Nodes, Of, QueryOperator
from semantics.behaviours.queries import evaluate, overlay
from semantics.contingencies import Fallback, Precautions
from semantics.state.setting import Control, Scheduler
from specs import Source
from specs.elaboration import Variation, elaborate
from specs.parser import parse

RECEIVERS = ("ais", "radio")
EVENTS = ("coming", "move", "going")

IN_WEST, IN_EAST, OUTSIDE = (37.00075, -8.6495), (37.00075, -8.6475), (37.00075, -8.70)

PACE = 1.0
"""Seconds from one vessel to the next."""

LATER = 20
"""How many other vessels come before one moves; it moves again after as many more, and goes after as many more."""

TIME_TO_LIVE = PACE * (LATER + 0.25)

STEP = 100
"""In how large groups of known entities costs are told."""


@dataclass
class Strangers:
    """A run in which each event has its own turn.

    Attributes:
        state: The state of the run.
        costs: For each event, seconds by how many entities were known.
        counts: How many events there were, by what their steps say.
    """

    plan: Plan
    tape: Tape
    state: LiveState
    costs: dict[str, dict[int, list[float]]] = field(
        default_factory=lambda: defaultdict(lambda: defaultdict(list))
    )
    counts: Counter[str] = field(default_factory=Counter)
    observing: dict[int, float] = field(default_factory=dict)

    @property
    def known(self) -> int:
        """How many entities are known."""
        return len(self.state.configuration.setting.kinds)

    def turn(self, event: str, now: float, *heard: Heard) -> None:
        """Make a turn in which one event happens, and take its time."""
        known, began = self.known, time.thread_time()
        for each in heard:
            self.tape.arrived(each, now)
        turn = advance(self.plan, self.state, Batch(heard), now)
        self.tape.turned(turn, now)
        self.state = turn.state
        self.costs[event][known].append(time.thread_time() - began)
        words = [str(step.transition.label) for step in turn.steps if step.transition.label.rule == "env"]
        assert len(words) == 1, f"one {event} at a time: {words}"
        verb = {"coming": "appears in", "move": "is seen in", "going": "vanishes"}[event]
        self.counts[event] += verb in words[0]

    def observe(self) -> None:
        """Take the time of observing a place, and of learning it."""
        c = self.state.configuration
        began = time.thread_time()
        seen = evaluate(Of(QueryOperator.CHILDREN, Nodes(("west0",))), c.structure.physical, c.alpha)
        c.with_each(overlay(c.structure.logical, seen))
        self.observing[self.known] = time.thread_time() - began


def vessel(number: int, at: tuple[float, float], now: float) -> Heard:
    """Return what a receiver tells of a vessel."""
    said = PhysicalProperty(f"mmsi{244_000_000 + number}", "Vessel", point(*at), time=now, source="ais")
    return Heard(RECEIVERS[number // SHARE], Aged(said, TIME_TO_LIVE))


def events(vessels: int) -> Iterator[tuple[str, float, tuple[Heard, ...]]]:
    """Yield all events in the order of their times."""
    for number in range(vessels + 3 * LATER + 1):
        now = number * PACE
        for event, first, at in (("coming", 0, IN_WEST), ("move", 1, IN_EAST), ("move", 2, OUTSIDE)):
            if 0 <= number - first * LATER < vessels:
                yield event, now, (vessel(number - first * LATER, at, now),)
        if 0 <= number - 3 * LATER < vessels:
            yield "going", now + PACE / 2, ()


def flown(vessels: int, folder: Path) -> Strangers:
    """Return a run through which all vessels have drifted."""
    source = Source("strangers", mission_text(0))
    mission = elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED, {}))
    plan = Plan(mission.initial, precautions=Precautions(Fallback.CONTINUE))
    header = {"mission": "strangers", "text": source.text, "digest": "", "version": "", "verified": False}
    recorder = Recorder(folder / "strangers.mcap", {**header, "vehicles": {}}, 0.0, mission.setting.kinds)
    run = Strangers(plan, Tape(recorder, lambda _finding: ()), started(plan))
    for event, now, heard in events(vessels):
        run.turn(event, now, *heard)
        if event == "coming" and run.known % STEP == 0:
            run.observe()
    recorder.close("it was measured", now)
    return run


def by_hundreds(costs: dict[int, list[float]]) -> dict[int, float]:
    """Return the median in each hundred of known entities, by the middle of the hundred."""
    found: dict[int, list[float]] = defaultdict(list)
    for known, each in costs.items():
        found[known // STEP * STEP + STEP // 2] += each
    return {known: median(each) for known, each in sorted(found.items()) if len(each) >= STEP // 2}


def slope(points: Iterable[tuple[int, float]]) -> float:
    """Return how much more it costs for one more that is known."""
    known, costs = zip(*points, strict=True)
    return linear_regression(known, costs).slope


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vessels", type=int, default=len(RECEIVERS) * SHARE)
    options = parser.parse_args()
    settle()
    with tempfile.TemporaryDirectory() as folder:
        run = flown(options.vessels, Path(folder))
    counts = tuple(run.counts[event] for event in EVENTS)
    assert counts == (options.vessels, 2 * options.vessels, options.vessels), f"the counts are {counts}"
    comings, moves, goings = counts
    say(f"{comings:,} comings, {moves:,} moves, {goings:,} goings; {os.cpu_count()} cores")
    columns = {event: by_hundreds(run.costs[event]) for event in EVENTS}
    say(f"  {'known':>7} {'coming':>9} {'move':>9} {'going':>9}  µs")
    for known in columns["coming"]:
        say(f"  {known:>7} {' '.join(f'{columns[event].get(known, 0) * 1e6:9.0f}' for event in EVENTS)}")
    more = [slope(columns[event].items()) * 1e6 for event in EVENTS]
    say(f"  {'1 more':>7} {' '.join(f'{each:9.2f}' for each in more)}")
    for known, seconds in run.observing.items():
        say(f"  observing a place among {known:>4} known: {seconds * 1000:4.1f} ms")


if __name__ == "__main__":
    main()
