"""Decision trees as arrays: an inner node tests a column, a leaf holds the result.

A reference is a number: 0 for not learned yet, k > 0 for inner node k - 1, k < 0 for leaf -k - 1. An inner node has a
window of codes; for each of them, `next` holds a reference. A node with a question has the same reference for all codes
with the same answer.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.columns import Column
from checker.recording.access_recording import ColumnQuestion

UNKNOWN = 0
RECORD = 8
"""The numbers of an inner node; the last is spare."""

COLUMN, LOW, WIDTH, BASE, WORD, SHIFT, MASK = range(7)
"""The fields of an inner node: its column, the first code and the size of its window, and the begin of the window in
`next`. The last three are the column's position in a row under the present packing (see `kernel.locate`)."""


class LearningError(Exception):
    """A rule asked another question after the same answers: a bug, since rules are pure."""


def leaf_reference(leaf: int) -> int:
    """Return the reference to a leaf."""
    return -leaf - 1


@dataclass(slots=True)
class Trees:
    """All decision trees of an exploration, by number.

    Attributes:
        root: The reference to the root of each tree.
        nodes: `RECORD` numbers for each inner node.
        next: References, window by window.
        asks: The question of each inner node.
        answers: For each inner node with a question, the reference for each answer.
        waiting: For each such node, the codes without a reference, by their answer.
        answered: For each such node, the number of codes with a known answer.
        forgotten: The number of times that a tree was discarded.
    """

    root: Growing = field(default_factory=lambda: Growing(np.int32))
    nodes: Growing = field(default_factory=lambda: Growing(np.uint64))
    next: Growing = field(default_factory=lambda: Growing(np.int32))
    asks: list[ColumnQuestion] = field(default_factory=list)
    answers: list[dict[Any, int]] = field(default_factory=list)
    waiting: list[dict[Any, list[int]]] = field(default_factory=list)
    answered: list[int] = field(default_factory=list)
    forgotten: int = 0

    def plant(self) -> int:
        """Return the number of a new, empty tree."""
        return self.root.append(UNKNOWN)

    def grow(
        self,
        tree: int,
        path: Sequence[tuple[ColumnQuestion, Any]],
        leaf: int,
        columns: Sequence[tuple[Column, int]],
    ) -> None:
        """Add a path to a leaf to a tree; `columns` are those of its questions, with their numbers.

        A path has a code for each value read, and an answer for each question.

        Raises:
            LearningError: The tree has another question there.
        """
        reference = int(self.root.room[tree])
        previous: tuple[int, Any, Column] | None = None
        for (ask, answer), (column, number) in zip(path, columns, strict=True):
            if reference == UNKNOWN:
                reference = self._new_node(ask, number) + 1
                self._lead(tree, previous, reference)
            if reference < 0 or self.asks[reference - 1] != ask:
                raise LearningError(f"a rule asked {ask} out of turn")
            previous = (reference - 1, answer, column)
            reference = self._follow(reference - 1, answer)
        if reference not in (UNKNOWN, leaf_reference(leaf)):
            raise LearningError("a rule asked less than before, with the same answers")
        self._lead(tree, previous, leaf_reference(leaf))

    def settle(self, node: int, code: int, column: Column) -> bool:
        """Answer a node's question for a new code; return False if a rule must run."""
        if self.asks[node].question is None:
            return False
        self._widen(node, code)
        self._fill(node, column)
        return self._follow_code(node, code) != UNKNOWN

    def column_of(self, node: int) -> int:
        """Return the number of the column that a node tests."""
        return int(self.nodes.room[RECORD * node + COLUMN])

    def forget(self, tree: int) -> None:
        """Discard everything that a tree has learned."""
        self.root.room[tree] = UNKNOWN
        self.forgotten += 1

    def after(self, node: int, code: int | None) -> int:
        """Return a node's reference for a code of its column; `UNKNOWN` for None."""
        return UNKNOWN if code is None else self._follow_code(node, code)

    def _new_node(self, ask: ColumnQuestion, column: int) -> int:
        self.asks.append(ask)
        self.answers.append({})
        self.waiting.append({})
        self.answered.append(0)
        return self.nodes.append(column, *[0] * (RECORD - 1)) // RECORD

    def _follow(self, node: int, answer: Any) -> int:
        if self.asks[node].question is not None:
            return self.answers[node].get(answer, UNKNOWN)
        return self._follow_code(node, answer)

    def _follow_code(self, node: int, answer: int) -> int:
        low, width, base = self.window(node)
        return int(self.next.room[base + answer - low]) if low <= answer < low + width else UNKNOWN

    def window(self, node: int) -> tuple[int, int, int]:
        """Return the first code of a node's window, its size, and its begin in `next`."""
        low, width, base = self.nodes.room[RECORD * node + LOW : RECORD * node + WORD]
        return int(low), int(width), int(base)

    def _lead(self, tree: int, previous: "tuple[int, Any, Column] | None", reference: int) -> None:
        if previous is None:
            self.root.room[tree] = reference
            return
        node, answer, column = previous
        if self.asks[node].question is None:
            self._widen(node, answer)
            low, _, base = self.window(node)
            self.next.room[base + answer - low] = reference
            return
        self.answers[node][answer] = reference
        self._widen(node, 0)
        self._widen(node, len(column.values) - 1)
        self._fill(node, column)

    def _widen(self, node: int, code: int) -> None:
        """Extend a node's window to a code, and by half of its size, which keeps repeated growth cheap."""
        low, width, old = self.window(node)
        if low <= code < low + width:
            return
        first = min(low, code) if width else code
        last = max(low + width - 1, code) + width // 2 if width else code
        base = self.next.extend(last - first + 1, UNKNOWN)
        if width:
            self.next.room[base + low - first : base + low - first + width] = self.next.room[
                old : old + width
            ]
        self.nodes.room[RECORD * node + LOW : RECORD * node + WORD] = first, last - first + 1, base

    def _fill(self, node: int, column: Column) -> None:
        """Compute the answers of a node's question for the codes in its window, each once."""
        ask, answers, waiting = self.asks[node], self.answers[node], self.waiting[node]
        _, width, base = self.window(node)
        assert ask.question is not None
        end = min(width, len(column.values))
        for code in range(self.answered[node], end):
            answer = ask.question(column.value(code), *ask.constants)
            waiting.setdefault(answer, []).append(code)
        self.answered[node] = max(self.answered[node], end)
        for answer in answers.keys() & waiting.keys():
            self.next.room[base + np.array(waiting.pop(answer))] = answers[answer]
