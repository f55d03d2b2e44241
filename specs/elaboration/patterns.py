"""Patterns of `react` and `match`."""

from __future__ import annotations

from collections.abc import Callable

from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.constant_values import elaborate_constant
from specs.elaboration.names import Names
from specs.elaboration.scopes import Scope

Bind = Callable[[s.Name], str]
"""A function from a variable of a pattern to its unique name."""


def elaborate_pattern(node: s.Pattern, names: Names, scope: Scope, bind: Bind, *, react: bool) -> Pattern:
    """Return a pattern; in a `react`, a pattern that is only a variable accepts observations."""
    match node:
        case s.ObservationPattern(variable):
            return Anything(None if variable is None else bind(variable), "observation")
        case s.MessagePattern(variable):
            return Anything(None if variable is None else bind(variable), "message")
        case s.VariablePattern(variable):
            return Anything(bind(variable), "observation" if react else None)
        case s.Wildcard():
            return Anything()
        case s.LiteralPattern(value):
            return Exactly(elaborate_constant(value, names))
        case s.ConstantPattern(name) if scope.find(name.text) is not None:
            hint = f"take the value, and compare it in a guard: case x if x == {name.text} => ..."
            message = f"'{name.text}' is a variable, and a pattern compares with fixed names"
            names.findings.add(Code.NOT_CONSTANT, node, message, hint)
            return Anything()
        case s.ConstantPattern(name):
            return Exactly(elaborate_constant(name, names, scope.fixed))
        case s.TuplePattern(items):
            found = []
            for item in items:  # a loop: a comprehension would add a stack frame at each depth
                found.append(elaborate_pattern(item, names, scope, bind, react=False))  # noqa: PERF401
            return Elements(tuple(found))


def note_hiding(node: s.Pattern, names: Names) -> None:
    """Record the variables of a pattern with the name of an entity or a bigActor."""
    for part in s.walk(node):
        if isinstance(part, s.VariablePattern) and (
            part.variable.text in names.kinds or part.variable.text in names.agents
        ):
            places = names.hiding.setdefault(part.variable.text, [])
            if part.span not in places:  # a family's text is read once for each member
                places.append(part.span)


def warn_of_hiding(names: Names) -> None:
    """Warn once of each entity or bigActor that patterns hide."""
    for name, places in names.hiding.items():
        meant = "entity" if name in names.kinds else "bigActor"
        more = len(places) - 1
        also = f" and in {more} more {'pattern' if more == 1 else 'patterns'}" if more else ""
        hint = f"write ={name} to compare with the {meant}, or give the variable another name"
        message = f"'{name}' takes any value here{also}, and hides the {meant} '{name}'"
        names.findings.warn(Code.HIDES_AN_ENTITY, min(places, key=lambda span: span.start), message, hint)


def check_distinct(node: s.Pattern, names: Names) -> None:
    """Report a variable that a pattern binds twice."""
    seen: set[str] = set()
    for part in s.walk(node):
        if isinstance(part, s.VariablePattern):
            if part.variable.text in seen:
                hint = "rename one of the two and compare them in a guard"
                names.findings.add(
                    Code.DUPLICATE_NAME, part, f"the pattern binds '{part.variable.text}' twice", hint
                )
            seen.add(part.variable.text)
