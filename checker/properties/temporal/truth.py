"""The truth of formulas without temporal operators: arrays over configurations and edges."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from checker.engines.graph import Bools, Graph
from checker.limits import look
from semantics.properties.propositions import Always, And, Not, Or, Proposition, holds
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Now,
    Steps,
    Taken,
    Temporal,
    atoms,
    parts,
)
from semantics.state.configuration import Configuration

Valuation = Mapping[Proposition, Bools]
"""For each proposition, whether it is true in each configuration."""

OFTEN = 1024
"""The number of configurations between two checks of the time."""


def valuation(configurations: Iterable[Configuration], asked: Iterable[Proposition]) -> Valuation:
    """Evaluate propositions on all configurations."""
    wanted = tuple(dict.fromkeys(asked))
    rows = [_row(number, c, wanted) for number, c in enumerate(configurations)]
    table = np.array(rows, dtype=np.bool_).reshape(len(rows), len(wanted))
    return {each: np.ascontiguousarray(table[:, column]) for column, each in enumerate(wanted)}


def _row(number: int, c: Configuration, wanted: Iterable[Proposition]) -> list[bool]:
    if number % OFTEN == 0:
        look()
    return [holds(each, c) for each in wanted]


@dataclass(eq=False)
class FormulaTruth:
    """The truth of formulas on a graph.

    Attributes:
        graph: The graph, total.
        values: The truth of its propositions, or of their atoms.
    """

    graph: Graph
    values: Valuation
    known: dict[Temporal, Bools] = field(default_factory=dict)

    def steps(self, steps: Steps) -> Bools:
        """Return for each edge whether it is one of some steps."""
        return self.graph.taken(np.array([steps.has(label) for label in self.graph.labels], dtype=np.bool_))

    def here(self, formula: Temporal) -> Bools:
        """Return for each configuration whether a formula about it alone is true."""
        if formula not in self.known:
            self.known[formula] = self._here(formula)
        return self.known[formula]

    def _here(self, formula: Temporal) -> Bools:
        match formula:
            case Now(Always(value)):
                return np.full(self.graph.size, value)
            case Now(proposition) if proposition in self.values:
                return self.values[proposition]
            case Now(Not(inner)):
                return ~self.here(Now(inner))
            case Now(And(formulas)):
                return self.joined(np.logical_and, True, formulas)
            case Now(Or(formulas)):
                return self.joined(np.logical_or, False, formulas)
            case Enabled(steps):
                return self.graph.enabled(self.steps(steps))
            case Denied(inner):
                return ~self.here(inner)
            case Both(left, right):
                return self.here(left) & self.here(right)
            case Either(left, right):
                return self.here(left) | self.here(right)
        raise ValueError(f"a configuration alone does not decide the formula: {formula}")

    def joined(self, how: np.ufunc, neutral: bool, formulas: Iterable[Proposition]) -> Bools:
        """Return for each configuration the value of a connective of propositions."""
        found = np.full(self.graph.size, neutral)
        for each in formulas:
            how(found, self.here(Now(each)), out=found)
        return found

    def everywhere(self, formula: Temporal) -> Bools | None:
        """Return for each edge whether a formula is true; None if it has temporal operators."""
        if isinstance(formula, Taken):
            return self.taken(formula)
        if isinstance(formula, Now | Enabled):
            return self.here(formula)[self.graph.sources]
        if not isinstance(formula, Denied | Both | Either):
            return None
        inner = [self.everywhere(each) for each in parts(formula)]
        known = [each for each in inner if each is not None]
        if len(known) < len(inner):
            return None
        if isinstance(formula, Denied):
            return ~known[0]
        return known[0] & known[1] if isinstance(formula, Both) else known[0] | known[1]

    def taken(self, atom: Taken) -> Bools:
        """Return for each edge whether an atom about it is true."""
        if atom not in self.known:
            self.known[atom] = self.steps(atom.steps)
        return self.known[atom]


def is_about_steps(formula: Temporal) -> bool:
    """Return whether a formula asks for enabled steps."""
    return any(isinstance(atom, Enabled) for atom in atoms(formula))
