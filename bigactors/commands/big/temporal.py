"""LTL and CTL on systems of bigraphs: the checker's engine on their transition systems.

A weight only makes a step possible; `checker.properties.temporal.claim_decider` says which runs there are.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from itertools import chain

import numpy as np

from bigraphs.claims import ClaimOutcome, Decided, WitnessRun, WitnessStep
from bigraphs.transitions import TransitionSystem
from checker.engines.graph import STUTTER, Graph
from checker.properties.temporal.claim_decider import ClaimDecider
from checker.properties.temporal.claim_text import claim_words_of, parse_claim
from checker.properties.temporal.decision import Decision
from checker.properties.temporal.lassos import Lasso
from checker.verdicts import Outcome
from physical.wordings import counted
from semantics.state.configuration import Label


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
    def claims(self) -> ClaimDecider:
        """The decision procedures, given the states in which predicates occur."""
        columns = zip(self.found.system.predicates, self.found.labels, strict=True)
        values = {
            predicate.label: np.frombuffer(bytes(holds), dtype=np.uint8) > 0 for predicate, holds in columns
        }
        return ClaimDecider(
            graph_of(self.found), values, self.found.complete, claim_words_of(self.found.system)
        )

    def decide(self, logic: str, text: str) -> Decided:
        """Decide a formula of a logic, `ltl` or `ctl`; raises NotationError for an invalid formula.

        On an incomplete system a formula can be violated, but never holds.
        """
        said = f"{logic} {' '.join(text.split())}"
        if not len(self.found):
            parse_claim(text, logic, claim_words_of(self.found.system))
            return Decided(said, ClaimOutcome.INCOMPLETE)
        found = self.claims.decide(logic, text)
        linear = logic == "ltl"
        if found.outcome is Outcome.VIOLATED:
            assert found.run is not None
            shown = self.violated(said, found.run, linear)
            notes = filter(None, (shown.note, found.note))
            return replace(shown, note="; ".join(notes), remarks=found.remarks)
        return replace(self.unviolated(said, found, linear), remarks=found.remarks)

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

    def run(self, lasso: Lasso) -> WitnessRun:
        """Return a lasso of edges as a run."""
        return WitnessRun(tuple(self.steps(lasso)), len(lasso.stem) if lasso.loop else None)

    def steps(self, lasso: Lasso) -> Iterator[WitnessStep]:
        """Yield the steps of a lasso, with its loop taken once."""
        for edge in (*lasso.stem, *lasso.loop):
            action = int(self.claims.graph.actions[edge])
            rules = () if action == STUTTER else (self.claims.graph.labels[action].rule,)
            yield WitnessStep(rules, int(self.claims.graph.targets[edge]))
