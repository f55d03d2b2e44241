"""Constant values in the text: messages from outside, and operands of properties."""

from __future__ import annotations

from collections.abc import Mapping

from semantics.behaviours.values import Route, Text, Truth, Value
from semantics.state.signature import NO_ENTITIES
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import shorten
from specs.elaboration.names import Names


def elaborate_constant(node: s.Expression, names: Names, bound: Mapping[str, Value] | None = None) -> Value:
    """Return the value of a constant; reports any other expression. `bound` has names that denote other values."""
    match node:
        case s.TextLiteral(text):
            return Text(text)
        case s.IntegerLiteral(number):
            return number
        case s.TruthLiteral(truth):
            return Truth.of(truth)
        case s.UnaryOperation("-", s.IntegerLiteral(number)):
            return -number
        case s.TupleLiteral(items):
            return tuple(elaborate_constant(item, names, bound) for item in items)
        case s.SetLiteral(items):
            return frozenset(elaborate_constant(item, names, bound) for item in items)
        case s.RouteLiteral(items):
            return Route(tuple(elaborate_constant(item, names, bound) for item in items))
        case s.Name(name):
            if bound and name in bound:
                return bound[name]
            if name not in names.agents and name not in NO_ENTITIES:
                names.entity(node, otherwise=f'a text stands in quotes: "{shorten(name)}"')
            return name
        case s.Member():
            return names.member(node.family, elaborate_constant(node.index, names, bound), node.index) or ""
        case _:
            hint = "write a text, a number, a name, true, false, or a tuple, set or route of these"
            names.findings.add(Code.NOT_CONSTANT, node, "this is not a fixed value", hint)
            return ""
