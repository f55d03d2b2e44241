"""The syntax tree of BigraphER's expressions, one class for each construct; `span` is its position."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, TypeAlias

from bigraphs.notation.lalr import Span
from bigraphs.system import Value

NOWHERE = Span()
MAX_SIZE: Final = 20_000
"""Of a bigraph: nodes, places, sites, names and edges together."""


# --- values: numbers and strings


@dataclass(frozen=True, slots=True)
class Literal:
    """A number or a string as written."""

    value: Value
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Variable:
    """A constant, a parameter of the system, or one of the declaration that it stands in."""

    name: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Negated:
    """`-e`."""

    operand: ValueExpression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Absolute:
    """`abs(e)`."""

    operand: ValueExpression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """Operands with `+ -` or `* /` between them, from the left, or `^`, from the right."""

    first: ValueExpression
    rest: tuple[tuple[str, ValueExpression], ...]
    span: Span = field(default=NOWHERE, compare=False)


ValueExpression: TypeAlias = Literal | Variable | Negated | Absolute | Arithmetic
Arguments: TypeAlias = tuple[ValueExpression, ...]


# --- bigraphs


@dataclass(frozen=True, slots=True)
class Ref:
    """The bigraph of that name, `b` or `b(1, n + 1)`."""

    name: str
    arguments: Arguments = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Number:
    """`1`, the empty region, or `0`, a site without a region."""

    value: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Ion:
    """A node with a site in it, or none if its control is atomic: `K`, `K{x, y}`, `K(1, "a"){x}`."""

    control: str
    links: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Nest:
    """An ion with something in it."""

    ion: Ion
    inside: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Identity:
    """`id`, `id(n)`, `id{x}`, `id(n, {x})`."""

    width: int = 1
    names: tuple[str, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Placed:
    """`([{0, 1}, {0}], 2)`: for each site the regions it is in, and the number of regions.

    `merge(n)` and `split(n)` are read as such.
    """

    parents: tuple[tuple[int, ...], ...]
    regions: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Close:
    """`/x`, or `/{x, y}`: names joined into one edge."""

    names: tuple[str, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Substitute:
    """`y/{x, ...}`: names joined into one."""

    outer: str
    inner: tuple[str, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class NewNames:
    """`{x}`: idle names."""

    names: tuple[str, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Wired:
    """Closures and substitutions before what they apply to, the last one first."""

    wires: tuple[Wire, ...]
    body: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Chain:
    """Operands with the operators between them, from the left; all bind alike."""

    first: Expression
    rest: tuple[tuple[str, Expression], ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Share:
    """`share what by placing in where`: each region of what is in several sites of where."""

    what: Expression
    by: Expression
    where: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Repeat:
    """`par(n, b)`, b n times in one region, or `ppar(n, b)`, side by side; `operator` is `|` or `||`."""

    operator: str
    times: ValueExpression
    body: Expression
    span: Span = field(default=NOWHERE, compare=False)


Wire: TypeAlias = Close | Substitute
Expression: TypeAlias = (
    Ref | Number | Ion | Nest | Identity | Placed | Wire | NewNames | Wired | Chain | Share | Repeat
)
