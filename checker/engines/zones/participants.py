"""The participants of each edge in local time, from the footprints of steps.

A column that one process writes and another one touches is shared. It is a process too, without clocks; those that the
same processes touch are one. The participants of a step are those processes whose columns it writes, and the shared
columns that it touches, or that such a process begins or ceases to read. What is shared is learned on the way, as the
constants of clocks are: a search begins again when more is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.decision_leaves import COPIES, COPIES_END, PAIR, STEP, WRITES, WRITES_END
from checker.engines.zones.step_footprints import LearnedFootprints
from checker.engines.zones.timed_automaton import EDGE, FOOTPRINT, TimedAutomaton

if TYPE_CHECKING:
    from checker.engines.fast.model.learner import Learner

WORD = 64
Bits = NDArray[np.bool_]


class Participants:
    """The footprints of an automaton's edges, and the processes that each of them joins.

    Attributes:
        sizes: The numbers of agents, clauses, and vehicles with an endurance.
        words: The words of a set of columns.
        numbers: The number of each footprint.
        division: The process of each agent, clause and vehicle, and that of each shared column, -1 for others.
    """

    def __init__(self, learner: Learner, automaton: TimedAutomaton, sizes: tuple[int, int, int]) -> None:
        self.learner = learner
        self.automaton = automaton
        self.sizes = sizes
        self.total = sum(sizes)
        self.begin()

    def begin(self) -> None:
        """Forget all footprints, and what processes touched."""
        self.words = max(2 * (len(self.learner.columns) // WORD + 1), 4)
        self.reads, self.writes, self.copies = (Growing(np.uint64) for _ in range(3))
        self.touched, self.wrote = (np.zeros(self.total * self.words, np.uint64) for _ in range(2))
        self.epoch = self._epoch
        self.see()
        self._count()

    def _count(self) -> None:
        """Begin to number footprints."""
        self.numbers: dict[bytes, int] = {}
        self.found: list[bytes] = []
        self.division: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None
        self.divide()

    @property
    def _epoch(self) -> tuple[int, int]:
        return self.learner.trees.forgotten, self.learner.awoken

    @property
    def is_void(self) -> bool:
        """Whether the footprints found so far may lack columns: a rule was learned anew, or a column has no bit."""
        return self._epoch != self.epoch or len(self.learner.columns) > WORD * self.words

    def see(self) -> None:
        """Note the columns of new leaves and transitions."""
        size, leaves = 8 * self.words, self.learner.leaves
        if len(self.learner.columns) > WORD * self.words:
            return
        for leaf in range(len(self.reads) // self.words, max(self.learner.paths, default=-1) + 1):
            self._add(self.reads, self.learner.paths.get(leaf, ()), size)
        for step in range(len(self.writes) // self.words, len(leaves.rule)):
            record = leaves.steps.room[STEP * step : STEP * (step + 1)].tolist()
            copies = leaves.copies.room[PAIR * record[COPIES] : PAIR * record[COPIES_END]].tolist()
            writes = leaves.writes.room[PAIR * record[WRITES] : PAIR * record[WRITES_END] : PAIR].tolist()
            self._add(self.writes, (*writes, *copies[::PAIR]), size)
            self._add(self.copies, copies[1::PAIR], size)

    def _add(self, to: Growing, columns: object, size: int) -> None:
        bits = sum(1 << column for column in set(columns))  # type: ignore[call-overload]
        first = to.extend(self.words)
        to.room[first : first + self.words] = np.frombuffer(bits.to_bytes(size, "little"), np.uint64)

    def tables(self, begun: int, edges: int) -> LearnedFootprints:
        """Return the tables of the loops, with room for the footprints of so many new edges."""
        agents, clauses, _ = self.sizes
        writing = np.zeros(len(self.learner.trees.root), np.int8)
        writing[list(self.learner.writing_trees)] = 1
        size = self.size
        scratch = (np.zeros(each, np.uint64) for each in (size, self.words, self.words))
        self.fresh = np.zeros(edges * size, np.uint64)
        known = (self.reads.room, self.writes.room, self.copies.room, writing, self.touched, self.wrote)
        here = np.zeros(self.total * self.words, np.uint64)
        numbers = (self.words, agents, clauses, self.total)
        return LearnedFootprints._make((*numbers, *known, here, *scratch, begun, self.fresh))

    @property
    def size(self) -> int:
        """The words of a footprint."""
        return self.words + (self.total + WORD - 1) // WORD

    def take(self, begun: int, end: int) -> None:
        """Give the new edges the numbers of their footprints."""
        if end <= begun:
            return
        size = self.size
        rows = self.fresh[: (end - begun) * size].reshape(-1, size)
        kinds, which = np.unique(rows, axis=0, return_inverse=True)
        numbers = np.array([self._number(each.tobytes()) for each in kinds], np.int32)
        self.automaton.edges.room[EDGE * begun + FOOTPRINT : EDGE * end : EDGE] = numbers[which.ravel()]
        self._join()

    def _number(self, footprint: bytes) -> int:
        if footprint not in self.numbers:
            self.numbers[footprint] = len(self.found)
            self.found.append(footprint)
        return self.numbers[footprint]

    # --- processes

    def divide(self) -> bool:
        """Work out the processes; return whether they changed."""
        touched, wrote = self.bits(self.touched), self.bits(self.wrote)
        begin = sum(self.sizes[:2])
        home = np.arange(self.total)
        for vehicle in range(begin, begin + self.sizes[2]):
            writers = np.flatnonzero((wrote[:begin] & touched[vehicle]).any(axis=1))
            home[vehicle] = writers[0] if len(writers) == 1 else begin if len(writers) else 0
            if len(writers) > 1:
                home[vehicle] = -1
        home[begin + self.sizes[2] :] = -1
        own = np.flatnonzero(home == -1)
        home[own] = begin + np.arange(len(own))
        joined = np.zeros((begin + len(own), touched.shape[1]), np.bool_)
        np.logical_or.at(joined, home, touched)
        shared = self.shared(joined, wrote)
        groups, which = np.unique(joined[:, shared], axis=1, return_inverse=True)
        cells = np.full(touched.shape[1], -1)
        cells[shared] = len(joined) + which.ravel()
        before, self.division = self.division, (home, cells)
        if before is not None and all(map(np.array_equal, before, self.division)):
            return False
        self.automaton.processes = len(joined) + (groups.shape[1] if len(shared) else 0)
        self.automaton.takes_from.size = self.automaton.takes.size = 0
        self._join()
        return True

    @staticmethod
    def shared(touched: Bits, wrote: Bits) -> NDArray[np.int64]:
        """Return the columns that several processes touch and some write."""
        return np.flatnonzero((touched.sum(axis=0) > 1) & wrote.any(axis=0))

    def _join(self) -> None:
        """Note the participants of footprints that have none yet."""
        automaton, division = self.automaton, self.division
        if not len(automaton.takes_from):
            automaton.takes_from.append(0)
        new = self.found[len(automaton.takes_from) - 1 :]
        if not new or division is None:
            return
        home, cells = division
        bits = self.bits(np.frombuffer(b"".join(new), np.uint64), self.size)
        begin = WORD * (self.size - self.words)
        for each in bits:
            columns = cells[each[begin:]]
            members = np.union1d(home[each[: self.total]], columns[columns >= 0])
            automaton.takes.append(*members.tolist())
            automaton.takes_from.append(len(automaton.takes))

    def of(self, footprint: int) -> tuple[int, ...]:
        """Return the participants of a footprint, in their order."""
        begin, end = self.automaton.takes_from.room[footprint : footprint + 2]
        return tuple(self.automaton.takes.room[begin:end].tolist())

    def bits(self, words: NDArray[np.uint64], size: int | None = None) -> Bits:
        """Return sets of so many words, those of columns by default, a row each."""
        rows = words.reshape(-1, self.words if size is None else size)
        found: Bits = np.unpackbits(rows.view(np.uint8), axis=1, bitorder="little").astype(np.bool_)
        return found


class WatchedParticipants(Participants):
    """The participants of the edges of an automaton with an observer, which is a process that reads more columns.

    Attributes:
        base: Those without the observer.
        kinds, kind_of: The sets of columns that the observer reads, and that of each of the mission's locations.
        process: The observer.
    """

    def __init__(self, base: Participants, automaton: TimedAutomaton, reads: NDArray[np.uint64]) -> None:
        self.base = base
        self.learner, self.words, self.sizes, self.total = (
            base.learner,
            base.words,
            base.sizes,
            base.total + 1,
        )
        self.automaton = automaton
        kinds, which = np.unique(reads, axis=0, return_inverse=True)
        self.kinds = [int.from_bytes(each.tobytes(), "little") for each in kinds]
        self.kind_of = which.ravel()
        self.touched = np.concatenate((base.touched, np.bitwise_or.reduce(kinds, axis=0)))
        self.wrote = np.concatenate((base.wrote, np.zeros(self.words, np.uint64)))
        self._count()
        assert self.division is not None
        self.process = int(self.division[0][-1])

    def footprints(
        self, numbers: NDArray[np.int32], sources: NDArray[np.int32], targets: NDArray[np.int32]
    ) -> NDArray[np.int32]:
        """Return the numbers of footprints with the observer, for edges between the mission's locations."""
        most = len(self.kinds)
        several = (numbers * np.int64(most) + self.kind_of[sources]) * most + self.kind_of[targets]
        met, which = np.unique(several, return_inverse=True)
        known = [self._footprint(each // most**2, each // most % most, each % most) for each in met.tolist()]
        found: NDArray[np.int32] = np.array(known, np.int32)[which]
        return found

    def _footprint(self, number: int, source: int, target: int) -> int:
        """Return the number of a footprint with the observer, which reads these kinds of columns."""
        before, after = self.kinds[source], self.kinds[target]
        begin = WORD * (self.base.size - self.words)
        whole = int.from_bytes(self.base.found[number], "little")
        members, columns = whole & ((1 << begin) - 1), whole >> begin
        if columns & before:
            members |= 1 << self.base.total
            columns |= before ^ after
        begin = WORD * (self.size - self.words)
        return self._number((members | columns << begin).to_bytes(8 * self.size, "little"))

    def join(self) -> None:
        """Note the participants of all edges."""
        self._join()

    def read(self) -> Bits:
        """Return the columns that the observer reads in each of the mission's locations."""
        kinds = [each.to_bytes(8 * self.words, "little") for each in self.kinds]
        return self.bits(np.frombuffer(b"".join(kinds), np.uint64))[self.kind_of]
