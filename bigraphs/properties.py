"""Properties of states, as in BigMC: patterns, sizes, predecessors and successors."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Final, TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.canonical_form import equal
from bigraphs.matching import find_matches
from bigraphs.records import Record


class Matches(Record):
    """The pattern occurs; its names match any link, except `link_constants`, which match the link of the same name."""

    pattern: Bigraph
    link_constants: frozenset[str] = frozenset()


class Equal(Record):
    """The state equals `state`."""

    state: Bigraph


class TerminalState(Record):
    """No rule applies."""


class Not(Record):
    """The negation of `operand`."""

    operand: Formula


class Both(Record):
    """Both operands hold."""

    left: Formula
    right: Formula


class Either(Record):
    """At least one operand holds."""

    left: Formula
    right: Formula


class IfElse(Record):
    """`then` holds if `condition` holds, else `otherwise` holds."""

    condition: Formula
    then: Formula
    otherwise: Formula


class StateScope(Enum):
    """The states that a formula refers to."""

    THIS = "this"
    PREDECESSOR = "pred"
    """Every predecessor; true of a state without predecessors."""
    SUCCESSOR = "succ"
    """Every successor."""
    TERMINAL = "terminal"
    """This state, if no rule applies; true of any other state."""


class Scoped(Record):
    """The operand holds in every state of the scope; predecessors and successors support only patterns and sizes."""

    scope: StateScope
    operand: Formula


class Size(Record):
    """The number of nodes of each state in a scope."""

    scope: StateScope = StateScope.THIS


class Compare(Record):
    """A comparison (`==`, `!=`, `<`, `<=`, `>`, `>=`) of node counts, for all states in the scopes."""

    symbol: str
    left: Size | int
    right: Size | int


Formula: TypeAlias = Matches | Equal | TerminalState | Not | Both | Either | IfElse | Scoped | Compare


class SystemProperty(Record):
    """A formula that must hold in every reachable state."""

    name: str
    formula: Formula


class StateContext(Record):
    """A state with its predecessors and successors."""

    state: Bigraph
    predecessors: tuple[Bigraph, ...] = ()
    successors: tuple[Bigraph, ...] = ()


_COMPARISONS: Final[Mapping[str, Callable[[int, int], bool]]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def holds(formula: Formula, here: StateContext) -> bool:
    """Return whether a formula holds in a situation."""
    match formula:
        case Matches(pattern, constants):
            return any(True for _ in find_matches(pattern, here.state, link_constants=constants))
        case Equal(state):
            return equal(state, here.state)
        case TerminalState():
            return not here.successors
        case Not(operand):
            return not holds(operand, here)
        case Both(left, right):
            return holds(left, here) and holds(right, here)
        case Either(left, right):
            return holds(left, here) or holds(right, here)
        case IfElse(condition, then, otherwise):
            return holds(then if holds(condition, here) else otherwise, here)
        case Scoped(StateScope.THIS | StateScope.TERMINAL as scope, operand):
            return not _states(scope, here) or holds(operand, here)
        case Scoped(scope, operand):
            return all(holds(operand, StateContext(state)) for state in _states(scope, here))
        case Compare(symbol, left, right):
            compare = _COMPARISONS[symbol]
            return all(compare(one, other) for one in _sizes(left, here) for other in _sizes(right, here))


def _states(scope: StateScope, here: StateContext) -> tuple[Bigraph, ...]:
    return {
        StateScope.THIS: (here.state,),
        StateScope.PREDECESSOR: here.predecessors,
        StateScope.SUCCESSOR: here.successors,
        StateScope.TERMINAL: () if here.successors else (here.state,),
    }[scope]


def _sizes(size: Size | int, here: StateContext) -> Iterable[int]:
    if isinstance(size, int):
        return (size,)
    return [len(state.nodes) for state in _states(size.scope, here)]
