"""Formulas: what properties claim of one configuration, and with the operators of `temporal`, of runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from specs.syntax.expressions import Expression, TruthLiteral
from specs.syntax.nodes import Name, Node
from specs.syntax.temporal import Enabled, LeadsTo, PathOperation, PathPrefix, PathQuantifier, Taken


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
