"""Elaboration of expressions and queries: names are resolved to variables, nodes and bigActors."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Final

from bigraphs.notation.spelling import listed
from semantics.behaviours.expressions import (
    OPERATORS,
    Apply,
    EvaluationScope,
    Expression,
    Fault,
    Host,
    Literal,
    QueryOf,
    RouteOf,
    Self,
    SetOf,
    ShortCircuit,
    TupleOf,
    Variable,
    evaluate,
    leaves,
)
from semantics.behaviours.observations import QueryOperator
from semantics.behaviours.values import Text, Truth
from semantics.state.signature import NO_ENTITIES
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.names import Names
from specs.elaboration.scopes import Scope
from specs.elaboration.type_constraints import (
    AGENT,
    COLLECTION,
    CONDITION,
    MEMBER,
    NODE,
    NODES,
    NUMBER,
    Need,
    operands,
    unquoted,
)
from specs.elaboration.value_types import MISTAKEN
from specs.grammar import QUERY_WORDS

_WORDS: Final = ("HOST", "SELF", "true", "false")
FUNCTIONS: Final = tuple(
    sorted(name for name in OPERATORS if name.isidentifier() and name not in {"in", "of", "not"})
)
"""The functions of the language."""

_COLLECTIONS: Final[Mapping[type, type[TupleOf | SetOf | RouteOf]]] = {
    s.TupleLiteral: TupleOf,
    s.SetLiteral: SetOf,
    s.RouteLiteral: RouteOf,
}


def elaborate_expression(node: s.Expression, scope: Scope, names: Names) -> Expression:
    """Return an expression with its names resolved; reports unknown names."""
    match node:
        case s.Name():
            return _name(node, scope, names)
        case s.Member():
            return _member(node, scope, names)
        case s.TextLiteral(value):
            return Literal(Text(value))
        case s.IntegerLiteral(value):
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
            members = elaborate_expression(operand, scope, names)
            return Apply("of", (names.need(operand, members, COLLECTION, "'of'"), Literal(kind.text)))
        case s.FunctionCall():
            return _call(node, scope, names)


def _all(items: tuple[s.Expression, ...], scope: Scope, names: Names) -> tuple[Expression, ...]:
    found = []
    for item in items:  # a loop: a comprehension would add a stack frame at each depth
        found.append(elaborate_expression(item, scope, names))  # noqa: PERF401
    return tuple(found)


def _unary(node: s.UnaryOperation, scope: Scope, names: Names) -> Expression:
    if node.operator == "-" and isinstance(node.operand, s.IntegerLiteral):
        return Literal(-node.operand.value)
    operand = elaborate_expression(node.operand, scope, names)
    if node.operator == "-":
        return Apply("-", (Literal(0), names.need(node.operand, operand, NUMBER, "'-'")))
    return Apply("not", (names.need(node.operand, operand, CONDITION, "'not'"),))


def _binary(node: s.BinaryOperation, scope: Scope, names: Names) -> Expression:
    left = elaborate_expression(node.left, scope, names)
    right = elaborate_expression(node.right, scope, names)
    if node.operator in ("and", "or"):
        names.need(node.left, left, CONDITION, f"'{node.operator}'")
        names.need(node.right, right, CONDITION, f"'{node.operator}'")
        return ShortCircuit(node.operator == "or", left, right)
    operator = node.operator.removeprefix("not ")
    names.demands += operands(operator, (node.left, node.right), (left, right))
    applied = Apply(operator, (left, right))
    return Apply("not", (applied,)) if operator != node.operator else applied


def _call(node: s.FunctionCall, scope: Scope, names: Names) -> Expression:
    arguments = _all(node.arguments, scope, names)
    name = node.function.text
    if name not in FUNCTIONS:
        other = names.sort_of(name)
        otherwise = (
            f"it is a {other}, and no function" if other else f"the functions are {', '.join(FUNCTIONS)}"
        )
        names.findings.unknown(node.function, FUNCTIONS, sort="function", otherwise=otherwise)
        return MISTAKEN
    if not check_arity(node.function, len(arguments), OPERATORS[name].arity, names.findings):
        return MISTAKEN
    names.demands += operands(name, node.arguments, arguments)
    return Apply(name, arguments)


def check_arity(name: s.Name, given: int, wanted: int, findings: Findings) -> bool:
    """Whether the number of arguments fits; reports it if not."""
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
    if node.text in names.kinds or node.text in names.agents or node.text in NO_ENTITIES:
        return Literal(node.text)
    sort = names.sort_of(node.text)
    if sort is None:
        otherwise = f'a variable is bound by let {node.text} = ...; a text is written "{node.text}"'
        among = [*scope.names(), *names.kinds, *names.agents, *_WORDS]
        names.findings.unknown(node, among, otherwise=otherwise)
    else:
        family = names.families.get(node.text, {})
        of_kind = [name for name, kind in sorted(names.kinds.items()) if kind == node.text]
        hint = (
            f"name a member: {next(iter(family.values()))}"
            if family
            else f"list those that are meant: {{{', '.join(of_kind[:5])}}}"
            if of_kind
            else f'as a text it is written "{node.text}"'
        )
        names.findings.add(Code.WRONG_SORT, node, f"'{node.text}' is a {sort}, which is no value", hint)
    return MISTAKEN


def _member(node: s.Member, scope: Scope, names: Names) -> Expression:
    """Return the name of a member, or a look-up by its entity if a run decides which member is meant.

    For a variable it returns an element.
    """
    index, variable = elaborate_expression(node.index, scope, names), scope.find(node.family.text)
    if variable is not None:
        found = (Variable(variable), index)
        names.demands += operands("element", (node.family, node.index), found)
        return Apply("element", found)
    if index is MISTAKEN:
        return MISTAKEN
    if isinstance(index, Literal):
        member = names.member(node.family, index.value, node.index)
        return MISTAKEN if member is None else Literal(member)
    members = names.family(node.family) or {}
    if all(isinstance(leaf, Literal) for leaf in leaves(index)):  # such as i + 1, in a family's body
        with suppress(Fault):
            number = evaluate(index, EvaluationScope("", "", {}, {}, names.kinds, {}))
            if isinstance(number, int) and 0 <= number < len(members):
                return Literal(tuple(members.values())[number])
    names.need(node.index, index, MEMBER, f"'{node.family.text}[...]'")
    return Apply("[]", (Literal(frozenset(members.items())), index))


# --- nodes and bigActors ----------------------------------------------------------------------------------------


def elaborate_node(node: s.Expression, scope: Scope, names: Names, by: str, need: Need = NODE) -> Expression:
    """Return an expression that must denote a node; reports a name that denotes none."""
    return _named(node, scope, names, need, by)


def elaborate_agent(node: s.Expression, scope: Scope, names: Names, by: str) -> Expression:
    """Return an expression that must denote a bigActor; reports a name that denotes none."""
    return _named(node, scope, names, AGENT, by)


def _named(node: s.Expression, scope: Scope, names: Names, need: Need, by: str) -> Expression:
    """Return an expression that must denote a node or a bigActor; reports a word that denotes neither."""
    known = names.agents if need is AGENT else names.kinds
    if isinstance(node, s.Name) and scope.find(node.text) is None and node.text not in scope.fixed:
        sort = names.sort_of(node.text)
        if sort is None:
            words = {"SELF"} if need is AGENT else {"HOST"} | (QUERY_WORDS if need is NODES else set())
            otherwise = listed(known, "bigActors" if need is AGENT else "entities")
            names.findings.unknown(node, [*scope.names(), *known, *words], otherwise=otherwise)
        elif need is AGENT:
            names.agent(node)
        else:
            names.entity(node)
        return Literal(node.text)
    if isinstance(node, s.TextLiteral):
        wanted = "a bigActor" if need is AGENT else "an entity"
        spells = unquoted(node, known)
        message = f"{by} needs {wanted}, and a text {'' if spells else 'that names none '}is given"
        hint = spells or names.findings.suggest(node.value, known) or need.remedy
        names.findings.add(Code.WRONG_VALUE, node, message, hint)
        return Literal(Text(node.value))
    return names.need(node, elaborate_expression(node, scope, names), need, by)


# --- queries --------------------------------------------------------------------------------------------------


def elaborate_query(query: s.Query, scope: Scope, names: Names, *, inside: bool = False) -> QueryOf:
    """Return a query; reports one that applies an operator to bigActors, which have no relations."""
    match query:
        case s.AllNodes():
            return QueryOf(None, None)
        case s.HostReference():
            return QueryOf(None, Host())
        case s.Name():
            return QueryOf(None, elaborate_node(query, scope, names, "a query", NODES))
        case s.QueryApplication(relation, argument):
            if inside and relation == QueryOperator.HOSTED_AT:
                hint = "bigActors have no parents, children or links: write HOSTED_AT outermost"
                names.findings.add(
                    Code.WRONG_QUERY,
                    query,
                    "HOSTED_AT gives bigActors, and the query goes on from them",
                    hint,
                )
            found = elaborate_query(argument, scope, names, inside=True)
            leaf = found.operator is None and found.argument is not None
            return QueryOf(relation, found.argument if leaf else found)
