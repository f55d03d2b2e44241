"""The local states of a mission's processes in local time.

A process's local state is the part of a location that its steps, clocks and deadlines depend on. It has the columns
that only the process touches, the shared columns that it reads, and, of a clause, its window. The local state of a
shared group of columns has their values, and the processes that read them: those take part when they are written.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from checker.engines.zones.difference_bounds import NONE
from checker.engines.zones.participants import Bits, Participants, WatchedParticipants
from checker.engines.zones.timed_automaton_of import Network


@dataclass
class LocalStates:
    """The local states of processes in the locations of an automaton.

    Attributes:
        network: The mission's automaton.
        participants: Those of the edges of that automaton, or of the one with an observer.
        behind: The mission's location behind each location.
        watch: For each location the state of the observer; None without one.
    """

    network: Network
    participants: Participants
    behind: NDArray[np.int64]
    watch: NDArray[np.int64] | None = None

    @cached_property
    def numbers(self) -> list[list[int]]:
        """For each process the number of its local state in each location."""
        found: list[list[int]] = []
        for process in range(self.participants.automaton.processes):
            values = self._values(process)
            varying = values[:, (values != values[0]).any(axis=0)]
            _, which = np.unique(varying, axis=0, return_inverse=True)
            found.append(which.ravel().tolist())
        return found

    def name(self, process: int) -> str:
        """Return the name of a process."""
        home, _ = self.homes
        if process not in self._reads:
            return f"cells_{process - int(home.max()) - 1}"
        agents, clauses, vehicles = self.participants.sizes
        member = home.tolist().index(process)
        if member < agents:
            return f"agent_{self.network.model.groups[0][member]}"
        if member < agents + clauses:
            return f"environment_{member - agents}"
        if member < agents + clauses + vehicles:
            return f"vehicle_{self.network.timing.endurances[member - agents - clauses][0]}"
        return "observer"

    def _values(self, process: int) -> NDArray[np.int64]:
        """Return for each location the part that belongs to a process."""
        home, cells = self.homes
        codes = self._codes
        if process not in self._reads:
            mine = cells == process
            return np.column_stack((codes[:, mine], *(reads[:, mine] for reads in self._reads.values())))
        members = np.flatnonzero(home == process).tolist()
        shared = np.where(self._reads[process] & (cells >= 0), codes, NONE)
        own = np.logical_or.reduce([self._touched[each] for each in members]) & (cells < 0)
        return np.column_stack((codes[:, own], shared, *map(self._window, members)))

    @cached_property
    def _codes(self) -> NDArray[np.int64]:
        """The code of each column in each location."""
        store = self.network.store
        rows, which = np.unique(self.network.of_locations.used[self.behind], return_inverse=True)
        codes = np.array([store.codes(row) for row in rows.tolist()], np.int64)
        return codes[which.ravel()]

    @cached_property
    def homes(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The process of each agent, clause and vehicle, and that of each shared column."""
        assert self.participants.division is not None
        home, cells = self.participants.division
        return home, cells[: self._codes.shape[1]]

    @cached_property
    def _touched(self) -> Bits:
        return self.participants.bits(self.participants.touched)[:, : self._codes.shape[1]]

    @cached_property
    def _reads(self) -> dict[int, Bits]:
        """For each process but the shared groups, for each location, the columns that decide its course."""
        found: dict[int, Bits] = {}
        for member, process in enumerate(self.homes[0].tolist()):
            reads = self._reads_of(member)[:, : self._codes.shape[1]]
            found[process] = found[process] | reads if process in found else reads
        return found

    def _reads_of(self, member: int) -> Bits:
        """Return for each location the columns that decide the course of an agent, clause, vehicle or observer."""
        if isinstance(self.participants, WatchedParticipants) and member == self.participants.base.total:
            return self.participants.read()[self.behind]
        rows = self.network.of_locations.used[self.behind].astype(np.int64)
        leaves = [self.network.model.classify(tree, rows) for tree in self._trees(member)]
        assert self.network.participants is not None
        sets = self.network.participants.bits(self.network.participants.reads.used)
        found: Bits = np.logical_or.reduce([sets[each] for each in leaves])
        return found

    def _trees(self, member: int) -> list[int]:
        """Return the trees of an agent, clause or vehicle."""
        agents, clauses, _ = self.participants.sizes
        loops, timed = self.network.model.loops, self.network.timed
        if member < agents:
            both = member, member + agents
            return [int(trees[each]) for trees in (loops.agents, timed.agents) for each in both]
        if member < agents + clauses:
            return [int(trees[member - agents]) for trees in (loops.clauses, timed.clauses)]
        return [int(timed.vehicles[member - agents - clauses])]

    def _window(self, member: int) -> NDArray[np.int64]:
        """Return for each location what only this member knows: the state of its window, or of the observer."""
        clause = member - self.participants.sizes[0]
        if isinstance(self.participants, WatchedParticipants) and member == self.participants.base.total:
            assert self.watch is not None
            return self.watch
        if clause in self.network.windows:
            digit = 3 ** self.network.windows.index(clause)
            found: NDArray[np.int64] = self.network.said.used[self.behind] // digit % 3
            return found
        return np.zeros(len(self.behind), np.int64)
