"""Reactive systems as values: a signature, a first state, rules in priority classes, and predicates.

This is what a `.big` or a `.bgm` file means once it has been read: every parameter has a value, every
expression is a bigraph. Nothing here knows how a system is run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.errors import NotationError
from bigraphs.properties import Property
from bigraphs.rules import ReactionRule
from bigraphs.signature import Signature
from bigraphs.sorting import UNSORTED, Sorting

Value: TypeAlias = int | float | str


class SystemKind(Enum):
    """What the weights of rules mean."""

    BRS = "brs"
    """Nothing: rules have no weights."""
    PBRS = "pbrs"
    """Weights: the probability of a step is its share of all that can happen in its class (a Markov chain)."""
    SBRS = "sbrs"
    """Rates of exponentially distributed delays (a continuous-time Markov chain); infinite if instantaneous."""
    NBRS = "nbrs"
    """Weights within an action; which action is taken is a choice (a Markov decision process)."""


class Where(Enum):
    """The part of a state, around an occurrence of a redex, that a condition looks at."""

    CONTEXT = "ctx"
    PARAM = "param"


@dataclass(frozen=True, slots=True)
class Position:
    """A place in a source text, lines and columns from 1."""

    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Condition:
    """What must (or, if not `positive`, must not) occur in the context or in the parameter of a match."""

    positive: bool
    pattern: Bigraph
    where: Where


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule of a system, its parameters given.

    Site `i` of the reactum holds what site `instantiation[i]` of the redex held. `weight` is a weight or a
    rate, None in a BRS; infinity is a rate of an instantaneous rule. `action` names the action that it is part
    of, in an NBRS only, and `reward` is that action's. An outer name of the redex stands for any link, but one
    of `link_constants` (BigMC's declared names) for the link of that name.
    """

    name: str
    redex: Bigraph
    reactum: Bigraph
    instantiation: tuple[int, ...]
    weight: float | None = None
    action: str | None = None
    reward: int | float = 0
    conditions: tuple[Condition, ...] = ()
    parameters: tuple[Value, ...] = ()
    link_constants: frozenset[str] = frozenset()
    position: Position | None = field(default=None, compare=False)

    @property
    def label(self) -> str:
        """Return the name with its parameters, `move(1,"a")`: distinct within a system."""
        return call(self.name, self.parameters)

    def reaction(self) -> ReactionRule:
        """Return the bare reaction rule, for `bigraphs.matching` and `bigraphs.rewriting`."""
        return ReactionRule(
            self.redex,
            self.reactum,
            self.instantiation,
            self.label,
            link_constants=self.link_constants,
        )


@dataclass(frozen=True, slots=True)
class PriorityClass:
    """Rules of one priority; those of an instantaneous class fire without a state between, the first that can first."""

    rules: tuple[Rule, ...]
    instantaneous: bool = False
    position: Position | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Predicate:
    """A pattern that states are labelled with where it occurs, and the reward of being in such a state."""

    name: str
    pattern: Bigraph
    reward: int | float | None = None
    parameters: tuple[Value, ...] = ()
    position: Position | None = field(default=None, compare=False)

    @property
    def label(self) -> str:
        """Return the name with its parameters."""
        return call(self.name, self.parameters)


@dataclass(frozen=True, slots=True)
class Action:
    """A choice of an NBRS, with the reward for taking it."""

    name: str
    reward: int | float = 0


@dataclass(frozen=True, slots=True)
class System:
    """A reactive system; `classes` come from the highest priority down, `initial` is ground.

    Rules keep every state sorted by `sorting`, and `properties` (BigMC's) are to hold in every state.
    """

    kind: SystemKind
    signature: Signature
    initial: Bigraph
    classes: tuple[PriorityClass, ...] = ()
    predicates: tuple[Predicate, ...] = ()
    actions: tuple[Action, ...] = ()
    properties: tuple[Property, ...] = ()
    sorting: Sorting = UNSORTED
    warnings: tuple[NotationError, ...] = field(default=(), compare=False, repr=False)
    """What its text has wrong, where it does not matter."""

    def rules(self) -> Iterator[Rule]:
        """Yield every rule, from the highest priority down."""
        return (rule for each in self.classes for rule in each.rules)


def call(name: str, parameters: tuple[Value, ...]) -> str:
    """Write a name with its parameters.

    >>> call("move", (1, 2.0, "a"))
    'move(1,2.0,"a")'
    """
    return f"{name}({','.join(map(_written, parameters))})" if parameters else name


def _written(value: Value) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)
