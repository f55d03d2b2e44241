"""Writing BigraphER's notation; `parse_model` and `parse_expression` read back what is written here."""

from __future__ import annotations

from collections.abc import Iterable

from bigraphs.notation.big_syntax import (
    BigDeclaration,
    Chain,
    Close,
    ControlDeclaration,
    Declaration,
    Expression,
    Identity,
    Ion,
    Model,
    Nest,
    NewNames,
    Number,
    Placed,
    ReactDeclaration,
    Ref,
    Share,
    Substitute,
    System,
    Wired,
)


def format_model(model: Model) -> str:
    """Write a whole file, one declaration a line."""
    lines = [format_declaration(declaration) for declaration in model.declarations]
    return "\n".join(lines + (_system(model.system) if model.system else [])) + "\n"


def format_declaration(declaration: Declaration) -> str:
    """Write one declaration with its semicolon."""
    match declaration:
        case ControlDeclaration(name, arity, atomic):
            return f"{'atomic ' if atomic else ''}ctrl {name} = {arity};"
        case BigDeclaration(name, body):
            return f"big {name} = {format_expression(body)};"
        case ReactDeclaration(name, redex, reactum, None):
            return f"react {name} = {format_expression(redex)} --> {format_expression(reactum)};"
        case ReactDeclaration(name, redex, reactum, sites):
            arrow = f"{format_expression(redex)} --> {format_expression(reactum)}"
            return f"react {name} = {arrow} @ [{_commas(map(str, sites or ()))}];"


def format_expression(expression: Expression) -> str:
    """Write one expression, with the parentheses that it needs."""
    match expression:
        case Chain(first, rest):
            level = _LEVEL[rest[0][0]]
            operands = [f" {operator} {_operand(operand, level)}" for operator, operand in rest]
            return _operand(first, level) + "".join(operands)
        case Wired(wires, body):
            return " ".join([*map(_simple, wires), _wired_body(body)])
        case Share(what, by, where):
            return f"share {_simple(what)} by {_simple(by)} in {_simple(where)}"
        case _:
            return _simple(expression)


_LEVEL = {"|": 1, "||": 1, "+": 2, "*": 3}


def _operand(expression: Expression, level: int) -> str:
    """Write an operand: a chain that binds more tightly needs no parentheses."""
    text = format_expression(expression)
    inner = _LEVEL[expression.rest[0][0]] if isinstance(expression, Chain) else 4
    return text if inner > level else f"({text})"


def _wired_body(expression: Expression) -> str:
    return (
        _simple(expression)
        if isinstance(expression, Ion | Nest | Ref)
        else f"({format_expression(expression)})"
    )


def _simple(expression: Expression) -> str:
    match expression:
        case Ref(name):
            return name
        case Number(value):
            return str(value)
        case Ion(control, links):
            return control + (_braces(links) if links else "")
        case Nest(ion, inside):
            return f"{_simple(ion)}.{_simple(inside)}"
        case Close((name,)):
            return f"/{name}"
        case Close(names):
            return f"/{_braces(names)}"
        case Substitute(outer, inner):
            return f"{outer}/{_braces(inner)}"
        case NewNames(names):
            return _braces(names)
        case Identity() | Placed():
            return _placing(expression)
        case _:
            return f"({format_expression(expression)})"


def _placing(expression: Identity | Placed) -> str:
    match expression:
        case Identity(1, ()):
            return "id"
        case Identity(width, ()):
            return f"id({width})"
        case Identity(0, names):
            return f"id{_braces(names)}"
        case Identity(width, names):
            return f"id({width}, {_braces(names)})"
        case Placed(parents, regions):
            sets = _commas(_braces(map(str, within)) for within in parents)
            return f"([{sets}], {regions})"


def _system(system: System) -> list[str]:
    classes = []
    for each in system.rules:
        opening, closing = "()" if each.instantaneous else "{}"
        classes.append(f"{opening}{_commas(each.rules)}{closing}")
    lines = ["begin brs", f"  init {system.init};", f"  rules = [{_commas(classes)}];"]
    if system.predicates:
        lines.append(f"  preds = {_braces(system.predicates)};")
    return [*lines, "end"]


def _braces(words: Iterable[str]) -> str:
    return f"{{{_commas(words)}}}"


def _commas(words: Iterable[str]) -> str:
    return ", ".join(words)
