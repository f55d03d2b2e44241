"""Ground formulas: the quantifiers of an invariant about ways are expanded once, before a run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, asks_of_regions
from semantics.properties.propositions import Always, And, Not, Or, Proposition
from semantics.properties.region_atoms import ApartFrom

MOST_PARTS: Final = 20_000
"""The most parts of a ground formula that a run watches."""


class TooManyPartsError(ValueError):
    """A formula has too many parts."""


def about_ways(*properties: Property) -> tuple[Property, ...]:
    """Return the invariants about ways, with ground formulas; those with too many parts are left out."""
    return tuple(_grounded(properties))


def _grounded(properties: tuple[Property, ...]) -> Iterator[Property]:
    for each in properties:
        if each.kind is PropertyKind.INVARIANT and asks_of_regions((each,)):
            try:
                yield replace(each, formula=grounded(each.formula))
            except TooManyPartsError:
                continue


def grounded(formula: Proposition, most: int = MOST_PARTS) -> Proposition:
    """Return an equivalent formula without quantifiers, each of its parts once.

    Raises:
        TooManyPartsError: It has more than `most` parts.
    """
    return _Grounding(most).of(formula)


class _Grounding:
    """The expansion of one formula, which counts its parts."""

    def __init__(self, most: int) -> None:
        self._left = most

    def of(self, formula: Proposition) -> Proposition:
        match formula:
            case Not(inner):
                found = self.of(inner)
                return Always(not found.value) if isinstance(found, Always) else Not(found)
            case And() | Or():
                return self._of_parts(formula)
        return formula

    def _of_parts(self, formula: And | Or) -> Proposition:
        make, decides = type(formula), isinstance(formula, Or)
        found: dict[Proposition, None] = {}
        for part in formula.formulas:
            self._left -= 1
            if self._left < 0:
                raise TooManyPartsError("the formula has too many parts")
            each = self.of(part)
            if isinstance(each, Always):
                if each.value is decides:
                    return each
            elif isinstance(each, make) and isinstance(each.formulas, tuple):
                found |= dict.fromkeys(each.formulas)
            elif not (isinstance(each, ApartFrom) and _mirrored(each) in found):
                found[each] = None
        if not found:
            return Always(not decides)
        return next(iter(found)) if len(found) == 1 else make(tuple(found))


def _mirrored(atom: ApartFrom) -> ApartFrom:
    """Return the same question with its entities exchanged."""
    return replace(atom, entity=atom.other, other=atom.entity)
