"""The search for the first run of a number of steps to a goal that fewer steps don't reach.

It has one clock, and proceeds depth first by groups of zones (see `zone_tables`), from the first step on. Where that
takes long, searches in local time decide which of the begun steps lead to the goal.
"""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from checker.engines.zones import zone_groups
from checker.engines.zones.difference_bounds import FREE
from checker.engines.zones.timed_automaton import EDGE, FIRST, TimedAutomaton
from checker.engines.zones.zone_search import CHUNK, Search
from checker.engines.zones.zone_tables import (
    AT,
    BEFORE,
    BEGIN,
    BY,
    DEPTH,
    FULL,
    GROUP,
    GROUPS,
    LAYER,
    LONGEST,
    MISSED,
)

LeadsOn = Callable[["ShortestRun", int], bool]
"""Whether a group leads to the goal in the steps that are left."""


class ShortestRun(Search):
    """The first sequence of a number of steps to a goal.

    The search prunes locations from which the remaining steps don't suffice.

    Attributes:
        length: The number of steps.
        ends: The locations in which it may end.
    """

    def __init__(
        self, automaton: TimedAutomaton, location: int, ages: Sequence[int], length: int, ends: Sequence[int]
    ) -> None:
        self.length = length
        self.ends = list(ends)
        super().__init__(automaton, location, ages)

    def _begin(self) -> None:
        self.left.size = 0
        self.left.extend(len(self.automaton))
        self.left.used[:] = steps_left(self.automaton, self.ends)
        super()._begin()
        self.state[LAYER], self.state[LONGEST] = FREE, self.length
        self.state[AT], self.state[GROUPS], self.state[DEPTH] = 0, 1, 1
        self.groups.room[:GROUP] = -1, -1, 0

    def groups_at_end(
        self, look: Callable[[], None], leads_on: LeadsOn | None, patience: int
    ) -> Iterator[int]:
        """Yield the groups after all steps, in order.

        After each number of zones, `patience`, `leads_on` is asked about the first group on the way of which it is
        unknown.
        """
        sure, until, batch = {0}, self.count + patience, self._chunks.batch()
        while self.state[AT] >= 0:
            look()
            most = min(until, self.count + CHUNK)
            why = zone_groups.advance_by_groups(self.model, self.zones, self.state, self.largest, most, batch)
            if why == FULL:
                self._see(int(self.state[MISSED]))
                batch = self._chunks.batch(int(self.state[MISSED]))
            elif self.state[DEPTH] > self.length:
                yield int(self.state[AT])
                zone_groups.turn_back(self.zones, self.state)
            elif self.count >= until and self.state[AT] >= 0:
                until = self.count + patience
                if leads_on is not None:
                    self._ask(leads_on, sure)

    def _ask(self, leads_on: LeadsOn, sure: set[int]) -> None:
        """Turn back from the first group on the way that isn't sure to lead to the goal, unless it does."""
        way = self._way(int(self.state[AT]))
        depth = next((at for at, group in enumerate(way) if group not in sure), None)
        if depth is None:
            return
        if leads_on(self, way[depth]):
            sure.add(way[depth])
        else:
            self.state[AT], self.state[DEPTH] = way[depth], depth + 1
            zone_groups.turn_back(self.zones, self.state)

    def _way(self, group: int) -> list[int]:
        """Return the groups on the way to a group, from the first one."""
        way = [group]
        while way[-1] > 0:
            way.append(int(self.groups.room[GROUP * way[-1] + BEFORE]))
        return way[::-1]

    def steps_to(self, group: int) -> tuple[int, ...]:
        """Return the steps that lead to a group."""
        return tuple(int(self.groups.room[GROUP * each + BY]) for each in self._way(group)[1:])

    def zones_of(self, group: int) -> range:
        """Return the zones of a group."""
        begins = self.groups.room[BEGIN : GROUP * int(self.state[GROUPS]) : GROUP]
        end = int(begins[group + 1]) if group + 1 < len(begins) else self.count
        return range(int(begins[group]), end)


class RestOfRun(Search):
    """The zones in local time that are reached from a group in the steps that are left.

    Attributes:
        run: The search for the run that the group belongs to.
        group: The group.
        rest: The number of steps that are left.
    """

    def __init__(self, run: ShortestRun, group: int) -> None:
        self.run, self.group = run, group
        self.rest = run.length - len(run.steps_to(group))
        super().__init__(run.automaton, run.location, run.ages, is_local=True)

    def _begin(self) -> None:
        self.left.size = 0
        self.left.extend(len(self.automaton))
        self.left.used[:] = self.run.left.used
        super()._begin()

    def _enter_first(self) -> None:
        self.state[LONGEST] = self.rest
        for zone in self.run.zones_of(self.group):
            self._enter(self.run.place(zone), self.run.matrix(zone))

    @property
    def _goes_on(self) -> bool:
        return super()._goes_on and bool(self.state[DEPTH] <= self.rest)

    def last(self) -> range:
        """Return the zones after all steps."""
        return self.layer(self.rest) if len(self.layers) > self.rest else range(0)


def steps_left(automaton: TimedAutomaton, ends: Sequence[int]) -> NDArray[np.int32]:
    """Return for each location the least number of edges to an end, `FREE` if no end is reachable."""
    taken = automaton.edges.used[FIRST::EDGE] >= 0
    sources, targets = (each[taken] for each in automaton.arrows())
    left = np.full(len(automaton), FREE, np.int32)
    left[ends] = 0
    while True:
        nearer = left.copy()
        np.minimum.at(nearer, sources, np.minimum(left[targets] + 1, FREE))
        if np.array_equal(nearer, left):
            return left
        left = nearer
