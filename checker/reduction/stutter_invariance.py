"""Stutter invariance: the formulas whose truth no idle step changes.

A step is *idle* if it leaves all propositions of a formula as they are and no `taken` names it. Partial-order reduction
inserts idle steps in a run, and removes others.
"""

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
    Taken,
    Temporal,
    Until,
    WeakUntil,
    parts,
)


def is_stutter_invariant(formula: Temporal) -> bool:
    """Return whether idle steps, inserted or removed anywhere, never change the truth of a formula.

    `taken` is false of an idle step. So it is invariant only where an operator skips the steps for which the operand
    has one value: `<> (taken sense a and p)`, `[] (taken sense a -> <> q)`. The condition is sufficient, by syntax.
    """
    match formula:
        case Taken() | Next():
            return False
        case Eventually(inner):
            return is_stutter_invariant(inner) or _is_when_idle(inner, False)
        case Globally(inner):
            return is_stutter_invariant(inner) or _is_when_idle(inner, True)
        case Until(left, right) | WeakUntil(left, right):
            return _is_until(left, right, True)
        case Release(left, right):  # the dual of `until`
            return _is_until(left, right, False)
    return all(map(is_stutter_invariant, parts(formula)))


def _is_until(left: Temporal, right: Temporal, kept: bool) -> bool:
    """Return the invariance of an operator that waits for `right` while `left` is `kept`."""
    passes = _is_when_idle(left, kept)
    if is_stutter_invariant(right):
        return passes or is_stutter_invariant(left)
    return passes and _is_when_idle(right, not kept)


def _is_when_idle(formula: Temporal, value: bool) -> bool:
    """Return whether a formula has a value at each idle step, and depends at others on nothing but this step."""
    return _at_step(formula) and _when_idle(formula) is value


def _at_step(formula: Temporal) -> bool:
    """Return whether a formula is a Boolean combination of `taken` and of invariant formulas."""
    if isinstance(formula, Denied | Both | Either):
        return all(map(_at_step, parts(formula)))
    return isinstance(formula, Taken) or is_stutter_invariant(formula)


def _when_idle(formula: Temporal) -> bool | None:
    """Return the value of a formula at all idle steps, None if it depends on more."""
    match formula:
        case Taken():
            return False
        case Now(Always(value)):
            return value
        case Denied(inner):
            known = _when_idle(inner)
            return None if known is None else not known
        case Both(left, right):
            return _joined(_when_idle(left), _when_idle(right), False)
        case Either(left, right):
            return _joined(_when_idle(left), _when_idle(right), True)
    return None


def _joined(left: bool | None, right: bool | None, decisive: bool) -> bool | None:
    """Return the value of a connective that one `decisive` operand decides."""
    if decisive in (left, right):
        return decisive
    return None if None in (left, right) else not decisive
