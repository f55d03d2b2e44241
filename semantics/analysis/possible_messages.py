"""Possible messages: the `react` statements that may take a message, as far as its expression shows."""

from collections.abc import Callable
from typing import Final

from semantics.behaviours.expressions import Expression, Literal, TupleOf, Variable
from semantics.behaviours.observations import Observation
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern, bind
from semantics.behaviours.program import Program
from semantics.behaviours.statements import React

UNKNOWN: Final = Variable("")
"""The expression of a message about which nothing is known."""


def may_take(pattern: Pattern, message: Expression) -> bool:
    """Return whether a pattern may take a message; the values of variables and operators are unknown."""
    match pattern, message:
        case _, Literal(value):
            return bind(pattern, value) is not None
        case Anything(_, of), TupleOf():
            return of != "observation"
        case Exactly(value), TupleOf():
            return isinstance(value, tuple) and not isinstance(value, Observation)
        case Elements(items), TupleOf(parts):
            return len(items) == len(parts) and all(map(may_take, items, parts))
        case _:
            return True


def wakes(program: Program) -> Callable[[Expression], tuple[int, ...]]:
    """Return the function from a message to the numbers of the `react` statements that may take it."""
    reacts = [(number, each) for number, each in enumerate(program.statements) if isinstance(each, React)]

    def woken(message: Expression) -> tuple[int, ...]:
        return tuple(
            number for number, react in reacts if any(may_take(case.pattern, message) for case in react.cases)
        )

    return woken
