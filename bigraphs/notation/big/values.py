"""Evaluation of numbers and strings: integers stay integers and within bounds."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Mapping
from typing import Final, TypeAlias

from bigraphs.errors import BigraphError
from bigraphs.notation.big.build_values import LARGEST
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.syntax import (
    Absolute,
    Arithmetic,
    Literal,
    Negated,
    ValueExpression,
    Variable,
)
from bigraphs.notation.lalr import Span
from bigraphs.system import Value

Lookup: TypeAlias = Callable[[Variable], Value | None]
TYPES: Final[Mapping[str, type]] = {"int": int, "float": float, "string": str}


def type_name(value: Value) -> str:
    """Return the language's word for the type of a value."""
    return {int: "int", float: "float", str: "string"}[type(value)]


def evaluate(expression: ValueExpression, lookup: Lookup, findings: Findings) -> Value | None:
    """Return the value, or None after a recorded mistake."""
    match expression:
        case Literal(value):
            return value
        case Variable():
            return lookup(expression)
        case Negated(operand):
            return _negated(evaluate(operand, lookup, findings), expression.span, findings)
        case Absolute(operand):
            return _absolute(evaluate(operand, lookup, findings), expression.span, findings)
        case Arithmetic():
            return _arithmetic(expression, lookup, findings)


def variables(value: ValueExpression) -> Iterator[str]:
    """Yield every name in an expression."""
    match value:
        case Variable(name):
            yield name
        case Negated(operand) | Absolute(operand):
            yield from variables(operand)
        case Arithmetic(first, rest):
            for operand in (first, *(operand for _, operand in rest)):
                yield from variables(operand)
        case _:
            pass


def typed(type_: str, value: Value, span: Span, findings: Findings) -> Value | None:
    """Return a value converted to a type; an integer is also a float."""
    if type_ == "float" and isinstance(value, int):
        return float(value)
    if isinstance(value, TYPES[type_]):
        return value
    article = "an" if type_ == "int" else "a"
    findings.add("type", f"{article} {type_} was expected, this is {_described(value)}", span)
    return None


def _described(value: Value) -> str:
    return (
        f'the string "{value}"'
        if isinstance(value, str)
        else f"the {'int' if isinstance(value, int) else 'float'} {value}"
    )


def _negated(value: Value | None, span: Span, findings: Findings) -> Value | None:
    if isinstance(value, str):
        findings.add("type", "a string has no sign", span)
        return None
    return None if value is None else -value


def _absolute(value: Value | None, span: Span, findings: Findings) -> Value | None:
    if isinstance(value, str):
        findings.add("type", "'abs' takes a number, not a string", span)
        return None
    return None if value is None else abs(value)


def _arithmetic(expression: Arithmetic, lookup: Lookup, findings: Findings) -> Value | None:
    values = [evaluate(operand, lookup, findings) for operand in _operands(expression)]
    found = values[0]
    for (symbol, _), other in zip(expression.rest, values[1:], strict=True):
        if found is None or other is None:
            return None
        found = _applied(symbol, found, other, expression.span, findings)
    return found


def _operands(expression: Arithmetic) -> list[ValueExpression]:
    return [expression.first, *(operand for _, operand in expression.rest)]


def _applied(symbol: str, left: Value, right: Value, span: Span, findings: Findings) -> Value | None:
    if isinstance(left, str) or isinstance(right, str):
        findings.add("type", f"'{symbol}' takes numbers, not strings", span)
        return None
    try:
        return _bounded(_OPERATIONS[symbol](left, right))
    except ZeroDivisionError:
        findings.add("number", "division by zero", span)
    except (OverflowError, BigraphError):
        findings.add("number", "the result is too large, or no number", span)
    return None


def _bounded(value: int | float) -> int | float:
    if isinstance(value, complex) or math.isnan(value):
        raise BigraphError("number", "no number")
    if isinstance(value, int) and abs(value) >= LARGEST:
        raise OverflowError
    return value


def _divided(left: int | float, right: int | float) -> int | float:
    """Divide; an integer quotient is truncated towards zero, as in BigraphER."""
    if isinstance(left, int) and isinstance(right, int):
        quotient = abs(left) // abs(right)
        return quotient if (left < 0) == (right < 0) else -quotient
    return left / right


def _raised(base: int | float, exponent: int | float) -> int | float:
    if isinstance(base, int) and isinstance(exponent, int):
        if exponent < 0:
            raise BigraphError("number", "a whole number to a negative power")
        if abs(base) > 1 and exponent > LARGEST.bit_length():
            raise OverflowError
    found: int | float = base**exponent
    return found


_OPERATIONS: Final[Mapping[str, Callable[[int | float, int | float], int | float]]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": _divided,
    "^": _raised,
}
