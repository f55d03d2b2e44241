"""Expressions: the values of behaviours, and the queries of observations."""

from __future__ import annotations

from typing import TypeAlias

from semantics.behaviours.observations import QueryOperator
from specs.syntax.nodes import Name, Node, node


@node
class TextLiteral(Node):
    """`"handover"`: a text, never equal to a name. `"base"` and `base` are two values."""

    value: str


@node
class IntegerLiteral(Node):
    """`3`: a whole number. A negative one is written `-3`."""

    value: int


@node
class TruthLiteral(Node):
    """`true` or `false`, in expressions and in formulas."""

    value: bool


@node
class HostReference(Node):
    """`HOST`: the node that hosts the agent at that moment, in expressions and in queries."""


@node
class SelfReference(Node):
    """`SELF`: the agent's own name."""


@node
class TupleLiteral(Node):
    """`("found", oilSpill0)`: a tuple of two or more values."""

    items: tuple[Expression, ...]


@node
class SetLiteral(Node):
    """`{uav0, uav1}` or `{}`: a set."""

    items: tuple[Expression, ...]


@node
class RouteLiteral(Node):
    """`[gate0, gate1, gate0]` or `[]`: a route.

    An ordered list: `for` visits its stops in order, and a repeated stop each time. `r + s` appends a route to another;
    `r - s`, `minus`, `intersect` and `r of Location` remove stops and keep the order of the others.
    """

    items: tuple[Expression, ...]


@node
class Member(Node):
    """`patrol[uav0]`, `patrol[0]`: a member of a family of bigActors, by its entity or by its number, from 0.

    In behaviours, both may be computed: `send "go" to patrol[who]`, `patrol[i + 1]`. Behind a variable, the brackets
    give an element of its tuple or route: `route[0]` is `element(route, 0)`.
    """

    family: Name
    index: Expression


@node
class UnaryOperation(Node):
    """`not e` (also `!e`), `-e`: negation."""

    operator: str
    operand: Expression


@node
class BinaryOperation(Node):
    """`a or b`, `a and b`, `a in b`, `a not in b`, `a == b`, `a != b`, `a < b`, `a + b`, `a - b`.

    Also `<=`, `>` and `>=`. `||` is another way to write `or`, and `&&` to write `and`.
    """

    operator: str
    left: Expression
    right: Expression


@node
class OfKind(Node):
    """`obs of Vessel`: the elements of a kind."""

    operand: Expression
    kind: Name


@node
class FunctionCall(Node):
    """`size(obs)`: a built-in function applied to its arguments."""

    function: Name
    arguments: tuple[Expression, ...]


@node
class AllNodes(Node):
    """`ALL`: all nodes."""


@node
class QueryApplication(Node):
    """`PARENT(q)`, `CHILDREN(q)`, `LINKED_TO(q)` or `HOSTED_AT(q)`.

    A relation, applied to each node that the inner query shows. `PARENT_HOST`, `CHILDREN_HOST`, `LINKED_TO_HOST` and
    `HOSTED_AT_HOST` are short for the relation of `HOST`. `CHILDREN(x)` also shows x, so `x in o` is true; `size`,
    `empty`, `first`, `of`, `for` and `choose` use only the children. Of `LINKED_TO(x)`, x is a member: without it,
    `empty(o - {x})` is true if no other node is linked.
    """

    relation: QueryOperator
    argument: Query


Agent: TypeAlias = Name | Member

Expression: TypeAlias = (
    Name
    | Member
    | TextLiteral
    | IntegerLiteral
    | TruthLiteral
    | HostReference
    | SelfReference
    | TupleLiteral
    | SetLiteral
    | RouteLiteral
    | UnaryOperation
    | BinaryOperation
    | OfKind
    | FunctionCall
)

Query: TypeAlias = HostReference | AllNodes | Name | QueryApplication
