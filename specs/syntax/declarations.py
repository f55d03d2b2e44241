"""Declarations: the parts of a mission file, except its world."""

from __future__ import annotations

from typing import TypeAlias, TypeVar

from specs.syntax.actions import RuleBody
from specs.syntax.expressions import Agent, Expression, TextLiteral
from specs.syntax.formulas import FairDeadlockFreedom, Formula, Progress, TemporalProperty
from specs.syntax.live import Live
from specs.syntax.nodes import Name, Node, node
from specs.syntax.statements import Duration, Statement
from specs.syntax.timing import Timing
from specs.syntax.world import Believes, Length, Placement, Signature, World

# --- rules, behaviours, bigActors


@node
class Parameter(Node):
    """`u: UAV`: a parameter of a reaction rule, which stands for a node of this kind."""

    name: Name
    kind: Name


@node
class Rule(Node):
    """`rule land(u: UAV, b: Location) { u[c] || b.$0 -> b.(u[c] | $0) }`.

    A named reaction rule. The parameters are optional.
    """

    name: Name
    parameters: tuple[Parameter, ...]
    body: RuleBody


@node
class Definition(Node):
    """`def visit(place) = { ... }`: a behaviour with parameters."""

    name: Name
    parameters: tuple[Name, ...]
    body: tuple[Statement, ...]


@node
class BigActor(Node):
    """`BigActor a hosted_at uav0 with_behavior { ... }`.

    An agent. The name is optional. `with_behavior visit(oilSpill0)` is short for `with_behavior { visit(oilSpill0) }`.
    """

    name: Name | None
    host: Name
    body: tuple[Statement, ...]


@node
class Family(Node):
    """`BigActor patrol[i] for u in UAV hosted_at u with_behavior visit(u, i)`.

    A family of agents: one for each entity of a kind, or of a set or a route of entities. A member is named after its
    entity, `patrol[uav0]`. In its body, `u` is that entity, and `i` the member's number, from 0: in the order of a
    route, else of the entities' names. `BigActor patrol[u] for u in ...` has no number. The host may be `u`, or an
    entity that hosts all members.
    """

    name: Name
    index: Name
    variable: Name
    range: Expression
    host: Name
    body: tuple[Statement, ...]


# --- environment


@node
class DriftsAmong(Node):
    """`oilSpill0 drifts among circle (37.0, -8.7) radius 400 m, searchArea1`.

    The entity may move to any of these placements at any time, unless it is absent, carried or in transit. A place
    stands for its centroid. After a flight, a vehicle drifts again from its destination.
    """

    entity: Name
    placements: tuple[Placement | Name, ...]


@node
class DriftsWithin(Node):
    """`boat0 drifts within harbour0`: the entity may move to any point of the place."""

    entity: Name
    place: Name


@node
class Drops(Node):
    """`wifi drops`, `wifi drops and returns`: a channel is lost for all its members."""

    channel: Name
    returns: bool = False


@node
class Leaves(Node):
    """`uav0 leaves wifi`, `uav0 leaves wifi and returns`: one entity loses a channel."""

    entity: Name
    channel: Name
    returns: bool = False


@node
class Appears(Node):
    """`tanker0 appears at point (37.0, -8.7), searchArea1 linked ais`.

    An absent entity appears at any of these placements, with these links.
    """

    entity: Name
    placements: tuple[Placement | Name, ...]
    channels: tuple[Name, ...] = ()


@node
class Vanishes(Node):
    """`tanker0 vanishes`: an entity leaves P."""

    entity: Name


@node
class Says(Node):
    """`says "handover" to a at most 3 times`, or `someone says ...`.

    Someone outside sends a message to a bigActor. `to a` is optional if there is one bigActor; the default is
    `at most once`.
    """

    message: Expression
    recipient: Agent | None = None
    times: int = 1


@node
class Arrives(Node):
    """`uav0 arrives`: all flights of uav0 end, so `commit` is fair."""

    entity: Name


@node
class Strays(Node):
    """`UAV strays at most 30 m`, `uav0 strays at most 30 m`: the farthest distance of a vehicle from its way.

    The way is the shortest line between the points to which it is sent; take-off, turns and wind are included. The
    clause of a vehicle replaces that of its kind. It bounds [regions](#regions), and a run watches it.
    """

    vehicle: Name
    distance: Length


@node
class Misses(Node):
    """`observe may miss OilSpill, boat0`: an observation may leave out these entities, although they are there.

    A kind stands for all its entities ([observations that miss](#observations-that-miss)).
    """

    entities: tuple[Name, ...]


EnvironmentClause: TypeAlias = (
    DriftsAmong | DriftsWithin | Drops | Leaves | Appears | Vanishes | Says | Arrives | Strays | Misses
)


@node
class Environment(Node):
    """`environment { ... }`: all changes that may happen without an action of an agent."""

    clauses: tuple[EnvironmentClause, ...]


# --- scheduler, control and checks


@node
class Scheduler(Node):
    """`scheduler program_order`: the order of service of requests: program_order (the default), unordered or fcfs."""

    name: str


@node
class ControlMode(Node):
    """`control atomic`: whether control takes time: atomic (the default) or timed."""

    name: str


@node
class StandardProperty(Node):
    """`race_freedom`: a standard property, requested by its name alone."""

    name: str


@node
class Invariant(Node):
    """`invariant "never in the basin": not (actually uav0 in basin0)`: true in every configuration."""

    label: TextLiteral
    formula: Formula


@node
class Reachable(Node):
    """`reachable "found": uav0 in oilSpill0`: true in some configuration."""

    label: TextLiteral
    formula: Formula


@node
class Deadline(Node):
    """`within 40 min "there": uav0 in oilSpill0`, `within 5 min "answered": pending OBS a leads to not pending OBS a`.

    On every run, the formula is true at some moment up to that time from the start. With `leads to`: whenever the first
    formula is true, the second is true then or within that time. In missions with `timing` only.
    """

    limit: Duration
    label: TextLiteral
    formula: Formula


@node
class FirstTime(Node):
    """`time "found": uav0 in oilSpill0`: the earliest and the latest moment at which it is first true.

    In missions with `timing` only.
    """

    label: TextLiteral
    formula: Formula


Property: TypeAlias = (
    StandardProperty
    | FairDeadlockFreedom
    | Invariant
    | Reachable
    | TemporalProperty
    | Progress
    | Deadline
    | FirstTime
)


@node
class Check(Node):
    """`check { ... }`: the properties to check. Without it, the first three standard ones are checked."""

    properties: tuple[Property, ...]


Declaration: TypeAlias = (
    Signature
    | World
    | Believes
    | Rule
    | Definition
    | BigActor
    | Family
    | Environment
    | Scheduler
    | ControlMode
    | Check
    | Timing
    | Live
)

D = TypeVar("D", bound=Node)


@node
class Mission(Node):
    """`mission oil_spill` and declarations in any order. The header is optional."""

    name: Name | None
    declarations: tuple[Declaration, ...]

    def each(self, sort: type[D]) -> tuple[D, ...]:
        """Return the declarations of one sort, in the order of the file."""
        return tuple(item for item in self.declarations if isinstance(item, sort))
