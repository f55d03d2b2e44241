"""The first run to a goal: the fewest steps, among those the first by step numbers, each step as early as possible."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain

import numpy as np

from checker.engines.zones.difference_bounds import close
from checker.engines.zones.earliest_dates import Dates, TimedState, Zone
from checker.engines.zones.shortest_run import LeadsOn, RestOfRun, ShortestRun
from checker.engines.zones.zone_search import CHUNK, Search
from checker.limits import look

Wanted = Callable[[int], list[Zone]]
"""The goal: the accepted clock values in each location, as a union of zones."""


def first_run(search: Search, wanted: Wanted) -> Dates | None:
    """Return the first run to a goal, None if it is unreachable."""
    zone = next((each for each in range(search.count) if meets(search, each, wanted)), None)
    return None if zone is None else run_of(search, wanted, search.depth(zone))


def run_of(search: Search, wanted: Wanted, length: int) -> Dates:
    """Return the first run of a number of steps to a goal that fewer steps don't reach."""
    automaton = search.automaton
    ends = sorted({search.place(zone) for zone in search.layer(length) if meets(search, zone, wanted)})

    def found(asked: LeadsOn | None) -> Iterator[tuple[int, ...]]:
        route = ShortestRun(automaton, search.location, search.ages, length, ends)
        for group in route.groups_at_end(look, asked, max(search.count, CHUNK)):
            if any(meets(route, zone, wanted) for zone in route.zones_of(group)):
                yield route.steps_to(group)

    asked = (partial(leads_on, wanted), None) if search.is_local else (None,)
    steps = next(chain.from_iterable(map(found, asked)))
    return Dates(automaton, TimedState(search.location, search.ages), steps, wanted)


def leads_on(wanted: Wanted, route: ShortestRun, group: int) -> bool:
    """Return whether a group leads to the goal in the steps that are left; in doubt it does."""
    rest = RestOfRun(route, group)
    rest.finish(look)
    return rest.is_far or any(meets(rest, zone, wanted) for zone in rest.last())


def meets(search: Search, zone: int, wanted: Wanted) -> bool:
    """Return whether a zone intersects the goal."""
    return any(_meet(search.matrix(zone), other) for other in wanted(search.place(zone)))


def _meet(one: Zone, other: Zone) -> bool:
    both = np.minimum(one, other)
    return bool(close(both, len(both)))
