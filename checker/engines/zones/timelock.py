"""Timelocks: states from which only steps that take no time can follow, for ever.

Such steps only compare clocks with constants and reset them. So backward propagation finds the states from which time
can pass, as unions of zones: first those where it passes at once, then their predecessors by steps. This is done only
where steps may form a cycle through locations with deadlines.
"""

from __future__ import annotations

import numpy as np

from checker.engines.strong_components import strong_components
from checker.engines.timed.answers import TimelockRun
from checker.engines.timed.first_runs import TimedRun
from checker.engines.zones.earliest_dates import (
    Dates,
    TimedState,
    Zone,
    before_edge,
    moved,
    passes,
    spread,
    tested,
    whole,
    without,
)
from checker.engines.zones.first_run import first_run
from checker.engines.zones.observer_walk import ObserverClock
from checker.engines.zones.observers import Meter, Observer
from checker.engines.zones.timed_automaton import (
    DEADLINES,
    DEADLINES_END,
    LOCATION,
    Constraint,
    TimedAutomaton,
)
from checker.engines.zones.timed_automaton_of import Network
from checker.engines.zones.zone_search import Search
from checker.limits import look
from semantics.timing.actor_clocks import Sort


def first_stop(network: Network) -> TimelockRun | None:
    """Return the first run to a timelock, None if there is none."""
    risky = _risky(network.automaton)
    if not risky:
        return None
    passing = _passing(network.automaton, risky)
    never = np.full((2, len(network.automaton)), ObserverClock.OFF, np.int8)
    observer = Observer(network, never, Meter(), is_exact=True)
    exact = Search(observer.automaton, 0, observer.first_ages())
    exact.finish(look)
    stopped = [_without(place, network, passing) for place in observer.locations.tolist()]
    run = first_run(exact, stopped.__getitem__)
    return None if run is None else _going_round(network, observer, run)


def _risky(automaton: TimedAutomaton) -> set[int]:
    """Return the locations that reach, through locations with deadlines, a cycle of such locations."""
    sources, targets = automaton.arrows()
    ending = automaton.locations.used[DEADLINES::LOCATION] < automaton.locations.used[DEADLINES_END::LOCATION]
    among = ending[sources] & ending[targets]
    order = np.argsort(sources[among], kind="stable")
    sources, targets = sources[among][order], targets[among][order]
    starts = np.searchsorted(sources, np.arange(len(automaton) + 1))
    _, component = strong_components(starts, targets)
    risky = np.bincount(component)[component] > 1
    risky[sources[sources == targets]] = True
    while np.any(more := risky[targets] & ~risky[sources]):
        risky[sources[more]] = True
    return set(np.flatnonzero(risky).tolist())


def _passing(automaton: TimedAutomaton, risky: set[int]) -> dict[int, list[Zone]]:
    """Return for each risky location the clock values from which time can pass eventually."""
    found = {place: _passing_at_once(automaton, place) for place in risky}
    sources: dict[int, set[int]] = {place: set() for place in risky}
    for place in risky:
        for edge in automaton.out(place):
            if edge.target in risky:
                sources[edge.target].add(place)
    waiting = dict.fromkeys(sorted(risky))
    while waiting:
        look()
        place = next(iter(waiting))
        del waiting[place]
        size = len(automaton.location(place).clocks)
        more = list(found[place])
        for edge in automaton.out(place):
            after = found[edge.target] if edge.target in risky else [whole(len(edge.sources))]
            more += (zone for each in after for zone in [before_edge(edge, size, each)] if zone is not None)
        grown = spread(more)
        if _is_more(grown, found[place]):
            found[place] = grown
            waiting |= dict.fromkeys(sorted(sources[place]))
    return found


def _passing_at_once(automaton: TimedAutomaton, place: int) -> list[Zone]:
    location = automaton.location(place)
    if any(most < 0 for _, most in location.deadlines):
        return [whole(len(location.clocks))]  # its successors are unknown
    if any(most == 0 for _, most in location.deadlines):
        return []
    zone = tested(
        whole(len(location.clocks)), [Constraint(clock, 0, most - 1) for clock, most in location.deadlines]
    )
    return [] if zone is None else [zone]


def _is_more(zones: list[Zone], before: list[Zone]) -> bool:
    """Return whether one union of zones holds more than another one."""
    for zone in zones:
        rest = [zone]
        for each in before:
            rest = without(rest, each)
        if rest:
            return True
    return False


def _without(place: int, network: Network, passing: dict[int, list[Zone]]) -> list[Zone]:
    if place not in passing:
        return []
    rest = [whole(len(network.automaton.location(place).clocks))]
    for each in passing[place]:
        rest = without(rest, each)
    return rest


def _going_round(network: Network, observer: Observer, dates: Dates) -> TimelockRun:
    """Return the run to the timelock, extended by the first possible steps until a state repeats."""

    def shown(moment: TimedState) -> tuple[int, tuple[int, ...]]:
        """Return a state in the form of `Timeline`."""
        location = observer.spot(moment.location).location
        place = network.place(location)
        windows, ages = iter(place.windows), iter(network.capped(location, moment.ages))
        clocks = network.situation(place.number).clocks
        return place.number, tuple(next(windows if each.sort is Sort.WINDOW else ages) for each in clocks)

    run: TimedRun = dates.run()
    state = min(dates.ends, key=shown)
    seen: dict[object, int] = {}
    while shown(state) not in seen:
        seen[shown(state)] = len(run.steps)
        edge = next(each for each in observer.automaton.out(state.location) if passes(each, state.ages))
        run, state = run.then(edge.step), TimedState(edge.target, moved(edge, state.ages))
    return TimelockRun(run, seen[shown(state)])
