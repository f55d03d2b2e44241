"""The first run to something: the fewest steps, of those the first by their numbers, each as early as may be."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from checker.engines.zones.bounds import close
from checker.engines.zones.dates import Dates, Moment, Zone
from checker.engines.zones.search import Route, Search
from checker.limits import look

Wanted = Callable[[int], list[Zone]]
"""What the clocks have to show in each location, at one moment."""


def first_run(search: Search, wanted: Wanted) -> Dates | None:
    """Return the first run to where clocks show what is wanted, None where they never do."""
    zone = next((each for each in range(search.count) if meets(search, each, wanted)), None)
    return None if zone is None else run_of(search, wanted, search.depth(zone))


def run_of(search: Search, wanted: Wanted, length: int, ends: Iterable[int] | None = None) -> Dates:
    """Return the first run of so many steps to what is wanted, which no shorter one leads to."""
    automaton = search.automaton
    among = range(len(automaton)) if ends is None else ends
    route = Route(automaton, search.location, search.ages, length, [at for at in among if wanted(at)])
    group = next(
        group
        for group in route.groups_at_end(look)
        if any(meets(route, zone, wanted) for zone in route.zones_of(group))
    )
    return Dates(automaton, Moment(search.location, search.ages), route.steps_to(group), wanted)


def meets(search: Search, zone: int, wanted: Wanted) -> bool:
    """Tell whether the clocks may show in a zone what is wanted."""
    return any(_meet(search.matrix(zone), other) for other in wanted(search.place(zone)))


def _meet(one: Zone, other: Zone) -> bool:
    both = np.minimum(one, other)
    return bool(close(both, len(both)))
