"""Decision trees as arrays: inner nodes test a column, leaves hold the result.

A reference is a number: 0 what is not known yet, k > 0 the inner node k - 1, k < 0 the leaf -k - 1. An inner node has
a window of codes; what its column's code leads to stands in `next`. A node that asks a yes or no leads from every code
with the same answer to the same place.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from checker.engines.fast.arrays import Growing
from checker.engines.fast.columns import Column
from checker.engines.fast.recording import Ask

UNKNOWN = 0
RECORD = 8
"""Numbers that an inner node has; the last is one to spare."""

COLUMN, LOW, WIDTH, BASE, WORD, SHIFT, MASK = range(7)
"""What they are: the column that it asks, the first code of its window, how many codes that has, where it begins in
`next`, and where the column stands in a row as long as the packing is the same (see `kernel.locate`)."""


class LearningError(Exception):
    """A rule asked something else though all its questions were answered alike: a bug, for rules are pure."""


def leaf_reference(leaf: int) -> int:
    """Return the reference to a leaf."""
    return -leaf - 1


@dataclass(slots=True)
class Trees:
    """All decision trees of an exploration, by number.

    Attributes:
        root: For each tree the reference to its root.
        nodes: For each inner node `RECORD` numbers.
        next: References, window by window.
        asks: For each inner node what it asks.
        answers: For each inner node that asks a question, the reference that each answer leads to.
        waiting: For each such node the codes whose answer leads nowhere yet, by that answer.
        answered: For how many codes each such node was asked.
        forgotten: How many times a tree was forgotten.
    """

    root: Growing = field(default_factory=lambda: Growing(np.int32))
    nodes: Growing = field(default_factory=lambda: Growing(np.uint64))
    next: Growing = field(default_factory=lambda: Growing(np.int32))
    asks: list[Ask] = field(default_factory=list)
    answers: list[dict[Any, int]] = field(default_factory=list)
    waiting: list[dict[Any, list[int]]] = field(default_factory=list)
    answered: list[int] = field(default_factory=list)
    forgotten: int = 0

    def plant(self) -> int:
        """Return the number of a new tree that knows nothing."""
        return self.root.append(UNKNOWN)

    def grow(
        self, tree: int, path: Sequence[tuple[Ask, Any]], leaf: int, columns: Sequence[tuple[Column, int]]
    ) -> None:
        """Let a tree know that a path leads to a leaf; `columns` are those asked, with their numbers.

        A path has a code for each value that was read, and a truth for each yes or no.

        Raises:
            LearningError: The tree asks something else there.
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
        """Answer a node's yes or no for a code that it had not met; False where a rule must be run."""
        if self.asks[node].question is None:
            return False
        self._widen(node, code)
        self._fill(node, column)
        return self._follow_code(node, code) != UNKNOWN

    def column_of(self, node: int) -> int:
        """Return the number of the column that a node asks."""
        return int(self.nodes.room[RECORD * node + COLUMN])

    def forget(self, tree: int) -> None:
        """Forget all that a tree knows."""
        self.root.room[tree] = UNKNOWN
        self.forgotten += 1

    def after(self, node: int, code: int | None) -> int:
        """Return the reference that a node leads to by the code of its column; `UNKNOWN` without one."""
        return UNKNOWN if code is None else self._follow_code(node, code)

    def _new_node(self, ask: Ask, column: int) -> int:
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
        """Return the first code of a node's window, how many it has, and where it begins in `next`."""
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
        """Let a node's window take in a code, and half of it more, so that growing again and again stays cheap."""
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
        """Answer a node's question for every code that its window holds and its column has: for each once."""
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
