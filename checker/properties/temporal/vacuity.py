"""Vacuity of temporal properties: the parts that are never needed, and a run that needs the others.

A part is replaced by the worst that may stand there, and the formula is decided once more on the same graph. Where it
doesn't hold then, the run that shows it is one on which the part is needed (an interesting witness).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import reduce
from typing import Final, cast

from checker.engines.graph import Graph
from checker.limits import BoundMet
from checker.properties.subformulas import Formula, Part, at, few, never_needed, unneeded
from checker.properties.temporal.automaton import TooLargeError
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.digraph import shortest
from checker.properties.temporal.effort import Exhausted
from checker.properties.temporal.evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso, component_of, fair_cycle, tightened
from checker.properties.temporal.linear import conjuncts, counterexample
from checker.properties.temporal.truth import Truth
from semantics.properties.property import Ranges
from semantics.properties.propositions import Always, Not, Or
from semantics.properties.temporal import Denied, Either, Globally, Now, OnAllPaths, Temporal

MOST_EDGES: Final = 1_000_000
"""A formula is decided again as often as a graph's edges go into so many, and not at all where they don't."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What makes a formula that holds say less than it seems to, and a run on which it says what it says."""

    remarks: tuple[str, ...] = ()
    witness: Lasso | None = None


@dataclass(eq=False)
class _Trials:
    """Tells of strengthened formulas whether they hold, as long as that isn't too much, and remembers which don't."""

    decide: Callable[[Temporal], bool]
    left: int
    failed: list[Temporal] = field(default_factory=list)

    def holds(self, formula: Formula) -> bool:
        if self.left == 0:
            raise Exhausted
        self.left -= 1
        strengthened = cast("Temporal", formula)  # of a formula on runs
        held = self.decide(strengthened)
        if not held:
            self.failed.append(strengthened)
        return held


def is_judged(graph: Graph) -> bool:
    """Tell whether a graph is small enough to decide formulas on it once more."""
    return len(graph.targets) <= MOST_EDGES


def judge_linear(truth: Truth, formula: Temporal, fairness: Conditions, ranges: Ranges) -> Judged:
    """Return what there is to say of a formula that holds of all fair runs of a graph that is not partial."""
    graph, held = truth.graph, set(conjuncts(formula))

    def decide(strengthened: Temporal) -> bool:
        changed = (each for each in conjuncts(strengthened) if each not in held)
        return all(counterexample(graph, truth, each, fairness) is None for each in changed)

    trials = _Trials(decide, MOST_EDGES // max(1, len(graph.targets)))
    remarks = _remarks(truth, formula, ranges, trials)
    if not trials.left or (remarks and not trials.failed):
        return Judged(remarks)
    try:
        witness = _witness(truth, trials.failed, fairness)
    except BoundMet:
        return Judged(remarks)
    if witness is not None and not is_true_on(witness, formula, truth):
        raise AssertionError(f"a run violates what holds: {formula}")
    return Judged(remarks, witness)


def judge_branching(tree: Branching, formula: Temporal, ranges: Ranges) -> Judged:
    """Return what there is to say of a formula that holds; a witness where its own evidence is no step long."""
    trials = _Trials(lambda each: bool(tree.where(each)[0]), MOST_EDGES // max(1, len(tree.graph.targets)))
    remarks = _remarks(tree.truth, formula, ranges, trials)
    if len(tree.evidence(formula)):
        return Judged(remarks)
    found = (tree.evidence(each, claimed=False) for each in trials.failed)
    try:
        return Judged(remarks, max(filter(len, found), key=len, default=None))
    except BoundMet:
        return Judged(remarks)


# --- what is never needed -------------------------------------------------------------------------------------


def _remarks(truth: Truth, formula: Temporal, ranges: Ranges, trials: _Trials) -> tuple[str, ...]:
    """Return what is said of parts, as far as bounds let it be known."""
    found = list(_never_begun(truth, formula))
    if found:
        return tuple(found)
    try:
        found.extend(_remark(truth, formula, *each) for each in unneeded(formula, ranges, trials.holds))
    except (Exhausted, TooLargeError, BoundMet):
        trials.left = 0
    return few(found)


def _never_begun(truth: Truth, formula: Temporal) -> Iterator[str]:
    """Yield that the condition of a formula is never true: that is known without deciding anything."""
    match formula:
        case Globally(Either(Denied(condition), conclusion)) | OnAllPaths(
            Globally(Either(Denied(condition), conclusion))
        ):
            if _is_never(truth, condition):
                yield f"vacuous: '{condition}' is never true, so that '{conclusion}' is never needed"


def _remark(truth: Truth, formula: Temporal, around: Part, part: Part) -> str:
    said = never_needed(around, part)
    conditions = [_condition_before(formula, path) for path in part.paths]
    if all(each is not None and _is_never(truth, each) for each in conditions):
        never = "and its like are" if len(conditions) > 1 else "is"
        return f"vacuous: '{conditions[0]}' {never} never true, so that {said}"
    return f"{said}: it holds without"


def _condition_before(formula: Temporal, path: tuple[int, ...]) -> Temporal | None:
    """Return the condition of the implication of which the conclusion stands somewhere."""
    if path[-1] != 1:
        return None
    match at(formula, path[:-1]):
        case Either(Denied(condition), _):
            return condition
        case Or((Not(condition), _)):
            return Now(condition)
    return None


def _is_never(truth: Truth, condition: Temporal) -> bool:
    true = truth.everywhere(condition)
    return true is not None and not true.any()


# --- a run on which all is needed -----------------------------------------------------------------------------


def _witness(truth: Truth, failed: list[Temporal], fairness: Conditions) -> Lasso | None:
    """Return a run on which all of some formulas are false; if there is none, the shortest found for one of them."""
    try:
        wanted = reduce(Either, failed, cast("Temporal", Now(Always(False))))
        found = _run_against(truth, wanted, fairness)
        if found is not None:
            return found
    except TooLargeError:
        pass
    runs = (_run_against(truth, each, fairness) for each in failed)
    return min((run for run in runs if run is not None), key=len, default=None)


def _run_against(truth: Truth, formula: Temporal, fairness: Conditions) -> Lasso | None:
    found = counterexample(truth.graph, truth, formula, fairness)
    return None if found is None else _continued(truth.graph, found, fairness)


def _continued(graph: Graph, run: Lasso, fairness: Conditions) -> Lasso:
    """Return a fair run that begins as one does that needs no loop."""
    if run.loop:
        return run
    end = int(graph.targets[run.stem[-1]]) if run.stem else 0
    components = fair_components(graph, fairness)
    path = () if components[end] >= 0 else shortest(graph, end, (components >= 0)[graph.targets])
    assert path is not None  # every run goes on to a fair one
    entry = int(graph.targets[path[-1]]) if path else end
    loop = fair_cycle(component_of(graph, components, entry, fairness), entry)
    return tightened(Lasso((*run.stem, *path), loop))
