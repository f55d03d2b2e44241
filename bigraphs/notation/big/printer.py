"""The printer of BigraphER's notation; `parse_model` and `parse_expression` read its output."""

from __future__ import annotations

from collections.abc import Iterable

from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    BigDeclaration,
    Call,
    ClassTerm,
    ConditionTerm,
    ConstantDeclaration,
    ControlDeclaration,
    Declaration,
    LinkDeclaration,
    Model,
    ParameterDeclaration,
    PlaceDeclaration,
    ReactDeclaration,
    SortDeclaration,
    SystemTerm,
)
from bigraphs.notation.big.syntax import (
    Absolute,
    Arguments,
    Arithmetic,
    Chain,
    Close,
    Expression,
    Identity,
    Ion,
    Literal,
    Negated,
    Nest,
    NewNames,
    Number,
    PlacingLiteral,
    Ref,
    Repeat,
    Share,
    Substitute,
    ValueExpression,
    Variable,
    Wired,
)


def format_model(model: Model) -> str:
    """Return the text of a file, one declaration per line."""
    lines = [format_declaration(declaration) for declaration in model.declarations]
    return "\n".join(lines + (_system(model.system) if model.system else [])) + "\n"


def format_declaration(declaration: Declaration) -> str:
    """Return the text of one declaration, with its semicolon if it has one."""
    match declaration:
        case ControlDeclaration():
            return _control(declaration)
        case ConstantDeclaration(type_, name, value):
            return f"{type_} {name} = {format_value(value)};"
        case BigDeclaration(name, body, parameters, arguments):
            return f"{_fun(parameters)}big {name}{_given(parameters, arguments)} = {format_expression(body)};"
        case ReactDeclaration():
            return _react(declaration)
        case ActionDeclaration(name, rules, reward):
            return "\n".join(
                [f"action {name}{_reward(reward)}", *(f"  {_react(rule)}" for rule in rules), "end"]
            )
        case SortDeclaration(name, controls):
            return f"sort {name} = {_braces(controls)};"
        case PlaceDeclaration(control, content):
            return f"place {control} = {_braces(content)};"
        case LinkDeclaration(name, ports):
            written = (control if port is None else f"{control}.{port}" for control, port in ports)
            return f"link {name} = {_braces(written)};"


def _control(control: ControlDeclaration) -> str:
    words = [
        "" if control.status == "active" else f"{control.status} ",
        "ordered " if control.ordered else "",
        _fun(control.parameters),
    ]
    return f"{''.join(words)}ctrl {control.name}{_given(control.parameters, ())} = {control.arity};"


def _fun(parameters: tuple[str, ...]) -> str:
    return "fun " if parameters else ""


def _given(parameters: tuple[str, ...], arguments: Arguments) -> str:
    return f"({_commas(parameters)})" if parameters else _arguments(arguments)


def _react(react: ReactDeclaration) -> str:
    arrow = "-->" if react.weight is None else f"-[{format_value(react.weight)}]->"
    change = f"{format_expression(react.redex)} {arrow} {format_expression(react.reactum)}"
    sites = "" if react.instantiation is None else f" @ [{_commas(map(str, react.instantiation))}]"
    conditions = f" if {_commas(map(_condition, react.conditions))}" if react.conditions else ""
    given = _given(react.parameters, react.arguments)
    return f"{_fun(react.parameters)}react {react.name}{given} = {change}{sites}{conditions};"


def _condition(condition: ConditionTerm) -> str:
    return f"{'' if condition.positive else '!'}{format_expression(condition.pattern)} in {condition.where}"


def _reward(reward: ValueExpression | None) -> str:
    return "" if reward is None else f"[{format_value(reward)}]"


def _arguments(arguments: Arguments) -> str:
    return f"({_commas(map(format_value, arguments))})" if arguments else ""


def format_value(value: ValueExpression) -> str:
    """Return the text of a number, a string or a value expression, with the necessary parentheses."""
    match value:
        case Literal(str() as text):
            return f'"{text}"'
        case Literal(number):
            return repr(number)
        case Variable(name):
            return name
        case Negated(operand):
            return f"-{_value_operand(operand, 3)}"
        case Absolute(operand):
            return f"abs({format_value(operand)})"
        case Arithmetic(first, rest):
            level = _VALUE_LEVEL[rest[0][0]]
            if level == 4:  # '^' associates to the right
                return f"{_value_operand(first, 5)} ^ {_value_operand(rest[0][1], 3)}"
            written = [f" {symbol} {_value_operand(operand, level + 1)}" for symbol, operand in rest]
            return _value_operand(first, level + 1) + "".join(written)


_VALUE_LEVEL = {"+": 1, "-": 1, "*": 2, "/": 2, "^": 4}


def _value_operand(value: ValueExpression, least: int) -> str:
    """Return the text of an operand, in parentheses if it binds less tightly than `least`."""
    match value:
        case Arithmetic(_, rest):
            level = _VALUE_LEVEL[rest[0][0]]
        case Negated():
            level = 3
        case _:
            level = 5
    text = format_value(value)
    return text if level >= least else f"({text})"


def format_expression(expression: Expression) -> str:
    """Return the text of an expression, with the necessary parentheses."""
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
    """Return the text of an operand, without parentheses if it binds more tightly than `level`."""
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
        case Ref(name, arguments):
            return name + _arguments(arguments)
        case Repeat(operator, times, body):
            word = "par" if operator == "|" else "ppar"
            return f"{word}({format_value(times)}, {format_expression(body)})"
        case Number(value):
            return str(value)
        case Ion(control, links, arguments):
            return control + _arguments(arguments) + (_braces(links) if links else "")
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
        case Identity() | PlacingLiteral():
            return _placing(expression)
        case _:
            return f"({format_expression(expression)})"


def _placing(expression: Identity | PlacingLiteral) -> str:
    match expression:
        case Identity(1, ()):
            return "id"
        case Identity(width, ()):
            return f"id({width})"
        case Identity(0, names):
            return f"id{_braces(names)}"
        case Identity(width, names):
            return f"id({width}, {_braces(names)})"
        case PlacingLiteral(parents, regions):
            sets = _commas(_braces(map(str, within)) for within in parents)
            return f"([{sets}], {regions})"


def _system(system: SystemTerm) -> list[str]:
    rules = _commas(map(_class, system.classes))
    lines = [f"begin {system.kind}", *map(_parameter, system.parameters)]
    lines += [f"  init {_call(system.init)};", f"  rules = [{rules}];"]
    if system.predicates:
        lines.append(f"  preds = {_braces(map(_call, system.predicates))};")
    return [*lines, "end"]


def _class(each: ClassTerm) -> str:
    opening, closing = "()" if each.instantaneous else "{}"
    return f"{opening}{_commas(map(_call, each.rules))}{closing}"


def _call(call: Call) -> str:
    return call.name + _arguments(call.arguments) + _reward(call.reward)


def _parameter(parameter: ParameterDeclaration) -> str:
    written = list(map(format_value, parameter.values))
    several = f"[{' : '.join(written)}]" if parameter.ranged else _braces(written)
    values = written[0] if len(written) == 1 else several
    return f"  {parameter.type} {_commas(parameter.names)} = {values};"


def _braces(words: Iterable[str]) -> str:
    return f"{{{_commas(words)}}}"


def _commas(words: Iterable[str]) -> str:
    return ", ".join(words)
