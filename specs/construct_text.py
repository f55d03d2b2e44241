"""The canonical text of constructs on one line: expressions, queries, patterns, actions, formulas, placements."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import singledispatch
from typing import Final

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.values import ESCAPES
from specs import syntax as s

# The precedence of an operator, and the least precedences of its two operands; 8 binds tightest.
_BINARY: Final = {"or": (1, 1, 2), "and": (2, 2, 3), "+": (5, 5, 6), "-": (5, 5, 6)}
_COMPARISON: Final = (4, 5, 5)
_PATH: Final = (5, 6, 5)
_WORDS: Final = ("always", "eventually", "next", "infinitely often")
_CONNECTIVE: Final = {"<->": (1, 1, 2), "->": (2, 3, 2), "or": (3, 3, 4), "and": (4, 4, 5)}
_ATOM: Final = 8


@singledispatch
def write(node: s.Node) -> str:
    """Return the canonical text of a node that fits on one line."""
    if isinstance(node, s.Node):
        raise TypeError(f"{type(node).__name__} does not fit on one line")
    raise TypeError(f"{node!r} is no part of a tree: a name is Name('uav0'), a length Length(300, 'm')")


def inner(node: s.Node, least: int) -> str:
    """Return the text of an operand, in parentheses if it binds less tightly than `least`."""
    return write(node) if binding(node) >= least else f"({write(node)})"


def listed(nodes: Iterable[s.Node]) -> str:
    """Return the texts, separated by commas."""
    return ", ".join(write(node) for node in nodes)


def binding(node: s.Node) -> int:
    """Return the precedence of the outermost operator of an expression or a formula."""
    match node:
        case s.BinaryOperation():
            return _BINARY.get(node.operator, _COMPARISON)[0]
        case s.UnaryOperation():
            return 3 if node.operator == "not" else 7
        case s.OfKind():
            return 6
        case s.Connective():
            return _CONNECTIVE[node.operator][0]
        case s.Negation():
            return 8 if _is_unlike(node) else 6
        case s.PathOperation():
            return _PATH[0]
        case s.PathPrefix():
            return 0 if node.operator in _WORDS else 6
        case s.PathQuantifier():
            return 6
        case s.Quantified() | s.LeadsTo():
            return 0
    return _ATOM


def constant(node: s.Expression) -> str:
    """Return the text of a fixed value: an atom, or a negative number."""
    match node:
        case s.UnaryOperation("-", s.IntegerLiteral()):
            return write(node)
    return inner(node, _ATOM)


# --- expressions and queries


@write.register
def _(node: s.Name) -> str:
    return node.text


@write.register
def _(node: s.TextLiteral) -> str:
    return f'"{node.value.translate(ESCAPES)}"'


@write.register
def _(node: s.IntegerLiteral) -> str:
    return str(node.value)


@write.register
def _(node: s.TruthLiteral) -> str:
    return "true" if node.value else "false"


@write.register
def _(_node: s.HostReference) -> str:
    return "HOST"


@write.register
def _(_node: s.SelfReference) -> str:
    return "SELF"


@write.register
def _(node: s.TupleLiteral) -> str:
    return f"({listed(node.items)})"


@write.register
def _(node: s.SetLiteral) -> str:
    return f"{{{listed(node.items)}}}"


@write.register
def _(node: s.RouteLiteral) -> str:
    return f"[{listed(node.items)}]"


@write.register
def _(node: s.Member) -> str:
    return f"{write(node.family)}[{write(node.index)}]"


@write.register
def _(node: s.UnaryOperation) -> str:
    if node.operator == "not":
        return f"not {inner(node.operand, 3)}"
    return f"-{inner(node.operand, 7)}"


@write.register
def _(node: s.BinaryOperation) -> str:
    _, left, right = _BINARY.get(node.operator, _COMPARISON)
    return f"{inner(node.left, left)} {node.operator} {inner(node.right, right)}"


@write.register
def _(node: s.OfKind) -> str:
    return f"{inner(node.operand, 6)} of {write(node.kind)}"


@write.register
def _(node: s.FunctionCall) -> str:
    return f"{write(node.function)}({listed(node.arguments)})"


@write.register
def _(_node: s.AllNodes) -> str:
    return "ALL"


@write.register
def _(node: s.QueryApplication) -> str:
    if isinstance(node.argument, s.HostReference) and node.argument.span == node.span:
        return f"{node.relation}_HOST"
    return f"{node.relation}({write(node.argument)})"


# --- control actions


@write.register
def _(node: s.Command) -> str:
    return COMMANDS[node.name].write(map(write, node.operands), map(write, node.via))


@write.register
def _(node: s.ApplyRule) -> str:
    return f"{write(node.rule)}({listed(node.arguments)})"


@write.register
def _(node: s.RuleBody) -> str:
    return f"{{ {node.text} }}"


# --- patterns


@write.register
def _(node: s.ObservationPattern) -> str:
    return f"{write(node.variable) if node.variable else '_'}: Observation"


@write.register
def _(node: s.MessagePattern) -> str:
    return f"{write(node.variable) if node.variable else '_'}: Message"


@write.register
def _(node: s.VariablePattern) -> str:
    return write(node.variable)


@write.register
def _(_node: s.Wildcard) -> str:
    return "_"


@write.register
def _(node: s.LiteralPattern) -> str:
    return write(node.value)


@write.register
def _(node: s.ConstantPattern) -> str:
    return f"={write(node.name)}"


@write.register
def _(node: s.TuplePattern) -> str:
    return f"({listed(node.items)})"


# --- formulas


@write.register
def _(node: s.Negation) -> str:
    if _is_unlike(node):
        return write(node.operand).replace("==", "!=", 1)
    return f"not {inner(node.operand, 6)}"


def _is_unlike(node: s.Negation) -> bool:
    """Return whether a negation is written with `!=`."""
    claim = node.operand
    return isinstance(claim, s.SameName) or (isinstance(claim, s.Stored) and claim.operator == "==")


@write.register
def _(node: s.Connective) -> str:
    _, left, right = _CONNECTIVE[node.operator]
    return f"{inner(node.left, left)} {node.operator} {inner(node.right, right)}"


@write.register
def _(node: s.Quantified) -> str:
    behaviour = f" with_behavior {write(node.behaviour)}" if node.behaviour else ""
    host = f" hosted_at {write(node.host)}" if node.host else ""
    variables, body = [node.variable], node.body
    while isinstance(body, s.Quantified) and body.joined:
        variables.append(body.variable)
        body = body.body
    among = f"{write(node.range)}{behaviour}{host}"
    return f"{node.quantifier} {', '.join(map(write, variables))}: {among} . {write(body)}"


@write.register
def _(node: s.Inside) -> str:
    relation = "directly in" if node.directly else "in"
    return f"{_whose(node.actually)}{write(node.entity)} {relation} {write(node.place)}"


@write.register
def _(node: s.PossiblyIn) -> str:
    return f"possibly {write(node.entity)} in {write(node.place)}"


@write.register
def _(node: s.SurelyIn) -> str:
    return f"surely {write(node.entity)} in {write(node.place)}"


@write.register
def _(node: s.ApartFrom) -> str:
    height = f" or {write(node.height)} up" if node.height else ""
    return f"{write(node.entity)} at least {write(node.distance)}{height} from {write(node.other)}"


@write.register
def _(node: s.WithinRangeOf) -> str:
    return f"{write(node.entity)} within {write(node.distance)} of {write(node.other)}"


@write.register
def _(node: s.LinkedTo) -> str:
    return f"{_whose(node.actually)}{write(node.entity)} linked {write(node.other)}"


def _whose(actually: bool) -> str:
    return "actually " if actually else ""


@write.register
def _(node: s.Present) -> str:
    return f"present {write(node.entity)}"


@write.register
def _(node: s.Known) -> str:
    return f"known {write(node.entity)}"


@write.register
def _(node: s.Pending) -> str:
    return f"pending {node.request} {write(node.agent)}" if node.request else f"pending {write(node.agent)}"


@write.register
def _(node: s.Ended) -> str:
    return f"ended {write(node.agent)}"


@write.register
def _(node: s.Waiting) -> str:
    return f"waiting {write(node.agent)}"


@write.register
def _(node: s.HostedAt) -> str:
    return f"{write(node.agent)} hosted_at {write(node.host)}"


@write.register
def _(node: s.SameName) -> str:
    return f"{write(node.left)} == {write(node.right)}"


@write.register
def _(node: s.Stored) -> str:
    return f"{write(node.agent)}.{write(node.variable)} {node.operator} {constant(node.value)}"


@write.register
def _(node: s.HasValue) -> str:
    return f"bound {write(node.agent)}.{write(node.variable)}"


# --- formulas of runs


@write.register
def _(node: s.PathPrefix) -> str:
    if node.operator in _WORDS:
        return f"{node.operator} {write(node.operand)}"
    return f"{node.operator} {inner(node.operand, 6)}"


@write.register
def _(node: s.PathOperation) -> str:
    _, left, right = _PATH
    return f"{inner(node.left, left)} {node.operator} {inner(node.right, right)}"


@write.register
def _(node: s.LeadsTo) -> str:
    return f"{inner(node.left, 1)} leads to {inner(node.right, 1)}"


@write.register
def _(node: s.PathQuantifier) -> str:
    path = node.operand
    letters = {sign: letter for letter, sign in s.SIGNS.items()}
    if isinstance(path, s.PathPrefix) and path.operator in letters:
        return f"{node.quantifier}{letters[path.operator]} {inner(path.operand, 6)}"
    return f"{node.quantifier} {inner(path, 6)}"


@write.register
def _(node: s.Taken) -> str:
    return f"taken {write(node.steps)}"


@write.register
def _(node: s.Enabled) -> str:
    return f"enabled {write(node.steps)}"


@write.register
def _(node: s.Steps) -> str:
    return " ".join(map(write, node.words))


@write.register
def _(node: s.Fairness) -> str:
    return f"{node.strength} fairness of {listed(node.steps)}"


# --- placements


@write.register
def _(node: s.Placement) -> str:
    return " ".join(placed(node))


@write.register
def _(node: s.Coordinate) -> str:
    latitude, longitude = node.written
    return f"({latitude or decimal(node.latitude)}, {longitude or decimal(node.longitude)})"


@write.register
def _(node: s.Length) -> str:
    return f"{decimal(node.value)} {node.unit}"


@write.register
def _(node: s.Duration) -> str:
    return f"{decimal(node.value)} {node.unit}"


@write.register
def _(node: s.Speed) -> str:
    return f"{decimal(node.value)} {node.unit}"


@write.register
def _(node: s.Speeds) -> str:
    if node.least == node.greatest:
        return write(node.least)
    return f"{write(node.least)} to {write(node.greatest)}"


def decimal(value: float) -> str:
    """Return the shortest text of a number, without a fraction if it is whole.

    >>> decimal(400.0), decimal(37.1), decimal(1e-07)
    ('400', '37.1', '1e-07')
    """
    return str(int(value)) if float(value).is_integer() and abs(value) < 1e15 else repr(value)


def separated(word: str, nodes: Sequence[s.Node]) -> list[str]:
    """Return a list behind a word, in pieces at whose ends a line may be wrapped."""
    texts = [f"{write(node)}," for node in nodes[:-1]] + [write(nodes[-1])]
    return [f"{word} {texts[0]}", *texts[1:]]


def placed(placement: s.Placement) -> list[str]:
    """Return the text of a placement, in pieces at whose ends a line may be wrapped."""
    pieces = shape(placement.geometry)
    if placement.altitude:
        low, high = placement.altitude.lowest, placement.altitude.highest
        pieces.append(f"altitude {write(low)}" if low == high else f"altitude {write(low)} to {write(high)}")
    return pieces


def shape(geometry: s.Geometry) -> list[str]:
    """Return the text of a geometry, in pieces at whose ends a line may be wrapped."""
    match geometry:
        case s.Point(position):
            return [f"point {write(position)}"]
        case s.Box(first, second):
            return [f"box {write(first)}", write(second)]
        case s.Circle(centre, radius):
            return [f"circle {write(centre)}", f"radius {write(radius)}"]
        case s.Polygon(corners):
            return ["polygon", *(write(corner) for corner in corners)]
