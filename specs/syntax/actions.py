"""Control actions: what `control` requests, and the bodies of reaction rules."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import TypeAlias

from bigraphs.errors import NotationError
from bigraphs.notation.paper import RuleTerm, parse_rule
from specs.syntax.expressions import Expression
from specs.syntax.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class MoveHost(Node):
    """`MOVE_HOST_TO e` or `MOVE_HOST_TO e VIA v, w`: move the agent's host into a place.

    It passes the places behind VIA on its way, in their order: twenty at the most, each named once. These are context:
    L has to have them, P has to show them, and nothing else is asked of them. On its way it is in none of them: what
    flies is in transit to its destination. Live, the vehicle gets the way as a mission on board.
    """

    destination: Expression
    via: tuple[Expression, ...] = ()


@dataclass(frozen=True, slots=True)
class Move(Node):
    """`MOVE u TO e` or `MOVE u TO e VIA v, w`: move another entity into a place."""

    entity: Expression
    destination: Expression
    via: tuple[Expression, ...] = ()


@dataclass(frozen=True, slots=True)
class Connect(Node):
    """`CONNECT_HOST_TO e`: join a channel of a node."""

    node: Expression


@dataclass(frozen=True, slots=True)
class Disconnect(Node):
    """`DISCONNECT_HOST_FROM e`: leave the channels shared with a node."""

    node: Expression


@dataclass(frozen=True, slots=True)
class HandOver(Node):
    """`HAND u TO g`: hand the control authority over an entity to a station."""

    entity: Expression
    station: Expression


@dataclass(frozen=True, slots=True)
class Put(Node):
    """`PUT x IN e`: put what a carrier holds where the carrier is, or into a carrier."""

    entity: Expression
    place: Expression


@dataclass(frozen=True, slots=True)
class ApplyRule(Node):
    """`land(uav0, base0)`: a named reaction rule, its parameters given."""

    rule: Name
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
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


Action: TypeAlias = MoveHost | Move | Connect | Disconnect | HandOver | Put | ApplyRule | RuleBody
