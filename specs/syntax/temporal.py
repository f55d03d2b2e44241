"""What is claimed of runs: the operators of temporal logic, steps, fairness, and the properties made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from specs.syntax.expressions import TextLiteral
from specs.syntax.nodes import Name, Node

if TYPE_CHECKING:
    from specs.syntax.formulas import Formula

SIGNS = {"G": "[]", "F": "<>", "X": "X"}
"""The signs of the operators that letters stand for."""

# --- operators


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
