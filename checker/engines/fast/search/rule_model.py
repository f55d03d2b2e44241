"""The model: the learned rules of a mission, in the form that the compiled loops read for the rows of a store."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.columns import Packing
from checker.engines.fast.model.decision_trees import RECORD
from checker.engines.fast.model.learned_model import AT, NODE, TREE, UNSORTED, LearnedModel, find_unlearned
from checker.engines.fast.model.learner import CodedSource, Learner, TransitionGroup
from checker.engines.fast.store import kernel, repacking
from checker.engines.fast.store.row_store import Making, RowStore
from checker.engines.fast.store.rows import Rows
from checker.limits import look
from semantics.state.cell_values import AGENTS, Row
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import by_clause, moves, served

if TYPE_CHECKING:
    from checker.engines.fast.reduce.symmetry_tables import Exchanging
    from checker.engines.fast.store.canonicalise import Exchanges

Lesson = tuple[int, int, int, int]
"""A journal entry: row, tree, whether the next one was learned at the same stop, and 0.

With a row below 0, it is a part of an entry of the symmetry tables.
"""


class RuleModel:
    """The learned rules.

    Who keeps tables of its own about the rules rebuilds them after each lesson: it is one of the `followers`. Call
    `see` once they all are.

    Attributes:
        learner: The learned rules.
        store: The rows from which rules are learned, and whose packing the tables know.
        exchanging: The symmetry of the rules; None without symmetry reduction.
        loops: The tables in the form that the loops read.
        learned: The lessons so far, in order.
        groups: The agents for each value of the cell that names them.
        asked: The trees of questions that are asked of each row: their bounds for each of the groups, and the trees.
        actors: The greatest number of actors of a configuration so far: two for each agent, one for each clause.
        followers: Called after each rebuilding of the tables; they may ask new questions.
    """

    loops: LearnedModel

    def __init__(self, learner: Learner, store: RowStore, exchanging: "Exchanging | None" = None) -> None:
        self.learner = learner
        self.store = store
        self.exchanging = exchanging
        self.learned: list[Lesson] = []
        self.followers: list[Callable[[], None]] = []
        self.clauses = [
            learner.tree(TransitionGroup(by_clause, clause)) for clause in learner.setting.environment
        ]
        self.actors = len(self.clauses)
        self.groups: list[tuple[Name, ...]] = []
        self.asked = (np.zeros(1, np.int32), np.zeros(0, np.int32))
        self._trees: tuple[NDArray[np.int32], ...] = ()
        self._masks = Growing(np.uint64, shared=True)
        self._located = 0
        self._placed = (-1, -1)
        self._snapshot: tuple[LearnedModel, Exchanges | None] | None = None
        store.begin(learner.columns.sizes, learner.columns.codes(learner.still))

    # --- rows as configurations -----------------------------------------------------------------------------------

    def row(self, number: int) -> Row:
        """Return the cells of a configuration."""
        return self.learner.columns.row(self.store.codes(number))

    def configuration(self, number: int) -> Configuration:
        """Return a configuration."""
        return Configuration(self.learner.setting, self.row(number))

    def rules(self, counts: NDArray[np.int64]) -> Counter[str]:
        """Return the number of transitions of each rule, from the number of each transition."""
        names = {number: name for name, number in self.learner.rules.items()}
        found: Counter[str] = Counter()
        for step in np.flatnonzero(counts):
            found[names[int(self.learner.leaves.rule.room[step])]] += int(counts[step])
        return found

    # --- for the loops --------------------------------------------------------------------------------------------

    @property
    def symmetry(self) -> tuple[Any, Any]:
        """The symmetry tables, and this thread's scratch space; None without symmetry reduction."""
        swaps = self.exchanging
        return (None, None) if swaps is None else (swaps.exchanges, swaps.desk)

    @property
    def making(self) -> Making:
        """The makers of successors: the tables, the symmetry tables and this thread's scratch space."""
        return (self.loops, *self.symmetry)

    @property
    def epoch(self) -> int:
        """A number that changes when successors that were made before become void."""
        return self.store.changes + self.learner.trees.forgotten

    def snapshot(self) -> "tuple[LearnedModel, Exchanges | None]":
        """Return copies of the trees and symmetry tables, which other threads may read while this one learns."""
        if self._snapshot is None:
            trees = self.learner.trees
            copies = [each.used.copy() for each in (trees.root, trees.nodes, trees.next)]
            model = self.loops._replace(root=copies[0], nodes=copies[1], next=copies[2])
            self._snapshot = model, None if self.exchanging is None else self.exchanging.snapshot()
        return self._snapshot

    def classify(self, tree: int, rows: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the leaf of each row in a tree, learning on the way."""
        found = np.zeros(len(rows), np.int32)
        done, stored = 0, self.store.rows
        while done < len(rows):
            look()
            known = (self.loops, stored.words, stored.folded)
            done += kernel.classify(*known, rows[done:], tree, found[done:], self.store.state)
            if done < len(rows):
                self.learn(int(rows[done]))
        return found

    # --- learning -------------------------------------------------------------------------------------------------

    def learn_missing(self) -> None:
        """Learn the rule or representative at whose lack a loop stopped."""
        if self.exchanging is not None and self.store.state[NODE] == UNSORTED:
            self.learned += self.exchanging.missed
            self.exchanging.learn()
            self.see()
        else:
            self.learn(int(self.store.state[AT]))

    def learn(self, row: int) -> None:
        """Learn the path of a row in the tree at whose end its walk stopped, and in its other actors' trees."""
        words = self.store.rows.row(row)
        trees = list(dict.fromkeys([int(self.store.state[TREE]), *self._unlearned(words)]))
        for left, tree in zip(range(len(trees))[::-1], trees, strict=True):
            self.learned.append((row, tree, int(left > 0), 0))
            self._learn(self.store.packing, words, tree)
        self.see()

    def _unlearned(self, words: NDArray[np.uint64]) -> list[int]:
        """Return the trees of a row's actors, and of the questions asked about them, that lack the row."""
        found = np.zeros(len(self.loops.agents) + len(self.clauses) + len(self.asked[1]), np.int32)
        count = find_unlearned(self.loops, words, *self.asked, found, self.store.state.copy())
        trees: list[int] = found[:count].tolist()
        return trees

    def _learn(self, where: Packing, words: NDArray[np.uint64], tree: int) -> None:
        self.learner.learn(tree, CodedSource(self.learner.columns, where, words.tolist()))

    def forget(self) -> None:
        """Discard everything learned but the values of columns; call `see` afterwards."""
        self.learner.forget()
        self.learned = []

    def restore(self, where: Packing, rows: Rows, size: int, learned: list[Lesson]) -> None:
        """Continue from the rows of another model of the same mission, learning again everything that it had learned.

        Raises:
            ValueError, IndexError: The rows can't be of such a model.
        """
        first, lessons = self.store.codes(0), iter(learned)
        for each in lessons:
            self._learn_again(where, rows, size, each, lessons)
        self.learned = learned
        self.store.adopt(where, rows, size, self.learner.columns.sizes)
        begun = self.store.codes(0)
        if begun[: len(first)] != first or any(begun[len(first) :]):
            raise ValueError("it begins with another configuration")
        self.see()

    def _learn_again(
        self, where: Packing, rows: Rows, size: int, lesson: Lesson, others: Iterator[Lesson]
    ) -> None:
        """Learn again as another model did; raise ValueError if that model can't have learned it."""
        row, tree, is_followed, _ = lesson
        if row < 0 and self.exchanging is not None:
            self.exchanging.learn_again(lesson, others)
            self.see()
            return
        if not 0 <= row < size:
            raise ValueError("it learned from a row that it does not have")
        if not 0 <= tree < len(self.learner.trees.root):
            raise ValueError("it learned a path of no rule")
        try:
            self._learn(where, rows.row(row), tree)
            if not is_followed:
                self.see()
        except Exception as error:  # on a row that is no configuration, rules may fail in any way
            raise ValueError(f"a rule does not run on its rows: {type(error).__name__}: {error}") from error

    # --- tables ---------------------------------------------------------------------------------------------------

    def see(self) -> None:
        """Give the rows the bits of new values, and rebuild all tables from everything learned."""
        asked = -1
        while asked != len(self.learner.owners):  # followers ask questions about new agents
            self._rebuild()
            asked = len(self.learner.owners)
            for follow in self.followers:
                follow()

    def _rebuild(self) -> None:
        self.learner.settle()
        self._pack()
        alpha, groups = self._agents()
        if groups != self.groups:
            self.groups = list(groups)
            self._trees = self._trees_of(groups)
            self.asked = (np.zeros(len(groups) + 1, np.int32), np.zeros(0, np.int32))
        trees, leaves = self.learner.trees, self.learner.leaves
        self._locate()
        self._make_masks()
        of_leaves = (leaves.leaves, leaves.steps, leaves.copies, leaves.writes, leaves.part)
        learned = (trees.root, trees.nodes, trees.next, *of_leaves, self._masks)
        takes_turns = int(self.learner.setting.scheduler is Scheduler.FCFS)
        rooms = (*(each.room for each in learned), self.store.packing.columns, *self._trees)
        self.loops = LearnedModel._make((*rooms, alpha, takes_turns))
        if self.exchanging is not None:
            self.exchanging.see(self.store.packing)
        self._snapshot = None

    def _pack(self) -> None:
        """Give each column enough bits; afterwards the positions in nodes and masks may be outdated."""
        columns, store = self.learner.columns, self.store
        if self._placed != (columns.growth.times, store.changes):
            store.pack(columns.sizes, lambda: (columns.room(self.learner.varying), self.learner.by_home()))
        if self._placed[1] != store.changes:
            self._masks.size = self._located = 0
        self._placed = columns.growth.times, store.changes

    def _locate(self) -> None:
        """Write the column positions into new inner nodes, or into all of them after a repacking."""
        nodes = self.learner.trees.nodes
        repacking.locate(nodes.used, self.store.packing.columns, self._located)
        self._located = len(nodes) // RECORD

    def _make_masks(self) -> None:
        """Compute the masks of new transitions, or of all of them after a repacking."""
        leaves, where, folded = self.learner.leaves, self.store.packing, self.store.folded
        width = 2 * where.words if folded is None else 1
        known = self._masks.size // width
        self._masks.extend((len(leaves.rule) - known) * width)
        arrays = (self._masks.used, leaves.steps.room, leaves.writes.room, where.columns)
        if folded is None:
            repacking.make_masks(*arrays, where.words, known)
        else:
            repacking.note_pieces(*arrays, folded.piece_of, known)

    def _agents(self) -> tuple[int, Sequence[tuple[Name, ...]]]:
        """Return the column of the agents' names, -1 if they are constant, and the agents for each of its values."""
        learner = self.learner
        if AGENTS not in learner.varying:
            return -1, [learner.still.read(AGENTS)]
        number = learner.columns.numbers[(AGENTS,)]
        return number, learner.columns.all[number].values

    def _trees_of(self, groups: Sequence[tuple[Name, ...]]) -> tuple[NDArray[np.int32], ...]:
        """Return the bounds of the groups of agents, the trees of all agents, and those of the clauses."""
        learner = self.learner
        trees = [
            [learner.tree(TransitionGroup(rules, a)) for rules in (served, moves) for a in group]
            for group in groups
        ]
        begins = [0, *accumulate(map(len, trees))]
        most = max(end - begin for begin, end in pairwise(begins))
        self.actors = max(self.actors, len(self.clauses) + most)
        found = (begins, [tree for group in trees for tree in group], self.clauses)
        return tuple(np.array(numbers, np.int32) for numbers in found)
