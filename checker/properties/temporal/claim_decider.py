"""Decide formulas over named predicates on a graph: of systems of bigraphs, and of models of a user's own.

Runs are infinite: a run stays in a state without transitions. Runs are fair to a rule only if a formula declares it.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, cast

from checker.engines.graph import Bools, Graph
from checker.properties.temporal.claim_text import (
    EACH_RULE,
    Claim,
    ClaimWords,
    Occurs,
    fair_to,
    parse_claim,
)
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.decision import Decision, FormulaDecider
from checker.properties.temporal.fairness import classes, conditions_of
from checker.properties.temporal.truth import FormulaTruth
from checker.verdicts import Outcome
from semantics.properties.propositions import Proposition
from semantics.properties.temporal import Fairness, Now, Steps, Temporal, atoms

ENOUGH: Final = {
    f"{strength} fairness of {EACH_RULE}": (fair_to(strength == "strong", Steps(), EACH_RULE),)
    for strength in ("weak", "strong")
}
"""Fairness assumptions that may make a violated formula true, the weakest first."""


@dataclass(frozen=True)
class ClaimDecider:
    """Decides formulas on one graph; common computations are done once.

    Attributes:
        rows: The graph of the transitions.
        values: For each predicate the states in which it is true.
        complete: Whether the graph is complete.
        words: The words of formulas.
    """

    rows: Graph
    values: Mapping[str, Bools]
    complete: bool
    words: ClaimWords

    @cached_property
    def graph(self) -> Graph:
        """The graph, with a self-loop at each state without transitions."""
        return self.rows.total()

    @cached_property
    def formulas(self) -> FormulaDecider:
        """The decision procedures."""
        values = {cast("Proposition", Occurs(name)): column for name, column in self.values.items()}
        truth = FormulaTruth(self.graph, values)

        def is_still(formula: Temporal) -> bool:
            asked = tuple(atoms(formula))
            return all(isinstance(each, Now) and _is_constant(truth.here(each)) for each in asked)

        return FormulaDecider(truth, self.complete, is_still)

    def decide(self, logic: str, text: str) -> Decision:
        """Decide a formula of a logic, `ltl` or `ctl`; raises NotationError for an invalid formula.

        On an incomplete graph a formula can be violated, but never holds.
        """
        claim, linear = parse_claim(text, logic, self.words), logic == "ltl"
        decide = self.formulas.linear if linear else self.formulas.branching
        found = decide(claim.formula, self.conditions(claim.fairness))
        found = replace(found, remarks=(*self.empty(claim.fairness), *found.remarks))
        if found.outcome is Outcome.VIOLATED:
            notes = filter(None, (found.note, *self.unfair(claim, linear)))
            return replace(found, note="; ".join(notes))
        return found

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
        """Yield each declared fairness without any step; none if the graph is incomplete, as a step may follow."""
        for each in declared if self.complete else ():
            if not any(self.graph.taken(labels).any() for labels in classes(each, self.graph.labels)):
                yield f"{each} covers no step of any run"


def _is_constant(values: Bools) -> bool:
    return bool(values.all() or not values.any())
