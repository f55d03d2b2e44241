"""Build the syntax tree of behaviours: one method for each rule of the grammar, with its name."""

# ruff: noqa: D102 - each method builds the grammar rule of its name, and mission.lark shows that rule

from __future__ import annotations

from lark import Token, Transformer

from semantics.behaviours.observations import QueryOperator
from specs import syntax as s
from specs.build_world import option
from specs.building import (
    BuildingMistake,
    Children,
    RuleResult,
    cover,
    decimal,
    name,
    names,
    nodes,
    optional,
    rule_body,
    span_of,
    text,
    whole,
)
from specs.codes import Code
from specs.diagnostics import Diagnostic

PATTERN_TYPES = ("Observation", "Message")
_OPERATORS = {"||": "or", "&&": "and", "!": "not"}


class BuildBehaviour(Transformer[Token, s.Mission]):
    """Build bigActors, statements, patterns, queries, control actions and expressions."""

    def definition(self, c: Children) -> s.Definition:
        return s.Definition(name(c[1]), names(c[2:-1]), c[-1].value, span=cover(c))

    def bigactor(self, c: Children) -> s.BigActor:
        body = (c[5],) if isinstance(c[5], s.Call) else c[5].value
        return s.BigActor(optional(c[1], name), name(c[3]), body, span=cover(c))

    def family(self, c: Children) -> s.Family:
        body = (c[12],) if isinstance(c[12], s.Call) else c[12].value
        return s.Family(name(c[1]), name(c[3]), name(c[6]), c[8], name(c[10]), body, span=cover(c))

    def block(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), nodes(c))

    # --- statements

    def observe(self, c: Children) -> s.Observe:
        return s.Observe(c[2], span=cover(c))

    def control(self, c: Children) -> s.Control:
        return s.Control(c[2], span=cover(c))

    def react(self, c: Children) -> s.React:
        cases = tuple(each for each in c if isinstance(each, s.Case))
        branches = [each for each in c if isinstance(each, s.After)]
        if len(branches) > 1:
            _refuse_after(
                branches[1],
                "a second 'after' branch",
                "leave it out: the first sets the time limit of the react",
            )
        if branches and c[-2] is not branches[0]:
            _refuse_after(branches[0], "an 'after' branch before a case", "write it behind all cases")
        return s.React(cases, branches[0] if branches else None, span=cover(c))

    def after(self, c: Children) -> s.After:
        return s.After(c[1], nodes(c[3:]), span=cover(c))

    def duration(self, c: Children) -> s.Duration:
        return s.Duration(decimal(None, c[0]), str(c[1]), span=cover(c))

    def send(self, c: Children) -> s.Send:
        if c[3] is not None:
            return s.Send(c[1], c[3], span=cover(c))
        if isinstance(c[1], s.TupleLiteral) and len(c[1].items) == 2:
            return s.Send(c[1].items[0], c[1].items[1], span=cover(c))
        hint = "write send e to a, or send(e, a)"
        raise BuildingMistake(
            Diagnostic(Code.MISSING_RECIPIENT, cover(c), "the message has no recipient", hint)
        )

    def migrate(self, c: Children) -> s.Migrate:
        return s.Migrate(c[2], span=cover(c))

    def spawn(self, c: Children) -> s.Spawn:
        if isinstance(c[2], s.Call):
            return s.Spawn(None, c[2], c[5], span=cover(c))
        return s.Spawn(name(c[1]), c[5], c[3], span=cover(c))

    def display(self, c: Children) -> s.Display:
        return s.Display(c[2], span=cover(c))

    def let(self, c: Children) -> s.Let:
        return s.Let(name(c[1]), c[3], span=cover(c))

    def assign(self, c: Children) -> s.Assign:
        return s.Assign(name(c[0]), c[2], span=cover(c))

    def if_statement(self, c: Children) -> s.If:
        otherwise = () if c[4] is None else (c[4],) if isinstance(c[4], s.If) else c[4].value
        return s.If(c[1], c[2].value, otherwise, span=cover(c))

    def loop(self, c: Children) -> s.Loop:
        return s.Loop(c[1].value, span=cover(c))

    def while_statement(self, c: Children) -> s.While:
        return s.While(c[1], c[2].value, span=cover(c))

    def for_statement(self, c: Children) -> s.For:
        return s.For(name(c[1]), c[3], c[4].value, span=cover(c))

    def match(self, c: Children) -> s.Match:
        return s.Match(c[1], nodes(c[2:]), span=cover(c))

    def choose(self, c: Children) -> s.Choose:
        alternatives = tuple(
            s.Alternative(part.value, span=part.span) if isinstance(part, RuleResult) else part
            for part in c
            if not isinstance(part, Token)
        )
        return s.Choose(alternatives, span=cover(c))

    def alternative(self, c: Children) -> s.Alternative:
        return s.Alternative(nodes(c), span=cover(c))

    def choose_from(self, c: Children) -> s.ChooseFrom:
        return s.ChooseFrom(name(c[1]), c[3], c[4].value, span=cover(c))

    def call(self, c: Children) -> s.Call:
        return s.Call(name(c[0]), nodes(c), span=cover(c))

    def skip(self, c: Children) -> s.Skip:
        return s.Skip(span=cover(c))

    # --- patterns

    def case(self, c: Children) -> s.Case:
        return s.Case(c[1], c[3], nodes(c[5:]), span=cover(c))

    def typed(self, c: Children) -> s.Pattern:
        variable = name(c[0]) if c[0].type == "NAME" else None
        if option("type of a pattern", c[2], PATTERN_TYPES) == "Observation":
            return s.ObservationPattern(variable, span=cover(c))
        return s.MessagePattern(variable, span=cover(c))

    def variable(self, c: Children) -> s.VariablePattern:
        return s.VariablePattern(name(c[0]), span=cover(c))

    def wildcard(self, c: Children) -> s.Wildcard:
        return s.Wildcard(span=cover(c))

    def literal(self, c: Children) -> s.LiteralPattern:
        return s.LiteralPattern(_literal(c), span=cover(c))

    def constant(self, c: Children) -> s.ConstantPattern:
        return s.ConstantPattern(name(c[1]), span=cover(c))

    def tuple_pattern(self, c: Children) -> s.TuplePattern:
        return s.TuplePattern(nodes(c), span=cover(c))

    # --- queries

    def query_host(self, c: Children) -> s.HostReference:
        return s.HostReference(span=cover(c))

    def query_all(self, c: Children) -> s.AllNodes:
        return s.AllNodes(span=cover(c))

    def query_name(self, c: Children) -> s.Name:
        return name(c[0])

    def relation(self, c: Children) -> s.QueryApplication:
        return s.QueryApplication(QueryOperator(c[0]), c[2], span=cover(c))

    def relation_host(self, c: Children) -> s.QueryApplication:
        span = span_of(c[0])
        return s.QueryApplication(
            QueryOperator(c[0].removesuffix("_HOST")), s.HostReference(span=span), span=span
        )

    # --- control actions

    def command(self, c: Children) -> s.Command:
        via = c[-1].value if isinstance(c[-1], RuleResult) else ()
        return s.Command(str(c[0]), nodes(c), via, span=cover(c))

    def via(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), nodes(c))

    def apply_rule(self, c: Children) -> s.ApplyRule:
        return s.ApplyRule(name(c[0]), nodes(c), span=cover(c))

    def inline_rule(self, c: Children) -> s.RuleBody:
        return rule_body(c[0])

    # --- expressions

    def binary(self, c: Children) -> s.BinaryOperation:
        operator = " ".join(str(token) for token in c[1:-1])
        return s.BinaryOperation(_OPERATORS.get(operator, operator), c[0], c[-1], span=cover(c))

    def unary(self, c: Children) -> s.UnaryOperation:
        return s.UnaryOperation(_OPERATORS.get(str(c[0]), str(c[0])), c[1], span=cover(c))

    def of_kind(self, c: Children) -> s.OfKind:
        return s.OfKind(c[0], name(c[2]), span=cover(c))

    def reference(self, c: Children) -> s.Name:
        return name(c[0])

    def member(self, c: Children) -> s.Member:
        index: s.Expression = _index(c[2]) if isinstance(c[2], Token) else c[2]
        return s.Member(name(c[0]), index, span=cover(c))

    def string(self, c: Children) -> s.TextLiteral:
        return text(c[0])

    def integer(self, c: Children) -> s.IntegerLiteral:
        return s.IntegerLiteral(whole(c[0]), span=cover(c))

    def truth(self, c: Children) -> s.TruthLiteral:
        return s.TruthLiteral(c[0].type == "TRUE", span=cover(c))

    def host(self, c: Children) -> s.HostReference:
        return s.HostReference(span=cover(c))

    def self_name(self, c: Children) -> s.SelfReference:
        return s.SelfReference(span=cover(c))

    def function_call(self, c: Children) -> s.FunctionCall:
        return s.FunctionCall(name(c[0]), nodes(c), span=cover(c))

    def tuple_of(self, c: Children) -> s.TupleLiteral:
        return s.TupleLiteral(nodes(c), span=cover(c))

    def set_of(self, c: Children) -> s.SetLiteral:
        return s.SetLiteral(nodes(c), span=cover(c))

    def route_of(self, c: Children) -> s.RouteLiteral:
        return s.RouteLiteral(nodes(c), span=cover(c))

    def group(self, c: Children) -> s.Expression:
        expression: s.Expression = c[1]
        return expression


def _refuse_after(branch: s.After, message: str, hint: str) -> None:
    raise BuildingMistake(Diagnostic(Code.MISPLACED_AFTER, branch.span, message, hint))


def _index(token: Token) -> s.Name | s.IntegerLiteral:
    """Return the index of a member that is written as a name or a number."""
    return name(token) if token.type == "NAME" else s.IntegerLiteral(whole(token), span=span_of(token))


def _literal(c: Children) -> s.TextLiteral | s.IntegerLiteral | s.TruthLiteral:
    token = c[-1]
    if token.type == "STRING":
        return text(token)
    if token.type == "NUMBER":
        return s.IntegerLiteral(-whole(token) if c[0] else whole(token), span=cover(c))
    return s.TruthLiteral(token.type == "TRUE", span=cover(c))
