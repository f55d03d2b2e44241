"""Surveys: the answers of all rows to a question, each with its number of rows and its first row."""

from collections.abc import Callable, Hashable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.model.learner import TransitionGroup
from checker.engines.fast.search.rule_model import RuleModel
from semantics.state.cell_values import AGENTS
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.successors import Expansion, expand

BLOCK = 1 << 18
"""The number of rows classified together: the results take some fifty bytes for each."""


@dataclass(frozen=True, slots=True)
class SurveyAnswer:
    """One answer to a question.

    Attributes:
        value: The answer.
        count: The number of configurations that give it.
        first: The first of them.
    """

    value: Any
    count: int
    first: int


class RowSurvey:
    """Evaluates questions on the expanded configurations.

    Attributes:
        model: The configurations, and what is known of their rules.
        taken: How often each transition is enabled in them.
        size: The number of configurations.
    """

    def __init__(self, model: RuleModel, taken: NDArray[np.int64]) -> None:
        self.model = model
        self.learner = model.learner
        self.taken = taken
        self.size = model.store.expanded

    def agents(self) -> tuple[Name, ...]:
        """Return every agent of some configuration, sorted."""
        learner = self.learner
        groups = [learner.still.read(AGENTS)]
        if AGENTS in learner.varying:
            column = learner.columns.all[learner.columns.numbers[(AGENTS,)]]
            groups = [column.value(code) for code in range(len(column.values))]
        return tuple(sorted({agent for group in groups for agent in group}))

    def configuration(self, number: int) -> Configuration:
        """Return a configuration."""
        return self.model.configuration(number)

    def classify(self, tree: int, rows: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the leaf of each row in a tree."""
        return self.model.classify(tree, rows)

    def shown(self, number: int) -> Iterator[tuple[Configuration, Expansion]]:
        """Yield a configuration with its expansion, as input for an inspection."""
        c = self.configuration(number)
        yield c, expand(c)

    def answers(self, question: Callable[[Configuration], Hashable]) -> list[SurveyAnswer]:
        """Return each distinct answer once, in the order of first occurrence."""
        found: dict[Hashable, SurveyAnswer] = {}
        tree = self.learner.question(question)
        for rows, leaves in self.leaves(tree):
            for leaf, first, count in distinct(leaves):
                value = self.learner.answers[leaf]
                before = found.get(value)
                start = int(rows[first]) if before is None else min(before.first, int(rows[first]))
                found[value] = SurveyAnswer(value, count + (0 if before is None else before.count), start)
        return sorted(found.values(), key=lambda answer: answer.first)

    def blocks(self, size: int | None = None) -> Iterator[NDArray[np.int64]]:
        """Yield the numbers of the expanded configurations, or of the first `size`, block by block."""
        end = self.size if size is None else size
        for begin in range(0, end, BLOCK):
            yield np.arange(begin, min(begin + BLOCK, end), dtype=np.int64)

    def leaves(self, tree: int) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int32]]]:
        """Yield rows with their leaves in a tree, block by block."""
        return ((rows, self.classify(tree, rows)) for rows in self.blocks())

    def where(self, question: Callable[[Configuration], bool], size: int | None = None) -> NDArray[np.bool_]:
        """Return the truth of a question for each expanded configuration, or for the first `size`."""
        return self.where_with_change(question, size)[0]

    def where_with_change(
        self, question: Callable[[Configuration], bool], size: int | None = None
    ) -> tuple[NDArray[np.bool_], bool]:
        """Return where the answer is yes, and whether some value that it read differs between rows."""
        tree = self.learner.question(question)
        found = [np.zeros(0, np.bool_)]
        met: set[int] = set()
        numbers: dict[Hashable, int] = {False: 0, True: 1}
        for rows in self.blocks(size):
            leaves = self.classify(tree, rows)
            met.update(distinct_leaves(leaves))
            found.append(self.numbered(leaves, numbers) == 1)
        return np.concatenate(found), len(met) > 1

    def numbered(self, leaves: NDArray[np.int32], numbers: dict[Hashable, int]) -> NDArray[np.int64]:
        """Return the number of each leaf's answer; new answers get the next numbers."""
        there = distinct_leaves(leaves)
        found = np.zeros(there[-1] + 1 if there else 0, np.int64)
        found[there] = [numbers.setdefault(self.learner.answers[leaf], len(numbers)) for leaf in there]
        return found[leaves]

    def of_actor(self, actor: TransitionGroup) -> int:
        """Return the tree of an actor."""
        return self.learner.tree(actor)


def distinct_leaves(leaves: NDArray[np.int32]) -> list[int]:
    """Return each leaf once, in ascending order."""
    found: list[int] = np.flatnonzero(np.bincount(leaves)).tolist()
    return found


def distinct(leaves: NDArray[np.int32]) -> Iterator[tuple[int, int, int]]:
    """Yield each leaf with its first position and its number of occurrences."""
    values, firsts, counts = np.unique(leaves, return_index=True, return_counts=True)
    for value, first, count in zip(values, firsts, counts, strict=True):
        yield int(value), int(first), int(count)
