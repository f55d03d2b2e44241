"""Tests of a collection's size, such as `empty(obs)`, that have one outcome for all collections with a member."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from semantics.behaviours.expressions import Apply, Expression, Literal
from specs import syntax as s

_FLIPPED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}
_HOLDS: Final[Mapping[str, Callable[[int, int], bool]]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


@dataclass(frozen=True, slots=True)
class SizeTest:
    """A test of a collection's size.

    Attributes:
        where: The test as written.
        asked: The collection as written.
        collection: The collection.
        function: The function that asks, `empty` or `size`.
        outcome: Its outcome for every collection with a member.
    """

    where: s.Expression
    asked: s.Expression
    collection: Expression
    function: str
    outcome: bool


def size_test(where: s.Expression, applied: str, operands: tuple[Expression, ...]) -> SizeTest | None:
    """Return the test that an operator on operands is; None if it is none, or depends on the number of members."""
    match where, operands:
        case s.FunctionCall(arguments=(asked,)), (collection,) if applied == "empty":
            return SizeTest(where, asked, collection, "empty", outcome=False)
        case s.BinaryOperation(left=s.FunctionCall(arguments=(asked,))), (
            Apply("size", (collection,)),
            Literal(int(n)),
        ):
            return _decided(where, asked, collection, _HOLDS.get(applied), n)
        case s.BinaryOperation(right=s.FunctionCall(arguments=(asked,))), (
            Literal(int(n)),
            Apply("size", (collection,)),
        ):
            return _decided(where, asked, collection, _HOLDS.get(_FLIPPED.get(applied, "")), n)
    return None


def _decided(
    where: s.Expression,
    asked: s.Expression,
    collection: Expression,
    compare: Callable[[int, int], bool] | None,
    bound: int,
) -> SizeTest | None:
    """Return a comparison of a size with a number, if it has one outcome for all sizes from 1."""
    if compare is None:
        return None
    outcomes = {compare(size, bound) for size in (1, max(bound, 1), max(bound, 1) + 1)}
    return SizeTest(where, asked, collection, "size", outcomes.pop()) if len(outcomes) == 1 else None
