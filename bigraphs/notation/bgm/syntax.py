"""The syntax tree of `.bgm` files; `offset` is a position in the text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from bigraphs.signature import Status


@dataclass(frozen=True, slots=True)
class Hole:
    """`$0`: a hole, the remaining content of a place."""

    index: int
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Prefix:
    """`k[x, -].t`: a node, the names on its ports (None for `-`, unlinked), and its content."""

    control: str
    ports: tuple[str | None, ...] = ()
    inside: Term = ()
    offset: int = field(default=0, compare=False)


Term: TypeAlias = "tuple[Prefix | Hole, ...]"
"""The nodes and holes side by side in one place; `nil` is empty."""
Wide: TypeAlias = tuple[Term, ...]
"""Places side by side, `t || u`."""


@dataclass(frozen=True, slots=True)
class ControlLine:
    """`%active k : 2` or `%passive k : 2`."""

    name: str
    arity: int
    status: Status
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class NameLine:
    """`%outer x`, `%name x` or `%inner x`: a name that matches only itself in rules."""

    name: str
    inner: bool = False
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class RuleLine:
    """`%rule r redex -> reactum`, or without the name."""

    redex: Wide
    reactum: Wide
    name: str | None = None
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class ModelLine:
    """A term by itself: the initial state."""

    term: Wide
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Operation:
    """`==`, `&&`, `!`, `if` and the like, between properties or numbers."""

    symbol: str
    operands: tuple[Query, ...]
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Ask:
    """`matches(t)`, `size()`, ... of the states in a scope, `$pred->size()`; None is this state."""

    predicate: str
    term: Wide | None = None
    scope: str | None = None
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Count:
    """A number in a property."""

    value: int
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, slots=True)
class Scoped:
    """`$terminal->(q)`: a property of the states in a scope."""

    scope: str
    operand: Query
    offset: int = field(default=0, compare=False)


Query: TypeAlias = Operation | Ask | Count | Scoped


@dataclass(frozen=True, slots=True)
class PropertyLine:
    """`%property p query`."""

    name: str
    query: Query
    offset: int = field(default=0, compare=False)


Line: TypeAlias = ControlLine | NameLine | RuleLine | ModelLine | PropertyLine
