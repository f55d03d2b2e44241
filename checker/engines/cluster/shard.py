"""A shard of an exploration: the rows that belong to one worker, and the rules that it has learned.

Each round it expands some rows of its layer. Successors that belong to others leave in parcels; of those that come, the
new ones become rows. It knows nothing of how parcels travel.
"""

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.cluster import kernel
from checker.engines.cluster.keys import Keys
from checker.engines.cluster.transfer import Dictionary, Entry, Parcel, Told
from checker.engines.fast import kernel as loops
from checker.engines.fast.columns import WORD, Packing, shifts
from checker.engines.fast.kernel import AT, CROWDS, CUT, EXPANDED, GATHERED, LIMIT, SIZE
from checker.engines.fast.learner import Learner
from checker.engines.fast.origins import Elsewhere
from checker.engines.fast.rows import Rows
from checker.engines.fast.space import FIRST_ROWS, MOST_ROWS, Space
from checker.engines.fast.writing import Deeper, Varies
from checker.limits import memory_taken
from semantics.state.configuration import Configuration

SENT = 1 << 17
"""How many of the rows that were sent last are remembered, so as not to be sent again."""


@dataclass(frozen=True, slots=True)
class Standing:
    """How far a worker has come.

    Attributes:
        size: How many rows it has.
        expanded: How many of them were expanded.
        end: Where its layer ends.
        transitions: How many transitions the expanded ones have.
        cut: Whether the limit left some out.
        crowded: Whether some were not followed.
        runs: How many times rules were run in Python.
        memory: How many bytes its process takes.
        used: How many bytes rows, origins and the visited set take.
        sent: How many bytes of rows it sent so far.
    """

    size: int
    expanded: int
    end: int
    transitions: int
    cut: bool
    crowded: bool
    runs: int
    memory: int
    used: int
    sent: int


def column_at(where: Packing) -> NDArray[np.uint64]:
    """Return the column of each bit of a row."""
    found = np.zeros(WORD * where.words, np.uint64)
    for column, (word, shift, mask) in enumerate(zip(where.word, where.shift, where.mask, strict=True)):
        first = WORD * int(word) + int(shift)
        found[first : first + int(mask).bit_length()] = column
    return found


def writable(words: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return words that the loops take: what comes from others is read-only, for which they would be compiled anew."""
    return words if words.flags.writeable else np.array(words)


def spelling(
    packing: Packing, codes: NDArray[Any], begins: NDArray[Any], numbers: NDArray[Any]
) -> kernel.Spelling:
    """Return how rows in another packing and other codes are read (see `kernel.Spelling`)."""
    varying = np.flatnonzero(packing.mask)
    known = (each.astype(np.uint64) for each in (varying, codes, begins, numbers))
    return kernel.Spelling(writable(packing.columns), *known)


class Outbox:
    """Successors that belong to other workers.

    Attributes:
        rows: Packed rows.
        origins: What each was reached from.
        owners: Whose each is.
    """

    def __init__(self) -> None:
        self.rows: list[NDArray[np.uint64]] = []
        self.origins: list[NDArray[np.uint32]] = []
        self.owners: list[NDArray[np.int32]] = []

    def add(self, rows: NDArray[np.uint64], origins: NDArray[np.int64], owners: NDArray[np.int32]) -> None:
        """Put in rows, one in each line."""
        self.rows.append(rows)
        self.origins.append(origins.astype(np.uint32))
        self.owners.append(owners)

    def repack(self, old: Packing, new: Packing) -> None:
        """Pack what is in it anew."""
        packed = [np.zeros((len(rows), new.words), np.uint64) for rows in self.rows]
        for rows, to in zip(self.rows, packed, strict=True):
            flat = to.ravel()
            flat[: rows.size] = rows.ravel()
            loops.repack(flat, len(rows), shifts(old, new), old.words, new.words)
        self.rows = packed

    def taken_out(self, peer: int, words: int) -> tuple[NDArray[np.uint64], NDArray[np.uint32]]:
        """Return the rows of one worker, in their order, and what they were reached from."""
        which = [np.flatnonzero(owners == peer) for owners in self.owners]
        rows = [np.zeros((0, words), np.uint64)]
        rows += [each[chosen] for each, chosen in zip(self.rows, which, strict=True)]
        origins = [np.zeros(0, np.uint32)]
        origins += [each[chosen] for each, chosen in zip(self.origins, which, strict=True)]
        return np.concatenate(rows).ravel(), np.concatenate(origins)


class Shard(Space):
    """One worker's rows.

    Attributes:
        me: Its number.
        workers: How many there are.
        begins: Where each layer begins, up to the one that is expanded.
        end: Where that ends.
        rules_before: How many transitions each rule had in what was resumed.
        happened_before: The words of what the environment did in it.
        told: What each worker was told of this one's codes.
        dictionaries: What is known of each worker's codes.
        column_at: The column of each bit of a row, in the packing for which it was made.
        varying: The columns that have more than one value there.
    """

    ORIGINS = Elsewhere
    """Rows of other workers have numbers, too: row · workers + worker."""

    PLAIN = sys.maxsize  # rows go from worker to worker

    def __init__(self, initial: Configuration, pending: int, me: int, workers: int) -> None:
        self.me = me
        self.workers = workers
        self.sent = 0
        self.outbox = Outbox()
        learner = Learner(initial.setting, initial.state, pending)  # type: ignore[arg-type]  # a stored one
        self.keys = Keys(learner.columns)
        self.located_in: Packing | None = None
        super().__init__(learner, None)
        self.start()

    # --- beginning ------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin with the initial configuration alone, or with nothing where that is another's."""
        self.clear()
        first = self.packed(self.learner.columns.codes(self.learner.still))
        self.rows.words[: len(first)] = first
        self.end = int(self.owners_of(first, np.zeros(1, np.int64))[0] == self.me)
        self.state[SIZE] = self.end
        self._rebuild(2 * FIRST_ROWS)
        self._make_room(len(self.batch.hashes))

    def clear(self) -> None:
        """Forget all rows, what others were told, and what they have told; the values that it knows are kept.

        What was learned is learned again: rows at which it was learned are gone, and a checkpoint needs to name some.
        """
        self.learner.forget()
        self.state[[AT, EXPANDED, SIZE, CUT, CROWDS, GATHERED]] = 0
        self.state[LIMIT] = MOST_ROWS
        self.rows = Rows(self.packing.words, self.rows.room, self.ORIGINS)
        self.learner.columns.codes(self.learner.still)  # makes columns that only the first row needs
        self._see()
        self.counts.used[:] = 0
        self.begins, self.end = [0], 0
        self.learned = []
        self.rules_before: Counter[str] = Counter()
        self.happened_before: frozenset[str] = frozenset()
        self.told = [Told() for _ in range(self.workers)]
        self.dictionaries = [Dictionary() for _ in range(self.workers)]
        self.outbox = Outbox()
        self._forget_sent()

    def packed(self, codes: list[int]) -> NDArray[np.uint64]:
        """Return the words of a row."""
        where = self.packing
        words = np.zeros(where.words, np.uint64)
        for word, shift, code in zip(where.word, where.shift, codes, strict=True):
            words[word] |= np.uint64(code) << shift
        return words

    def _see(self) -> None:
        """Let the loops see what is known now."""
        super()._see()
        self.keys.refresh()
        if self.located_in is not self.packing:
            self.column_at, self.located_in = column_at(self.packing), self.packing
            self.varying = np.flatnonzero(self.packing.mask).astype(np.uint64)

    def _pack(self) -> None:
        """Pack the rows anew where a column has outgrown its bits, and those that wait to be sent."""
        old = self.packing
        super()._pack()
        new = self.packing
        if new.words != old.words or not np.array_equal(new.columns[: len(old.columns)], old.columns):
            self.outbox.repack(old, new)
            self._forget_sent()

    def _forget_sent(self) -> None:
        self.lately = np.zeros(SENT * (self.packing.words + 1), np.uint64)

    # --- rounds ---------------------------------------------------------------------------------------------------

    def expand(self, layer: int, most: int) -> tuple[Parcel, ...]:
        """Expand at most so many rows of a layer, and return a parcel for each worker."""
        self.enter(layer)
        until = min(self.expanded + most, self.end)
        self.state[AT] = self.expanded
        while self.expanded < until:
            self._make_room(len(self.batch.hashes))
            known = loops.gather(self.model, self.rows.words, self.rows.folded, self.batch, self.state, until)
            self._deal()
            if not known:
                self._miss()
        return self.parcels()

    def enter(self, layer: int) -> None:
        """Begin a layer, unless it was begun."""
        if layer == len(self.begins):
            self.begins.append(self.end)
            self.end = self.size

    def _deal(self) -> None:
        """Take in those of the batch that are this worker's, and lay the others out to be sent."""
        batch, count = self.batch, int(self.state[GATHERED])
        chosen, owners = np.zeros(count, np.int64), np.zeros(count, np.int32)
        found = kernel.deal(
            self.rows.words,
            self.rows.origins.loops,
            self.table.room,
            batch,
            count,
            self.owning(),
            self.me,
            self.lately,
            chosen,
            owners,
            self.counts.used,
            self.state,
        )
        self.state[GATHERED] = 0
        self.state[EXPANDED] = self.state[AT]
        others = chosen[:found]
        rows = batch.words.reshape(-1, self.packing.words)[others]
        self.outbox.add(rows, batch.origins[others], owners[:found])

    def owning(self) -> kernel.Owning:
        """Return what decides whose a row is."""
        columns, keys = self.packing.columns, self.keys
        return kernel.Owning(columns, self.varying, self.column_at, keys.keys, keys.begins, self.workers)

    def owners_of(self, rows: NDArray[np.uint64], origins: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the worker that each of some rows belongs to, which were reached from these of its own."""
        owners = np.zeros(len(origins), np.int32)
        kernel.owners_of(self.rows.words, origins, rows, self.packing.words, self.owning(), owners)
        return owners

    def parcels(self, *, always: bool = False) -> tuple[Parcel, ...]:
        """Return what waits to be sent, a parcel for each worker; with news in each only if it has rows, or always."""
        found = []
        for peer in range(self.workers):
            rows, origins = self.outbox.taken_out(peer, self.packing.words)
            tells = peer != self.me and (always or len(origins))
            news = self.told[peer].news(self.learner.columns) if tells else ()
            found.append(Parcel(news, self.packing, rows, origins))
        self.sent += sum(parcel.bytes for parcel in found)
        self.outbox = Outbox()
        return tuple(found)

    def take(self, *parcels: Parcel) -> None:
        """Take in what the others have sent, in their order."""
        self.hear(parcels)
        for peer, parcel in enumerate(parcels):
            for count in self.translated(peer, parcel):
                arrays = (self.rows.words, self.rows.origins.loops, self.table.room)
                loops.store(*arrays, None, None, self.batch, 0, count, self.state)

    def hear(self, parcels: Sequence[Parcel]) -> None:
        """Take in the values that the others have told."""
        heard = [(peer, entry) for peer, parcel in enumerate(parcels) for entry in parcel.news]
        for peer, entry in heard:
            self._note(self.dictionaries[peer], entry)
        if heard:
            self._see()

    def _note(self, dictionary: Dictionary, entry: Entry) -> None:
        """Note another worker's values; a cell that varies there is not still here either."""
        learner, cell = self.learner, entry.place[0]
        if len(entry.place) == 3 and learner.columns.dig(cell, entry.place[1] + 1):
            learner.relearn(Deeper(cell))
        number = learner.columns.number(entry.place)
        codes = [learner.columns.all[number].code(value) for value in entry.values]
        dictionary.add(entry.column, number, codes)
        if any(codes) and cell not in learner.varying:
            learner.relearn(Varies(cell))

    def translated(self, peer: int, parcel: Parcel) -> Iterator[int]:
        """Put the rows of a parcel into the batch, some at a time; yield how many there are."""
        if not len(parcel):
            return
        room, rows = len(self.batch.hashes), writable(parcel.rows)
        read = spelling(parcel.packing, *self.dictionaries[peer].arrays())
        for first in range(0, len(parcel), room):
            self._make_room(room)
            origins = parcel.origins[first : first + room].astype(np.int64) * self.workers + peer
            self.batch.origins[: len(origins)] = origins
            kernel.translate(
                rows,
                first,
                len(origins),
                parcel.packing.words,
                read,
                self.packing.columns,
                self.packing.words,
                self.batch.words,
                self.batch.hashes,
            )
            yield len(origins)

    # --- learning ---------------------------------------------------------------------------------------------------

    def go_on(self) -> None:
        """Learn what was not known where the loops stopped."""
        self._miss()

    def learn_at(self, codes: list[int]) -> None:
        """Learn what follows from a row of codes, which takes the place of all rows."""
        self.rows.words[: self.packing.words] = self.packed(codes)
        self.state[SIZE], self.state[AT] = 1, 0
        while not self.state[AT]:
            known = loops.gather(self.model, self.rows.words, self.rows.folded, self.batch, self.state, 1)
            self.state[GATHERED] = 0
            if not known:
                self._miss()
        self.state[SIZE], self.state[AT] = 0, 0

    def look_around(self) -> None:
        """Find rows again that were put in their place."""
        self._rebuild(2 * max(self.size, FIRST_ROWS))
        self._make_room(len(self.batch.hashes))

    def has_origins_in(self, boundaries: Sequence[tuple[int, ...]]) -> bool:
        """Tell whether each row was reached from one of the layer before, given where all workers' layers begin.

        The first configuration, the only one of its layer, is its own origin.
        """
        first = self.rows.origins.room[: self.boundaries[1]]
        if sum(each[1] for each in boundaries) != 1 or np.any(first != self.me):
            return False
        for layer, (begin, end) in enumerate(pairwise(self.boundaries[1:])):
            rows, workers = np.divmod(self.rows.origins.room[begin:end], np.uint64(self.workers))
            begins, ends = (np.array([each[k] for each in boundaries], np.uint64) for k in (layer, layer + 1))
            if not np.all((begins[workers] <= rows) & (rows < ends[workers])):
                return False
        return True

    # --- limits, counts -------------------------------------------------------------------------------------------

    def keep(self, size: int) -> None:
        """Keep so many rows, and take in no more: the limit of configurations was met."""
        self.state[SIZE] = self.state[LIMIT] = size
        self.state[CUT] += 1
        self._rebuild(len(self.table.room))

    def rules(self, *, followed: bool = True) -> Counter[str]:
        """Return how many transitions each rule has."""
        return super().rules(followed=followed) + self.rules_before

    @property
    def boundaries(self) -> tuple[int, ...]:
        """Where each layer begins, and where the last ends: that of what was reached from the one that is expanded."""
        return (*self.begins, self.end, self.size)

    def standing(self) -> Standing:
        """Return how far it has come."""
        return Standing(
            self.size,
            self.expanded,
            self.end,
            sum(self.rules().values()),
            self.was_cut,
            self.is_crowded,
            self.learner.runs,
            memory_taken(),
            self.bytes_used,
            self.sent,
        )
