"""A search through the zones of a timed automaton."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.arrays import Growing
from checker.engines.zones import kernel
from checker.engines.zones.automaton import EDGES, LOCATION, SIZE, UNKNOWN, Automaton
from checker.engines.zones.kernel import (
    AT,
    BEFORE,
    BEGIN,
    BY,
    COUNT,
    FOUND,
    GROUP,
    GROUPS,
    MISSED,
    USED,
)

CHUNK = 1 << 14
"""Zones that are kept between two looks at the clock."""


class Search:
    """What was reached from a location at given ages.

    Attributes:
        automaton: What is searched.
        state: How far it has come.
    """

    def __init__(self, automaton: Automaton, location: int, ages: Sequence[int]) -> None:
        self.automaton = automaton
        self.begins, self.sums = Growing(np.int64), Growing(np.int64)
        self.bounds, self.places, self.following = (Growing(np.int32) for _ in range(3))
        self.heads, self.groups = Growing(np.int32), Growing(np.int32)
        self.location, self.ages = location, tuple(ages)
        self.state = np.zeros(kernel.STATE, np.int64)
        self._begin()

    def _begin(self) -> None:
        self.heads.size = 0
        self.state[:] = 0
        self.state[FOUND] = -1
        self._see(1)
        size = len(self.ages) + 1
        shown = np.array((0, *self.ages), np.int32)
        first = np.zeros((self._largest, self._largest), np.int32)
        first[:size, :size] = shown[:, None] - shown[None, :]
        scratch = np.zeros_like(first), np.zeros((4, 1 + self._largest), np.int32)
        kernel.enter(self.model, self.zones, self.state, self.location, first, *scratch)
        self.groups.room[:GROUP] = -1, -1, 0
        self.state[GROUPS] = 1

    # --- searching

    def advance(self, zones: int = CHUNK) -> bool:
        """Follow groups until so many more zones are kept; tell whether anything is left to be followed.

        Nothing is, where what is looked for was found.
        """
        until = self.count + zones
        while True:
            why = kernel.advance(self.model, self.zones, self.state, self._largest, until)
            if why == kernel.DONE:
                return self.state[AT] < self.state[GROUPS] and self.found < 0
            if why == kernel.FULL:
                self._see(int(self.state[MISSED]))
            else:
                self.learn()
                self._see(1)

    def learn(self) -> None:
        """Find out what leads from locations that were reached."""
        raise AssertionError("nobody knows what leads from some location")

    def waiting(self) -> NDArray[np.int64]:
        """Return the locations of zones that are not followed yet of which nobody knows what leads from them."""
        begin = int(self.groups.room[GROUP * int(self.state[AT]) + BEGIN])
        reached = np.unique(self.places.room[begin : self.count]).astype(np.int64)
        found: NDArray[np.int64] = reached[self.automaton.locations.used[EDGES::LOCATION][reached] == UNKNOWN]
        return found

    def again(self) -> None:
        """Begin anew."""
        self.automaton.forget()
        self._begin()

    def finish(self, look: Callable[[], None]) -> None:
        """Search to the end, or to what is looked for, with a look now and then at whether there is time."""
        while self.advance():
            look()

    def _see(self, zones: int) -> None:
        """Let the loops see the automaton as it is, with room for so many more zones."""
        automaton = self.automaton
        self._largest = automaton.largest
        for each, size in (
            (self.begins, self.count),
            (self.sums, self.count),
            (self.places, self.count),
            (self.following, self.count),
        ):
            each.size = size
            each.reserve(zones + CHUNK)
        self.bounds.size = int(self.state[USED])
        self.bounds.reserve((zones + 1) * self._largest**2)
        self.groups.size = GROUP * int(self.state[GROUPS])
        self.groups.reserve(GROUP * (zones + CHUNK))
        missing = len(automaton) - len(self.heads)
        if missing:
            self.heads.extend(missing, -1)
        parts = (
            automaton.locations,
            automaton.edges,
            automaton.tests,
            automaton.sources,
            automaton.deadlines,
        )
        clocks = (automaton.clocks, automaton.lower, automaton.upper)
        self.model = kernel.Model._make(each.room for each in (*parts, *clocks))
        found = (self.bounds, self.begins, self.sums, self.places, self.following, self.heads, self.groups)
        self.zones = kernel.Zones(*(each.room for each in found))

    # --- what was found

    @property
    def count(self) -> int:
        """How many zones there are."""
        return int(self.state[COUNT])

    @property
    def found(self) -> int:
        """The first group in which what is looked for was found; -1 where it was not."""
        return int(self.state[FOUND])

    @property
    def progress(self) -> tuple[int, int]:
        """How many groups were followed, and how many there are."""
        return int(self.state[AT]), int(self.state[GROUPS])

    def steps_to(self, group: int) -> tuple[int, ...]:
        """Return the steps that lead to a group."""
        steps = []
        while group > 0:
            steps.append(int(self.groups.room[GROUP * group + BY]))
            group = int(self.groups.room[GROUP * group + BEFORE])
        return tuple(reversed(steps))

    def group_records(self) -> NDArray[np.int32]:
        """Return of each group the one before, its step, and its first zone."""
        return self.groups.room[: GROUP * int(self.state[GROUPS])].reshape(-1, GROUP)

    def zones_of(self, group: int) -> range:
        """Return the zones of a group."""
        ends = (
            int(self.groups.room[GROUP * (group + 1) + BEGIN])
            if group + 1 < self.state[GROUPS]
            else self.count
        )
        return range(int(self.groups.room[GROUP * group + BEGIN]), ends)

    def place(self, zone: int) -> int:
        """Return the location of a zone."""
        return int(self.places.room[zone])

    def matrix(self, zone: int) -> NDArray[np.int32]:
        """Return a zone."""
        size = int(self.automaton.locations.room[LOCATION * self.place(zone) + SIZE])
        begin = int(self.begins.room[zone])
        return self.bounds.room[begin : begin + size * size].reshape(size, size)

    def by_place(self) -> dict[int, list[int]]:
        """Return the zones of each location."""
        found: dict[int, list[int]] = {}
        for zone, place in enumerate(self.places.room[: self.count].tolist()):
            found.setdefault(place, []).append(zone)
        return found

    def __iter__(self) -> Iterator[tuple[int, NDArray[np.int32]]]:
        return ((self.place(zone), self.matrix(zone)) for zone in range(self.count))
