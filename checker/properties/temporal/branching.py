"""Branching time by fixpoints: the configurations where a formula is true, and a run that shows its initial value.

A partial graph gives bounds: where a formula is surely true, and where it may be.
"""

from dataclasses import dataclass, field

import numpy as np

from checker.engines.graph import Bools, Graph
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.digraph import Digraph, reaching, reversed_rows, shortest
from checker.properties.temporal.lassos import Lasso, component_of, fair_cycle, tightened
from checker.properties.temporal.shortest import shortest_run
from checker.properties.temporal.truth import FormulaTruth
from semantics.properties.propositions import Always
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Eventually,
    Globally,
    Next,
    Now,
    OnAllPaths,
    OnSomePath,
    Path,
    Release,
    Temporal,
    Until,
    WeakUntil,
)

TRUE, FALSE = Now(Always(True)), Now(Always(False))


@dataclass(eq=False)
class Branching:
    """Evaluates formulas on a graph.

    Attributes:
        graph: The explored graph, total.
        truth: The truth of atoms in its configurations.
        fairness: The fairness conditions of the runs that path quantifiers range over.
    """

    graph: Graph
    truth: FormulaTruth
    fairness: Conditions
    known: dict[tuple[Temporal, bool], Bools] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.backwards: Digraph = reversed_rows(self.graph)

    def where(self, formula: Temporal, *, perhaps: bool = False) -> Bools:
        """Return where a formula is surely true, or may be: the same, unless the graph is partial."""
        return self._where(core(formula), perhaps and self.graph.partial is not None)

    def _where(self, formula: Temporal, perhaps: bool) -> Bools:
        if (formula, perhaps) not in self.known:
            self.known[formula, perhaps] = self._evaluate(formula, perhaps)
        return self.known[formula, perhaps]

    def _evaluate(self, formula: Temporal, perhaps: bool) -> Bools:
        match formula:
            case Now():
                return self.truth.here(formula)
            case Enabled():
                return self.truth.here(formula) | self.graph.open if perhaps else self.truth.here(formula)
            case Denied(inner):
                return ~self._where(inner, not perhaps and self.graph.partial is not None)
            case Both(left, right):
                return self._where(left, perhaps) & self._where(right, perhaps)
            case Either(left, right):
                return self._where(left, perhaps) | self._where(right, perhaps)
            case OnSomePath(Next(inner)):
                return self.before(self._where(inner, perhaps), perhaps)
            case OnSomePath(Until(left, right)):
                return self.until(self._where(left, perhaps), self._where(right, perhaps), perhaps)
            case OnSomePath(Release(left, right)):
                kept = self._where(right, perhaps)
                ended = self.until(kept, kept & self._where(left, perhaps), perhaps)
                return ended | self.for_ever(kept, perhaps)
        raise ValueError(f"no branching formula: {formula}")

    def before(self, after: Bools, perhaps: bool) -> Bools:
        """Return the configurations with a successor among these."""
        found = self.graph.enabled(after[self.graph.targets])
        return found | self.graph.open if perhaps else found

    def until(self, kept: Bools, goal: Bools, perhaps: bool) -> Bools:
        """Return the configurations from which a run stays in `kept` until it reaches a goal."""
        return reaching(self.backwards, goal | (self.graph.open & kept) if perhaps else goal, kept)

    def for_ever(self, kept: Bools, perhaps: bool) -> Bools:
        """Return the configurations from which a fair run stays in `kept`."""
        return self.until(kept, self.fair(kept) >= 0, perhaps)

    def fair(self, kept: Bools) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
        """Return the fair components among some configurations; with fairness only among fully expanded ones."""
        return fair_components(
            self.graph, self.fairness, kept if self.fairness.none else kept & ~self.graph.open
        )

    # --- evidence

    def evidence(self, formula: Temporal, at: int = 0, *, claimed: bool = True) -> Lasso:
        """Return a run that shows why a formula is surely true, or surely false, at a configuration.

        No single run shows a true formula about all paths, or a false one about some path: the run ends there.
        """
        return self._evidence(core(formula), at, claimed)

    def _evidence(self, formula: Temporal, at: int, claimed: bool) -> Lasso:
        match formula:
            case Denied(inner):
                return self._evidence(inner, at, not claimed)
            case Both(left, right) if not claimed:
                return self._evidence(left if self._surely(left, False)[at] else right, at, False)
            case Either(left, right) if claimed:
                return self._evidence(left if self._surely(left, True)[at] else right, at, True)
            case Both(left, right) | Either(left, right):
                return max((self._evidence(each, at, claimed) for each in (left, right)), key=len)
            case OnSomePath(Next(inner)) if claimed:
                return self.going(at, np.ones(self.graph.size, dtype=np.bool_), inner, once=True)
            case OnSomePath(Until(left, right)) if claimed:
                return self.going(at, self._surely(left, True), right)
            case OnSomePath(Release(left, right)) if claimed:
                kept = self._surely(right, True)
                if self.until(kept, kept & self._surely(left, True), False)[at]:
                    return self.going(at, kept, Both(left, right))
                return self.staying(at, kept)
        return Lasso((), shortest=True)

    def _surely(self, formula: Temporal, claimed: bool) -> Bools:
        known = self._where(formula, not claimed and self.graph.partial is not None)
        return known if claimed else ~known

    def going(self, at: int, kept: Bools, then: Temporal, *, once: bool = False) -> Lasso:
        """Return a shortest run to a configuration where a formula is true, extended by its evidence."""
        goal = self._surely(then, True)
        if goal[at] and not once:
            return self._evidence(then, at, True)
        within, arriving = kept | goal, goal[self.graph.targets]
        path = shortest(self.graph, at, arriving, through=within)
        assert path is not None  # the backward fixpoint found one
        rest = self._evidence(then, int(self.graph.targets[path[-1]]), True)
        return Lasso((*path, *rest.stem), rest.loop, self.graph.partial is None and not len(rest))

    def staying(self, at: int, kept: Bools) -> Lasso:
        """Return a fair run that stays in some configurations for ever."""
        components = self.fair(kept)
        if components[at] < 0:
            path = shortest(self.graph, at, (components >= 0)[self.graph.targets], through=kept)
            assert path is not None  # the backward fixpoint found one
        else:
            path = ()
        entry = int(self.graph.targets[path[-1]]) if path else at
        part = component_of(self.graph, components, entry, self.fairness)
        known = tightened(Lasso(path, fair_cycle(part, entry)))
        return shortest_run(self.graph, components, self.fairness, known, start=at, through=kept)


def core(formula: Temporal) -> Temporal:
    """Return a formula with `E X`, `E U` and `E R` as its only operators."""
    match formula:
        case Now() | Enabled():
            return formula
        case Denied(inner):
            return Denied(core(inner))
        case Both(left, right):
            return Both(core(left), core(right))
        case Either(left, right):
            return Either(core(left), core(right))
        case OnSomePath(path):
            return _on_some(path)
        case OnAllPaths(path):
            return Denied(_on_some(denied(path)))
    raise ValueError(f"a path operator without a quantifier before it: {formula}")


def _on_some(path: Temporal) -> Temporal:
    match path:
        case Next(inner):
            return OnSomePath(Next(core(inner)))
        case Eventually(inner):
            return OnSomePath(Until(TRUE, core(inner)))
        case Globally(inner):
            return OnSomePath(Release(FALSE, core(inner)))
        case Until(left, right):
            return OnSomePath(Until(core(left), core(right)))
        case Release(left, right):
            return OnSomePath(Release(core(left), core(right)))
        case WeakUntil(left, right):
            return OnSomePath(Release(core(right), core(Either(left, right))))
    raise ValueError(f"a quantifier of paths without an operator behind it: {path}")


def denied(path: Temporal) -> Path:
    """Return the dual of an operator of paths."""
    match path:
        case Next(inner):
            return Next(Denied(inner))
        case Eventually(inner):
            return Globally(Denied(inner))
        case Globally(inner):
            return Eventually(Denied(inner))
        case Until(left, right):
            return Release(Denied(left), Denied(right))
        case Release(left, right):
            return Until(Denied(left), Denied(right))
        case WeakUntil(left, right):
            return Until(Denied(right), Both(Denied(left), Denied(right)))
    raise ValueError(f"a quantifier of paths without an operator behind it: {path}")
