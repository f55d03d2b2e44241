"""The builder of bigraph expressions."""

from __future__ import annotations

from typing import Any

from bigraphs.notation.big import syntax
from bigraphs.notation.big.build_values import Values
from bigraphs.notation.big.syntax import Expression, ValueExpression
from bigraphs.notation.lalr import Span, Token


class Expressions(Values):
    """Builds expressions of bigraphs."""

    def ref(self, at: Span, name: Token, arguments: syntax.Arguments | None) -> syntax.Ref:
        return syntax.Ref(str(name), arguments or (), at)

    def number(self, at: Span, number: Token) -> syntax.Number:
        return syntax.Number(self.whole(number), at)

    def ion(
        self,
        at: Span,
        control: Token,
        arguments: syntax.Arguments | None,
        links: tuple[str, ...] | None,
    ) -> syntax.Ion:
        return syntax.Ion(str(control), links or (), arguments or (), at)

    def nest(self, at: Span, ion: syntax.Ion, inside: Expression) -> syntax.Nest:
        return syntax.Nest(ion, inside, at)

    def close(self, at: Span, name: Token) -> syntax.Close:
        return syntax.Close((str(name),), at)

    def close_joined(self, at: Span, names: tuple[str, ...]) -> syntax.Close:
        return syntax.Close(names, at)

    def substitute(self, at: Span, outer: Token, inner: tuple[str, ...]) -> syntax.Substitute:
        return syntax.Substitute(str(outer), inner, at)

    def new_names(self, at: Span, names: tuple[str, ...]) -> syntax.NewNames:
        return syntax.NewNames(names, at)

    def merge(self, at: Span, width: Token | None) -> syntax.PlacingLiteral:
        return syntax.PlacingLiteral(((0,),) * self.width(width, 2), 1, at)

    def split(self, at: Span, width: Token | None) -> syntax.PlacingLiteral:
        count = self.width(width, 2)
        return syntax.PlacingLiteral((tuple(range(count)),), count, at)

    def width(self, token: Token | None, default: int) -> int:
        """Return a width; record a mistake if it exceeds the size limit of bigraphs, before such a term is built."""
        found = default if token is None else self.whole(token)
        if found <= syntax.MAX_SIZE:
            return found
        if token is not None:
            at = token.span
            self.wrong("too-large", f"a bigraph of more than {syntax.MAX_SIZE} parts", at)
        return 0

    def set(self, _at: Span, numbers: tuple[int, ...]) -> tuple[int, ...]:
        return numbers

    def placing(self, at: Span, *parts: Any) -> syntax.PlacingLiteral:
        sets = tuple(part for part in parts[:-1] if part is not None)
        return syntax.PlacingLiteral(sets, self.width(parts[-1], 0), at)

    def identity(self, at: Span, width: Token | None) -> syntax.Identity:
        return syntax.Identity(self.width(width, 1), (), at)

    def identity_of_names(self, at: Span, names: tuple[str, ...]) -> syntax.Identity:
        return syntax.Identity(0, names, at)

    def identity_of_both(self, at: Span, width: Token, names: tuple[str, ...]) -> syntax.Identity:
        return syntax.Identity(self.width(width, 1), names, at)

    def wired(self, at: Span, *parts: Any) -> syntax.Wired:
        return syntax.Wired(_distinct(parts[:-1]), parts[-1], at)

    def chain(self, at: Span, first: Expression, *rest: Any) -> Expression:
        pairs = tuple(zip(map(str, rest[::2]), rest[1::2], strict=True))
        return syntax.Chain(first, pairs, at) if pairs else first

    def applied(self, at: Span, context: Expression, content: Expression) -> syntax.Chain:
        return syntax.Chain(context, (("*", content),), at)

    def share(self, at: Span, what: Expression, by: Expression, where: Expression) -> syntax.Share:
        return syntax.Share(what, by, where, at)

    def repeat(self, at: Span, operator: Token, times: ValueExpression, body: Expression) -> syntax.Repeat:
        return syntax.Repeat("|" if operator == "par" else "||", times, body, at)


def _distinct(wires: tuple[syntax.Wire, ...]) -> tuple[syntax.Wire, ...]:
    """Return the wires; a closure written twice in a row counts once, as in BigraphER."""
    return tuple(wire for place, wire in enumerate(wires) if not place or wire != wires[place - 1])
