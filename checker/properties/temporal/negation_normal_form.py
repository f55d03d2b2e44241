"""Linear formulas in negation normal form, with numbered subformulas."""

from collections.abc import Callable
from dataclasses import dataclass, field

from semantics.properties.propositions import Always
from semantics.properties.temporal import (
    Both,
    Denied,
    Either,
    Eventually,
    Globally,
    Next,
    Now,
    Release,
    State,
    Taken,
    Temporal,
    Until,
    WeakUntil,
    parts,
)

Number = int
"""The index of a formula in `FormulaFactory.nodes`, in order of construction: the same in each process."""

Literal = tuple[Temporal, bool]
"""A formula without temporal operators, and whether it is claimed or denied."""

FALSE, TRUE = 0, 1


@dataclass(frozen=True, slots=True)
class NormalFormula:
    """`lit`, `and`, `or`, `next`, `until` or `release`, with its operands."""

    operator: str
    operands: tuple[Number, ...] = ()
    literal: Literal | None = None


@dataclass(slots=True)
class FormulaFactory:
    """A factory of formulas, which simplifies them on construction."""

    nodes: list[NormalFormula] = field(
        default_factory=lambda: [NormalFormula("false"), NormalFormula("true")]
    )
    numbers: dict[NormalFormula, Number] = field(default_factory=dict)

    def _number(self, operation: NormalFormula) -> Number:
        if operation not in self.numbers:
            self.numbers[operation] = len(self.nodes)
            self.nodes.append(operation)
        return self.numbers[operation]

    def literal(self, formula: Temporal, claimed: bool) -> Number:
        """Return a formula without temporal operators, or its negation."""
        match formula:
            case Denied(inner):
                return self.literal(inner, not claimed)
            case Now(Always(value)):
                return TRUE if value is claimed else FALSE
        return self._number(NormalFormula("lit", literal=(formula, claimed)))

    def both(self, left: Number, right: Number) -> Number:
        """Return a conjunction."""
        if FALSE in (left, right):
            return FALSE
        inner = self._inside("until", TRUE, "release", FALSE, left, right)
        if inner is not None:  # <> [] f and <> [] g is <> [] (f and g)
            return self.until(TRUE, self.release(FALSE, self.both(*inner)))
        return self._pair("and", left, right, TRUE)

    def either(self, left: Number, right: Number) -> Number:
        """Return a disjunction."""
        if TRUE in (left, right):
            return TRUE
        inner = self._inside("release", FALSE, "until", TRUE, left, right)
        if inner is not None:  # [] <> f or [] <> g is [] <> (f or g)
            return self.release(FALSE, self.until(TRUE, self.either(*inner)))
        return self._pair("or", left, right, FALSE)

    def _inside(
        self, outer: str, first: Number, inner: str, second: Number, *formulas: Number
    ) -> tuple[Number, ...] | None:
        """Return the formulas behind two operators, if all formulas begin with these."""
        found = []
        for number in formulas:
            around = self.nodes[number]
            within = self.nodes[around.operands[1]] if around.operator == outer else around
            if (within.operator, *around.operands[:1], *within.operands[:1]) != (inner, first, second):
                return None
            found.append(within.operands[1])
        return tuple(found)

    def _pair(self, operator: str, left: Number, right: Number, neutral: Number) -> Number:
        members = sorted({left, right} - {neutral})
        if len(members) < 2:
            return members[0] if members else neutral
        return self._number(NormalFormula(operator, tuple(members)))

    def next(self, inner: Number) -> Number:
        """Return `X f`."""
        return inner if inner in (FALSE, TRUE) else self._number(NormalFormula("next", (inner,)))

    def until(self, left: Number, right: Number) -> Number:
        """Return `f U g`."""
        if right in (FALSE, TRUE) or left == FALSE:
            return right
        then = self.nodes[right]
        if left == TRUE and then.operator == "until":  # <> (f U g) is <> g
            return self.until(TRUE, then.operands[1])
        return self._number(NormalFormula("until", (left, right)))

    def release(self, left: Number, right: Number) -> Number:
        """Return `f R g`."""
        if right in (FALSE, TRUE) or left == TRUE:
            return right
        then = self.nodes[right]
        if left == FALSE and then.operator == "release":  # [] (f R g) is [] g
            return self.release(FALSE, then.operands[1])
        return self._number(NormalFormula("release", (left, right)))

    def normal(self, formula: Temporal, claimed: bool = True) -> Number:
        """Return the negation normal form of a formula, or of its negation.

        A formula about the configuration alone, without temporal operators, stays whole, as one literal.
        """
        if isinstance(formula, State) or is_propositional(formula):
            return self.literal(formula, claimed)
        match formula:
            case Denied(inner):
                return self.normal(inner, not claimed)
            case Next(inner):
                return self.next(self.normal(inner, claimed))
            case Eventually(inner):
                return self._until(claimed)(TRUE if claimed else FALSE, self.normal(inner, claimed))
            case Globally(inner):
                return self._until(not claimed)(FALSE if claimed else TRUE, self.normal(inner, claimed))
            case Both(left, right):
                join = self.both if claimed else self.either
                return join(self.normal(left, claimed), self.normal(right, claimed))
            case Either(left, right):
                join = self.either if claimed else self.both
                return join(self.normal(left, claimed), self.normal(right, claimed))
            case Until(left, right):
                return self._until(claimed)(self.normal(left, claimed), self.normal(right, claimed))
            case Release(left, right):
                return self._until(not claimed)(self.normal(left, claimed), self.normal(right, claimed))
            case WeakUntil(left, right):
                return self.normal(Release(right, Either(left, right)), claimed)
        raise ValueError(f"a linear formula has no path quantifier: {formula}")

    def _until(self, until: bool) -> Callable[[Number, Number], Number]:
        return self.until if until else self.release


def is_propositional(formula: Temporal) -> bool:
    """Return whether a formula is about the configuration alone."""
    if isinstance(formula, State):
        return not isinstance(formula, Taken)
    return isinstance(formula, Denied | Both | Either) and all(map(is_propositional, parts(formula)))
