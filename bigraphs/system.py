"""Reactive systems as values: a signature, an initial state, rules in priority classes, and predicates.

A system is the meaning of a `.big` or `.bgm` file: all parameters have values and all expressions are bigraphs. This
module does not depend on the engine.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.errors import NotationError
from bigraphs.properties import SystemProperty
from bigraphs.rules import ReactionRule
from bigraphs.signature import Signature
from bigraphs.sorting import UNSORTED, Sorting

Value: TypeAlias = int | float | str


class SystemKind(Enum):
    """The meaning of the rules' weights."""

    BRS = "brs"
    """No weights."""
    PBRS = "pbrs"
    """Weights: the probability of a step is its share of the total weight in its class (a Markov chain)."""
    SBRS = "sbrs"
    """Rates of exponential delays (a continuous-time Markov chain); infinite for an instantaneous rule."""
    NBRS = "nbrs"
    """Weights within an action; the choice of the action is nondeterministic (a Markov decision process)."""


class Where(Enum):
    """The part of a state that a condition inspects, relative to an occurrence of a redex."""

    CONTEXT = "ctx"
    PARAM = "param"


@dataclass(frozen=True, slots=True)
class SourcePosition:
    """A position in a source text: line and column, from 1."""

    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Condition:
    """A pattern that must occur in the context or the parameter of a match, or must not if not `positive`."""

    positive: bool
    pattern: Bigraph
    where: Where


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule of a system, with the values of its parameters.

    Site `i` of the reactum receives the content of site `instantiation[i]` of the redex. `weight` is a weight or a
    rate; None in a BRS, infinity for an instantaneous rule. In an NBRS, `action` names the rule's action and `reward`
    is the reward of that action. An outer name of the redex matches any link; a name in `link_constants` (a declared
    name of BigMC) matches only the link of that name.
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
    position: SourcePosition | None = field(default=None, compare=False)

    @property
    def label(self) -> str:
        """Return the name with its parameters, `move(1,"a")`; labels are distinct within a system."""
        return call(self.name, self.parameters)

    def reaction(self) -> ReactionRule:
        """Return the reaction rule without weight and conditions, for `bigraphs.matching` and `bigraphs.rewriting`."""
        return ReactionRule(
            self.redex,
            self.reactum,
            self.instantiation,
            self.label,
            link_constants=self.link_constants,
        )


@dataclass(frozen=True, slots=True)
class PriorityClass:
    """Rules of one priority.

    The first applicable rule of an instantaneous class fires at once, without an intermediate state.
    """

    rules: tuple[Rule, ...]
    instantaneous: bool = False
    position: SourcePosition | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Predicate:
    """A pattern that labels the states in which it occurs, with the reward of such a state."""

    name: str
    pattern: Bigraph
    reward: int | float | None = None
    parameters: tuple[Value, ...] = ()
    position: SourcePosition | None = field(default=None, compare=False)

    @property
    def label(self) -> str:
        """Return the name with its parameters."""
        return call(self.name, self.parameters)


@dataclass(frozen=True, slots=True)
class Action:
    """An action of an NBRS, with its reward."""

    name: str
    reward: int | float = 0


@dataclass(frozen=True, slots=True)
class System:
    """A reactive system; `classes` are sorted from the highest priority down, `initial` is ground.

    Rules keep every state sorted by `sorting`. `properties` (BigMC's) must hold in every state.
    """

    kind: SystemKind
    signature: Signature
    initial: Bigraph
    classes: tuple[PriorityClass, ...] = ()
    predicates: tuple[Predicate, ...] = ()
    actions: tuple[Action, ...] = ()
    properties: tuple[SystemProperty, ...] = ()
    sorting: Sorting = UNSORTED
    warnings: tuple[NotationError, ...] = field(default=(), compare=False, repr=False)
    """The harmless mistakes in the source text."""

    def rules(self) -> Iterator[Rule]:
        """Yield every rule, from the highest priority down."""
        return (rule for each in self.classes for rule in each.rules)


def call(name: str, parameters: tuple[Value, ...]) -> str:
    """Return a name with its parameters as text.

    >>> call("move", (1, 2.0, "a"))
    'move(1,2.0,"a")'
    """
    return f"{name}({','.join(map(_written, parameters))})" if parameters else name


def _written(value: Value) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)
