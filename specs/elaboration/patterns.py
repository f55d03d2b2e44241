"""Patterns of `react` and `match`."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern
from semantics.behaviours.values import Value
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.constants import elaborate_constant
from specs.elaboration.names import Names

Bind = Callable[[s.Name], str]
"""Gives a variable of a pattern its unique name."""


def elaborate_pattern(
    node: s.Pattern, names: Names, bind: Bind, constants: Mapping[str, Value], *, react: bool
) -> Pattern:
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
        case s.ConstantPattern(name):
            return Exactly(elaborate_constant(name, names, constants))
        case s.TuplePattern(items):
            found = []
            for item in items:  # a loop, since a comprehension would cost a frame at each depth
                found.append(elaborate_pattern(item, names, bind, constants, react=False))  # noqa: PERF401
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
