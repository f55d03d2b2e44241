"""Patterns: what a case of `react` or `match` takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from specs.syntax.expressions import IntegerLiteral, TextLiteral, TruthLiteral
from specs.syntax.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class ObservationPattern(Node):
    """`obs: Observation` or `_: Observation`: an observation; `variable` is None for `_`."""

    variable: Name | None


@dataclass(frozen=True, slots=True)
class MessagePattern(Node):
    """`m: Message` or `_: Message`: any message; `variable` is None for `_`."""

    variable: Name | None


@dataclass(frozen=True, slots=True)
class VariablePattern(Node):
    """`x`: whatever comes, and it is called x; as the whole pattern of a `react` case, an observation."""

    variable: Name


@dataclass(frozen=True, slots=True)
class Wildcard(Node):
    """`_`: whatever comes."""


@dataclass(frozen=True, slots=True)
class LiteralPattern(Node):
    """`"handover"`, `3`, `true`: this value."""

    value: TextLiteral | IntegerLiteral | TruthLiteral


@dataclass(frozen=True, slots=True)
class ConstantPattern(Node):
    """`=uav0`: this name, not a variable."""

    name: Name


@dataclass(frozen=True, slots=True)
class TuplePattern(Node):
    """`("found", x, _)`: a tuple of that many values, each of which fits its pattern."""

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
