"""Formulas: what properties claim of configurations and of runs, and the temporal properties made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from specs.syntax.expressions import Expression, TextLiteral, TruthLiteral
from specs.syntax.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class Negation(Node):
    """`not F` (also `!F`); `X != Y` is read as `not X == Y`."""

    operand: Formula


@dataclass(frozen=True, slots=True)
class Connective(Node):
    """`F and G`, `F or G`, `F -> G`, `F <-> G`: binding loosest last, `->` to the right."""

    operator: str
    left: Formula
    right: Formula


@dataclass(frozen=True, slots=True)
class Quantified(Node):
    """`forall x: UAV . F` or `exists x: UAV . F`: over the entities of a kind; F reaches as far as it can."""

    quantifier: str
    variable: Name
    kind: Name
    body: Formula


@dataclass(frozen=True, slots=True)
class Inside(Node):
    """`X in Y`, `X directly in Y`, `actually X in Y`, `actually X directly in Y`.

    X is somewhere, or directly, inside Y: in L, or with `actually` in P.
    """

    entity: Name
    place: Name
    directly: bool = False
    actually: bool = False


@dataclass(frozen=True, slots=True)
class LinkedTo(Node):
    """`X linked N`, `actually X linked N`.

    N is a node that shares a link with X, or a channel of X: in L, or with `actually` in P.
    """

    entity: Name
    other: Name
    actually: bool = False


@dataclass(frozen=True, slots=True)
class Present(Node):
    """`present X`: X is in P."""

    entity: Name


@dataclass(frozen=True, slots=True)
class Known(Node):
    """`known X`: X is in L."""

    entity: Name


@dataclass(frozen=True, slots=True)
class Pending(Node):
    """`pending a`, `pending CTR a`.

    Agent a has a request, or one of that sort (OBS READY CTR FLY SND MGR), in η.
    """

    agent: Name
    request: str | None = None


@dataclass(frozen=True, slots=True)
class Ended(Node):
    """`ended a`: agent a has nothing left to run."""

    agent: Name


@dataclass(frozen=True, slots=True)
class Waiting(Node):
    """`waiting a`: agent a is at a `react`."""

    agent: Name


@dataclass(frozen=True, slots=True)
class HostedAt(Node):
    """`a hosted_at X`: agent a is on X."""

    agent: Name
    host: Name


@dataclass(frozen=True, slots=True)
class SameName(Node):
    """`x == y`: two names, of which at least one is quantified, are one."""

    left: Name
    right: Name


@dataclass(frozen=True, slots=True)
class Stored(Node):
    """`a.x == 3`, `a.x < 3`, `a.x <= 3`, `a.x > 3`, `a.x >= 3`: how agent a's variable x compares with that value.

    It keeps its last value to the end of the run. Before it has one, the comparison neither violates nor fulfils
    (temporal.md). What is no number has no value for `<`, `<=`, `>` and `>=`.
    """

    agent: Name
    variable: Name
    value: Expression
    operator: str = "=="


@dataclass(frozen=True, slots=True)
class HasValue(Node):
    """`bound a.x`: agent a has given its variable x a value."""

    agent: Name
    variable: Name


# --- runs

SIGNS = {"G": "[]", "F": "<>", "X": "X"}
"""The signs of the operators that letters stand for."""


@dataclass(frozen=True, slots=True)
class PathPrefix(Node):
    """`[] F`, `<> F`, `X F`, `always F`, `eventually F`, `next F`, `infinitely often F`.

    F now and ever after, now or later, after the next step. `G F` is `[] F` and `F F` is `<> F`. The signs bind like
    `not`; the words reach as far as they can.
    """

    operator: str
    operand: Formula


@dataclass(frozen=True, slots=True)
class PathOperation(Node):
    """`F U G`, `F R G`, `F W G`, `F until G`.

    F until G (which comes), G until F and G are true together or for ever, F until G or for ever. They bind tighter
    than `and`, to the right.
    """

    operator: str
    left: Formula
    right: Formula


@dataclass(frozen=True, slots=True)
class LeadsTo(Node):
    """`F leads to G`: whenever F, then G or eventually G; `[] (F -> <> G)`. It binds loosest."""

    left: Formula
    right: Formula


@dataclass(frozen=True, slots=True)
class PathQuantifier(Node):
    """`AG F`, `EF F`, `AX F`, `A (F U G)`, `E (F W G)`: on all runs from here, or on some; in `ctl` only."""

    quantifier: str
    operand: Formula


# --- steps


@dataclass(frozen=True, slots=True)
class Steps(Node):
    """`sense a`, `a`, `sense`, `agents`, `rules`, `requests`, `environment`.

    Steps by one rule of a bigActor, all its steps, those by a rule, those of the bigActors, those of the world.
    """

    words: tuple[Name, ...]


@dataclass(frozen=True, slots=True)
class Taken(Node):
    """`taken sense a`: the next step is one of these; in `ltl` only."""

    steps: Steps


@dataclass(frozen=True, slots=True)
class Enabled(Node):
    """`enabled sense a`: one of these steps is possible; in `ltl` and `ctl`."""

    steps: Steps


Formula: TypeAlias = (
    TruthLiteral
    | Negation
    | Connective
    | Quantified
    | Inside
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


@dataclass(frozen=True, slots=True)
class Fairness(Node):
    """`weak fairness of a, b`, `strong fairness of actuate`.

    Runs that never take these steps, though from some time on they always could (weak), or could again and again
    (strong), are left out. A rule, `agents`, `rules` and `requests` mean each bigActor, rule or request by itself.
    """

    strength: str
    steps: tuple[Steps, ...]


@dataclass(frozen=True, slots=True)
class TemporalProperty(Node):
    """`ltl "served": pending CTR a leads to not pending CTR a`, `ctl "home": AG EF uav0 in base0`.

    True of every run; true of the tree of all runs. `ltl "served" under weak fairness of agents: ...` looks at fair
    runs only.
    """

    logic: str
    label: TextLiteral
    formula: Formula
    fairness: tuple[Fairness, ...] = ()


@dataclass(frozen=True, slots=True)
class Progress(Node):
    """`progress`, `progress under strong fairness of actuate`.

    Every pending request is eventually served, under weak fairness of each rule and request, and what is added.
    Flights end only where the environment says that they arrive. `progress "served in time" under ...` has a name.
    """

    fairness: tuple[Fairness, ...] = ()
    label: TextLiteral | None = None
