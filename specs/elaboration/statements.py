"""Statements, numbered in one program, and the facts about each body that later checks need."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

from bigraphs.notation.spelling import listed
from semantics.behaviours import statements as k
from semantics.behaviours.commands import COMMANDS, HOST, MOST_VIA
from semantics.behaviours.expressions import Expression, Literal, Variable
from semantics.behaviours.reaction_rules import PlaceTerm
from semantics.behaviours.values import Value
from specs import syntax as s
from specs.autopilot_words import ORDERS
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.expressions import (
    check_arity,
    elaborate_agent,
    elaborate_expression,
    elaborate_node,
    elaborate_query,
)
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.names import Names
from specs.elaboration.patterns import check_distinct, elaborate_pattern, note_hiding
from specs.elaboration.rule_regions import regions_of
from specs.elaboration.rule_schemas import Schema, SchemaParameter
from specs.elaboration.rules import elaborate_rule, word_of
from specs.elaboration.scopes import Scope, Variables
from specs.elaboration.type_constraints import (
    COLLECTION,
    CONDITION,
    CONDITIONAL,
    FILLED,
    CaseDistinction,
    Need,
)
from specs.foreign_words import DONE

LONGEST: Final = 7 * 24 * 3600.0
"""The longest duration in seconds."""

_FILLED_LATER: Final = k.Tested()
"""The placeholder of a statement until its blocks are numbered."""


@dataclass(frozen=True, slots=True)
class CallSite:
    """A call of a behaviour: `tail` if no code follows it, `top` if it is a tail call that is not nested."""

    behaviour: str
    where: s.Node
    tail: bool
    top: bool


@dataclass(frozen=True, slots=True)
class SpawnSite:
    """A `spawn`: the name, behaviour and host of the new bigActor."""

    name: str
    behaviour: str
    host: Expression


@dataclass(frozen=True, slots=True)
class ControlSite:
    """A `control`, as written and as elaborated."""

    where: s.Action
    statement: k.ControlBy

    @property
    def via(self) -> tuple[s.Expression, ...]:
        """The places of its VIA."""
        return self.where.via if isinstance(self.where, s.Command) else ()


@dataclass(slots=True)
class ElaboratedBody:
    """The body of a bigActor or a behaviour: its block, and the statements in it that later checks examine.

    `runs` is the behaviour that it is declared with, if it contains nothing else.
    """

    name: str
    is_agent: bool
    block: k.Block = ()
    calls: list[CallSite] = field(default_factory=list)
    spawns: list[SpawnSite] = field(default_factory=list)
    controls: list[ControlSite] = field(default_factory=list)
    migrations: list[Expression] = field(default_factory=list)
    loops: list[int] = field(default_factory=list)
    runs: str | None = None
    variables: dict[str, list[str]] = field(default_factory=dict)


@dataclass(slots=True)
class StatementNumbers:
    """The statements of a mission so far, each with its line and its syntax node."""

    names: Names
    schemas: dict[str, Schema]
    statements: list[k.Statement] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    variables: Variables = field(default_factory=Variables)
    starts: list[int] = field(default_factory=list)
    branch_lines: dict[tuple[int, int], int] = field(default_factory=dict)
    nodes: list[s.Node] = field(default_factory=list)

    def __post_init__(self) -> None:
        text = self.names.findings.source.text
        self.starts = [0, *(at + 1 for at, character in enumerate(text) if character == "\n")]

    def reserve(self, node: s.Node) -> int:
        """Return the number of a new statement."""
        self.statements.append(_FILLED_LATER)
        self.lines.append(self.line(node))
        self.nodes.append(node)
        return len(self.statements) - 1

    def line(self, node: s.Node) -> int:
        """Return the first line of a node."""
        return bisect_right(self.starts, node.span.start)

    def branch(self, number: int, rank: int, node: s.Node) -> None:
        """Record the first line of a statement's branch."""
        self.branch_lines[number, rank] = self.line(node)

    def body(
        self,
        body: ElaboratedBody,
        written: tuple[s.Statement, ...],
        parameters: Mapping[str, str],
        constants: Mapping[str, Value],
    ) -> None:
        """Number the statements of a body."""
        for name, unique in parameters.items():
            body.variables.setdefault(name, []).append(unique)
        match written:
            case (s.Call(called),):
                body.runs = called.text
        scope = Scope(None, dict(parameters), constants)
        body.block = _Statements(self, body).block(written, scope, tail=True, top=True)


@dataclass(frozen=True, slots=True)
class _Place:
    """The context of a statement: its scope, whether it is in tail position, and whether it is not nested."""

    scope: Scope
    tail: bool
    top: bool


class _Statements:
    """Elaborates the statements of one body. Each depth of nesting costs three frames of Python's stack."""

    def __init__(self, program: StatementNumbers, body: ElaboratedBody) -> None:
        self.program = program
        self.names = program.names
        self.into = body

    def block(
        self, written: tuple[s.Statement, ...], scope: Scope, *, tail: bool, top: bool = False
    ) -> k.Block:
        """Return the numbers of consecutive statements; `scope` grows with each `let`."""
        numbers: list[int] = []
        real = [statement for statement in written if not isinstance(statement, s.Skip)]
        for statement in real:
            last = statement is real[-1]
            number = self.program.reserve(statement)
            numbers.append(number)
            place = _Place(scope, tail and last, top and (last or not isinstance(statement, s.Call)))
            self.program.statements[number] = _STATEMENTS[type(statement)](self, statement, place, number)
        return tuple(numbers)

    # --- names

    def bind(self, scope: Scope, name: s.Name) -> str:
        unique = self.program.variables.fresh(name.text)
        scope.bound[name.text] = unique
        self.into.variables.setdefault(name.text, []).append(unique)
        return unique

    def expression(self, node: s.Expression, place: _Place) -> Expression:
        return elaborate_expression(node, place.scope, self.names)

    def needed(self, node: s.Expression, place: _Place, need: Need, by: str) -> Expression:
        return self.names.need(node, self.expression(node, place), need, by)

    # --- commands

    def observe(self, node: s.Observe, place: _Place, _: int) -> k.Statement:
        return k.Observe(elaborate_query(node.query, place.scope, self.names))

    def control(self, node: s.Control, place: _Place, number: int) -> k.Statement:
        name, arguments = self.action(node.action, place, number)
        statement = k.ControlBy(name, arguments)
        self.into.controls.append(ControlSite(node.action, statement))
        return statement

    def action(self, action: s.Action, place: _Place, number: int) -> tuple[str, tuple[Expression, ...]]:
        if isinstance(action, s.RuleBody):
            return self.inline(action, place, number)
        if isinstance(action, s.ApplyRule):
            rule = self.names.rules.get(action.rule.text)
            if rule is None:
                otherwise = f"control actions are {', '.join(each.form for each in COMMANDS.values())}"
                if self.names.rules:
                    otherwise = listed(self.names.rules, "rules")
                self.names.findings.unknown(action.rule, self.names.rules, sort="rule", otherwise=otherwise)
            else:
                check_arity(action.rule, len(action.arguments), len(rule.parameters), self.names.findings)
            by = f"rule '{action.rule.text}'"
            return action.rule.text, tuple(self.node(each, place, by) for each in action.arguments)
        arguments = tuple(self.node(each, place, action.name) for each in (*action.operands, *action.via))
        _check_way(action, arguments, self.names.findings)
        return action.name, arguments

    def node(self, node: s.Expression, place: _Place, by: str) -> Expression:
        return elaborate_node(node, place.scope, self.names, by)

    def inline(self, body: s.RuleBody, place: _Place, number: int) -> tuple[str, tuple[Expression, ...]]:
        """Return the name and the arguments of an inline rule, which is open in the variables bound there."""
        words = (
            {}
            if body.term is None
            else dict.fromkeys(
                word
                for side in (body.term.redex, body.term.reactum)
                for region in regions_of(side)
                for node in region.nodes()
                for word in (word_of(node), node.name or "")
            )
        )
        fixed = place.scope.fixed
        bound: dict[str, Expression] = {word: Literal(fixed[word]) for word in words if word in fixed}
        bound |= {
            word: Variable(unique)
            for word in words
            if (unique := place.scope.find(word)) is not None and word != HOST
        }
        parameters = tuple(SchemaParameter(f"{word}#", None) for word in bound)
        schema = elaborate_rule(body, "", parameters, dict.fromkeys(bound), self.names)
        name = f"rule#{number}"
        if schema is not None:
            self.program.schemas[name] = schema
        return name, tuple(bound.values())

    def react(self, node: s.React, place: _Place, number: int) -> k.Statement:
        cases = self.cases(node.cases, place, number, react=True)
        self.judged(node, None, node.cases, cases)
        if node.after is None:
            return k.React(cases)
        check_duration(node.after.duration, self.names.findings)
        self.program.branch(number, len(cases), node.after)
        body = self.block(node.after.body, place.scope.inner(), tail=place.tail)
        return k.React(cases, k.After(float(node.after.duration.seconds), body))

    def send(self, node: s.Send, place: _Place, _: int) -> k.Statement:
        message = self.expression(node.message, place)
        return k.Send(message, elaborate_agent(node.recipient, place.scope, self.names, "'send'"))

    def migrate(self, node: s.Migrate, place: _Place, _: int) -> k.Statement:
        host = self.node(node.host, place, "'migrate'")
        self.into.migrations.append(host)
        return k.Migrate(host)

    def spawn(self, node: s.Spawn, place: _Place, _: int) -> k.Statement:
        host, called = self.node(node.host, place, "'hosted_at'"), node.behaviour
        arguments = tuple(self.expression(each, place) for each in called.arguments)
        self.called(called)
        if node.name is None:
            hint = f"write: spawn {called.behaviour.text}0 hosted_at ... with_behavior {called.behaviour.text}(...)"
            self.names.findings.add(Code.NAMELESS_SPAWN, node, "the spawned bigActor has no name", hint)
        name = node.name.text if node.name is not None else ""
        self.into.spawns.append(SpawnSite(name, called.behaviour.text, host))
        return k.Spawn(name, host, called.behaviour.text, arguments)

    # --- internal

    def display(self, node: s.Display, place: _Place, _: int) -> k.Statement:
        return k.Display(self.expression(node.value, place))

    def let(self, node: s.Let, place: _Place, _: int) -> k.Statement:
        value = self.expression(node.value, place)
        return k.Assign(self.bind(place.scope, node.variable), value)

    def assign(self, node: s.Assign, place: _Place, _: int) -> k.Statement:
        value = self.expression(node.value, place)
        variable = place.scope.find(node.variable.text)
        if node.variable.text in place.scope.fixed:
            message = f"'{node.variable.text}' stands for the same throughout the member"
            hint = f"bind another name: let other = {node.variable.text}"
            self.names.findings.add(Code.UNBOUND_VARIABLE, node.variable, message, hint)
        elif variable is None:
            hint = self.names.findings.suggest(node.variable.text, place.scope.names())
            message = f"'{node.variable.text}' is no variable here"
            self.names.findings.add(
                Code.UNBOUND_VARIABLE,
                node.variable,
                message,
                hint or f"bind it: let {node.variable.text} = ...",
            )
            variable = self.bind(place.scope, node.variable)  # no further findings for this name
        return k.Assign(variable or "", value)

    def if_(self, node: s.If, place: _Place, _: int) -> k.Statement:
        test = self.needed(node.condition, place, CONDITION, CONDITIONAL)
        then = self.block(node.then, place.scope.inner(), tail=place.tail)
        return k.If(test, then, self.block(node.otherwise, place.scope.inner(), tail=place.tail))

    def loop(self, node: s.Loop, place: _Place, number: int) -> k.Statement:
        body = self.block(node.body, place.scope.inner(), tail=False)
        if not body:
            self.names.findings.add(
                Code.EMPTY_LOOP, node, "a loop without a statement", "give it one, or leave it out"
            )
        if place.top:
            self.into.loops.append(number)
        return k.Loop(body)

    def while_(self, node: s.While, place: _Place, _: int) -> k.Statement:
        test = self.needed(node.condition, place, CONDITION, CONDITIONAL)
        return k.While(test, self.block(node.body, place.scope.inner(), tail=False))

    def for_(self, node: s.For, place: _Place, _: int) -> k.Statement:
        members = self.needed(node.collection, place, COLLECTION, "'for'")
        rest = self.program.variables.rest()
        inner, each = place.scope.inner(), self.program.reserve(node)
        variable = self.bind(inner, node.variable)
        self.program.statements[each] = k.ForEach(variable, rest, self.block(node.body, inner, tail=False))
        return k.For(members, rest, each)

    def match(self, node: s.Match, place: _Place, number: int) -> k.Statement:
        subject = self.expression(node.subject, place)
        cases = self.cases(node.cases, place, number, react=False)
        self.judged(node.subject, subject, node.cases, cases)
        return k.Match(subject, cases)

    def choose(self, node: s.Choose, place: _Place, number: int) -> k.Statement:
        found: list[k.Block] = []
        for rank, each in enumerate(node.alternatives):
            self.program.branch(number, rank, each)
            found.append(self.block(each.body, place.scope.inner(), tail=place.tail))
        return k.Choose(tuple(found))

    def choose_from(self, node: s.ChooseFrom, place: _Place, _: int) -> k.Statement:
        members = self.needed(node.collection, place, FILLED, "'choose'")
        inner = place.scope.inner()
        variable = self.bind(inner, node.variable)
        return k.ChooseFrom(variable, members, self.block(node.body, inner, tail=place.tail))

    def call(self, node: s.Call, place: _Place, _: int) -> k.Statement:
        arguments = tuple(self.expression(each, place) for each in node.arguments)
        self.called(node)
        self.into.calls.append(CallSite(node.behaviour.text, node, place.tail, place.top))
        return k.Call(node.behaviour.text, arguments)

    def called(self, node: s.Call) -> None:
        behaviour = self.names.behaviours.get(node.behaviour.text)
        if behaviour is None:
            name = node.behaviour.text
            order = ORDERS.get(name.lower(), "define it: def name(parameters) = { ... }")
            instead = DONE.get(name, order)
            known = self.names.behaviours
            self.names.findings.unknown(node.behaviour, known, sort="behaviour", otherwise=instead)
        else:
            check_arity(node.behaviour, len(node.arguments), len(behaviour.parameters), self.names.findings)

    def judged(
        self,
        where: s.Node,
        subject: Expression | None,
        written: tuple[s.Case, ...],
        cases: tuple[k.Case, ...],
    ) -> None:
        """Record cases, to be checked when all types are known."""
        pairs = zip((each.pattern for each in written), (each.pattern for each in cases), strict=True)
        self.names.demands.append(CaseDistinction(where, subject, tuple(pairs)))

    def cases(
        self, written: tuple[s.Case, ...], place: _Place, number: int, *, react: bool
    ) -> tuple[k.Case, ...]:
        found: list[k.Case] = []
        for rank, case in enumerate(written):
            self.program.branch(number, rank, case)
            inner = place.scope.inner()
            check_distinct(case.pattern, self.names)
            note_hiding(case.pattern, self.names)
            bind = partial(self.bind, inner)
            pattern = elaborate_pattern(case.pattern, self.names, place.scope, bind, react=react)
            guard = None
            if case.guard is not None:
                tested = elaborate_expression(case.guard, inner, self.names)
                guard = self.names.need(case.guard, tested, CONDITION, CONDITIONAL)
            first = (self.program.reserve(case),) if react and guard is not None else ()
            body = self.block(case.body, inner, tail=place.tail)
            found.append(k.Case(pattern, guard, (*first, *body)))
        return tuple(found)


def check_duration(written: s.Duration, findings: Findings) -> None:
    """Report a duration that is not positive or is too long."""
    if not 0 < written.seconds <= LONGEST:
        message = f"a time limit of {written.value:g} {written.unit}"
        findings.add(Code.BAD_TIME_LIMIT, written, message, "give it more than 0 s, and at most 168 h")


def _check_way(action: s.Command, arguments: tuple[Expression, ...], findings: Findings) -> None:
    """Report a VIA that is too long, or repeats a place; `arguments` are the operands and the VIA."""
    if len(action.via) > MOST_VIA:
        message = f"a move passes {MOST_VIA} places at the most, and {len(action.via)} are named"
        findings.add(Code.BAD_WAY, action.via[MOST_VIA], message, "make two moves of it")
        return
    command = COMMANDS[action.name]
    named: dict[PlaceTerm, Expression] = dict(zip(command.operands, arguments, strict=False))
    destinations = [named.get(place) for _, place in command.open.moves]
    via = arguments[len(command.operands) :]
    for number, (place, node) in enumerate(zip(via, action.via, strict=True)):
        if place in destinations:
            message, hint = f"'{write(node)}' is where it goes", "leave it out: it comes last by itself"
        elif place in via[:number]:
            message, hint = f"'{write(node)}' is passed already", "come by a second time with another move"
        else:
            continue
        findings.add(Code.BAD_WAY, node, message, hint)


_STATEMENTS: Final[Mapping[type, Callable[[_Statements, Any, _Place, int], k.Statement]]] = {
    s.Observe: _Statements.observe,
    s.Control: _Statements.control,
    s.React: _Statements.react,
    s.Send: _Statements.send,
    s.Migrate: _Statements.migrate,
    s.Spawn: _Statements.spawn,
    s.Display: _Statements.display,
    s.Let: _Statements.let,
    s.Assign: _Statements.assign,
    s.If: _Statements.if_,
    s.Loop: _Statements.loop,
    s.While: _Statements.while_,
    s.For: _Statements.for_,
    s.Match: _Statements.match,
    s.Choose: _Statements.choose,
    s.ChooseFrom: _Statements.choose_from,
    s.Call: _Statements.call,
}
