"""Vacuity of temporal properties: the unneeded parts, and a run that needs the others.

A part is replaced by the strongest constant, and the formula is decided again on the same graph. If it fails then, the
counterexample is a run on which the part is needed (an interesting witness).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import reduce
from typing import Final, cast

from checker.engines.graph import Graph
from checker.limits import BoundMet
from checker.properties.subformulas import Formula, Subformula, at, few, never_needed, unneeded
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.buchi_automaton import AutomatonTooLargeError
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.digraph import shortest
from checker.properties.temporal.effort import Exhausted
from checker.properties.temporal.lasso_evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso, component_of, fair_cycle, tightened
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.truth import FormulaTruth
from semantics.properties.property import Ranges
from semantics.properties.propositions import Always, Not, Or
from semantics.properties.temporal import Denied, Either, Globally, Now, OnAllPaths, Temporal, conjuncts

MOST_EDGES: Final = 1_000_000
"""The budget for deciding a formula's variants, in edges; each decision costs the edges of the graph."""


IsKept = Callable[[Temporal], bool]
"""Returns whether a graph decides a formula; the graph of a reduced exploration does not decide all."""


def every_formula(_: Temporal) -> bool:
    """Return whether a graph with every run decides a formula: it does."""
    return True


@dataclass(frozen=True, slots=True)
class Judged:
    """The reasons why a true formula is vacuous, and a run on which it is not."""

    remarks: tuple[str, ...] = ()
    witness: Lasso | None = None


@dataclass(eq=False)
class _Trials:
    """Decides strengthened formulas within a bound, and records those that fail.

    A formula that the graph does not decide is taken to fail.

    Attributes:
        truth: The truth of atoms.
        decide: Returns whether a formula holds.
        left: The number of decisions left.
        is_kept: Returns whether the graph decides a formula.
    """

    truth: FormulaTruth
    decide: Callable[[Temporal], bool]
    left: int
    is_kept: IsKept
    failed: list[Temporal] = field(default_factory=list)

    def holds(self, formula: Formula) -> bool:
        strengthened = cast("Temporal", formula)  # the original is a temporal formula
        if not self.is_kept(strengthened):
            return False
        if self.left == 0:
            raise Exhausted
        self.left -= 1
        held = self.decide(strengthened)
        if not held:
            self.failed.append(strengthened)
        return held

    def is_never(self, condition: Temporal) -> bool:
        """Return whether a condition about one configuration or step is never true."""
        if not self.is_kept(Globally(Denied(condition))):
            return False
        true = self.truth.everywhere(condition)
        return true is not None and not true.any()


def is_judged(graph: Graph) -> bool:
    """Return whether a graph is small enough for repeated decisions."""
    return len(graph.targets) <= MOST_EDGES


def judge_linear(
    truth: FormulaTruth,
    formula: Temporal,
    fairness: Conditions,
    ranges: Ranges,
    is_kept: IsKept = every_formula,
) -> Judged:
    """Return the judgement on a formula that all fair runs of a complete graph satisfy."""
    graph, held = truth.graph, set(conjuncts(formula))

    def decide(strengthened: Temporal) -> bool:
        changed = (each for each in conjuncts(strengthened) if each not in held)
        return all(counterexample(graph, truth, each, fairness) is None for each in changed)

    trials = _Trials(truth, decide, MOST_EDGES // max(1, len(graph.targets)), is_kept)
    remarks = _remarks(formula, ranges, trials)
    if not trials.left or (remarks and not trials.failed):
        return Judged(remarks)
    try:
        witness = _witness(truth, trials.failed, fairness)
    except BoundMet:
        return Judged(remarks)
    if witness is not None and not is_true_on(witness, formula, truth):
        raise AssertionError(f"a run violates a formula that holds: {formula}")
    return Judged(remarks, witness)


def judge_branching(
    tree: Branching, formula: Temporal, ranges: Ranges, is_kept: IsKept = every_formula
) -> Judged:
    """Return the judgement on a true formula; with a witness if its own evidence is empty."""
    most = MOST_EDGES // max(1, len(tree.graph.targets))
    trials = _Trials(tree.truth, lambda each: bool(tree.where(each)[0]), most, is_kept)
    remarks = _remarks(formula, ranges, trials)
    if len(tree.evidence(formula)):
        return Judged(remarks)
    found = (tree.evidence(each, claimed=False) for each in trials.failed)
    try:
        return Judged(remarks, max(filter(len, found), key=len, default=None))
    except BoundMet:
        return Judged(remarks)


# --- unneeded parts -------------------------------------------------------------------------------------------


def _remarks(formula: Temporal, ranges: Ranges, trials: _Trials) -> tuple[str, ...]:
    """Return the remarks on parts, as far as bounds allow."""
    found = list(_never_begun(formula, trials))
    if found:
        return tuple(found)
    try:
        found.extend(_remark(formula, *each, trials) for each in unneeded(formula, ranges, trials.holds))
    except (Exhausted, AutomatonTooLargeError, BoundMet):
        trials.left = 0
    return few(found)


def _never_begun(formula: Temporal, trials: _Trials) -> Iterator[str]:
    """Yield a remark if the condition of an implication is never true; this needs no decision."""
    match formula:
        case Globally(Either(Denied(condition), conclusion)) | OnAllPaths(
            Globally(Either(Denied(condition), conclusion))
        ):
            if trials.is_never(condition):
                yield f"vacuous: '{condition}' is never true, so that '{conclusion}' is never needed"


def _remark(formula: Temporal, around: Subformula, part: Subformula, trials: _Trials) -> str:
    said = never_needed(around, part)
    conditions = [_condition_before(formula, path) for path in part.paths]
    if all(each is not None and trials.is_never(each) for each in conditions):
        never = "and its like are" if len(conditions) > 1 else "is"
        return f"vacuous: '{conditions[0]}' {never} never true, so that {said}"
    return f"{said}: it holds without"


def _condition_before(formula: Temporal, path: tuple[int, ...]) -> Temporal | None:
    """Return the condition of an implication with its conclusion at a position."""
    if path[-1] != 1:
        return None
    match at(formula, path[:-1]):
        case Either(Denied(condition), _):
            return condition
        case Or((Not(condition), _)):
            return Now(condition)
    return None


# --- an interesting witness -----------------------------------------------------------------------------------


def _witness(truth: FormulaTruth, failed: list[Temporal], fairness: Conditions) -> Lasso | None:
    """Return a run on which all of some formulas are false; else the shortest one found for a single formula."""
    try:
        wanted = reduce(Either, failed, cast("Temporal", Now(Always(False))))
        found = _run_against(truth, wanted, fairness)
        if found is not None:
            return found
    except AutomatonTooLargeError:
        pass
    runs = (_run_against(truth, each, fairness) for each in failed)
    return min((run for run in runs if run is not None), key=len, default=None)


def _run_against(truth: FormulaTruth, formula: Temporal, fairness: Conditions) -> Lasso | None:
    found = counterexample(truth.graph, truth, formula, fairness)
    return None if found is None else _continued(truth.graph, found, fairness)


def _continued(graph: Graph, run: Lasso, fairness: Conditions) -> Lasso:
    """Return a fair infinite run with the given beginning."""
    if run.loop:
        return run
    end = int(graph.targets[run.stem[-1]]) if run.stem else 0
    components = fair_components(graph, fairness)
    path = () if components[end] >= 0 else shortest(graph, end, (components >= 0)[graph.targets])
    assert path is not None  # every run has a fair continuation
    entry = int(graph.targets[path[-1]]) if path else end
    loop = fair_cycle(component_of(graph, components, entry, fairness), entry)
    return tightened(Lasso((*run.stem, *path), loop))
