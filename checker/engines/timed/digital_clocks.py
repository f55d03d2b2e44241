"""The reference explorer of missions with timing: digital clocks, which advance by whole ticks.

All bounds are closed integers, so digital clocks reach the same configurations as dense time and give the same verdicts
(Henzinger, Manna, Pnueli 1992).
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Sequence

from checker.engines.contract import Exploration, Inspect, Options, Progress, sample
from checker.engines.reference import crowded
from checker.engines.timed.answers import shown_in_time, shown_to
from checker.engines.timed.digital_answers import DigitalAnswers
from checker.engines.timed.digital_graph import Timeline
from checker.engines.timed.exchanged_clocks import ClockExchange
from checker.engines.timed.first_runs import DELAY, layers
from checker.engines.timed.original_times import OriginalTimes
from checker.limits import EXPLORING, BoundMet, CheckPart, Stop, bounded, is_full, look
from semantics.state.configuration import Configuration


def explore_in_ticks(initial: Configuration, inspect: Iterable[Inspect], options: Options) -> Exploration:
    """Visit the configurations that are reachable in time, then show each to the inspections."""
    started = time.monotonic()
    found = Exploration([], [])
    symmetry = None if options.reduce is None else options.reduce.symmetry
    exchange = None if symmetry is None else ClockExchange(symmetry)
    timeline = Timeline(initial, exchange)
    while True:
        _visit_all(timeline, found, options, started)
        if not timeline.grown or found.bounds:
            break
        timeline.begin()  # a constant is larger than assumed: clocks are counted further
    found.times = times = _summarise(timeline, found)
    with bounded(options.limits, started):
        _show(times, found, tuple(inspect))
    if exchange is not None:
        found.times, found.reducer, found.start = OriginalTimes(times, exchange), options.reduce, initial
        _doubt(timeline, options)
    found.seconds = time.monotonic() - started
    return found


def _show(times: DigitalAnswers, found: Exploration, inspect: Sequence[Inspect]) -> None:
    """Show each configuration to the inspections until a bound is met."""
    try:
        for place in range(len(times.timeline.order)):
            for inspection in inspect:
                look()
                for c, steps in shown_in_time(times, place, shown_to(inspection)):
                    inspection(place, c, steps)
    except BoundMet as met:
        found.bounds.append(met.bound.met_in(CheckPart.LOOKING))


def _visit_all(timeline: Timeline, found: Exploration, options: Options, started: float) -> None:
    limits, reported, count, crowds = options.limits, started, 0, dict[int, bool]()
    while timeline.waiting:
        index = timeline.waiting.popleft()
        now, count = time.monotonic(), count + 1
        stop = limits.end(now - started, EXPLORING)
        if stop is None and count % 1024 == 0 and is_full(limits):
            stop = limits.bound(Stop.MEMORY)
        if (
            stop is None
            and limits.configurations is not None
            and len(timeline.states) > limits.configurations
        ):
            stop = limits.bound(Stop.CONFIGURATIONS)
        if stop is not None:
            found.bounds.append(stop)
            return
        if options.report is not None and now - reported >= options.every:
            options.report(_progress(timeline, count, now - started))
            reported = now
        number = timeline.configuration(index)
        if number not in crowds:
            crowds[number] = crowded(timeline.situations[number].c, limits.pending)
        if crowds[number]:
            bound = limits.bound(Stop.PENDING)
            found.bounds += [] if bound in found.bounds else [bound]
        else:
            timeline.expand(index)


def _doubt(timeline: Timeline, options: Options) -> None:
    """Check the reductions' assumptions on some configurations (`--paranoid`).

    Raises:
        Drift: An assumption fails; a bug of ours.
    """
    for place in sample(len(timeline.order), options.keeping.doubted):
        look()
        if options.reduce is not None:
            options.reduce.hold(timeline.situations[timeline.order[place]].c)


def _progress(timeline: Timeline, count: int, seconds: float) -> Progress:
    states, waiting = len(timeline.states), len(timeline.waiting)
    return Progress(states, sum(map(len, timeline.edges)), 0, waiting, count / max(seconds, 1e-9))


def _summarise(timeline: Timeline, found: Exploration) -> DigitalAnswers:
    """Record the configurations in the order of discovery, and each taken transition once."""
    places, origins = {timeline.configuration(0): 0}, [0]
    for depth, layer in enumerate(layers(0, timeline.edges.__getitem__)):
        follow = sorted(
            (places[timeline.configuration(state)], step, timeline.configuration(target))
            for state in layer
            for step, target in timeline.edges[state]
            if step != DELAY
        )
        for before, _, number in follow:
            if number not in places:
                places[number] = len(origins)
                origins.append(before)
                found.depth = depth + 1
    timeline.order = list(places)
    found.expanded, found.origins = len(origins), origins
    found.configurations = [timeline.situations[number].c for number in timeline.order]
    taken = {
        (number, step)
        for (number, _), edges in zip(timeline.states, timeline.edges, strict=True)
        for step, _ in edges
        if step != DELAY
    }
    timeline.taken = taken
    found.transitions = found.allowed = len(taken)
    found.rules = Counter(
        timeline.situations[number].steps[step].transition.label.rule for number, step in taken
    )
    return DigitalAnswers(timeline)
