"""The builder of values; it checks the bounds of numbers and rejects reserved names."""

from __future__ import annotations

import math
from typing import Any, Final

from bigraphs.errors import NotationError
from bigraphs.notation.big import syntax
from bigraphs.notation.big.grammar import RESERVED
from bigraphs.notation.big.syntax import ValueExpression
from bigraphs.notation.lalr import Span, Token
from bigraphs.system import Value

LARGEST: Final = 2**62
"""The exclusive upper bound of integers, as in BigraphER."""
MAX_DEPTH: Final = 50
"""The nesting limit of signs and powers."""


class Values:
    """Builds numbers, strings and names; the base class of the other builders."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.mistakes: list[NotationError] = []

    def wrong(self, code: str, message: str, at: Span, hint: str = "") -> None:
        found = NotationError(code, message, self.text, at.start, length=at.end - at.start, hint=hint)
        self.mistakes.append(found)

    def whole(self, token: Token) -> int:
        """Return the integer of an INT token."""
        digits = token.replace("_", "")
        if len(digits) > 19 or int(digits) >= LARGEST:
            at = token.span
            self.wrong("number", f"a number of {len(digits)} digits is too large", at)
            return 0
        return int(digits)

    def named(self, token: Token) -> str:
        """Return a declared name; record a mistake if it is a reserved word."""
        if token in RESERVED:
            at = token.span
            self.wrong("name", f"'{token}' is a word of the language", at, "take another name")
        return str(token)

    def names(self, _at: Span, *names: Token) -> tuple[str, ...]:
        return tuple(map(str, names))

    def numbers(self, _at: Span, *numbers: Token | None) -> tuple[int, ...]:
        return tuple(self.whole(number) for number in numbers if number is not None)

    def values(self, _at: Span, *values: ValueExpression) -> syntax.Arguments:
        return values

    def arguments(self, _at: Span, values: syntax.Arguments) -> syntax.Arguments:
        return values

    def number_value(self, at: Span, token: Token) -> syntax.Literal:
        return syntax.Literal(self.number_of(token), at)

    def number_of(self, token: Token) -> Value:
        digits = token.replace("_", "")
        if digits.isdecimal():
            return self.whole(token)
        found = float(digits)
        if math.isinf(found) and digits != "inf":
            self.wrong("number", f"{digits[:20]} is too large", token.span)
        return found

    def string_value(self, at: Span, token: Token) -> syntax.Literal:
        return syntax.Literal(str(token[1:-1]), at)

    def variable(self, at: Span, name: Token) -> syntax.Variable:
        return syntax.Variable(str(name), at)

    def negated(self, at: Span, _minus: Token, operand: ValueExpression) -> ValueExpression:
        return self.checked(syntax.Negated(operand, at))

    def absolute(self, at: Span, operand: ValueExpression) -> syntax.Absolute:
        return syntax.Absolute(operand, at)

    def raised(
        self, at: Span, base: ValueExpression, caret: Token, exponent: ValueExpression
    ) -> ValueExpression:
        return self.checked(syntax.Arithmetic(base, ((str(caret), exponent),), at))

    def arithmetic(self, at: Span, first: ValueExpression, *rest: Any) -> ValueExpression:
        pairs = tuple(zip(map(str, rest[::2]), rest[1::2], strict=True))
        return syntax.Arithmetic(first, pairs, at) if pairs else first

    def checked(self, found: ValueExpression) -> ValueExpression:
        """Return a value expression; record a mistake if its signs and powers nest too deeply to be evaluated."""
        depth, inner = 0, found
        while depth <= MAX_DEPTH:
            if isinstance(inner, syntax.Negated):
                inner = inner.operand
            elif isinstance(inner, syntax.Arithmetic) and inner.rest[0][0] == "^":
                inner = inner.rest[0][1]
            else:
                return found
            depth += 1
        self.wrong("too-deep", f"signs and powers nest deeper than {MAX_DEPTH}", found.span)
        return syntax.Literal(0, found.span)
