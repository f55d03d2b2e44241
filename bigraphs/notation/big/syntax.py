"""The syntax tree of BigraphER's expressions, one class for each construct; `span` is its position."""

from __future__ import annotations

from typing import Final, TypeAlias

from bigraphs.notation.lalr import Span
from bigraphs.records import Record
from bigraphs.system import Value

NOWHERE = Span()
MAX_SIZE: Final = 20_000
"""The size limit of a bigraph: nodes, places, sites, names and edges together."""


# --- values: numbers and strings


class Literal(Record):
    """A number or a string as written."""

    value: Value
    span: Span = NOWHERE


class Variable(Record):
    """A constant, a parameter of the system, or a parameter of the enclosing declaration."""

    name: str
    span: Span = NOWHERE


class Negated(Record):
    """`-e`."""

    operand: ValueExpression
    span: Span = NOWHERE


class Absolute(Record):
    """`abs(e)`."""

    operand: ValueExpression
    span: Span = NOWHERE


class Arithmetic(Record):
    """Operands with `+ -` or `* /` between them, left-associative, or with `^`, right-associative."""

    first: ValueExpression
    rest: tuple[tuple[str, ValueExpression], ...]
    span: Span = NOWHERE


ValueExpression: TypeAlias = Literal | Variable | Negated | Absolute | Arithmetic
Arguments: TypeAlias = tuple[ValueExpression, ...]


# --- bigraphs


class Ref(Record):
    """The bigraph of that name, `b` or `b(1, n + 1)`."""

    name: str
    arguments: Arguments = ()
    span: Span = NOWHERE


class Number(Record):
    """`1`, the empty region, or `0`, a site without a region."""

    value: int
    span: Span = NOWHERE


class Ion(Record):
    """A node with a site, or without one if its control is atomic: `K`, `K{x, y}`, `K(1, "a"){x}`."""

    control: str
    links: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = NOWHERE


class Nest(Record):
    """An ion with content."""

    ion: Ion
    inside: Expression
    span: Span = NOWHERE


class Identity(Record):
    """`id`, `id(n)`, `id{x}`, `id(n, {x})`."""

    width: int = 1
    names: tuple[str, ...] = ()
    span: Span = NOWHERE


class PlacingLiteral(Record):
    """`([{0, 1}, {0}], 2)`: for each site its regions, and the number of regions.

    The parser turns `merge(n)` and `split(n)` into this form.
    """

    parents: tuple[tuple[int, ...], ...]
    regions: int
    span: Span = NOWHERE


class Close(Record):
    """`/x`, or `/{x, y}`: names joined into one edge."""

    names: tuple[str, ...]
    span: Span = NOWHERE


class Substitute(Record):
    """`y/{x, ...}`: names joined into one."""

    outer: str
    inner: tuple[str, ...]
    span: Span = NOWHERE


class NewNames(Record):
    """`{x}`: idle names."""

    names: tuple[str, ...]
    span: Span = NOWHERE


class Wired(Record):
    """Closures and substitutions before an expression; the last one applies first."""

    wires: tuple[Wire, ...]
    body: Expression
    span: Span = NOWHERE


class Chain(Record):
    """Operands with operators of equal precedence between them, left-associative."""

    first: Expression
    rest: tuple[tuple[str, Expression], ...]
    span: Span = NOWHERE


class Share(Record):
    """`share what by placing in where`: each region of `what` goes into several sites of `where`."""

    what: Expression
    by: Expression
    where: Expression
    span: Span = NOWHERE


class Repeat(Record):
    """`par(n, b)`, n copies of b in one region, or `ppar(n, b)`, side by side; `operator` is `|` or `||`."""

    operator: str
    times: ValueExpression
    body: Expression
    span: Span = NOWHERE


Wire: TypeAlias = Close | Substitute
Expression: TypeAlias = (
    Ref | Number | Ion | Nest | Identity | PlacingLiteral | Wire | NewNames | Wired | Chain | Share | Repeat
)
