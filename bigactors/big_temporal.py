"""LTL and CTL on systems of bigraphs: the checker's engine on the transition system of a system.

Runs are infinite: a run stays in a state without transitions. No fairness is assumed. A weight only says that a step is
possible.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import chain
from typing import Final, cast

import numpy as np

from bigactors.big_formulas import Occurs, parse_formula
from bigraphs.transitions import TransitionSystem
from bigraphs.verdicts import Decided, Outcome, Run, Step
from checker.engines.graph import STUTTER, Graph
from checker.properties.temporal.automaton import TooLargeError
from checker.properties.temporal.branching import Branching
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.evaluation import is_true_on
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.linear import shortest_counterexample
from checker.properties.temporal.truth import Truth
from semantics.properties.propositions import Proposition
from semantics.properties.temporal import Temporal
from semantics.state.configuration import Label

NO_FAIRNESS: Final = Conditions()


def decided_formulas(found: TransitionSystem, asked: Iterable[tuple[str, str]]) -> Iterator[Decided]:
    """Yield a verdict on each of some formulas, each given with its logic."""
    decider = Decider(found)
    return (decider.decide(logic, text) for logic, text in asked)


def graph_of(found: TransitionSystem) -> Graph:
    """Return the checker's graph of a transition system: an edge for each transition and each rule that makes it.

    A label's `rule` is the rule with its parameters, its `agent` the name alone, so that `Steps` finds both.
    """
    rules = {rule.label: rule for rule in found.system.rules()}
    number = {label: index for index, label in enumerate(rules)}
    sets = [[number[label] for label in each] for each in found.rule_sets]
    kinds = np.array(found.rules, dtype=np.int64)
    times = np.array([len(each) for each in sets], dtype=np.int64)[kinds] if sets else kinds
    sources = np.repeat(np.array(found.starts, dtype=np.int64), times)
    leaving = np.bincount(sources, minlength=len(found))
    return Graph(
        np.concatenate(([0], np.cumsum(leaving))),
        np.repeat(np.array(found.targets, dtype=np.int32), times),
        np.fromiter(chain.from_iterable(sets[kind] for kind in kinds), dtype=np.int32, count=len(sources)),
        tuple(Label(label, rule.name) for label, rule in rules.items()),
        None if found.complete else np.arange(len(found)) >= found.expanded,
    )


class Decider:
    """Decides formulas about one transition system; what they share is computed once."""

    def __init__(self, found: TransitionSystem) -> None:
        self.found = found

    @cached_property
    def graph(self) -> Graph:
        """The graph, with a self-loop at each state without transitions."""
        return graph_of(self.found).total()

    @cached_property
    def truth(self) -> Truth:
        """Where predicates occur."""
        columns = zip(self.found.system.predicates, self.found.labels, strict=True)
        values = {
            cast("Proposition", Occurs(predicate.label)): np.frombuffer(bytes(holds), dtype=np.uint8) > 0
            for predicate, holds in columns
        }
        return Truth(self.graph, values)

    def decide(self, logic: str, text: str) -> Decided:
        """Decide a formula of a logic, `ltl` or `ctl`; raises NotationError if it is none.

        On an incomplete system a formula can be violated, but never holds.
        """
        formula = parse_formula(text, logic, self.found.system)
        claim = f"{logic} {' '.join(text.split())}"
        if not len(self.found):
            return Decided(claim, Outcome.INCOMPLETE)
        return (self.linear if logic == "ltl" else self.branching)(claim, formula)

    def linear(self, claim: str, formula: Temporal) -> Decided:
        """Decide a linear-time formula."""
        try:
            lasso = shortest_counterexample(self.graph, self.truth, formula, NO_FAIRNESS)
        except TooLargeError as error:
            return Decided(claim, Outcome.INCOMPLETE, note=f"not decided: {error}; split the formula")
        if lasso is None:
            return Decided(claim, self.unless_violated())
        if lasso.loop and is_true_on(lasso, formula, self.truth):
            raise AssertionError(f"the counterexample is none: {formula}")
        what = f"a {'shortest ' if lasso.shortest else ''}run on which it is false"
        what += "" if lasso.loop else ", whatever follows"
        return Decided(claim, Outcome.VIOLATED, self.run(lasso), what)

    def branching(self, claim: str, formula: Temporal) -> Decided:
        """Decide a branching-time formula."""
        tree = Branching(self.graph, self.truth, NO_FAIRNESS)
        surely, perhaps = bool(tree.where(formula)[0]), bool(tree.where(formula, perhaps=True)[0])
        if perhaps:
            lasso = tree.evidence(formula) if surely else Lasso(())
            run = self.run(lasso) if len(lasso) else None
            return Decided(claim, self.unless_violated(), run, "a run that shows it")
        lasso = tree.evidence(formula, claimed=False)
        if not len(lasso):
            note = "false in the initial state; no single run shows it"
            return Decided(claim, Outcome.VIOLATED, note=note)
        return Decided(claim, Outcome.VIOLATED, self.run(lasso), "a run that shows it")

    def unless_violated(self) -> Outcome:
        """Return the outcome for a formula without counterexample."""
        return Outcome.HOLDS if self.found.complete else Outcome.INCOMPLETE

    def run(self, lasso: Lasso) -> Run:
        """Return a lasso of edges as a run."""
        return Run(tuple(self.steps(lasso)), len(lasso.stem) if lasso.loop else None)

    def steps(self, lasso: Lasso) -> Iterator[Step]:
        """Yield the steps of a lasso, the loop taken once."""
        for edge in (*lasso.stem, *lasso.loop):
            action = int(self.graph.actions[edge])
            rules = () if action == STUTTER else (self.graph.labels[action].rule,)
            yield Step(rules, int(self.graph.targets[edge]))
