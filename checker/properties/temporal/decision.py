"""Decide a formula on a graph, under fairness: for missions and for bigraphical reactive systems alike."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from checker.properties.subformulas import STILL
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.buchi_automaton import AutomatonTooLargeError
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.lasso_evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.truth import FormulaTruth
from checker.properties.temporal.vacuity import IsKept, Judged, every_formula, judge_branching, judge_linear
from checker.verdicts import Outcome
from semantics.properties.property import Ranges
from semantics.properties.temporal import Temporal


@dataclass(frozen=True, slots=True)
class Decision:
    """The decision on a formula.

    Attributes:
        outcome: The outcome.
        examined: The number of states with a known value.
        run: A counterexample; a witness if the formula holds. Empty if it is violated and no single run shows it.
        remarks: Reasons why a true formula may be vacuous.
        note: Why it is undecided.
    """

    outcome: Outcome
    examined: int = 0
    run: Lasso | None = None
    remarks: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, eq=False)
class FormulaDecider:
    """Decides formulas on one graph.

    Attributes:
        truth: The truth of their atoms.
        complete: Whether the graph is complete; else no formula is known to hold.
        is_still: Returns whether the values that a formula reads never change.
        is_kept: Returns whether the graph decides a formula: one that a reduction made does not decide all.
    """

    truth: FormulaTruth
    complete: bool
    is_still: Callable[[Temporal], bool]
    is_kept: IsKept = every_formula

    def linear(self, formula: Temporal, fairness: Conditions, ranges: Ranges = ()) -> Decision:
        """Decide a formula about every fair run."""
        try:
            lasso = counterexample(self.truth.graph, self.truth, formula, fairness)
        except AutomatonTooLargeError as error:
            return Decision(Outcome.INCOMPLETE, note=f"not decided: {error}; split the formula")
        if lasso is not None:
            if lasso.loop and is_true_on(lasso, formula, self.truth):
                raise AssertionError(f"the counterexample satisfies the formula: {formula}")
            return Decision(Outcome.VIOLATED, 1, lasso)
        size = self.truth.graph.size
        if not self.complete:
            return Decision(Outcome.INCOMPLETE, size)
        judged = self.judged(
            formula, lambda: judge_linear(self.truth, formula, fairness, ranges, self.is_kept)
        )
        return Decision(Outcome.HOLDS, size, judged.witness, judged.remarks)

    def branching(self, formula: Temporal, fairness: Conditions, ranges: Ranges = ()) -> Decision:
        """Decide a formula about the tree of fair runs."""
        tree = Branching(self.truth.graph, self.truth, fairness)
        surely, perhaps = bool(tree.where(formula)[0]), bool(tree.where(formula, perhaps=True)[0])
        if not perhaps:
            return Decision(Outcome.VIOLATED, 1, tree.evidence(formula, claimed=False))
        witness, examined = tree.evidence(formula) if surely else None, int(tree.where(formula).sum())
        if not self.complete:
            return Decision(Outcome.INCOMPLETE, examined, witness)
        judged = self.judged(formula, lambda: judge_branching(tree, formula, ranges, self.is_kept))
        return Decision(Outcome.HOLDS, examined, judged.witness or witness, judged.remarks)

    def judged(self, formula: Temporal, judge: Callable[[], Judged]) -> Judged:
        """Return the remarks on a formula that all fair runs satisfy, and a witness."""
        return Judged((STILL,)) if self.is_still(formula) else judge()

    def enough(self, formula: Temporal, linear: bool, ways: Iterable[tuple[str, Conditions]]) -> str | None:
        """Return the first of some fairness assumptions under which a violated formula holds, if any."""
        if not self.complete:
            return None
        holds = self.is_fairly_true if linear else self.is_fairly_true_of_all
        return next((words for words, fairness in ways if holds(formula, fairness)), None)

    def is_fairly_true(self, formula: Temporal, fairness: Conditions) -> bool:
        """Return whether all fair runs satisfy a linear formula; False if an automaton is too large."""
        try:
            return counterexample(self.truth.graph, self.truth, formula, fairness) is None
        except AutomatonTooLargeError:
            return False

    def is_fairly_true_of_all(self, formula: Temporal, fairness: Conditions) -> bool:
        """Return whether a branching formula is true at the first state, over fair runs."""
        return bool(Branching(self.truth.graph, self.truth, fairness).where(formula)[0])
