"""Formulas: claims on configurations and on runs, and temporal properties."""

from __future__ import annotations

from typing import TypeAlias

from specs.syntax.expressions import Agent, Expression, TextLiteral, TruthLiteral
from specs.syntax.nodes import Name, Node, node
from specs.syntax.world import Length


@node
class Negation(Node):
    """`not F` (also `!F`). `X != Y` is short for `not X == Y`."""

    operand: Formula


@node
class Connective(Node):
    """`F and G`, `F or G`, `F -> G`, `F <-> G`: `and` binds tightest and `<->` loosest; `->` binds to the right."""

    operator: str
    left: Formula
    right: Formula


@node
class Quantified(Node):
    """`forall x: UAV . F`, `exists x: UAV . F`, `forall x, y: UAV . F`, `forall x: agents . F`, `forall x: patrol . F`.

    All entities of a kind, or some; all bigActors; the members of a family. F extends as far as possible. `agents
    with_behavior visit` are the bigActors declared or spawned with it. `agents hosted_at Y` are those that Y, or an
    entity of the kind Y, hosts at that moment.
    """

    quantifier: str
    variable: Name
    range: Name
    body: Formula
    behaviour: Name | None = None
    host: Name | None = None
    joined: bool = False


@node
class Inside(Node):
    """`X in Y`, `X directly in Y`, `actually X in Y`, `actually X directly in Y`.

    X is inside Y, at any depth or directly: in L, or with `actually` in P.
    """

    entity: Name
    place: Name
    directly: bool = False
    actually: bool = False


@node
class PossiblyIn(Node):
    """`possibly X in Y`: X may be over the place Y, at rest or on its way.

    The [region](#regions) of X has a point in the interior of Y, and their altitudes meet; or Y carries X.
    """

    entity: Name
    place: Name


@node
class SurelyIn(Node):
    """`surely X in Y`: X is in the place Y, wherever it is on its way: all of its region lies in Y; or Y carries X."""

    entity: Name
    place: Name


@node
class ApartFrom(Node):
    """`X at least 50 m from Y`, `X at least 50 m or 30 m up from Y`.

    No point of X's region is nearer to one of Y's. It is also true if one is above the other by that length, or by the
    second one if it is given, and if one is absent.
    """

    entity: Agent
    other: Agent
    distance: Length
    height: Length | None = None


@node
class WithinRangeOf(Node):
    """`X within 3 km of Y`: both are there, and no point of X's region is farther from any of Y's."""

    entity: Agent
    other: Agent
    distance: Length


@node
class LinkedTo(Node):
    """`X linked N`, `actually X linked N`.

    N is a channel of X, or a node that shares a channel with X: in L, or with `actually` in P.
    """

    entity: Name
    other: Name
    actually: bool = False


@node
class Present(Node):
    """`present X`: the entity X is in P, or the bigActor X exists, from the beginning or since its spawning."""

    entity: Agent


@node
class Known(Node):
    """`known X`: X is in L."""

    entity: Name


@node
class Pending(Node):
    """`pending a`, `pending CTR a`.

    Agent a has a request in η, or one of that sort (`OBS`, `READY`, `CTR`, `FLY`, `SND` or `MGR`).
    """

    agent: Agent
    request: str | None = None


@node
class Ended(Node):
    """`ended a`: agent a has no statement left; its last requests, such as a flight, may still be pending."""

    agent: Agent


@node
class Waiting(Node):
    """`waiting a`: agent a is at a `react` statement."""

    agent: Agent


@node
class HostedAt(Node):
    """`a hosted_at X`: X hosts agent a."""

    agent: Agent
    host: Name


@node
class SameName(Node):
    """`x == y`: two names are the same; at least one of them is quantified."""

    left: Agent
    right: Agent


@node
class Stored(Node):
    """`a.x == 3`, `a.x < 3`, `a.x <= 3`, `a.x > 3`, `a.x >= 3`: compare agent a's variable x with a value.

    Before it has a value, the comparison neither violates nor fulfils a property
    ([temporal.md](temporal.md#variables-in-properties)).
    """

    agent: Agent
    variable: Name
    value: Expression
    operator: str = "=="


@node
class HasValue(Node):
    """`bound a.x`: agent a has given its variable x a value."""

    agent: Agent
    variable: Name


# --- runs

SIGNS = {"G": "[]", "F": "<>", "X": "X"}
"""The signs of the operators with letters."""


@node
class PathPrefix(Node):
    """`[] F`, `<> F`, `X F`, `always F`, `eventually F`, `next F`, `infinitely often F`.

    `always` (`[]` or `G`): now and ever after. `eventually` (`<>` or `F`): now or later. `next` (`X`): after the next
    step. The signs bind like `not`; the words extend as far as possible.
    """

    operator: str
    operand: Formula


@node
class PathOperation(Node):
    """`F U G`, `F R G`, `F W G`, `F until G`.

    `U` or `until`: F until G, and G comes. `R`: G until F and G are true together, or for ever. `W`: F until G, or for
    ever. They bind tighter than `and`, and to the right.
    """

    operator: str
    left: Formula
    right: Formula


@node
class LeadsTo(Node):
    """`F leads to G`: whenever F is true, G is true then or later: `[] (F -> <> G)`. It binds loosest."""

    left: Formula
    right: Formula


@node
class PathQuantifier(Node):
    """`AG F`, `EF F`, `AX F`, `A (F U G)`, `E (F W G)`: on all runs from here, or on some. In `ctl` only."""

    quantifier: str
    operand: Formula


# --- steps


@node
class Steps(Node):
    """`sense a`, `a`, `sense`, `agents`, `rules`, `requests`, `environment`.

    Sets of steps; [temporal.md](temporal.md#fairness) has the meaning of each.
    """

    words: tuple[Agent, ...]


@node
class Taken(Node):
    """`taken sense a`: the next step is one of these. In `ltl` only."""

    steps: Steps


@node
class Enabled(Node):
    """`enabled sense a`: one of these steps is possible. In `ltl` and `ctl`."""

    steps: Steps


Formula: TypeAlias = (
    TruthLiteral
    | Negation
    | Connective
    | Quantified
    | Inside
    | PossiblyIn
    | SurelyIn
    | ApartFrom
    | WithinRangeOf
    | LinkedTo
    | Present
    | Known
    | Pending
    | Ended
    | Waiting
    | HostedAt
    | SameName
    | Stored
    | HasValue
    | PathPrefix
    | PathOperation
    | LeadsTo
    | PathQuantifier
    | Taken
    | Enabled
)


# --- properties


@node
class Fairness(Node):
    """`weak fairness of a, b`, `strong fairness of actuate`.

    Only fair runs count: those that take the steps infinitely often if they are enabled from some time on (weak), or
    again and again (strong).
    """

    strength: str
    steps: tuple[Steps, ...]


@node
class TemporalProperty(Node):
    """`ltl "served": pending CTR a leads to not pending CTR a`, `ctl "home": AG EF uav0 in base0`.

    `ltl`: true of every run. `ctl`: true of the tree of all runs. With `under weak fairness of agents` after the name,
    only fair runs count.
    """

    logic: str
    label: TextLiteral
    formula: Formula
    fairness: tuple[Fairness, ...] = ()


@node
class FairDeadlockFreedom(Node):
    """`deadlock_freedom under weak fairness of env`, `deadlock_freedom "but for the link" under weak fairness of env`.

    No fair run stays for ever in states where work is left and only the environment can move
    ([temporal.md](temporal.md#deadlock-under-fairness)).
    """

    fairness: tuple[Fairness, ...]
    label: TextLiteral | None = None


@node
class Progress(Node):
    """`progress`, `progress under strong fairness of actuate`.

    Every pending request is eventually served, under weak fairness of each rule and request, and the added fairness.
    A name is optional: `progress "served in time"`.
    """

    fairness: tuple[Fairness, ...] = ()
    label: TextLiteral | None = None
