"""Decide a formula on a graph, under fairness: of missions and of systems of bigraphs alike."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from checker.properties.subformulas import STILL
from checker.properties.temporal.automaton import TooLargeError
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.linear import counterexample
from checker.properties.temporal.truth import Truth
from checker.properties.temporal.vacuity import Judged, judge_branching, judge_linear
from checker.verdicts import Outcome
from semantics.properties.property import Ranges
from semantics.properties.temporal import Temporal


@dataclass(frozen=True, slots=True)
class Decision:
    """What became of a formula.

    Attributes:
        outcome: What is known.
        examined: Of how many states it is known.
        run: A counterexample; where it holds, a witness. Empty where a formula is violated and no single run shows it.
        remarks: What makes a formula that holds say less than it seems to.
        note: Why it is not decided.
    """

    outcome: Outcome
    examined: int = 0
    run: Lasso | None = None
    remarks: tuple[str, ...] = ()
    note: str = ""


@dataclass(frozen=True, eq=False)
class Formulas:
    """Decides formulas on one graph.

    Attributes:
        truth: Where their atoms are true.
        complete: Whether the graph is all there is; else what nothing speaks against is not known to hold.
        is_still: Tells whether nothing that a formula speaks of ever changes.
    """

    truth: Truth
    complete: bool
    is_still: Callable[[Temporal], bool]

    def linear(self, formula: Temporal, fairness: Conditions, ranges: Ranges = ()) -> Decision:
        """Decide what is claimed of every fair run."""
        try:
            lasso = counterexample(self.truth.graph, self.truth, formula, fairness)
        except TooLargeError as error:
            return Decision(Outcome.INCOMPLETE, note=f"not decided: {error}; split the formula")
        if lasso is not None:
            if lasso.loop and is_true_on(lasso, formula, self.truth):
                raise AssertionError(f"the counterexample is none: {formula}")
            return Decision(Outcome.VIOLATED, 1, lasso)
        size = self.truth.graph.size
        if not self.complete:
            return Decision(Outcome.INCOMPLETE, size)
        judged = self.judged(formula, lambda: judge_linear(self.truth, formula, fairness, ranges))
        return Decision(Outcome.HOLDS, size, judged.witness, judged.remarks)

    def branching(self, formula: Temporal, fairness: Conditions, ranges: Ranges = ()) -> Decision:
        """Decide what is claimed of the tree of fair runs."""
        tree = Branching(self.truth.graph, self.truth, fairness)
        surely, perhaps = bool(tree.where(formula)[0]), bool(tree.where(formula, perhaps=True)[0])
        if not perhaps:
            return Decision(Outcome.VIOLATED, 1, tree.evidence(formula, claimed=False))
        witness, examined = tree.evidence(formula) if surely else None, int(tree.where(formula).sum())
        if not self.complete:
            return Decision(Outcome.INCOMPLETE, examined, witness)
        judged = self.judged(formula, lambda: judge_branching(tree, formula, ranges))
        return Decision(Outcome.HOLDS, examined, judged.witness or witness, judged.remarks)

    def judged(self, formula: Temporal, judge: Callable[[], Judged]) -> Judged:
        """Return what there is to say of a formula that holds of all fair runs."""
        return Judged((STILL,)) if self.is_still(formula) else judge()

    def enough(self, formula: Temporal, linear: bool, ways: Iterable[tuple[str, Conditions]]) -> str | None:
        """Return the first of some ways to be fair under which a formula holds that was violated, if one is."""
        if not self.complete:
            return None
        holds = self.is_fairly_true if linear else self.is_fairly_true_of_all
        return next((words for words, fairness in ways if holds(formula, fairness)), None)

    def is_fairly_true(self, formula: Temporal, fairness: Conditions) -> bool:
        """Tell whether a formula of linear time is true of all fair runs, as far as its automata are small."""
        try:
            return counterexample(self.truth.graph, self.truth, formula, fairness) is None
        except TooLargeError:
            return False

    def is_fairly_true_of_all(self, formula: Temporal, fairness: Conditions) -> bool:
        """Tell whether a formula of branching time is true at the first state, of fair runs."""
        return bool(Branching(self.truth.graph, self.truth, fairness).where(formula)[0])
