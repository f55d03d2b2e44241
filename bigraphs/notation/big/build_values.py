"""Build values from lark's trees; find numbers out of bounds and reserved names."""

from __future__ import annotations

import math
from typing import Any, Final

from lark import Token, v_args
from lark.tree import Meta
from lark.visitors import Transformer_NonRecursive

from bigraphs.errors import NotationError
from bigraphs.notation.big import syntax
from bigraphs.notation.big.grammar import RESERVED
from bigraphs.notation.big.syntax import Span, ValueExpression
from bigraphs.system import Value

LARGEST: Final = 2**62
"""Whole numbers are smaller than this, as they are in BigraphER."""
MAX_DEPTH: Final = 50
"""How deep signs and powers of numbers nest."""


def span_of(meta: Meta) -> Span:
    """Return where a tree was written."""
    return Span() if meta.empty else Span(meta.start_pos, meta.end_pos)


def token_span(token: Token) -> Span:
    """Return where a word was written."""
    return Span(token.start_pos or 0, token.end_pos or 0)


@v_args(inline=True, meta=True)
class Values(Transformer_NonRecursive[Token, Any]):
    """Numbers, strings and names; the base of the rest."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text
        self.mistakes: list[NotationError] = []

    def wrong(self, code: str, message: str, at: Span, hint: str = "") -> None:
        found = NotationError(code, message, self.text, at.start, length=at.end - at.start, hint=hint)
        self.mistakes.append(found)

    def whole(self, token: Token) -> int:
        """Return the number of an INT token."""
        digits = token.replace("_", "")
        if len(digits) > 19 or int(digits) >= LARGEST:
            at = token_span(token)
            self.wrong("number", f"a number of {len(digits)} digits is too large", at)
            return 0
        return int(digits)

    def named(self, token: Token) -> str:
        """Return a name that is declared, if it is none of the language's words."""
        if token in RESERVED:
            at = token_span(token)
            self.wrong("name", f"'{token}' is a word of the language", at, "take another name")
        return str(token)

    def names(self, _meta: Meta, *names: Token) -> tuple[str, ...]:
        return tuple(map(str, names))

    def numbers(self, _meta: Meta, *numbers: Token | None) -> tuple[int, ...]:
        return tuple(self.whole(number) for number in numbers if number is not None)

    def values(self, _meta: Meta, *values: ValueExpression) -> syntax.Arguments:
        return values

    def arguments(self, _meta: Meta, values: syntax.Arguments) -> syntax.Arguments:
        return values

    def number_value(self, meta: Meta, token: Token) -> syntax.Literal:
        return syntax.Literal(self.number_of(token), span_of(meta))

    def number_of(self, token: Token) -> Value:
        digits = token.replace("_", "")
        if digits.isdecimal():
            return self.whole(token)
        found = float(digits)
        if math.isinf(found) and digits != "inf":
            self.wrong("number", f"{digits[:20]} is too large", token_span(token))
        return found

    def string_value(self, meta: Meta, token: Token) -> syntax.Literal:
        return syntax.Literal(str(token[1:-1]), span_of(meta))

    def variable(self, meta: Meta, name: Token) -> syntax.Variable:
        return syntax.Variable(str(name), span_of(meta))

    def negated(self, meta: Meta, _minus: Token, operand: ValueExpression) -> ValueExpression:
        return self.checked(syntax.Negated(operand, span_of(meta)))

    def absolute(self, meta: Meta, operand: ValueExpression) -> syntax.Absolute:
        return syntax.Absolute(operand, span_of(meta))

    def raised(
        self, meta: Meta, base: ValueExpression, caret: Token, exponent: ValueExpression
    ) -> ValueExpression:
        return self.checked(syntax.Arithmetic(base, ((str(caret), exponent),), span_of(meta)))

    def arithmetic(self, meta: Meta, first: ValueExpression, *rest: Any) -> ValueExpression:
        pairs = tuple(zip(map(str, rest[::2]), rest[1::2], strict=True))
        return syntax.Arithmetic(first, pairs, span_of(meta)) if pairs else first

    def checked(self, found: ValueExpression) -> ValueExpression:
        """Refuse signs and powers that nest too deeply to be evaluated."""
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
