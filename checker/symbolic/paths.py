"""Paths of decision trees as sets: who comes to a leaf.

A path is found by one configuration that takes it, and stands for all that do. Where the configuration falls off the
tree, the rule is learned.
"""

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from checker.bounding import look
from checker.fast.learner import CodedSource, Learner
from checker.fast.trees import UNKNOWN
from checker.symbolic.coding import Coding
from checker.symbolic.diagrams import Set


class Outgrown(Exception):
    """What was learned has values that there are no bits for, or takes back what was learned before."""


class Path(NamedTuple):
    """A leaf, and who comes to it by one path."""

    leaf: int
    who: Set


class Paths:
    """Learns paths.

    Attributes:
        learner: What is known of the rules.
        coding: How configurations are written.
    """

    def __init__(self, learner: Learner, coding: Coding) -> None:
        self.learner = learner
        self.coding = coding

    def path(self, tree: int, codes: list[int]) -> Path:
        """Return the path that a configuration takes, learning it where it is not known.

        Raises:
            Outgrown: What was learned asks for a new coding.
        """
        while True:
            asked, reference = self._walk(tree, codes)
            if reference < 0:
                return Path(-reference - 1, self.coding.diagrams.meet(self._who(*each) for each in asked))
            look()
            self._learn(tree, codes, asked)

    def all_of(self, tree: int) -> Iterator[Path]:
        """Yield all known paths of a tree."""
        yield from self._below(int(self.learner.trees.root.room[tree]), self.coding.diagrams.all)

    def groups(self, tree: int) -> Iterator[tuple[int, frozenset[int]]]:
        """Yield the leaves of a tree, each with the columns that are asked on the way there."""
        waiting = [(int(self.learner.trees.root.room[tree]), frozenset[int]())]
        while waiting:
            reference, asked = waiting.pop()
            if reference < 0:
                yield -reference - 1, asked
            elif reference != UNKNOWN:
                more = asked | {self.learner.trees.column_of(reference - 1)}
                waiting += [(each, more) for each in self._leads(reference - 1)]

    def _walk(self, tree: int, codes: list[int]) -> tuple[list[tuple[int, int]], int]:
        """Return the nodes on the way with the references that they lead to, and the last of these."""
        trees = self.learner.trees
        reference, asked = int(trees.root.room[tree]), []
        while reference > 0:
            node = reference - 1
            column, (low, width, base) = trees.column_of(node), trees.window(node)
            at = (codes[column] if column < len(codes) else 0) - low
            reference = int(trees.next.room[base + at]) if 0 <= at < width else UNKNOWN
            asked.append((node, reference))
        return asked, reference

    def _learn(self, tree: int, codes: list[int], asked: list[tuple[int, int]]) -> None:
        learner, varying = self.learner, len(self.learner.varying)
        source = CodedSource(learner.columns, codes)
        if asked:
            node = asked[-1][0]
            column = learner.trees.column_of(node)
            if learner.trees.settle(node, source.code(column), learner.columns.all[column]):
                return
        dug = sum(learner.columns.holes.values())
        learner.learn(tree, source)
        forgotten = len(learner.varying) > varying or sum(learner.columns.holes.values()) > dug
        if forgotten or not self.coding.holds:
            raise Outgrown

    def _leads(self, node: int) -> dict[int, list[int]]:
        """Return what a node leads to, each with the codes that it leads there."""
        trees = self.learner.trees
        column, (low, width, base) = trees.column_of(node), trees.window(node)
        known = len(self.learner.columns.all[column].values)
        found: defaultdict[int, list[int]] = defaultdict(list)
        for code, reference in enumerate(trees.next.room[base : base + width].tolist(), low):
            if reference != UNKNOWN and code < known:
                found[reference].append(code)
        return found

    def _who(self, node: int, reference: int) -> Set:
        """Return who is led on by a node as by a reference."""
        trees = self.learner.trees
        column, (low, width, base) = trees.column_of(node), trees.window(node)
        led = np.flatnonzero(trees.next.room[base : base + width] == reference) + low
        return self._codes(
            node, [code for code in led.tolist() if code < len(self.learner.columns.all[column].values)]
        )

    def _codes(self, node: int, codes: list[int]) -> Set:
        column = self.learner.trees.column_of(node)
        return self.coding.diagrams.join(self.coding.code(column, code) for code in codes)

    def _below(self, reference: int, who: Set) -> Iterator[Path]:
        if reference < 0:
            yield Path(-reference - 1, who)
        elif reference != UNKNOWN:
            for below, codes in self._leads(reference - 1).items():
                here = who & self._codes(reference - 1, codes)
                if here.satisfiable():
                    yield from self._below(below, here)
