"""Patterns of `react` and `match`."""

from __future__ import annotations

from collections.abc import Callable

from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.constants import elaborate_constant
from specs.elaboration.names import Names
from specs.elaboration.scopes import Scope

Bind = Callable[[s.Name], str]
"""Gives a variable of a pattern its unique name."""


def elaborate_pattern(node: s.Pattern, names: Names, scope: Scope, bind: Bind, *, react: bool) -> Pattern:
    """Return a pattern; in a `react`, a variable that is the whole of it takes an observation."""
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
            for item in items:  # a loop, since a comprehension would cost a frame at each depth
                found.append(elaborate_pattern(item, names, scope, bind, react=False))  # noqa: PERF401
            return Elements(tuple(found))


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
