"""Conjuncts that exchanges map to one another: one of them stands for all.

An exchange maps the runs of a mission to its runs. So `<> ended a` is true of all runs if and only if its image is.
"""

from collections.abc import Hashable, Iterable
from functools import reduce

from checker.reduction.configuration_renaming import Renaming
from checker.reduction.mission_automorphisms import normal
from semantics.properties.temporal import (
    Both,
    Either,
    Enabled,
    Now,
    Steps,
    Taken,
    Temporal,
    chain,
    conjuncts,
    parts,
)


def one_of_each(formula: Temporal, exchanges: Iterable[Renaming]) -> Temporal:
    """Return a formula without the conjuncts that an exchange maps to an earlier one."""
    kept: dict[Hashable, Temporal] = {}
    for each in conjuncts(formula):
        images = (_normal(image(each, renaming)) for renaming in exchanges)
        if not any(one in kept for one in images):
            kept.setdefault(_normal(each), each)
    return reduce(Both, kept.values())


def image(formula: Temporal, renaming: Renaming) -> Temporal:
    """Return a formula with its names exchanged."""
    match formula:
        case Now(proposition):
            return Now(renaming.value(proposition))
        case Taken(steps) | Enabled(steps):
            agent = None if steps.agent is None else renaming.name(steps.agent)
            return type(formula)(Steps(steps.rules, agent))
    return type(formula)(*(image(each, renaming) for each in parts(formula)))


def _normal(formula: Temporal) -> Hashable:
    """Return a value that is the same for formulas that differ in the order of operands."""
    if isinstance(formula, Both | Either):
        return (type(formula), frozenset(map(_normal, chain(formula, type(formula)))))
    if isinstance(formula, Now):
        return normal(formula.proposition)
    return (type(formula), *map(_normal, parts(formula))) if parts(formula) else formula
