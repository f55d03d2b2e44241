"""Dependence on the order of names: such a mission has no interchangeable names."""

from collections.abc import Iterator

from semantics.analysis.possible_messages import UNKNOWN, may_take
from semantics.analysis.traversal import bindings, expressions_of
from semantics.behaviours.expressions import Apply, Expression, Literal, RouteOf, Variable, subexpressions
from semantics.behaviours.patterns import variables
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Assign,
    Call,
    ChooseFrom,
    Display,
    For,
    React,
    Send,
    Spawn,
    Statement,
)
from semantics.environment import Says
from semantics.fixpoints import fixpoint
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler


def ordered(c: Configuration) -> str | None:
    """Return why the order of names may affect a mission's program; None if it can't."""
    program, environment = c.setting.program, c.setting.environment
    told = any(isinstance(each, Send) for each in program.statements)
    told |= any(isinstance(each, Says) for each in environment)
    unordered = c.setting.scheduler is Scheduler.UNORDERED
    routes = _routes(program)
    for number, statement in enumerate(program.statements):
        line = (
            f" (line {program.lines[number]})"
            if number < len(program.lines) and program.lines[number]
            else ""
        )
        if isinstance(statement, For) and not _is_route(statement.members, routes):
            return f"a 'for' goes through names in their order{line}"
        if isinstance(statement, ChooseFrom):
            return f"where one alternative of 'choose' fails, those after it in the order of names are lost{line}"
        if isinstance(statement, Display) and not isinstance(statement.value, Literal):
            return f"'display' prints names{line}"
        inner = (each for whole in expressions_of(statement) for each in subexpressions(whole))
        if any(isinstance(each, Apply) and each.operator == "first" for each in inner):
            return f"'first' takes names in their order{line}"
        if isinstance(statement, React):
            guarded = [case for case in statement.cases if case.guard is not None]
            if any(unordered or (told and may_take(case.pattern, UNKNOWN)) for case in guarded):
                return f"a guard is tried on messages in the order of names, and may fail{line}"
    return None


def _routes(program: Program) -> frozenset[str]:
    """Return the variables that always hold a route; a greatest fixpoint because of loops."""
    given = [each for statement in program.statements for each in _given(statement, program)]

    def shrink(routes: frozenset[str]) -> frozenset[str]:
        return routes.difference(
            variable for variable, value in given if value is None or not _is_route(value, routes)
        )

    return fixpoint(shrink, frozenset(variable for variable, _ in given))


def _given(statement: Statement, program: Program) -> Iterator[tuple[str, Expression | None]]:
    """Yield the variables that a statement binds, each with its expression, None for a value unknown from the text."""
    is_known = isinstance(statement, Assign | Call | Spawn)
    for each in bindings(program, statement):
        yield from ((variable, each.expression if is_known else None) for variable in variables(each.pattern))


def _is_route(value: Expression, routes: frozenset[str]) -> bool:
    """Return whether an expression is a route, whose order is written in the text, if these variables are routes."""
    match value:
        case RouteOf():
            return True
        case Variable(name):
            return name in routes
        case Apply("+" | "-" | "minus" | "intersect" | "of", (first, *_)):
            return _is_route(first, routes)
    return False
