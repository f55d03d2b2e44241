"""A shard of an exploration: the rows of one worker, and the rules that it has learned.

In each round it expands some rows of its layer. Successors of other workers leave in parcels; new rows arrive in
theirs. The transport of parcels is elsewhere.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bigraphs.resources import memory_taken
from checker.engines.cluster import kernel
from checker.engines.cluster.divided_paths import DividedPaths, ReducedRound, place_of
from checker.engines.cluster.row_keys import Keys
from checker.engines.cluster.transfer import ColumnUpdate, Dictionary, RowParcel, SentValues
from checker.engines.cluster.worker_links import Links
from checker.engines.fast.model.columns import WORD, Packing, shifts
from checker.engines.fast.model.effects import Deeper, Varies
from checker.engines.fast.model.learned_model import AT, EXPANDED, SIFTED, SIZE, SuccessorBatch
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search.expander import Expander
from checker.engines.fast.search.row_search import choosing, chosen_steps, exchanging
from checker.engines.fast.search.rule_model import RuleModel
from checker.engines.fast.store import repacking
from checker.engines.fast.store.kernel import count as count_steps
from checker.engines.fast.store.origins import Elsewhere
from checker.engines.fast.store.row_store import FIRST_ROWS, RowFormat, RowStore
from checker.engines.fast.survey.row_survey import RowSurvey
from checker.reduction.reducer import Reduced
from semantics.state.configuration import Configuration

HALF, LOW = 32, (1 << 32) - 1
"""In a parcel, the low half of an origin is the sender's row; with partial-order reduction, the high half the mover."""

SENT = 1 << 17
"""The size of the cache of recently sent rows, which are not sent again."""


@dataclass(frozen=True, slots=True)
class ShardProgress:
    """A worker's progress.

    Attributes:
        size: The number of its rows.
        expanded: The number of expanded rows.
        end: The end of its layer.
        transitions: The number of transitions of the expanded rows.
        cut: Whether the limit left configurations out.
        crowded: Whether some rows were not expanded because an agent is crowded.
        runs: The number of runs of rules in Python.
        memory: The bytes of memory of its process.
        used: The bytes of rows, origins and visited set.
        sent: The bytes of rows sent so far.
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
    """Return a writable array: received ones are read-only, a type for which the loops would be compiled again."""
    return words if words.flags.writeable else np.array(words)


def spelling(
    packing: Packing, codes: NDArray[Any], begins: NDArray[Any], numbers: NDArray[Any]
) -> kernel.Spelling:
    """Return the translation from another packing and other codes (see `kernel.Spelling`)."""
    varying = np.flatnonzero(packing.mask)
    known = (each.astype(np.uint64) for each in (varying, codes, begins, numbers))
    return kernel.Spelling(writable(packing.columns), *known)


class Outbox:
    """Successors that belong to other workers.

    Attributes:
        packing: The packing of the rows.
        rows: Packed rows.
        origins: The origin of each.
        owners: The worker of each.
    """

    def __init__(self, packing: Packing) -> None:
        self.packing = packing
        self.rows: list[NDArray[np.uint64]] = []
        self.origins: list[NDArray[Any]] = []
        self.owners: list[NDArray[np.int32]] = []

    def add(self, rows: NDArray[np.uint64], origins: NDArray[Any], owners: NDArray[np.int32]) -> None:
        """Add rows, one in each line of the array."""
        self.rows.append(rows)
        self.origins.append(origins)
        self.owners.append(owners)

    def repack(self, new: Packing) -> None:
        """Repack the rows in it."""
        packed, old = [np.zeros((len(rows), new.words), np.uint64) for rows in self.rows], self.packing
        for rows, to in zip(self.rows, packed, strict=True):
            flat = to.ravel()
            flat[: rows.size] = rows.ravel()
            repacking.repack(flat, len(rows), shifts(old, new), old.words, new.words)
        self.rows, self.packing = packed, new

    def taken_out(self, peer: int) -> tuple[NDArray[np.uint64], NDArray[Any]]:
        """Return the rows for one worker, in order, with their origins."""
        which = [np.flatnonzero(owners == peer) for owners in self.owners]
        rows = [np.zeros((0, self.packing.words), np.uint64)]
        rows += [each[chosen] for each, chosen in zip(self.rows, which, strict=True)]
        origins: list[NDArray[Any]] = [np.zeros(0, np.uint32)]
        origins += [each[chosen] for each, chosen in zip(self.origins, which, strict=True)]
        return np.concatenate(rows).ravel(), np.concatenate(origins)


class Shard:
    """The rows of one worker.

    Attributes:
        me: The worker's number.
        workers: The number of workers.
        reduce: The reductions, None for none.
        store: Its rows. An origin may be another worker's row: its number is row · workers + worker.
        model: The rules that it has learned.
        expander: Makes the successors of its rows.
        keys: The keys of values, from which a row's worker is computed.
        choosing: What chooses ample sets; None without partial-order reduction.
        paths: With it, the paths of its cycle proviso.
        round: With it, the rows of this round.
        steps: With it, the steps of ample sets.
        answers: The places of the rows last received from each worker.
        outbox: The successors that wait for sending.
        begins: The first row of each layer, up to the one in expansion.
        end: The end of that layer.
        sent: The bytes of rows sent so far.
        learned: The rows at which something was learned.
        rules_before: The number of transitions of each rule before the resumed checkpoint.
        allowed_before: The number of enabled transitions before it.
        happened_before: The environment's events before it.
        told: The codes sent so far to each worker.
        dictionaries: The codes received from each worker.
        lately: The cache of rows sent lately, in the present packing.
        column_at: The column of each bit of a row, in the packing `located_in`.
        varying: The columns with several values in that packing.
    """

    def __init__(
        self, initial: Configuration, pending: int, me: int, workers: int, reduce: Reduced | None = None
    ) -> None:
        self.reduce = reduce
        self.me = me
        self.workers = workers
        self.sent = 0
        learner = Learner(initial.setting, initial.state, pending)  # type: ignore[arg-type]  # a stored one
        self.choosing = choosing(learner, reduce)
        self.store = RowStore(form=RowFormat(Elsewhere, compressible=self.choosing is None, travels=True))
        self.model = RuleModel(learner, self.store, exchanging(learner, reduce, ahead=False))
        self.expander = Expander(self.model, self.choosing)
        self.steps = chosen_steps(self.expander, self.choosing)
        self.paths = DividedPaths(me, workers)
        self.round: ReducedRound | None = None
        self.keys = Keys(learner.columns)
        self.outbox = Outbox(self.store.packing)
        self.answers: list[NDArray[np.int64]] = []
        self.located_in: Packing | None = None
        self.model.followers.append(self._see)
        self.model.see()
        self.start()

    @property
    def size(self) -> int:
        """The number of rows."""
        return self.store.size

    @property
    def expanded(self) -> int:
        """The number of expanded rows."""
        return self.store.expanded

    # --- start ------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin with the initial configuration, or without rows if it is another worker's."""
        self.clear()
        learner, store = self.model.learner, self.store
        first = store.packing.packed(learner.columns.codes(learner.still))
        store.rows.words[: len(first)] = first
        self.end = int(self.owners_of(first, np.zeros(1, np.int64))[0] == self.me)
        store.state[SIZE] = self.end
        self.look_around()

    def clear(self) -> None:
        """Forget all rows, and all codes sent and received; the columns' values stay.

        The trees are discarded, too: the rows at which they were learned are gone, and a checkpoint must name such
        rows.
        """
        model = self.model
        model.forget()
        model.exchanging = exchanging(model.learner, self.reduce, ahead=False)
        self.learned: set[int] = set()
        self.store.clear()
        model.learner.columns.codes(model.learner.still)  # creates the columns that only the first row needs
        model.see()
        self.expander.counts.used[:] = self.expander.met.used[:] = 0
        self.begins, self.end = [0], 0
        self.rules_before: Counter[str] = Counter()
        self.happened_before: frozenset[str] = frozenset()
        self.allowed_before = 0
        self.told = [SentValues() for _ in range(self.workers)]
        self.dictionaries = [Dictionary() for _ in range(self.workers)]
        self.outbox = Outbox(self.store.packing)
        if self.choosing is not None:
            self.choosing.paths.movers.room[0] = self.paths.leads.room[0] = 0
        self._forget_sent()

    def _see(self) -> None:
        """Keep up with the model, and with the packing of the rows."""
        self.keys.refresh()
        where = self.store.packing
        if self.located_in is where:
            return
        self.column_at, self.varying = column_at(where), np.flatnonzero(where.mask).astype(np.uint64)
        if self.located_in is not None and where.extends(self.located_in):
            self.outbox.packing = (
                where  # its rows keep their bits; rows to come have those of new columns, too
            )
        else:
            self.outbox.repack(where)
            self._forget_sent()
        self.located_in = where

    def _forget_sent(self) -> None:
        self.lately = np.zeros(SENT * (self.store.packing.words + 1), np.uint64)

    # --- rounds ---------------------------------------------------------------------------------------------------

    def expand(self, layer: int, most: int) -> tuple[RowParcel, ...]:
        """Expand at most `most` rows of a layer, and return a parcel for each worker."""
        self.enter(layer)
        if self.store.compress():
            self.model.see()
        rows = range(self.expanded, min(self.expanded + most, self.end))
        if self.choosing is None:
            self._expand([rows], self.expander.gather)
        else:
            self.round = ReducedRound(rows, np.zeros(len(rows), np.bool_))
            self._expand_reduced(self.round)
        self.store.state[EXPANDED] = rows.stop
        return self.parcels()

    def _expand(self, ranges: Iterable[range], gather: Callable[[int], bool]) -> None:
        """Expand rows by gathering their successors, learning on the way."""
        state = self.store.state
        for rows in ranges:
            state[AT] = rows.start
            while state[AT] < rows.stop:
                self.store.make_room(self.expander.successors)
                known = gather(rows.stop)
                if not known or state[AT] < rows.stop:
                    self._deal()
                if not known:
                    self._learn()
        self._deal()

    def _learn(self) -> None:
        """Learn the rule that gathering lacked at a row."""
        self.learned.add(int(self.store.state[AT]))
        self.expander.learn()

    def enter(self, layer: int) -> None:
        """Begin a layer, unless it has begun."""
        if layer == len(self.begins):
            self.begins.append(self.end)
            self.end = self.size

    def _deal(self) -> None:
        """Store the batch's rows of this worker, and put the others into the outbox."""
        store, expander = self.store, self.expander
        batch, count = expander.batch, expander.gathered()
        if self.round is not None:
            self._deal_reduced(self.round, batch, count)
            return
        chosen, owners = np.zeros(count, np.int64), np.zeros(count, np.int32)
        found = kernel.deal(
            *store.arrays,
            store.rows.folded,
            batch,
            count,
            self.owning(),
            self.me,
            self.lately,
            chosen,
            owners,
            expander.counts.used,
            store.state,
        )
        chosen, owners = chosen[:found], owners[:found]
        if store.rows.folded is not None:
            self._store(batch, chosen[owners == self.me])
            chosen, owners = chosen[owners != self.me], owners[owners != self.me]
        self.send(batch, chosen, owners)

    def _store(
        self, batch: SuccessorBatch, which: NDArray[np.int64], movers: NDArray[Any] | None = None
    ) -> NDArray[np.int64]:
        """Store some successors of a batch, which are its own; return their places if movers are given."""
        rows = batch.kept.reshape(-1, self.store.packing.words)[which].ravel()
        origins = batch.origins[which] * self.workers + self.me
        mine, size = batch._replace(kept=rows, hashes=batch.hashes[which], origins=origins), self.size
        self.store.add(mine, (0, len(which)), self.model.making)
        return which if movers is None else self._note_movers(mine, len(which), movers, size)

    def send(self, batch: SuccessorBatch, which: NDArray[np.int64], owners: NDArray[np.int32]) -> None:
        """Put some successors of a batch into the outbox; each has another worker."""
        rows = batch.kept.reshape(-1, self.store.packing.words)[which]
        origins: NDArray[Any] = batch.origins[which].astype(np.uint32)
        if self.choosing is not None:
            origins = origins | self.choosing.movers.room[batch.steps[which]].astype(np.uint64) << HALF
        self.outbox.add(rows, origins, owners)

    # --- partial-order reduction ----------------------------------------------------------------------------------

    def _expand_reduced(self, found: ReducedRound) -> None:
        """Expand the rows of a round by ample sets, learning on the way."""
        assert self.steps is not None
        state, rows = self.store.state, found.rows
        state[AT] = rows.start
        while state[AT] < rows.stop:
            self.store.make_room(self.expander.successors)
            begin = int(state[AT])
            known, batch, is_reduced = self.steps.gather_divided(rows.stop, self.end)
            found.reduced[begin - rows.start : int(state[AT]) - rows.start] = is_reduced
            self._deal_reduced(found, batch, int(state[SIFTED]))
            if not known:
                self._learn()

    def _deal_reduced(self, found: ReducedRound, batch: SuccessorBatch, count: int) -> None:
        """Store the batch's rows of this worker, and put all others into the outbox: their workers answer for them."""
        count_steps(batch.steps, 0, count, self.expander.counts.room)
        owners, places = self.owners_of(batch.kept, batch.origins[:count]), np.zeros(count, np.int64)
        mine, others = np.flatnonzero(owners == self.me), np.flatnonzero(owners != self.me)
        assert self.choosing is not None
        places[mine] = self._store(batch, mine, self.choosing.movers.room[batch.steps[mine]])
        followed = (
            batch.origins[:count].copy(),
            batch.steps[:count].astype(np.int64),
            owners.astype(np.int64),
            places,
        )
        found.followed.append(followed)
        self.send(batch, others, owners[others])

    def _note_movers(
        self, batch: SuccessorBatch, count: int, movers: NDArray[Any], size: int
    ) -> NDArray[np.int64]:
        """Note the movers of the rows from row `size` on, just stored from a batch; return the places of all in it."""
        numbers = self.store.look_up(batch, count, self.model.making)
        if self.choosing is not None:
            self.choosing.paths.reserve(self.store.rows.room)
            self.paths.leads.grow(self.store.rows.room)
            new = np.flatnonzero(numbers >= size)[::-1]  # of equal ones the first was stored
            self.choosing.paths.movers.room[numbers[new]] = movers[new]
            self.paths.leads.room[numbers[new]] = 0
        return place_of(numbers, self.end)

    def lead_on(self, links: Links) -> None:
        """Expand in full the rows of the round of which no followed step leads on; all workers call it at once."""
        found, counts = self.round, self.expander.counts.used
        assert found is not None
        assert self.choosing is not None
        answers = links.exchange(self.answers)
        if self.choosing.ample.forward:
            origins, steps, _, places = found.whole(answers)
            left = np.unique(origins[found.reduced[origins - found.rows.start] & (places & 1 == 0)])
        else:
            origins, steps, *_ = found.whole(answers)
            left = self.paths.lead_on(links, found, answers)
        np.subtract.at(counts, steps[np.isin(origins, left)], 1)
        self._expand((range(row, row + 1) for row in left.tolist()), self.expander.gather)

    # --- rows in transit --------------------------------------------------------------------------------------------

    def owning(self) -> kernel.Owning:
        """Return the data that assigns rows to workers."""
        columns, keys = self.store.packing.columns, self.keys
        return kernel.Owning(columns, self.varying, self.column_at, keys.keys, keys.begins, self.workers)

    def owners_of(self, rows: NDArray[np.uint64], origins: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the worker of each row; `origins` are own rows from which they were reached."""
        owners, store = np.zeros(len(origins), np.int32), self.store
        known = (store.rows.words, store.rows.folded)
        kernel.owners_of(*known, origins, rows, store.packing.words, self.owning(), owners)
        return owners

    def parcels(self, *, always: bool = False) -> tuple[RowParcel, ...]:
        """Return the waiting rows, a parcel for each worker; new values go with the rows, or to all if `always`."""
        found = []
        for peer in range(self.workers):
            rows, origins = self.outbox.taken_out(peer)
            tells = peer != self.me and (always or len(origins))
            news = self.told[peer].news(self.model.learner.columns) if tells else ()
            found.append(RowParcel(news, self.store.packing, rows, origins))
        self.sent += sum(parcel.bytes for parcel in found)
        self.outbox = Outbox(self.store.packing)
        return tuple(found)

    def take(self, *parcels: RowParcel) -> None:
        """Store the rows that the others have sent, in the order of the workers."""
        self.hear(parcels)
        self.answers = []
        for peer, parcel in enumerate(parcels):
            told = [np.zeros(0, np.int64)]
            for count in self.translated(peer, parcel):
                size = self.size
                self.store.add(self.expander.batch, (0, count), self.model.making)
                if self.choosing is not None:
                    batch = self.expander.batch
                    told.append(self._note_movers(batch, count, batch.steps, size))
            self.answers.append(np.concatenate(told))

    def hear(self, parcels: Sequence[RowParcel]) -> None:
        """Add the values that the others have sent."""
        heard = [(peer, entry) for peer, parcel in enumerate(parcels) for entry in parcel.news]
        for peer, entry in heard:
            self._note(self.dictionaries[peer], entry)
        if heard:
            self.model.see()

    def _note(self, dictionary: Dictionary, entry: ColumnUpdate) -> None:
        """Add another worker's values; a cell that varies there varies here, too."""
        learner, cell = self.model.learner, entry.place[0]
        if len(entry.place) == 3 and learner.columns.dig(cell, entry.place[1] + 1):
            learner.relearn(Deeper(cell))
        number = learner.columns.number(entry.place)
        codes = [learner.columns.all[number].code(value) for value in entry.values]
        dictionary.add(entry.column, number, codes)
        if any(codes) and cell not in learner.varying:
            learner.relearn(Varies(cell))

    def translated(self, peer: int, parcel: RowParcel) -> Iterator[int]:
        """Put the rows of a parcel into the batch, some at a time; yield their number."""
        if not len(parcel):
            return
        store, batch, rows = self.store, self.expander.batch, writable(parcel.rows)
        read, room = spelling(parcel.packing, *self.dictionaries[peer].arrays()), len(batch.hashes)
        for first in range(0, len(parcel), room):
            origins = parcel.origins[first : first + room].astype(np.int64)
            batch.origins[: len(origins)] = (origins & LOW) * self.workers + peer
            batch.steps[: len(origins)] = origins >> HALF
            where = (store.packing.columns, store.packing.words)
            made = (batch.kept, batch.hashes)
            kernel.translate(rows, first, len(origins), parcel.packing.words, read, *where, *made)
            yield len(origins)

    # --- learning ---------------------------------------------------------------------------------------------------

    def learn_at(self, codes: list[int]) -> None:
        """Learn from a row given by its codes, which replaces all rows."""
        store, expander = self.store, self.expander
        store.rows.words[: store.packing.words] = store.packing.packed(codes)
        store.state[[SIZE, AT]] = 1, 0
        while not store.state[AT]:
            known = expander.gather(1)
            expander.gathered()
            if not known:
                expander.learn()
        store.state[[SIZE, AT]] = 0, 0

    def look_around(self) -> None:
        """Rebuild the table after rows were put in place."""
        self.store.rebuild(2 * max(self.size, FIRST_ROWS))
        self.store.make_room(self.expander.successors)

    def has_origins_in(self, boundaries: Sequence[tuple[int, ...]]) -> bool:
        """Return whether each row's origin is in the previous layer, given the boundaries of all workers' layers.

        The initial configuration, alone in its layer, is its own origin.
        """
        first = self.store.rows.origins.room[: self.boundaries[1]]
        if sum(each[1] for each in boundaries) != 1 or np.any(first != self.me):
            return False
        for layer, (begin, end) in enumerate(pairwise(self.boundaries[1:])):
            rows, workers = np.divmod(self.store.rows.origins.room[begin:end], np.uint64(self.workers))
            begins, ends = (np.array([each[k] for each in boundaries], np.uint64) for k in (layer, layer + 1))
            if not np.all((begins[workers] <= rows) & (rows < ends[workers])):
                return False
        return True

    # --- counts -------------------------------------------------------------------------------------------

    def rules(self) -> Counter[str]:
        """Return the number of transitions of each rule."""
        return self.model.rules(self.expander.counts.used) + self.rules_before

    def survey(self) -> RowSurvey:
        """Return a survey of its expanded rows."""
        return RowSurvey(self.model, self.expander.met.used.copy())

    @property
    def allowed(self) -> int:
        """The number of enabled transitions of the expanded rows."""
        return int(self.expander.met.used.sum()) + self.allowed_before

    @property
    def boundaries(self) -> tuple[int, ...]:
        """The first row of each layer, the end of the layer in expansion, and the end of the next."""
        return (*self.begins, self.end, self.size)

    def standing(self) -> ShardProgress:
        """Return the worker's progress."""
        return ShardProgress(
            self.size,
            self.expanded,
            self.end,
            sum(self.rules().values()),
            self.store.was_cut,
            self.expander.is_crowded,
            self.model.learner.runs,
            memory_taken(),
            self.store.bytes_used,
            self.sent,
        )
