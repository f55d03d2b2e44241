"""Static messages: the possible messages, and the `react` statements that may take them."""

from collections.abc import Callable
from dataclasses import dataclass

from semantics.behaviours.expressions import Expression, Literal, TupleOf
from semantics.behaviours.observations import Observation
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern, bind
from semantics.behaviours.program import Program
from semantics.behaviours.statements import React
from semantics.behaviours.values import Value


@dataclass(frozen=True, slots=True)
class ConstantMessage:
    """A message with a constant value."""

    value: Value


@dataclass(frozen=True, slots=True)
class Tuple:
    """A message that is a tuple of this length."""

    parts: tuple["Message", ...]


@dataclass(frozen=True, slots=True)
class Unknown:
    """A message about which nothing is known statically."""


Message = ConstantMessage | Tuple | Unknown


def message_of(expression: Expression) -> Message:
    """Return the static knowledge about a message."""
    match expression:
        case Literal(value):
            return ConstantMessage(value)
        case TupleOf(items):
            return Tuple(tuple(map(message_of, items)))
        case _:
            return Unknown()


def may_take(pattern: Pattern, message: Message) -> bool:
    """Return whether a pattern may take a message."""
    match message:
        case ConstantMessage(value):
            return bind(pattern, value) is not None
        case Unknown():
            return True
        case Tuple(parts):
            return _may_take_tuple(pattern, parts)


def _may_take_tuple(pattern: Pattern, parts: tuple[Message, ...]) -> bool:
    match pattern:
        case Anything(_, of):
            return of != "observation"
        case Exactly(value):
            return isinstance(value, tuple) and not isinstance(value, Observation)
        case Elements(items):
            return len(items) == len(parts) and all(map(may_take, items, parts))


def wakes(program: Program) -> Callable[[Message], tuple[int, ...]]:
    """Return the function from a message to the numbers of the `react` statements that may take it."""
    reacts = [(number, each) for number, each in enumerate(program.statements) if isinstance(each, React)]

    def woken(message: Message) -> tuple[int, ...]:
        return tuple(
            number for number, react in reacts if any(may_take(case.pattern, message) for case in react.cases)
        )

    return woken
