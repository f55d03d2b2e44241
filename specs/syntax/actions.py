"""Control actions: the requests of `control`, and the bodies of reaction rules."""

from __future__ import annotations

from dataclasses import field
from functools import lru_cache
from typing import TypeAlias

from bigraphs.errors import NotationError
from bigraphs.notation.paper import RuleTerm, parse_rule
from specs.syntax.expressions import Expression
from specs.syntax.nodes import Name, Node, node


@node
class Command(Node):
    """`MOVE u TO e`, `HAND u TO g`: a command; each operand is the name of a node, or a variable that holds one.

    `VIA v, w` lists the places on its way in their order: twenty at the most, each named once. L has to have them, and
    P has to show them. On its way, the mover is in none of them: it is in transit to its destination.
    """

    name: str
    operands: tuple[Expression, ...]
    via: tuple[Expression, ...] = ()


@node
class ApplyRule(Node):
    """`land(uav0, base0)`: a named reaction rule with its arguments."""

    rule: Name
    arguments: tuple[Expression, ...]


@node
class RuleBody(Node):
    """`{ u[c] || b.$0 -> b.(u[c] | $0) }`: a reaction rule in the notation of the paper's runtime.

    Attributes:
        text: The body with collapsed white space.
        raw: The text between the braces with comments replaced by spaces; its offsets count from `raw_start`.
        raw_start: The offset of that text in the mission.
    """

    text: str
    raw: str = field(default="", compare=False, repr=False)
    raw_start: int = field(default=0, compare=False, repr=False)

    @property
    def term(self) -> RuleTerm | None:
        """The parsed rule, or None if it has a mistake; never None in a mission without mistakes."""
        return _read(self.raw or self.text)


@lru_cache(maxsize=1024)
def _read(text: str) -> RuleTerm | None:
    try:
        return parse_rule(text)
    except NotationError:
        return None


Action: TypeAlias = Command | ApplyRule | RuleBody
