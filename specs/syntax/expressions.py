"""Expressions: what a behaviour computes with, and the queries it observes with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from specs.syntax.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class TextLiteral(Node):
    """`"handover"`: a string, its escapes resolved."""

    value: str


@dataclass(frozen=True, slots=True)
class IntegerLiteral(Node):
    """`3`: a whole number; a negative one is written `-3` and is a `UnaryOperation`."""

    value: int


@dataclass(frozen=True, slots=True)
class TruthLiteral(Node):
    """`true` or `false`, in expressions and in formulas."""

    value: bool


@dataclass(frozen=True, slots=True)
class HostReference(Node):
    """`HOST`: the node on which the agent is, resolved when asked; in expressions and in queries."""


@dataclass(frozen=True, slots=True)
class SelfReference(Node):
    """`SELF`: the agent's own name."""


@dataclass(frozen=True, slots=True)
class TupleLiteral(Node):
    """`("found", oilSpill0)`: two values or more, in order."""

    items: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class SetLiteral(Node):
    """`{uav0, uav1}` or `{}`: a set."""

    items: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class UnaryOperation(Node):
    """`not e` (also `!e`) or `-e`: `operator` is `not` or `-`."""

    operator: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class BinaryOperation(Node):
    """`a or b`, `a and b`, `a in b`, `a not in b`, `a == b`, `a != b`, `a < b`, `a + b`, `a - b`.

    Also `<=`, `>` and `>=`. `operator` is the operator as written here; `||` and `&&` are read as
    `or` and `and`.
    """

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class OfKind(Node):
    """`obs of Vessel`: the elements of that kind."""

    operand: Expression
    kind: Name


@dataclass(frozen=True, slots=True)
class FunctionCall(Node):
    """`size(obs)`: a built-in function of the host language applied to its arguments."""

    function: Name
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class AllNodes(Node):
    """`ALL`: the query for every node there is."""


@dataclass(frozen=True, slots=True)
class QueryApplication(Node):
    """`PARENT(q)`, `CHILDREN(q)`, `LINKED_TO(q)` or `HOSTED_AT(q)`.

    A relation followed from a query's answer.

    `LINKED_TO_HOST` is read as `LINKED_TO(HOST)`, and so for the other three; its `HOST` then has the
    span of the whole.
    """

    relation: str
    argument: Query


Expression: TypeAlias = (
    Name
    | TextLiteral
    | IntegerLiteral
    | TruthLiteral
    | HostReference
    | SelfReference
    | TupleLiteral
    | SetLiteral
    | UnaryOperation
    | BinaryOperation
    | OfKind
    | FunctionCall
)

Query: TypeAlias = HostReference | AllNodes | Name | QueryApplication
