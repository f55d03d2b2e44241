"""The traversal of a program's text: the statements that code may reach, and the variables that statements bind."""

from collections.abc import Iterator
from enum import Enum, auto
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

from semantics.behaviours.expressions import Expression, Variable
from semantics.behaviours.patterns import Anything, Pattern
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Assign,
    Block,
    Call,
    ChooseFrom,
    For,
    ForEach,
    Match,
    React,
    Spawn,
    Statement,
    inner_blocks,
    operands,
)
from semantics.fixpoints import closure


def blocks(program: Program, statement: Statement) -> tuple[Block, ...]:
    """Return the blocks inside a statement, or the body of the behaviour that it calls."""
    if isinstance(statement, Call):
        return (program.behaviours[statement.behaviour].body,)
    return tuple(each.block for each in inner_blocks(statement))


@lru_cache(maxsize=1 << 12)
def reachable(program: Program, code: Block) -> frozenset[int]:
    """Return the statements that code may reach, without those of the agents it spawns."""
    return frozenset[int]().union(*(_within(program, number) for number in code))


@lru_cache(maxsize=1 << 12)
def _within(program: Program, first: int) -> frozenset[int]:
    """Return the statements that a statement may reach, itself included."""
    statements = program.statements
    return closure([first], lambda number: chain.from_iterable(blocks(program, statements[number])))


def expressions_of(statement: Statement) -> tuple[Expression, ...]:
    """Return the expressions whose value decides a step, or is kept, sent or used."""
    guards = (each.guard for each in inner_blocks(statement) if each.guard is not None)
    return (*operands(statement), *guards)


class Origin(Enum):
    """The origin of a bound value: an expression's value, all its members in a list, one of them, or a receipt."""

    VALUE = auto()
    MEMBERS = auto()
    MEMBER = auto()
    RECEIVED = auto()


class BoundPattern(NamedTuple):
    """A pattern whose variables a statement binds, with the origin of the matched value.

    Attributes:
        expression: The expression of the origin; None for a received value.
    """

    pattern: Pattern
    origin: Origin
    expression: Expression | None = None


def bindings(program: Program, statement: Statement) -> Iterator[BoundPattern]:
    """Yield the variables that a statement binds; a call and a spawn bind the parameters of their behaviour."""
    match statement:
        case Assign(variable, value):
            yield BoundPattern(Anything(variable), Origin.VALUE, value)
        case For(members, rest):
            yield BoundPattern(Anything(rest), Origin.MEMBERS, members)
        case ForEach(variable, rest):
            yield BoundPattern(Anything(variable), Origin.MEMBER, Variable(rest))
        case ChooseFrom(variable, members):
            yield BoundPattern(Anything(variable), Origin.MEMBER, members)
        case Match(value, cases):
            yield from (BoundPattern(case.pattern, Origin.VALUE, value) for case in cases)
        case React(cases):
            yield from (BoundPattern(case.pattern, Origin.RECEIVED) for case in cases)
        case Call(behaviour, arguments) | Spawn(_, _, behaviour, arguments) if (
            behaviour in program.behaviours
        ):
            parameters = program.behaviours[behaviour].parameters  # a wrong number of arguments is reported
            for parameter, argument in zip(parameters, arguments, strict=False):
                yield BoundPattern(Anything(parameter), Origin.VALUE, argument)
