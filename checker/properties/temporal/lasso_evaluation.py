"""Evaluate linear formulas on a lasso: an independent check of every counterexample."""

from checker.properties.temporal.lassos import Lasso
from checker.properties.temporal.truth import FormulaTruth
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Enabled,
    Eventually,
    Globally,
    Next,
    Now,
    Release,
    Taken,
    Temporal,
    Until,
    WeakUntil,
)


def is_true_on(lasso: Lasso, formula: Temporal, truth: FormulaTruth) -> bool:
    """Return whether a lasso satisfies a formula, by the definitions: O(length) for each operator."""
    return _Word(lasso, truth).truths(formula)[0]


class _Word:
    def __init__(self, lasso: Lasso, truth: FormulaTruth) -> None:
        self.edges = (*lasso.stem, *lasso.loop)
        self.truth = truth
        self.back = len(lasso.stem)

    def truths(self, formula: Temporal) -> list[bool]:
        """Return for each position whether the run from there satisfies a formula."""
        match formula:
            case Taken():
                return [bool(self.truth.taken(formula)[edge]) for edge in self.edges]
            case Now() | Enabled():
                here, sources = self.truth.here(formula), self.truth.graph.sources
                return [bool(here[sources[edge]]) for edge in self.edges]
            case Denied(inner):
                return [not each for each in self.truths(inner)]
            case Both(left, right):
                return [a and b for a, b in zip(self.truths(left), self.truths(right), strict=True)]
            case Either(left, right):
                return [a or b for a, b in zip(self.truths(left), self.truths(right), strict=True)]
            case Next(inner):
                return self.shifted(self.truths(inner))
            case Eventually(inner):
                return self.until([True] * len(self.edges), self.truths(inner), at_last=False)
            case Globally(inner):
                return self.until(self.truths(inner), [False] * len(self.edges), at_last=True)
            case Until(left, right):
                return self.until(self.truths(left), self.truths(right), at_last=False)
            case WeakUntil(left, right):
                return self.until(self.truths(left), self.truths(right), at_last=True)
            case Release(left, right):
                kept = self.truths(right)
                ends = [a and b for a, b in zip(self.truths(left), kept, strict=True)]
                return self.until(kept, ends, at_last=True)
        raise ValueError(f"no linear formula: {formula}")

    def shifted(self, values: list[bool]) -> list[bool]:
        return [*values[1:], values[self.back]]

    def until(self, kept: list[bool], ends: list[bool], *, at_last: bool) -> list[bool]:
        """Return where `kept` holds until `ends`, in two rounds of the loop; `at_last` is the value without an end."""
        found = [at_last] * len(self.edges)
        for _ in range(2):
            for at in reversed(range(len(found))):
                after = found[at + 1] if at + 1 < len(found) else found[self.back]
                found[at] = ends[at] or (kept[at] and after)
        return found
