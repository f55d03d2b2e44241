"""The state space of the fast explorer: breadth-first search over packed rows with learned trees.

It visits the same configurations in the same order as the reference explorer, and stops at the same bounds.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast import kernel, repacking
from checker.engines.fast.arrays import Growing
from checker.engines.fast.columns import WORD, Packing, bits_of, packing, packing_in_order, shifts
from checker.engines.fast.decision_trees import RECORD
from checker.engines.fast.frontier_chunks import Slices
from checker.engines.fast.learned_model import (
    ALPHA,
    AT,
    CODE,
    CROWDS,
    CUT,
    EXPANDED,
    FULL,
    GATHERED,
    KEPT,
    LATER,
    LIMIT,
    NODE,
    SIZE,
    STATE,
    TREE,
    TURNS,
    UNSORTED,
    WIDE,
    WORDS,
    LearnedModel,
    SuccessorBatch,
)
from checker.engines.fast.learner import CodedSource, Learner, TransitionGroup
from checker.engines.fast.mapped_arrays import Pages
from checker.engines.fast.origins import OriginPages, Rising
from checker.engines.fast.rows import Rows
from checker.engines.fast.table import most_in, rebuild, slots_for, slots_within
from checker.limits import look
from semantics.state.cell_values import AGENTS, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import by_clause, moves, served

BATCH = 1 << 15
"""The number of successors in a batch; rows are expanded until half of it is full."""

FIRST_ROWS = 1 << 15
MOST_ROWS = (1 << 31) - 1
UNPLANTED = -1
"""The stand-in for a node of a tree that had none."""


if TYPE_CHECKING:
    from checker.engines.fast.canonicalise import Exchanges, RowScratch
    from checker.engines.fast.partial_order import Choosing
    from checker.engines.fast.symmetry_tables import Exchanging


class Space:
    """The configurations reached so far, as rows, and the progress of their expansion.

    Attributes:
        learner: The learned rules.
        packing: The position of each column in a row.
        rows: The packed configurations with their origins; the first is its own origin.
        counts, met: How often each transition was followed, and how often enabled; equal without partial-order
            reduction.
        learned: The misses so far: row, tree, node and code.
        actors: The greatest number of actors of a configuration so far: two for each agent, one for each clause.
        left: Returns the bytes of memory still available; the table grows less when they run out.
        slices: Rows expanded ahead of the stored ones.
        pipeline: The threads that expand them.
        stored: The number of rows that other threads may look up.
        changes: The number of repackings.
        shown: A snapshot of the trees for other threads; None if it is out of date.
    """

    ORIGINS: type[OriginPages] = Rising
    PLAIN = 2
    """The greatest width in words of rows that are never tree-compressed."""

    COMPRESSED_FROM = 1 << 15
    """The number of wide rows from which they are tree-compressed: the loops for it take seconds to compile."""

    def __init__(
        self,
        learner: Learner,
        limit: int | None,
        choosing: "Choosing | None" = None,
        exchanging: "Exchanging | None" = None,
        threads: int = 1,
    ) -> None:
        self.learner = learner
        self.left: Callable[[], float] = lambda: math.inf
        self.choosing = choosing
        self.exchanging = exchanging
        self.state = np.zeros(STATE, np.int64)
        self.state[LIMIT] = MOST_ROWS if limit is None else min(limit, MOST_ROWS)
        self.slices = Slices(self, threads)
        self.pipeline = self.slices.pipeline
        self.stored = self.changes = 0
        self.shown: tuple[LearnedModel, Exchanges | None] | None = None
        self.packing: Packing
        self.batch: SuccessorBatch
        self.state[TURNS] = learner.setting.scheduler is Scheduler.FCFS
        self.learned: list[tuple[int, int, int, int]] = []
        self.clauses = [
            learner.tree(TransitionGroup(by_clause, clause)) for clause in learner.setting.environment
        ]
        self.actors = len(self.clauses)
        self.groups: list[tuple[Name, ...]] = []
        self.trees: tuple[NDArray[np.int32], ...] = ()
        self.counts = Growing(np.int64)
        self.met = self.counts if choosing is None else Growing(np.int64)
        self.masks = Growing(np.uint64, shared=True)
        self.located = 0
        self.grown = -1
        self.rows = Rows(1, FIRST_ROWS, self.ORIGINS)
        self.table = Pages(np.uint32, 1)
        self._add_first()
        self._make_room(BATCH)
        self._see()

    @property
    def size(self) -> int:
        """The number of configurations."""
        return int(self.state[SIZE])

    @property
    def expanded(self) -> int:
        """The number of expanded configurations."""
        return int(self.state[EXPANDED])

    @property
    def was_cut(self) -> bool:
        """Whether the limit left configurations out."""
        return bool(self.state[CUT])

    @property
    def is_crowded(self) -> bool:
        """Whether some configurations were not expanded because an agent is crowded."""
        return bool(self.state[CROWDS])

    @property
    def spilled(self) -> bool:
        """Whether rows and origins are in files."""
        return self.rows.spilled

    @property
    def bytes_used(self) -> int:
        """The bytes of rows, origins, visited set and paths; unwritten capacity takes none."""
        paths = 0 if self.choosing is None else self.choosing.paths.held(self.size)
        return self.rows.held(self.size) + self.table.room.nbytes + paths

    def rules(self, *, followed: bool = True) -> Counter[str]:
        """Return the number of transitions of each rule: the followed ones, or all."""
        names = {number: name for name, number in self.learner.rules.items()}
        found: Counter[str] = Counter()
        counts = self.counts.used if followed else self.met.used
        for step in np.flatnonzero(counts):
            found[names[int(self.learner.leaves.rule.room[step])]] += int(counts[step])
        return found

    def row(self, number: int) -> Row:
        """Return the cells of a configuration."""
        return self.learner.columns.row(self.codes(number))

    def configuration(self, number: int) -> Configuration:
        """Return a configuration."""
        return Configuration(self.learner.setting, self.row(number))

    def codes(self, number: int) -> list[int]:
        """Return the code of each column in a row."""
        return self.packing.codes(self.rows.row(number))

    # --- expanding ------------------------------------------------------------------------------------------------

    def advance(self, until: int, end: int | None = None) -> None:
        """Expand rows to row `until` or somewhat beyond, but never beyond `end`, learning on the way."""
        if self.choosing is not None:
            self._advance_by(self.choosing, until)
            return
        while self.expanded < until:
            self._compress()
            self.slices.advance(until if end is None else end)

    def expand_here(self, until: int) -> None:
        """Expand rows until row `until` or until the batch is full, learning on the way."""
        self.state[AT], self.state[GATHERED] = self.expanded, 0
        known = self.gather(until)
        gathered = int(self.state[GATHERED])
        self.store(self.batch, (0, gathered), (0, gathered), int(self.state[AT]))
        self.state[GATHERED] = 0
        if not known:
            self._miss()

    def _advance_by(self, choosing: "Choosing", until: int) -> None:
        """Expand rows until row `until`, following ample sets."""
        while self.state[AT] < until:
            self._compress()
            new = 2 * len(self.batch.steps)
            self._make_room(new)
            choosing.paths.reserve(self.rows.room)
            if not self._expand(choosing, until, self.size + new):
                self._miss()

    def _expand(self, choosing: "Choosing", until: int, room: int) -> bool:
        """Expand rows until row `until` or until there are `room` rows; return False at something not learned yet."""
        from checker.engines.fast.ample_kernel import expand_reduced  # noqa: PLC0415  # compiled only for a reduction

        loop: Callable[..., bool] = expand_reduced
        known = (self.model, choosing.members, *self.symmetry, choosing.paths.trails)
        arrays = (self.rows.words, self.rows.folded, self.rows.origins.loops, self.table.room, self.batch)
        return loop(*known, *arrays, until, room, self.met.room, self.counts.room, self.state)

    def gather(self, until: int) -> bool:
        """Gather the successors of rows, or their representatives; return False at something not learned yet."""
        rows = self.rows
        return bool(
            kernel.gather(self.model, *self.symmetry, rows.words, rows.folded, self.batch, self.state, until)
        )

    @property
    def symmetry(self) -> "tuple[Exchanges, RowScratch] | tuple[None, None]":
        """The symmetry tables, and this thread's scratch space; None without symmetry reduction."""
        swaps = self.exchanging
        return (None, None) if swaps is None else (swaps.exchanges, swaps.desk)

    @property
    def completing(self) -> tuple[Any, ...]:
        """What completes a compressed successor: the model, symmetry and tree compression; None for plain rows."""
        folded = self.rows.folded
        return (None,) * 4 if folded is None else (self.model, *self.symmetry, folded)

    def store(self, batch: SuccessorBatch, steps: tuple[int, int], found: tuple[int, int], at: int) -> None:
        """Store part of a batch: transitions and possibly new successors of the rows before row `at`."""
        kernel.count(batch.steps, *steps, self.counts.room)
        begin, end = found
        while begin < end:  # so the time of growth does not depend on the batch
            self._make_room(1)
            begin = self._store_some(batch, begin, end)
        self.state[EXPANDED] = at
        self.show()

    @property
    def epoch(self) -> int:
        """A number that changes when results found ahead become void."""
        return self.changes + self.learner.trees.forgotten

    def known(self) -> "tuple[LearnedModel, Exchanges | None]":
        """Return a snapshot of trees and symmetry tables that other threads may read during learning."""
        if self.shown is None:
            trees = self.learner.trees
            copies = [each.used.copy() for each in (trees.root, trees.nodes, trees.next)]
            model = self.model._replace(root=copies[0], nodes=copies[1], next=copies[2])
            self.shown = model, None if self.exchanging is None else self.exchanging.snapshot()
        return self.shown

    def show(self) -> None:
        """Publish the stored rows to other threads."""
        self.rows.show()
        self.stored = self.size

    def _store_some(self, batch: SuccessorBatch, begin: int, end: int) -> int:
        """Store successors of a batch until there is no room; return the first one not stored."""
        arrays = (self.rows.words, self.rows.origins.loops, self.table.room)
        return int(kernel.store(*arrays, *self.completing, batch, begin, end, self.state))

    def classify(self, tree: int, rows: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the leaf of each row in a tree, learning on the way."""
        found = np.zeros(len(rows), np.int32)
        done = 0
        while done < len(rows):
            look()
            known = (self.model, self.rows.words, self.rows.folded)
            done += kernel.classify(*known, rows[done:], tree, found[done:], self.state)
            if done < len(rows):
                self._learn(int(rows[done]))
        return found

    def edges(self, rows: range) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]]:
        """Yield the transitions of expanded rows, batch by batch: origins, steps, and targets (< 0: none)."""
        self.state[AT] = rows.start
        while self.state[AT] < rows.stop:
            look()
            known = self.gather(rows.stop)
            count, self.state[GATHERED] = int(self.state[GATHERED]), 0
            targets = np.zeros(count, np.int64)
            kernel.look_up(
                self.rows.words, self.table.room, *self.completing, self.batch, targets, self.state
            )
            yield self.batch.origins[:count].copy(), self.batch.steps[:count].copy(), targets
            if not known:
                self._miss()

    def _miss(self) -> None:
        look()
        if self.state[NODE] == WIDE:
            self._make_batches(2 * len(self.batch.hashes))
            self._see()
        elif self.state[NODE] == FULL:
            self._make_room(1)
        elif self.exchanging is not None and self.state[NODE] == UNSORTED:
            self.learned += self.exchanging.missed
            self.exchanging.learn()
            self._see()
        else:
            self._learn(int(self.state[AT]))

    def _learn(self, row: int) -> None:
        """Learn the entry at which the walk of a row ended."""
        tree, node, code = int(self.state[TREE]), int(self.state[NODE]), int(self.state[CODE])
        self.learned.append((row, tree, node, code))
        self._learn_entry(self.packing, self.rows.row(row), tree, node, code)

    def _learn_entry(
        self, where: Packing, words: NDArray[np.uint64], tree: int, node: int, code: int
    ) -> None:
        """Learn the path of a row in a tree; a new answer to a question of a node needs no rule.

        Then only the windows of nodes change, which the loops read in place.
        """
        trees = self.learner.trees
        if node >= 0 and trees.settle(node, code, self.learner.columns.all[trees.column_of(node)]):
            self.shown = None
            return
        self.learner.learn(tree, CodedSource(self.learner.columns, where, words.tolist()))
        self._see()

    def restore(
        self,
        where: Packing,
        rows: Rows,
        size: int,
        learned: list[tuple[int, int, int, int]],
    ) -> None:
        """Continue from the rows of another space of the same mission, learning again everything that it had learned.

        Raises:
            ValueError, IndexError: The rows can't be of such a space.
        """
        first, missed = self.codes(0), iter(learned)
        for each in missed:
            self._learn_again(where, rows, size, each, missed)
        self.learned = learned
        sizes = np.array(self.learner.columns.sizes, np.int64)
        begins = np.concatenate(([0], np.cumsum(sizes)))
        used = np.zeros(begins[-1], np.bool_)
        if len(where.mask) != len(sizes) or not all(
            repacking.mark_used(words, where.words, where.columns, begins, used)
            for _, words in rows.blocks(size)
        ):
            raise ValueError("it has other columns, or values outside of theirs")
        self.rows = rows
        self._pack_as(where, BATCH)
        self.state[SIZE] = size
        begun = self.codes(0)
        if begun[: len(first)] != first or any(begun[len(first) :]):
            raise ValueError("it begins with another configuration")
        self._rebuild(slots_for(size))
        self._make_room(BATCH)
        self._see()

    def _learn_again(
        self,
        where: Packing,
        rows: Rows,
        size: int,
        entry: tuple[int, int, int, int],
        others: Iterator[tuple[int, int, int, int]],
    ) -> None:
        """Learn again as another space did; raise ValueError if that space can't have learned it."""
        row, tree, node, code = entry
        trees = self.learner.trees
        swaps = self.exchanging
        if row < 0 and swaps is not None:
            swaps.learn_again(entry, others)
            self._see()
            return
        if not 0 <= row < size:
            raise ValueError("it learned from a row that it does not have")
        if not (0 <= tree < len(trees.root) and UNPLANTED <= node < len(trees.asks)):
            raise ValueError("it learned an answer to a question of no rule")
        try:
            self._learn_entry(where, rows.row(row), tree, node, code)
        except Exception as error:  # on a row that is no configuration, rules may fail in any way
            raise ValueError(f"a rule does not run on its rows: {type(error).__name__}: {error}") from error

    def _see(self) -> None:
        """Rebuild the loops' tables from everything learned."""
        self._pack()
        groups = self._groups()
        if groups != self.groups:
            self.groups = list(groups)
            agents, begins = self._agents(groups)
            self._take_turns(len(self.clauses) + max(end - begin for begin, end in pairwise(begins)))
            self.trees = tuple(np.array(numbers, np.int32) for numbers in (begins, agents, self.clauses))
        trees, leaves = self.learner.trees, self.learner.leaves
        self._locate()
        self._make_masks()
        learned = (
            trees.root,
            trees.nodes,
            trees.next,
            leaves.leaves,
            leaves.steps,
            leaves.copies,
            leaves.writes,
            leaves.part,
        )
        self.model = LearnedModel._make(
            (*(each.room for each in learned), self.masks.room, self.packing.columns, *self.trees)
        )
        if self.choosing is not None:
            self.choosing.see(groups, self.packing, len(self.batch.hashes))
        if self.exchanging is not None:
            self.exchanging.see(self.packing)
        self.shown = (self.model, self.symmetry[0]) if self.pipeline.threads == 1 else None

    def _locate(self) -> None:
        """Write the column positions into new inner nodes, or into all of them after a repacking."""
        nodes = self.learner.trees.nodes
        repacking.locate(nodes.used, self.packing.columns, self.located)
        self.located = len(nodes) // RECORD

    def _make_masks(self) -> None:
        """Compute the masks of new transitions, or of all of them after a repacking."""
        leaves, folded = self.learner.leaves, self.rows.folded
        width = 2 * self.packing.words if folded is None else 1
        known = self.masks.size // width
        self.masks.extend((len(leaves.rule) - known) * width)
        for counts in (self.counts, self.met):
            counts.extend(len(leaves.rule) - len(counts))
        arrays = (self.masks.used, leaves.steps.room, leaves.writes.room, self.packing.columns)
        if folded is None:
            repacking.make_masks(*arrays, self.packing.words, known)
        else:
            repacking.note_pieces(*arrays, folded.piece_of, known)

    def _groups(self) -> list[tuple[Name, ...]]:
        """Return the agents for each value of the cell that names them."""
        learner = self.learner
        self.state[ALPHA] = -1
        if AGENTS not in learner.varying:
            return [learner.still.read(AGENTS)]
        self.state[ALPHA] = number = learner.columns.numbers[(AGENTS,)]
        return learner.columns.all[number].values

    def _agents(self, groups: list[tuple[Name, ...]]) -> tuple[list[int], list[int]]:
        """Return the trees of all agents, group by group, and the bounds of the groups."""
        learner = self.learner
        trees = [
            [learner.tree(TransitionGroup(rules, a)) for rules in (served, moves) for a in group]
            for group in groups
        ]
        return [tree for group in trees for tree in group], [0, *accumulate(map(len, trees))]

    def _pack(self) -> None:
        """Repack the rows if a column has outgrown its bits; the batch must hold no gathered rows."""
        columns = self.learner.columns
        if self.grown == columns.growth.times:
            return
        self.grown, sizes = columns.growth.times, columns.sizes
        self.packing = self.packing.extended(sizes)
        if self.packing.holds(sizes):
            return
        self._repack(self._packed(columns.room(self.learner.varying), self.packing.words))

    def _compress(self) -> None:
        """Compress the rows once there are many; the batch must hold no gathered rows."""
        if self.rows.folded is None and self._is_compressed(self.packing):
            self._repack(self.packing)
            self._see()

    def _is_compressed(self, where: Packing) -> bool:
        """Return whether rows of a packing are tree-compressed; rows that once were stay so."""
        wide = where.words > self.PLAIN
        return wide and (self.rows.folded is not None or self.size >= self.COMPRESSED_FROM)

    def _repack(self, new: Packing) -> None:
        """Store the rows in another packing, compressed if they are wide and many."""
        self.pipeline.drop()
        moves = shifts(self.packing, new)
        self.rows.repack(self.size, moves, new.words, fold=self._is_compressed(new))
        self._pack_as(new, len(self.batch.hashes))
        self._rebuild(len(self.table.room))

    def _packed(self, room: Sequence[int], words: int) -> Packing:
        """Return a packing with room for `room` values in each column, in at least `words` words."""
        if -(-sum(bits_of(room)) // WORD) <= self.PLAIN:
            new = packing(room, words)
            if new.words <= self.PLAIN:
                return new
        return packing_in_order(
            room, self.learner.by_home(), words
        )  # so a transition changes few pieces of a row

    def _pack_as(self, where: Packing, successors: int) -> None:
        """Adopt a packing that the rows already have; make batches for `successors` successors."""
        self.pipeline.drop()
        self.changes += 1
        self.packing, self.state[WORDS], self.state[KEPT] = where, where.words, self.rows.kept
        self.grown = -1
        self.masks.size = self.located = 0
        self._make_batches(successors)

    # --- room -----------------------------------------------------------------------------------------------------

    def _add_first(self) -> None:
        codes = self.learner.columns.codes(self.learner.still)
        where = packing(self.learner.columns.sizes)
        self.rows.widen(where.words)
        self._pack_as(where, BATCH)
        for word, shift, code in zip(where.word, where.shift, codes, strict=True):
            self.rows.words[word] |= np.uint64(code) << shift
        self.state[SIZE] = 1

    def _make_batches(self, successors: int) -> None:
        """Replace the batch by an empty one; its contents must be stored."""
        self.batch = self.new_batch(successors)
        self.slices.spare.clear()
        self.state[GATHERED] = 0

    def _take_turns(self, actors: int) -> None:
        """Give batches a leaf for each of `actors` actors; their contents must be stored."""
        if actors > self.actors:
            self.actors = actors
            self._make_batches(len(self.batch.hashes))

    def new_batch(self, successors: int = 0, later: int = 0) -> SuccessorBatch:
        """Return an empty batch for `successors` successors (default: `BATCH`), with room for `later` deferred rows."""
        successors = successors or BATCH
        reduced = self.choosing is not None or self.exchanging is not None
        words = np.zeros(
            self.packing.words * successors if reduced or self.rows.folded is None else 0, np.uint64
        )
        is_stored_as_made = self.rows.folded is None and self.exchanging is None
        return SuccessorBatch(
            words,
            words if is_stored_as_made else np.zeros(self.rows.kept * successors, np.uint64),
            np.zeros(successors, np.uint64),
            np.zeros(successors, np.int64),
            np.zeros(successors, np.int32),
            np.zeros(self.actors, np.int32),
            np.zeros(LATER * later, np.int64),
            np.zeros(BATCH if later else 0, np.int32),
        )

    def _make_room(self, rows: int) -> None:
        """Make room for `rows` new rows."""
        wanted = min(self.size + rows, int(self.state[LIMIT]))
        if not self.rows.has_room(wanted):
            self.pipeline.rest()
            self.rows.reserve(wanted)
        if most_in(len(self.table.room)) < wanted:
            self._rebuild(self._slots(wanted))

    def _slots(self, rows: int) -> int:
        """Return the size of the next table: for half as many rows more, or for fewer when memory runs out."""
        table = self.table.room
        left = self.left() + table.nbytes
        within = min(slots_for(rows), slots_within(left, self.size, self.rows.bytes_each, table.itemsize))
        return max(int(within), slots_for(rows) * 3 // 4)

    def spill(self, folder: Path) -> None:
        """Move rows, origins and paths to files in a folder; the table, with its random accesses, stays in memory.

        Raises:
            OSError: There is no such folder, or no room in it.
        """
        self.pipeline.rest()
        self.rows.spill(folder, self.size)
        if self.choosing is not None:
            self.choosing.paths.spill(folder, self.size)

    def _rebuild(self, slots: int) -> None:
        self.pipeline.rest()
        self.table = Pages(np.uint32, 1)  # give the old one back before the next is taken
        self.table = Pages(np.uint32, slots)
        rebuild(self.rows.words, self.size, self.rows.kept, self.table.room, self.pipeline.divide)
