"""Patterns of the cases of `react` and `match`."""

from __future__ import annotations

from typing import TypeAlias

from specs.syntax.expressions import IntegerLiteral, TextLiteral, TruthLiteral
from specs.syntax.nodes import Name, Node, node


@node
class ObservationPattern(Node):
    """`obs: Observation` or `_: Observation`: any observation."""

    variable: Name | None


@node
class MessagePattern(Node):
    """`m: Message` or `_: Message`: any message."""

    variable: Name | None


@node
class VariablePattern(Node):
    """`x`: any value, bound to x. As the whole pattern of a `react` case, any observation."""

    variable: Name


@node
class Wildcard(Node):
    """`_`: any value."""


@node
class LiteralPattern(Node):
    """`"handover"`, `3`, `true`: exactly this value."""

    value: TextLiteral | IntegerLiteral | TruthLiteral


@node
class ConstantPattern(Node):
    """`=uav0`: exactly this name; without `=` it is a new variable."""

    name: Name


@node
class TuplePattern(Node):
    """`("found", x, _)`: a tuple of the same length whose values match these patterns."""

    items: tuple[Pattern, ...]


Pattern: TypeAlias = (
    ObservationPattern
    | MessagePattern
    | VariablePattern
    | Wildcard
    | LiteralPattern
    | ConstantPattern
    | TuplePattern
)
