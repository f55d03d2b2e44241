"""Declarations: what a mission file is made of beside its world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias, TypeVar

from specs.syntax.actions import RuleBody
from specs.syntax.expressions import Expression, TextLiteral
from specs.syntax.formulas import Formula, Progress, TemporalProperty
from specs.syntax.live import Live
from specs.syntax.nodes import Name, Node
from specs.syntax.statements import Statement
from specs.syntax.world import Believes, Placement, Signature, World

# --- rules, behaviours, bigActors


@dataclass(frozen=True, slots=True)
class Parameter(Node):
    """`u: UAV`: a parameter of a reaction rule and the kind of node it stands for."""

    name: Name
    kind: Name


@dataclass(frozen=True, slots=True)
class Rule(Node):
    """`rule land(u: UAV, b: Location) { u[c] || b.$0 -> b.(u[c] | $0) }`.

    A named reaction rule; parameters optional.
    """

    name: Name
    parameters: tuple[Parameter, ...]
    body: RuleBody


@dataclass(frozen=True, slots=True)
class Definition(Node):
    """`def visit(place) = { ... }`: a behaviour with parameters."""

    name: Name
    parameters: tuple[Name, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class BigActor(Node):
    """`BigActor a hosted_at uav0 with_behavior { ... }`.

    An agent; the name is optional, as in the paper's Figure 8.

    `with_behavior visit(oilSpill0)` is read as `with_behavior { visit(oilSpill0) }`.
    """

    name: Name | None
    host: Name
    body: tuple[Statement, ...]


# --- environment


@dataclass(frozen=True, slots=True)
class DriftsAmong(Node):
    """`oilSpill0 drifts among circle (37.0, -8.7) radius 400 m, searchArea1`.

    Placements, or the centroids of places. What is absent, carried or under command does not drift: a vehicle in
    transit is on its way to its destination until its flight ends (or, where nothing says that it arrives, may never
    end), and is nowhere that the wind could take it from. From where it has arrived it drifts again.
    """

    entity: Name
    placements: tuple[Placement | Name, ...]


@dataclass(frozen=True, slots=True)
class DriftsWithin(Node):
    """`boat0 drifts within harbour0`: anywhere in a place."""

    entity: Name
    place: Name


@dataclass(frozen=True, slots=True)
class Drops(Node):
    """`wifi drops`, `wifi drops and returns`: a whole channel."""

    channel: Name
    returns: bool = False


@dataclass(frozen=True, slots=True)
class Leaves(Node):
    """`uav0 leaves wifi`, `uav0 leaves wifi and returns`: one entity's membership of a channel."""

    entity: Name
    channel: Name
    returns: bool = False


@dataclass(frozen=True, slots=True)
class Appears(Node):
    """`tanker0 appears at point (37.0, -8.7), searchArea1 linked ais`.

    At any of the placements, with these links.
    """

    entity: Name
    placements: tuple[Placement | Name, ...]
    channels: tuple[Name, ...] = ()


@dataclass(frozen=True, slots=True)
class Vanishes(Node):
    """`tanker0 vanishes`: it leaves P."""

    entity: Name


@dataclass(frozen=True, slots=True)
class Says(Node):
    """`says "handover" to a at most 3 times`, or `someone says ...`.

    `to a` is optional where there is one bigActor, and the default is `at most once`.
    """

    message: Expression
    recipient: Name | None = None
    times: int = 1


@dataclass(frozen=True, slots=True)
class Arrives(Node):
    """`uav0 arrives`: its flights always end, so that commit is fair."""

    entity: Name


EnvironmentClause: TypeAlias = (
    DriftsAmong | DriftsWithin | Drops | Leaves | Appears | Vanishes | Says | Arrives
)


@dataclass(frozen=True, slots=True)
class Environment(Node):
    """`environment { ... }`: everything that may happen without an agent."""

    clauses: tuple[EnvironmentClause, ...]


# --- how it runs and what is checked


@dataclass(frozen=True, slots=True)
class Scheduler(Node):
    """`scheduler program_order`: program_order (the default), unordered or fcfs."""

    name: str


@dataclass(frozen=True, slots=True)
class ControlMode(Node):
    """`control atomic`: atomic (the default) or timed."""

    name: str


@dataclass(frozen=True, slots=True)
class StandardProperty(Node):
    """`local_consistency`, `race_freedom`, `deadlock_freedom` or `arrival`."""

    name: str


@dataclass(frozen=True, slots=True)
class Invariant(Node):
    """`invariant "never in the basin": not (actually uav0 in basin0)`: holds in every configuration."""

    label: TextLiteral
    formula: Formula


@dataclass(frozen=True, slots=True)
class Reachable(Node):
    """`reachable "found": uav0 in oilSpill0`: holds in some configuration."""

    label: TextLiteral
    formula: Formula


Property: TypeAlias = StandardProperty | Invariant | Reachable | TemporalProperty | Progress


@dataclass(frozen=True, slots=True)
class Check(Node):
    """`check { ... }`: the properties to check; without it the first three standard ones."""

    properties: tuple[Property, ...]


Declaration: TypeAlias = (
    Signature
    | World
    | Believes
    | Rule
    | Definition
    | BigActor
    | Environment
    | Scheduler
    | ControlMode
    | Check
    | Live
)

D = TypeVar("D", bound=Node)


@dataclass(frozen=True, slots=True)
class Mission(Node):
    """`mission oil_spill` and declarations in any order; the header is optional (`name` is None)."""

    name: Name | None
    declarations: tuple[Declaration, ...]

    def each(self, sort: type[D]) -> tuple[D, ...]:
        """Return the declarations of one sort, in the order of the file."""
        return tuple(item for item in self.declarations if isinstance(item, sort))
