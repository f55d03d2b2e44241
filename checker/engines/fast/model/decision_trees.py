"""Decision trees as arrays: an inner node tests a column, a leaf holds the result.

A reference is a number: 0 for not learned yet, k > 0 for inner node k - 1, k < 0 for leaf -k - 1. An inner node has a
window of codes; for each of them, `next` holds a reference. A node with a question has the same reference for all codes
with the same answer. Its window begins at code 0 and has room for all values of its column, so a new value needs no
rule where its answer is known: all nodes with questions about the column get the reference at once.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.model.columns import Column
from checker.recording.access_recording import ColumnQuestion
from semantics.state.cell_values import Cell

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
class QuestionedColumn:
    """A column with its questions, and the nodes that ask them.

    Attributes:
        column: The column.
        numbers: The questions, with a number for each.
        codes: For each question, the codes of the answered values by their answer.
        answered: The number of values whose answers are known.
        nodes: The inner nodes.
        asked: The number of the question of each node.
        width: The size of the window of each node.
    """

    column: Column
    numbers: dict[ColumnQuestion, int] = field(default_factory=dict)
    codes: list[dict[Any, list[int]]] = field(default_factory=list)
    answered: int = 0
    nodes: list[int] = field(default_factory=list)
    asked: list[int] = field(default_factory=list)
    width: int = 0

    def number(self, ask: ColumnQuestion) -> int:
        """Return the number of a question."""
        if ask not in self.numbers:
            self.numbers[ask] = len(self.codes)
            self.codes.append({})
            for code in range(self.answered):
                self._answer(ask, code)
        return self.numbers[ask]

    def answers(self, code: int) -> list[Any]:
        """Return the answer of each question for a new value."""
        self.answered = code + 1
        return [self._answer(ask, code) for ask in self.numbers]

    def _answer(self, ask: ColumnQuestion, code: int) -> Any:
        assert ask.question is not None
        answer = ask.question(self.column.value(code), *ask.constants)
        self.codes[self.numbers[ask]].setdefault(answer, []).append(code)
        return answer


@dataclass(slots=True)
class Trees:
    """All decision trees of an exploration, by number.

    Attributes:
        root: The reference to the root of each tree.
        nodes: `RECORD` numbers for each inner node.
        next: References, window by window.
        asks: The question of each inner node.
        answers: For each inner node with a question, the reference for each answer.
        questioned: The columns with questions, by their cells.
        forgotten: The number of times that a tree was discarded.
    """

    root: Growing = field(default_factory=lambda: Growing(np.int32))
    nodes: Growing = field(default_factory=lambda: Growing(np.uint64))
    next: Growing = field(default_factory=lambda: Growing(np.int32))
    asks: list[ColumnQuestion] = field(default_factory=list)
    answers: list[dict[Any, int]] = field(default_factory=list)
    questioned: dict[Cell, QuestionedColumn] = field(default_factory=dict)
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
        previous: tuple[int, Any] | None = None
        for (ask, answer), (column, number) in zip(path, columns, strict=True):
            if reference == UNKNOWN:
                reference = self._new_node(ask, column, number) + 1
                self._lead(tree, previous, reference)
            if reference < 0 or self.asks[reference - 1] != ask:
                raise LearningError(f"a rule asked {ask} out of turn")
            previous = (reference - 1, answer)
            reference = self._follow(*previous)
        if reference not in (UNKNOWN, leaf_reference(leaf)):
            raise LearningError("a rule asked less than before, with the same answers")
        self._lead(tree, previous, leaf_reference(leaf))

    def settle(self, cells: Iterable[Cell]) -> None:
        """Answer all questions about some cells for the new values of their columns."""
        for cell in cells:
            questioned = self.questioned.get(cell)
            if questioned is not None:
                self._settle(questioned)

    def forget(self, tree: int) -> None:
        """Discard everything that a tree has learned."""
        self.root.room[tree] = UNKNOWN
        self.forgotten += 1

    def window(self, node: int) -> tuple[int, int, int]:
        """Return the first code of a node's window, its size, and its begin in `next`."""
        low, width, base = self.nodes.room[RECORD * node + LOW : RECORD * node + WORD]
        return int(low), int(width), int(base)

    def _new_node(self, ask: ColumnQuestion, column: Column, number: int) -> int:
        node = len(self.asks)
        self.asks.append(ask)
        self.answers.append({})
        self.nodes.append(number, *[0] * (RECORD - 1))
        if ask.question is not None:
            self._ask(node, ask, column)
        return node

    def _ask(self, node: int, ask: ColumnQuestion, column: Column) -> None:
        """Add a new node to those that ask a question."""
        if ask.cell not in self.questioned:
            self.questioned[ask.cell] = QuestionedColumn(column)
            self._settle(self.questioned[ask.cell])
        questioned = self.questioned[ask.cell]
        questioned.asked.append(questioned.number(ask))
        questioned.nodes.append(node)
        width = questioned.width
        self.nodes.room[RECORD * node + LOW : RECORD * node + WORD] = (
            0,
            width,
            self.next.extend(width, UNKNOWN),
        )

    def _follow(self, node: int, answer: Any) -> int:
        if self.asks[node].question is not None:
            return self.answers[node].get(answer, UNKNOWN)
        low, width, base = self.window(node)
        return int(self.next.room[base + answer - low]) if low <= answer < low + width else UNKNOWN

    def _lead(self, tree: int, previous: tuple[int, Any] | None, reference: int) -> None:
        if previous is None:
            self.root.room[tree] = reference
            return
        node, answer = previous
        ask = self.asks[node]
        if ask.question is None:
            self._widen(node, answer)
            low, _, base = self.window(node)
            self.next.room[base + answer - low] = reference
            return
        self.answers[node][answer] = reference
        questioned = self.questioned[ask.cell]
        codes = questioned.codes[questioned.numbers[ask]].get(answer, ())
        _, _, base = self.window(node)
        self.next.room[base + np.array(codes, np.int64)] = reference

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

    def _settle(self, questioned: QuestionedColumn) -> None:
        """Answer all questions about a column for its new values, and lead the nodes with known answers onward."""
        count, nodes = len(questioned.column.values), np.array(questioned.nodes, np.int64)
        if count > questioned.width:
            self._widen_all(questioned, nodes, 1 << (count - 1).bit_length())
        bases = self.nodes.room[RECORD * nodes + BASE].astype(np.int64)
        for code in range(questioned.answered, count):
            answers = questioned.answers(code)
            pairs = zip(questioned.nodes, questioned.asked, strict=True)
            self.next.room[bases + code] = [
                self.answers[node].get(answers[ask], UNKNOWN) for node, ask in pairs
            ]

    def _widen_all(self, questioned: QuestionedColumn, nodes: NDArray[np.int64], width: int) -> None:
        """Give all nodes that ask about a column windows of another width."""
        old = self.nodes.room[RECORD * nodes + BASE].astype(np.int64)
        new = self.next.extend(len(nodes) * width, UNKNOWN) + width * np.arange(len(nodes))
        codes = np.arange(questioned.width)
        self.next.room[new[:, None] + codes] = self.next.room[old[:, None] + codes]
        self.nodes.room[RECORD * nodes + WIDTH] = width
        self.nodes.room[RECORD * nodes + BASE] = new
        questioned.width = width
