"""LTL and CTL on systems of bigraphs: the checker's engine on their transition systems.

Runs are infinite: a run stays in a state without transitions. Runs are fair to a rule only if a formula declares it.
A weight only makes a step possible.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from itertools import chain
from typing import Final, cast

import numpy as np

from bigactors.commands.big.formulas import EACH_RULE, Claim, Occurs, fair_to, parse_claim
from bigraphs.claims import ClaimOutcome, Decided, WitnessRun, WitnessStep
from bigraphs.transitions import TransitionSystem
from checker.engines.graph import STUTTER, Bools, Graph
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.decision import Decision, FormulaDecider
from checker.properties.temporal.fairness import classes, conditions_of
from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.truth import FormulaTruth
from checker.verdicts import Outcome as Known
from physical.wordings import counted
from semantics.properties.propositions import Proposition
from semantics.properties.temporal import Fairness, Now, Steps, Temporal, atoms
from semantics.state.configuration import Label

ENOUGH: Final = {
    f"{strength} fairness of {EACH_RULE}": (fair_to(strength == "strong", Steps(), EACH_RULE),)
    for strength in ("weak", "strong")
}
"""Fairness assumptions that may make a violated formula true, the weakest first."""


def decided_formulas(found: TransitionSystem, asked: Iterable[tuple[str, str]]) -> Iterator[Decided]:
    """Yield a verdict on each formula, given with its logic."""
    decider = Decider(found)
    return (decider.decide(logic, text) for logic, text in asked)


def graph_of(found: TransitionSystem) -> Graph:
    """Return the checker's graph of a transition system: an edge for each transition and each rule that makes it.

    A label's `rule` is the rule with its parameters, and its `agent` the rule's name, so that `Steps` can name either.
    """
    rules = {rule.label: rule for rule in found.system.rules()}
    number = {label: index for index, label in enumerate(rules)}
    sets = [[number[label] for label in kind.rules] for kind in found.kinds.values]
    kinds = np.array(found.kinds.codes, dtype=np.int64)
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
    """Decides formulas about one transition system; common computations are done once."""

    def __init__(self, found: TransitionSystem) -> None:
        self.found = found

    @cached_property
    def graph(self) -> Graph:
        """The graph, with a self-loop at each state without transitions."""
        return graph_of(self.found).total()

    @cached_property
    def formulas(self) -> FormulaDecider:
        """The decision procedures, given the states in which predicates occur."""
        columns = zip(self.found.system.predicates, self.found.labels, strict=True)
        values = {
            cast("Proposition", Occurs(predicate.label)): np.frombuffer(bytes(holds), dtype=np.uint8) > 0
            for predicate, holds in columns
        }
        truth = FormulaTruth(self.graph, values)

        def is_still(formula: Temporal) -> bool:
            asked = tuple(atoms(formula))
            return all(isinstance(each, Now) and _is_constant(truth.here(each)) for each in asked)

        return FormulaDecider(truth, self.found.complete, is_still)

    def decide(self, logic: str, text: str) -> Decided:
        """Decide a formula of a logic, `ltl` or `ctl`; raises NotationError for an invalid formula.

        On an incomplete system a formula can be violated, but never holds.
        """
        claim = parse_claim(text, logic, self.found.system)
        said = f"{logic} {' '.join(text.split())}"
        if not len(self.found):
            return Decided(said, ClaimOutcome.INCOMPLETE)
        linear = logic == "ltl"
        decide = self.formulas.linear if linear else self.formulas.branching
        found = decide(claim.formula, self.conditions(claim.fairness))
        remarks = (*self.empty(claim.fairness), *found.remarks)
        if found.outcome is Known.VIOLATED:
            assert found.run is not None
            shown = self.violated(said, found.run, linear)
            notes = filter(None, (shown.note, *self.unfair(claim, linear)))
            return replace(shown, note="; ".join(notes), remarks=remarks)
        return replace(self.unviolated(said, found, linear), remarks=remarks)

    def violated(self, said: str, lasso: Lasso, linear: bool) -> Decided:
        """Return the verdict on a formula with a run that violates it."""
        if linear:
            what = f"a {'shortest ' if lasso.shortest else ''}run on which it is false"
            what += "" if lasso.loop else ", whatever follows"
            return Decided(said, ClaimOutcome.VIOLATED, self.run(lasso), what)
        if not len(lasso):
            return Decided(
                said, ClaimOutcome.VIOLATED, note="false in the initial state; no single run shows it"
            )
        return Decided(said, ClaimOutcome.VIOLATED, self.run(lasso), "a run that shows it")

    def unviolated(self, said: str, found: Decision, linear: bool) -> Decided:
        """Return the verdict on a formula without a violation."""
        outcome = ClaimOutcome(found.outcome.value)
        if found.run is None or not len(found.run):
            return Decided(said, outcome, note=found.note)
        run = self.run(found.run)
        if linear:
            return Decided(
                said, outcome, run, note=f"a witness of {counted(len(run.steps), 'step')}, in --json"
            )
        return Decided(said, outcome, run, "a run that shows it")

    def unfair(self, claim: Claim, linear: bool) -> Iterator[str]:
        """Yield a note if a violated formula without fairness holds under fairness."""
        if not claim.fairness:
            ways = ((words, self.conditions(each)) for words, each in ENOUGH.items())
            if enough := self.formulas.enough(claim.formula, linear, ways):
                yield f"only unfair runs violate it: it holds under {enough}"

    def conditions(self, declared: Iterable[Fairness]) -> Conditions:
        """Return the conditions that fair runs meet infinitely often."""
        return conditions_of(declared, self.graph)

    def empty(self, declared: Iterable[Fairness]) -> Iterator[str]:
        """Yield each declared fairness without any step; none if the system is incomplete, as a step may follow."""
        for each in declared if self.found.complete else ():
            if not any(self.graph.taken(labels).any() for labels in classes(each, self.graph.labels)):
                yield f"{each} covers no step of any run"

    def run(self, lasso: Lasso) -> WitnessRun:
        """Return a lasso of edges as a run."""
        return WitnessRun(tuple(self.steps(lasso)), len(lasso.stem) if lasso.loop else None)

    def steps(self, lasso: Lasso) -> Iterator[WitnessStep]:
        """Yield the steps of a lasso, with its loop taken once."""
        for edge in (*lasso.stem, *lasso.loop):
            action = int(self.graph.actions[edge])
            rules = () if action == STUTTER else (self.graph.labels[action].rule,)
            yield WitnessStep(rules, int(self.graph.targets[edge]))


def _is_constant(values: Bools) -> bool:
    return bool(values.all() or not values.any())
