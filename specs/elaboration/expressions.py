"""Elaborate expressions and queries: resolve names to variables, nodes and bigActors."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Final

from semantics.behaviours.expressions import (
    OPERATORS,
    Apply,
    Either,
    Expression,
    Fault,
    Host,
    Literal,
    QueryOf,
    RouteOf,
    Self,
    SetOf,
    TupleOf,
    Variable,
    evaluate,
    leaves,
)
from semantics.behaviours.expressions import Scope as EvaluationScope
from semantics.behaviours.observations import QueryOperator
from semantics.behaviours.values import Truth
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.findings import Findings
from specs.elaboration.names import Names
from specs.elaboration.scopes import Scope

FUNCTIONS: Final = tuple(
    sorted(name for name in OPERATORS if name.isidentifier() and name not in {"in", "of", "not"})
)
"""What can be called in an expression."""

_COLLECTIONS: Final[Mapping[type, type[TupleOf | SetOf | RouteOf]]] = {
    s.TupleLiteral: TupleOf,
    s.SetLiteral: SetOf,
    s.RouteLiteral: RouteOf,
}

_ANY: Final = Literal("")
"""Stands for an expression with a mistake; the mission is refused."""


def elaborate_expression(node: s.Expression, scope: Scope, names: Names) -> Expression:
    """Return an expression with its names resolved; reports unknown names."""
    match node:
        case s.Name():
            return _name(node, scope, names)
        case s.Member():
            return _member(node, scope, names)
        case s.TextLiteral(value) | s.IntegerLiteral(value):
            return Literal(value)
        case s.TruthLiteral(value):
            return Literal(Truth.of(value))
        case s.HostReference():
            return Host()
        case s.SelfReference():
            return Self()
        case s.TupleLiteral(items) | s.SetLiteral(items) | s.RouteLiteral(items):
            return _COLLECTIONS[type(node)](_all(items, scope, names))
        case s.UnaryOperation():
            return _unary(node, scope, names)
        case s.BinaryOperation():
            return _binary(node, scope, names)
        case s.OfKind(operand, kind):
            names.kind(kind)
            return Apply("of", (elaborate_expression(operand, scope, names), Literal(kind.text)))
        case s.FunctionCall():
            return _call(node, scope, names)


def _all(items: tuple[s.Expression, ...], scope: Scope, names: Names) -> tuple[Expression, ...]:
    found = []
    for item in items:  # a loop, since a comprehension would cost a frame at each depth
        found.append(elaborate_expression(item, scope, names))  # noqa: PERF401
    return tuple(found)


def _unary(node: s.UnaryOperation, scope: Scope, names: Names) -> Expression:
    if node.operator == "-" and isinstance(node.operand, s.IntegerLiteral):
        return Literal(-node.operand.value)
    operand = elaborate_expression(node.operand, scope, names)
    return Apply("-", (Literal(0), operand)) if node.operator == "-" else Apply("not", (operand,))


def _binary(node: s.BinaryOperation, scope: Scope, names: Names) -> Expression:
    left = elaborate_expression(node.left, scope, names)
    right = elaborate_expression(node.right, scope, names)
    if node.operator in ("and", "or"):
        return Either(node.operator == "or", left, right)
    if node.operator == "not in":
        return Apply("not", (Apply("in", (left, right)),))
    return Apply(node.operator, (left, right))


def _call(node: s.FunctionCall, scope: Scope, names: Names) -> Expression:
    arguments = _all(node.arguments, scope, names)
    name = node.function.text
    if name not in FUNCTIONS:
        other = names.sort_of(name)
        otherwise = (
            f"it is a {other}, and no function" if other else f"the functions are {', '.join(FUNCTIONS)}"
        )
        names.findings.unknown(node.function, FUNCTIONS, sort="function", otherwise=otherwise)
        return _ANY
    check_arity(node.function, len(arguments), OPERATORS[name].arity, names.findings)
    return Apply(name, arguments)


def check_arity(name: s.Name, given: int, wanted: int, findings: Findings) -> bool:
    """Tell whether as many arguments are given as there are parameters; reports it if not."""
    if given == wanted:
        return True
    plural = "argument" if wanted == 1 else "arguments"
    message = f"'{name.text}' takes {wanted or 'no'} {plural}, and is given {given or 'none'}"
    findings.add(Code.WRONG_ARITY, name, message, "give it one for each parameter")
    return False


def _name(node: s.Name, scope: Scope, names: Names) -> Expression:
    variable = scope.find(node.text)
    if variable is not None:
        return Variable(variable)
    if node.text in scope.constants:
        return Literal(scope.constants[node.text])
    if node.text in names.kinds or node.text in names.agents:
        return Literal(node.text)
    sort = names.sort_of(node.text)
    if sort is None:
        names.findings.unknown(node, [*scope.names(), *names.kinds, *names.agents])
    else:
        family = names.families.get(node.text, {})
        hint = (
            f"name a member: {next(iter(family.values()))}"
            if family
            else f'as a text it is written "{node.text}"'
        )
        names.findings.add(Code.WRONG_SORT, node, f"'{node.text}' is a {sort}, which is no value", hint)
    return _ANY


def _member(node: s.Member, scope: Scope, names: Names) -> Expression:
    """Return the name of a member, or what looks it up by its entity where a run decides which one is meant.

    Of a variable it is an element.
    """
    index, variable = elaborate_expression(node.index, scope, names), scope.find(node.family.text)
    if variable is not None:
        return Apply("element", (Variable(variable), index))
    if index is _ANY:
        return _ANY
    if isinstance(index, Literal):
        return Literal(names.member(node.family, index.value, node.index) or "")
    members = names.family(node.family) or {}
    if all(
        isinstance(leaf, Literal) for leaf in leaves(index)
    ):  # such as i + 1, and in range where it is reached
        with suppress(Fault):
            number = evaluate(index, EvaluationScope("", "", {}, {}, names.kinds, {}))
            if isinstance(number, int) and 0 <= number < len(members):
                return Literal(tuple(members.values())[number])
    return Apply("[]", (Literal(frozenset(members.items())), index))


# --- what must be a node or a bigActor ------------------------------------------------------------------------


def elaborate_node(node: s.Expression, scope: Scope, names: Names) -> Expression:
    """Return an expression that is to be a node; reports what certainly is none."""
    return _named(node, scope, names, "node")


def elaborate_agent(node: s.Expression, scope: Scope, names: Names) -> Expression:
    """Return an expression that is to be a bigActor; reports what certainly is none."""
    return _named(node, scope, names, "bigActor")


def _named(node: s.Expression, scope: Scope, names: Names, wanted: str) -> Expression:
    """Elaborate what is to name a node or a bigActor; a constant that doesn't is reported."""
    known = names.kinds if wanted == "node" else names.agents
    other = s.SelfReference if wanted == "node" else s.HostReference
    hint = "write its name, or a variable that holds it"
    if isinstance(node, s.Name) and node.text in scope.fixed:
        value = scope.fixed[node.text]
        if value not in known:
            what = "a number" if isinstance(value, int) else "an entity"
            message = f"a {wanted} is expected here, and '{node.text}' is {what}"
            names.findings.add(Code.WRONG_VALUE, node, message, hint)
        return Literal(value)
    if isinstance(node, s.Name) and scope.find(node.text) is None:
        sort = names.sort_of(node.text)
        if sort is None:
            names.findings.unknown(node, [*scope.names(), *known])
        elif wanted == "node":
            names.entity(node)
        else:
            names.agent(node)
        return Literal(node.text)
    if isinstance(node, s.TextLiteral) and node.value not in known:
        message = f"a {wanted} is expected here, and a text that names none is given"
        names.findings.add(Code.WRONG_VALUE, node, message, names.findings.suggest(node.value, known))
    elif isinstance(node, _NAMELESS | other) or (wanted == "node" and _is_member(node, scope)):
        names.findings.add(Code.WRONG_VALUE, node, f"a {wanted} is expected here", hint)
    return elaborate_expression(node, scope, names)


_NAMELESS: Final = s.IntegerLiteral | s.TruthLiteral | s.TupleLiteral | s.SetLiteral | s.RouteLiteral


def _is_member(node: s.Expression, scope: Scope) -> bool:
    return isinstance(node, s.Member) and scope.find(node.family.text) is None


# --- queries --------------------------------------------------------------------------------------------------


def elaborate_query(query: s.Query, scope: Scope, names: Names, *, inside: bool = False) -> QueryOf:
    """Return a query; reports one that follows relations of bigActors, which have none."""
    match query:
        case s.AllNodes():
            return QueryOf(None, None)
        case s.HostReference():
            return QueryOf(None, Host())
        case s.Name():
            return QueryOf(None, elaborate_node(query, scope, names))
        case s.QueryApplication(relation, argument):
            if inside and relation == QueryOperator.HOSTED_AT:
                hint = "bigActors have no parents, children or links: write HOSTED_AT outermost"
                names.findings.add(
                    Code.WRONG_QUERY, query, "HOSTED_AT gives bigActors, and these are asked further", hint
                )
            found = elaborate_query(argument, scope, names, inside=True)
            leaf = found.operator is None and found.argument is not None
            return QueryOf(relation, found.argument if leaf else found)
