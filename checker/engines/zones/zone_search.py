"""A search through the zones of a timed automaton."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.zones import keep_zones, make_zones
from checker.engines.zones.difference_bounds import FREE
from checker.engines.zones.timed_automaton import EDGES, LOCATION, SIZE, UNKNOWN, TimedAutomaton
from checker.engines.zones.zone_chunks import ZoneChunks
from checker.engines.zones.zone_tables import (
    AT,
    COUNT,
    COVERED,
    DATED,
    DEPTH,
    FAR,
    FOUND,
    FULL,
    GROUP,
    GROUPS,
    LAYER,
    LONGEST,
    MISS,
    MISSED,
    MOST_LATE,
    RANK,
    RANKED,
    STATE,
    USED,
    CompiledAutomaton,
    ZoneBatch,
    Zones,
)

CHUNK = 1 << 14
"""Zones kept between two checks of the time."""

ALONE = np.zeros(1, np.int32)
"""The participants of each step with one clock."""


class Search:
    """The zones reached from a location and clock values, layer by layer.

    Attributes:
        automaton: The searched automaton.
        is_local: Whether each process has a date; else there is one clock.
        threads: The most threads that it uses; the results are the same for every number.
        model, zones, state: The tables of the loops, and their state.
        largest: The most rows of a matrix.
        layers: The first zone of each layer.
    """

    def __init__(
        self,
        automaton: TimedAutomaton,
        location: int,
        ages: Sequence[int],
        *,
        is_local: bool = False,
        threads: int = 1,
    ) -> None:
        self.model: CompiledAutomaton
        self.zones: Zones
        self.automaton = automaton
        self.is_local = is_local
        self.threads = threads
        self.begins, self.sums, self.dated_from = (Growing(np.int64) for _ in range(3))
        self.bounds, self.places, self.following, self.dated = (Growing(np.int32) for _ in range(4))
        self.depths = Growing(np.int32)
        self.heads, self.groups, self.ranks = (Growing(np.int32) for _ in range(3))
        self.rows, self.left = Growing(np.int32), Growing(np.int32)
        self.location, self.ages = location, tuple(ages)
        self.state = np.zeros(STATE, np.int64)
        self._chunks = ZoneChunks(self, threads)
        self._begin()

    def _begin(self) -> None:
        self._chunks.drop()
        self.heads.size = self.ranks.size = 0
        self.state[:] = 0
        self.state[FOUND], self.state[LONGEST] = -1, FREE
        self.layers, self._deepest, self._met = [0], 0, 1
        self._see(1)
        self._enter_first()
        self._settle()

    def _enter_first(self) -> None:
        """Keep the zones with which the search begins."""
        row = int(self.automaton.rows.room[self.location])
        self.rows.room[:RANK], self.ranks.room[row], self.state[RANKED] = (row, 0), 0, 1
        ages = np.array((0, *self.ages), np.int32)
        self._enter(self.location, ages[:, None] - ages[None, :])

    def _enter(self, location: int, ages: NDArray[np.int32]) -> None:
        """Keep a zone with which the search begins: all processes have one date."""
        which = np.array([*[0] * self.processes, *range(1, len(ages))])
        batch = self._chunks.batch(1 << MOST_LATE)
        batch.e[: len(which), : len(which)] = ages[which[:, None], which]
        model = self.model._replace(takes=np.arange(self.processes, dtype=np.int32))
        make_zones.enter(model, location, 0, self.processes, batch)
        self._store(batch)

    def _store(self, batch: ZoneBatch, until: int = int(FREE)) -> None:
        """Store a batch, up to the row after which there are `until` zones."""
        while keep_zones.store(self.model, self.zones, self.state, batch, until) == FULL:
            self._see(int(self.state[MISSED]))

    # --- searching

    def advance(self, zones: int = CHUNK) -> bool:
        """Expand zones until so many more are kept; return whether any are left to expand.

        The search ends early after the first layer with the goal.
        """
        until = self.count + zones
        with self._chunks:
            while self._goes_on and self.count < until:
                self._advance(until)
        return self._goes_on

    def _advance(self, until: int) -> None:
        part = self._chunks.first()
        self._store(part.batch, until)
        if not part.is_stored:
            return
        if self._chunks.stored() == MISS:
            self._chunks.drop()
            self.learn()
            self._see(1)
        elif self.state[AT] == self.state[LAYER]:
            self._settle()

    @property
    def _goes_on(self) -> bool:
        return bool(self.state[AT] < self.count) and not 0 <= self.found < len(self.layers) - 1

    def _settle(self) -> None:
        """Complete the layer under construction, and begin another one."""
        begin, end = int(self.state[LAYER]), self.count
        alive = np.flatnonzero(self.following.room[begin:end] != COVERED)
        ranks = self.ranks.room[self.automaton.rows.room[self.places.room[begin + alive]]]
        by_rank = np.argsort(ranks, kind="stable")
        keep_zones.arrange(self.model, self.zones, self.state, alive[by_rank] + begin)
        self._ends = np.append(np.flatnonzero(np.diff(ranks[by_rank])) + begin + 1, self.count)
        self._deepest, self._met = self.deepest, int(self.state[RANKED])
        self.state[LAYER] = self.count
        if self.count > begin:
            self.state[DEPTH] += 1
            self.layers.append(self.count)

    def end_of_row(self, zone: int) -> int:
        """Return the first end of a row's zones in the layer that is not before a zone."""
        return int(self._ends[min(int(np.searchsorted(self._ends, zone)), len(self._ends) - 1)])

    def learn(self) -> None:
        """Work out the edges of reached locations."""
        raise AssertionError("the transitions of some location are unknown")

    def waiting(self) -> NDArray[np.int64]:
        """Return the locations of unexpanded zones whose edges are unknown."""
        reached = np.unique(self.places.room[int(self.state[AT]) : self.count]).astype(np.int64)
        found: NDArray[np.int64] = reached[self.automaton.locations.used[EDGES::LOCATION][reached] == UNKNOWN]
        return found

    def again(self) -> None:
        """Restart the search."""
        self.automaton.forget()
        self._begin()

    def spill(self, folder: Path) -> None:
        """Move the zones to files in a folder.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self._chunks.rest()
        for each in (
            self.begins,
            self.sums,
            self.bounds,
            self.places,
            self.depths,
            self.following,
            self.dated,
            self.dated_from,
        ):
            each.spill(folder)
        self._see(1)

    def finish(self, look: Callable[[], None]) -> None:
        """Search to the end or to the goal, with periodic checks of the time."""
        while self.advance():
            look()

    def _see(self, zones: int) -> None:
        """Update the loops' view of the automaton, with room for so many more zones."""
        self._chunks.rest()
        automaton = self.automaton
        self.processes = automaton.processes if self.is_local else 1
        self.largest = automaton.largest + self.processes - 1
        for each in (self.begins, self.sums, self.places, self.depths, self.following, self.dated_from):
            each.size = self.count
            each.reserve(zones + CHUNK)
        for each, used in ((self.bounds, USED), (self.dated, DATED)):
            each.size = int(self.state[used])
            each.reserve((zones + 1) * self.largest**2)
        self.groups.size = GROUP * int(self.state[GROUPS])
        self.groups.reserve(GROUP * (zones + CHUNK))
        missing = len(automaton) - len(self.heads)
        if missing:
            self.heads.extend(missing, -1)
            self.left.extend(len(automaton) - len(self.left))
        rows = int(automaton.rows.used.max(initial=-1)) + 1
        if rows > len(self.ranks):
            self.ranks.extend(rows - len(self.ranks), -1)
            self.rows.reserve(RANK * rows)
        parts = (
            automaton.locations,
            automaton.edges,
            automaton.tests,
            automaton.sources,
            automaton.deadlines,
        )
        clocks = (automaton.clocks, automaton.lower, automaton.upper, automaton.rows, self.left)
        takes = (ALONE, ALONE) if self.processes == 1 else (automaton.takes_from.room, automaton.takes.room)
        rooms = (*(each.room for each in (*parts, *clocks)), *takes)
        self.model = CompiledAutomaton._make((*rooms, self.processes))
        dated = (self.dated, self.dated_from)
        kept = (self.bounds, self.begins, *dated, self.sums, self.places, self.depths, self.following)
        self.zones = Zones(*(each.room for each in (*kept, self.heads, self.ranks, self.rows, self.groups)))

    # --- results

    @property
    def is_far(self) -> bool:
        """Whether dates were too far apart to be counted."""
        return bool(self.state[FAR])

    @property
    def count(self) -> int:
        """The number of zones."""
        return int(self.state[COUNT])

    @property
    def followed(self) -> int:
        """The number of expanded zones."""
        return int(self.state[AT])

    @property
    def found(self) -> int:
        """The least number of steps to the goal; -1 if it was not found."""
        return int(self.state[FOUND])

    @property
    def deepest(self) -> int:
        """The depth at which the last row was discovered."""
        return int(self.state[DEPTH]) if self.state[RANKED] > self._met else self._deepest

    @property
    def order(self) -> NDArray[np.int64]:
        """The discovered rows: the fewest steps first, then by the rank of the predecessor and the step from there."""
        return self.rows.room[: RANK * int(self.state[RANKED]) : RANK].astype(np.int64)

    @property
    def origins(self) -> NDArray[np.int64]:
        """For each discovered row the rank of its predecessor."""
        return self.rows.room[1 : RANK * int(self.state[RANKED]) : RANK].astype(np.int64)

    def depth(self, zone: int) -> int:
        """Return the depth of a zone."""
        return int(np.searchsorted(self.layers, zone, side="right")) - 1

    def layer(self, depth: int) -> range:
        """Return the zones of a depth."""
        ends = [*self.layers[depth + 1 :], self.count]
        return range(self.layers[depth], ends[0])

    def place(self, zone: int) -> int:
        """Return the location of a zone."""
        return int(self.places.room[zone])

    def matrix(self, zone: int) -> NDArray[np.int32]:
        """Return the matrix of a zone."""
        size = int(self.automaton.locations.room[LOCATION * self.place(zone) + SIZE])
        begin = int(self.begins.room[zone])
        return self.bounds.room[begin : begin + size * size].reshape(size, size)

    def by_place(self) -> dict[int, NDArray[np.int64]]:
        """Return the zones of each location."""
        places = self.places.room[: self.count]
        order = np.argsort(places, kind="stable")
        met, begins = np.unique(places[order], return_index=True)
        return dict(zip(met.tolist(), np.split(order, begins[1:]), strict=True))

    def __iter__(self) -> Iterator[tuple[int, NDArray[np.int32]]]:
        return ((self.place(zone), self.matrix(zone)) for zone in range(self.count))
