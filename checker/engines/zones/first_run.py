"""The first run to a goal: the fewest steps, among those the first by step numbers, each step as early as possible."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from checker.engines.zones.difference_bounds import close
from checker.engines.zones.earliest_dates import Dates, TimedState, Zone
from checker.engines.zones.zone_search import Search, ShortestRun
from checker.limits import look

Wanted = Callable[[int], list[Zone]]
"""The goal: the accepted clock values in each location, as a union of zones."""


def first_run(search: Search, wanted: Wanted) -> Dates | None:
    """Return the first run to a goal, None if it is unreachable."""
    zone = next((each for each in range(search.count) if meets(search, each, wanted)), None)
    return None if zone is None else run_of(search, wanted, search.depth(zone))


def run_of(search: Search, wanted: Wanted, length: int, ends: Iterable[int] | None = None) -> Dates:
    """Return the first run of a number of steps to a goal that fewer steps don't reach."""
    automaton = search.automaton
    among = range(len(automaton)) if ends is None else ends
    route = ShortestRun(automaton, search.location, search.ages, length, [at for at in among if wanted(at)])
    group = next(
        group
        for group in route.groups_at_end(look)
        if any(meets(route, zone, wanted) for zone in route.zones_of(group))
    )
    return Dates(automaton, TimedState(search.location, search.ages), route.steps_to(group), wanted)


def meets(search: Search, zone: int, wanted: Wanted) -> bool:
    """Return whether a zone intersects the goal."""
    return any(_meet(search.matrix(zone), other) for other in wanted(search.place(zone)))


def _meet(one: Zone, other: Zone) -> bool:
    both = np.minimum(one, other)
    return bool(close(both, len(both)))
