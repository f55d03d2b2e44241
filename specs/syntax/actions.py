"""Control actions: what `control` requests, and the bodies of reaction rules."""

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
    """`MOVE u TO e`, `HAND u TO g`: a command, each operand the name of a node, or a variable that holds one.

    Behind `VIA v, w` stand the places that it passes on its way, in their order: twenty at the most, each named once.
    These are context: L has to have them, P has to show them, and nothing else is asked of them. On its way it is in
    none of them: what flies is in transit to its destination. Live, the vehicle gets the way as a mission on board.
    """

    name: str
    operands: tuple[Expression, ...]
    via: tuple[Expression, ...] = ()


@node
class ApplyRule(Node):
    """`land(uav0, base0)`: a named reaction rule, its parameters given."""

    rule: Name
    arguments: tuple[Expression, ...]


@node
class RuleBody(Node):
    """`{ u[c] || b.$0 -> b.(u[c] | $0) }`: a reaction rule in the notation of the paper's runtime.

    Attributes:
        text: What it says, its white space collapsed.
        raw: The text between the braces, its comments replaced by spaces: offsets in it count from `raw_start`.
        raw_start: Where that text begins in the mission.
    """

    text: str
    raw: str = field(default="", compare=False, repr=False)
    raw_start: int = field(default=0, compare=False, repr=False)

    @property
    def term(self) -> RuleTerm | None:
        """What it says, or None where it has a mistake; never None in a parsed mission."""
        return _read(self.raw or self.text)


@lru_cache(maxsize=1024)
def _read(text: str) -> RuleTerm | None:
    try:
        return parse_rule(text)
    except NotationError:
        return None


Action: TypeAlias = Command | ApplyRule | RuleBody
