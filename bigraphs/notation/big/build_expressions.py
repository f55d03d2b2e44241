"""Build expressions of bigraphs from lark's trees."""

from __future__ import annotations

from typing import Any

from lark import Token, v_args
from lark.tree import Meta

from bigraphs.notation.big import syntax
from bigraphs.notation.big.build_values import Values, span_of, token_span
from bigraphs.notation.big.syntax import Expression, ValueExpression


@v_args(inline=True, meta=True)
class Expressions(Values):
    """Expressions of bigraphs."""

    def ref(self, meta: Meta, name: Token, arguments: syntax.Arguments | None) -> syntax.Ref:
        return syntax.Ref(str(name), arguments or (), span_of(meta))

    def number(self, meta: Meta, number: Token) -> syntax.Number:
        return syntax.Number(self.whole(number), span_of(meta))

    def ion(
        self,
        meta: Meta,
        control: Token,
        arguments: syntax.Arguments | None,
        links: tuple[str, ...] | None,
    ) -> syntax.Ion:
        return syntax.Ion(str(control), links or (), arguments or (), span_of(meta))

    def nest(self, meta: Meta, ion: syntax.Ion, inside: Expression) -> syntax.Nest:
        return syntax.Nest(ion, inside, span_of(meta))

    def close(self, meta: Meta, name: Token) -> syntax.Close:
        return syntax.Close((str(name),), span_of(meta))

    def close_joined(self, meta: Meta, names: tuple[str, ...]) -> syntax.Close:
        return syntax.Close(names, span_of(meta))

    def substitute(self, meta: Meta, outer: Token, inner: tuple[str, ...]) -> syntax.Substitute:
        return syntax.Substitute(str(outer), inner, span_of(meta))

    def new_names(self, meta: Meta, names: tuple[str, ...]) -> syntax.NewNames:
        return syntax.NewNames(names, span_of(meta))

    def merge(self, meta: Meta, width: Token | None) -> syntax.Placed:
        return syntax.Placed(((0,),) * self.width(width, 2), 1, span_of(meta))

    def split(self, meta: Meta, width: Token | None) -> syntax.Placed:
        count = self.width(width, 2)
        return syntax.Placed((tuple(range(count)),), count, span_of(meta))

    def width(self, token: Token | None, default: int) -> int:
        """Return how wide something is: what is wider than a bigraph may be is not even made."""
        found = default if token is None else self.whole(token)
        if found <= syntax.MAX_SIZE:
            return found
        if token is not None:
            at = token_span(token)
            self.wrong("too-large", f"a bigraph of more than {syntax.MAX_SIZE} parts", at)
        return 0

    def set(self, _meta: Meta, numbers: tuple[int, ...]) -> tuple[int, ...]:
        return numbers

    def placing(self, meta: Meta, *parts: Any) -> syntax.Placed:
        sets = tuple(part for part in parts[:-1] if part is not None)
        return syntax.Placed(sets, self.width(parts[-1], 0), span_of(meta))

    def identity(self, meta: Meta, width: Token | None) -> syntax.Identity:
        return syntax.Identity(self.width(width, 1), (), span_of(meta))

    def identity_of_names(self, meta: Meta, names: tuple[str, ...]) -> syntax.Identity:
        return syntax.Identity(0, names, span_of(meta))

    def identity_of_both(self, meta: Meta, width: Token, names: tuple[str, ...]) -> syntax.Identity:
        return syntax.Identity(self.width(width, 1), names, span_of(meta))

    def wired(self, meta: Meta, *parts: Any) -> syntax.Wired:
        return syntax.Wired(_distinct(parts[:-1]), parts[-1], span_of(meta))

    def chain(self, meta: Meta, first: Expression, *rest: Any) -> Expression:
        pairs = tuple(zip(map(str, rest[::2]), rest[1::2], strict=True))
        return syntax.Chain(first, pairs, span_of(meta)) if pairs else first

    def applied(self, meta: Meta, context: Expression, content: Expression) -> syntax.Chain:
        return syntax.Chain(context, (("*", content),), span_of(meta))

    def share(self, meta: Meta, what: Expression, by: Expression, where: Expression) -> syntax.Share:
        return syntax.Share(what, by, where, span_of(meta))

    def repeat(self, meta: Meta, operator: Token, times: ValueExpression, body: Expression) -> syntax.Repeat:
        return syntax.Repeat("|" if operator == "par" else "||", times, body, span_of(meta))


def _distinct(wires: tuple[syntax.Wire, ...]) -> tuple[syntax.Wire, ...]:
    """Return wires where a closure written twice in a row counts once, as in BigraphER."""
    return tuple(wire for place, wire in enumerate(wires) if not place or wire != wires[place - 1])
