"""Tight automata: they repeat as soon as a run does, so their product with a graph has a shortest lasso.

A state says which of some formulas are true from there on. What is true at one moment follows from the step that is
taken and from what is true at the next; so where the rest of a run is the same, the state is too. An automaton that
decides a formula has fewer states, but may have to go round a loop several times, or come into it later (Schuppan and
Biere, Shortest counterexamples for symbolic model checking of LTL with past, TACAS 2005).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce
from operator import and_, or_
from typing import Final

import numpy as np

from checker.engines.graph import Bools, Numbers
from checker.properties.temporal.digraph import Indices, Rows, rows_of
from checker.properties.temporal.effort import Exhausted
from checker.properties.temporal.negation_normal_form import FALSE, TRUE, Formulas, Literal, Number, Operation
from semantics.properties.temporal import Temporal

MOST_BITS: Final = 14
"""How many literals and formulas an automaton may be about: its table has a row for each set of them."""


@dataclass(frozen=True, eq=False)
class Tight:
    """A tight automaton. Letters and states are sets of bits.

    Attributes:
        literals: What is claimed of a step, bit by bit.
        states: How many there are. Those that begin have the last bit.
        steps: From each letter and state to the states that may follow.
        marks: For each letter and state that may follow, the promises that are kept, a bit each.
        promises: How many there are.
    """

    literals: tuple[Literal, ...]
    states: int
    steps: Rows
    marks: Numbers
    promises: int


def tight(formula: Temporal) -> Tight:
    """Return the tight automaton of the runs on which a formula is false.

    Raises:
        Exhausted: It would be too large.
    """
    formulas = Formulas()
    return _Table(formulas, formulas.normal(formula, claimed=False)).automaton()


class _Table:
    """Which formulas are true, for each letter and each state after it."""

    def __init__(self, formulas: Formulas, start: Number) -> None:
        self.formulas = formulas
        reached = sorted(_reached(formulas, start))
        operations = {number: formulas.nodes[number] for number in reached}
        literals = [each.literal for each in operations.values() if each.literal is not None]
        self.literals = tuple(literals)
        self.ranks = {n: rank for rank, n in enumerate(n for n, each in operations.items() if each.literal)}
        self.untils = [number for number, each in operations.items() if each.operator == "until"]
        self.said = (*sorted(_said_of_later(operations) - {start}), start)
        if len(self.literals) + len(self.said) > MOST_BITS:
            raise Exhausted
        shape = (1 << len(self.literals), 1 << len(self.said))
        self.letter, self.after = np.indices(shape).reshape(2, -1)
        self.truths: dict[Number, Bools] = {FALSE: self.after < 0, TRUE: self.after >= 0}

    def automaton(self) -> Tight:
        states = 1 << len(self.said)
        now = self.letter * states + bits([self.true(number) for number in self.said], len(self.after))
        order = np.argsort(now, kind="stable")
        steps = rows_of(now[order], self.after[order], len(now))
        marks = bits([self.kept(number) for number in self.untils], len(self.after))
        return Tight(self.literals, states, steps, marks, len(self.untils))

    def true(self, number: Number) -> Bools:
        """Return where a formula is true."""
        if number not in self.truths:
            self.truths[number] = self._true(number, self.formulas.nodes[number])
        return self.truths[number]

    def _true(self, number: Number, operation: Operation) -> Bools:
        operands = operation.operands
        match operation.operator:
            case "lit":
                return _has(self.letter, self.ranks[number])
            case "and":
                return reduce(and_, map(self.true, operands))
            case "or":
                return reduce(or_, map(self.true, operands))
            case "next":
                return self.later(operands[0])
            case "until":
                return self.true(operands[1]) | (self.true(operands[0]) & self.later(number))
            case _:
                return self.true(operands[1]) & (self.true(operands[0]) | self.later(number))

    def later(self, number: Number) -> Bools:
        return _has(self.after, self.said.index(number))

    def kept(self, until: Number) -> Bools:
        """Return where an until is fulfilled, or nobody has promised it."""
        return ~self.true(until) | self.true(self.formulas.nodes[until].operands[1])


def _has(sets: Indices, bit: int) -> Bools:
    found: Bools = (sets >> bit) & 1 == 1
    return found


def _reached(formulas: Formulas, start: Number) -> set[Number]:
    found, waiting = set[Number](), [start]
    while waiting:
        number = waiting.pop()
        if number not in found:
            found.add(number)
            waiting += formulas.nodes[number].operands
    return found


def _said_of_later(operations: dict[Number, Operation]) -> set[Number]:
    """Return the formulas of which the present asks whether they are true at the next moment."""
    nexts = {each.operands[0] for each in operations.values() if each.operator == "next"}
    return nexts | {number for number, each in operations.items() if each.operator in ("until", "release")}


def bits(columns: Iterable[Bools], size: int) -> Indices:
    """Return columns as numbers, a bit for each."""
    found = np.zeros(size, dtype=np.int64)
    for bit, column in enumerate(columns):
        found |= column.astype(np.int64) << bit
    return found
