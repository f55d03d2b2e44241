"""The possible types of variables' values, over-approximated from the text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from semantics.behaviours.expressions import (
    Apply,
    Either,
    Expression,
    Host,
    Literal,
    RouteOf,
    Self,
    SetOf,
    TupleOf,
    Variable,
)
from semantics.behaviours.observations import Observation
from semantics.behaviours.patterns import Anything, variables
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Assign, Call, ChooseFrom, ForEach, Match, React, Spawn, Statement
from semantics.behaviours.values import Route, Truth

Types = frozenset[type]

WORDS: Final[Mapping[type, str]] = {
    int: "numbers",
    str: "names and texts",
    Truth: "true and false",
    tuple: "tuples",
    frozenset: "sets",
    Route: "routes",
    Observation: "observations",
}
"""What values of each type are called."""

ANY: Final = Types(WORDS)
NONE: Final = Types()

_RESULTS: Final[Mapping[str, type]] = {
    **dict.fromkeys(("in", "==", "!=", "<", "<=", ">", ">=", "not", "empty", "linked"), Truth),
    **dict.fromkeys(("union", "nodes", "agents", "children"), frozenset),
    **dict.fromkeys(("kind", "parent", "[]"), str),
    "size": int,
}
"""What operators return that always return the same type."""


def types_of(program: Program) -> Mapping[str, Types]:
    """Return the types of the values that each variable may be given; a least fixpoint, since loops lead back."""
    known: dict[str, Types] = {}
    grown = True
    while grown:
        grown = False
        for statement in program.statements:
            for variable, types in _given(statement, program, known):
                before = known.get(variable, NONE)
                known[variable] = before | types
                grown = grown or known[variable] != before
    return known


def _given(statement: Statement, program: Program, known: Mapping[str, Types]) -> Iterator[tuple[str, Types]]:
    """Yield what a statement gives to variables."""
    match statement:
        case Assign(variable, expression):
            yield variable, _types(expression, known)
        case Call(behaviour, arguments) | Spawn(_, _, behaviour, arguments):
            called = program.behaviours.get(behaviour)
            parameters = () if called is None else called.parameters
            for parameter, argument in zip(parameters, arguments, strict=False):
                yield parameter, _types(argument, known)
        case ForEach(variable, _, _) | ChooseFrom(variable, _, _):
            yield variable, ANY
        case React(cases) | Match(_, cases):
            for case in cases:
                seen = isinstance(case.pattern, Anything) and case.pattern.of == "observation"
                types = Types({Observation}) if seen else ANY
                yield from ((variable, types) for variable in variables(case.pattern))


def _types(expression: Expression, known: Mapping[str, Types]) -> Types:
    match expression:
        case Literal(value):
            return Types({type(value)})
        case Variable(name):
            return known.get(name, NONE)
        case Host() | Self():
            return Types({str})
        case TupleOf():
            return Types({tuple})
        case SetOf():
            return Types({frozenset})
        case RouteOf():
            return Types({Route})
        case Either():
            return Types({Truth})
        case Apply(operator, _) if operator in _RESULTS:
            return Types({_RESULTS[operator]})
        case Apply("+" | "-" | "of" | "minus" | "intersect", (left, _)):
            return Types(each if each in (int, Route) else frozenset for each in _types(left, known))
    return ANY
