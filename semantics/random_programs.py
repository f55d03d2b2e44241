"""Random programs from a stream of choices, such as the draws of `semantics.hypothesis_strategies`."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import (
    Apply,
    Expression,
    Host,
    Literal,
    QueryOf,
    RouteOf,
    Self,
    SetOf,
    ShortCircuit,
    TupleOf,
    Variable,
)
from semantics.behaviours.observations import QueryOperator
from semantics.behaviours.patterns import Anything, Elements, Exactly
from semantics.behaviours.patterns import Pattern as CasePattern
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import (
    After,
    Assign,
    Block,
    Call,
    Case,
    Choose,
    ChooseFrom,
    ControlBy,
    Display,
    For,
    ForEach,
    If,
    Loop,
    Match,
    Migrate,
    Observe,
    React,
    Send,
    Spawn,
    Statement,
    Tested,
    While,
)
from semantics.behaviours.values import Text, Truth, Value
from semantics.state.agents import Code
from semantics.state.signature import Name

T = TypeVar("T")

AGENT_NAMES = ("a", "b", "c", "d")
SPAWNED_NAMES = ("d", "c", "a")
Variables = tuple[str, ...]
"""The variables in scope: `o1` holds an observation, `v1` any value."""


class _Writer:
    """Draws statements and numbers them; each variable has a unique name."""

    def __init__(self, choose: Callable[[int], int], names: Sequence[Name]) -> None:
        self.choose = choose
        self.names = names
        self.statements: list[Statement] = []
        self.behaviours: dict[str, Behaviour] = {}
        self.variables = 0

    def pick(self, options: Sequence[T]) -> T:
        return options[self.choose(len(options))]

    def one(self, *options: Expression) -> Expression:
        return self.pick(options)

    def fresh(self, letter: str = "v") -> str:
        self.variables += 1
        return f"{letter}{self.variables}"

    def add(self, statement: Statement) -> int:
        self.statements.append(statement)
        return len(self.statements) - 1

    def block(self, scope: Variables, depth: int, least: int = 0) -> Block:
        """Draw a sequence of statements; later ones may read the variables of earlier ones."""
        block: list[int] = []
        for _ in range(self.pick(range(least, 4))):
            statement = self.statement(scope, depth)
            scope += (statement.variable,) if isinstance(statement, Assign) else ()
            block.append(self.add(statement))
            if isinstance(statement, Observe) and self.pick([True, False]):
                block.append(self.add(self.write_react(scope, depth - 1)))
        return tuple(block)

    def statement(self, scope: Variables, depth: int) -> Statement:
        kinds = [*_FLAT, *(_NESTED if depth > 0 else ()), *(("call", "spawn") if self.behaviours else ())]
        write: Callable[[Variables, int], Statement] = getattr(self, f"write_{self.pick(kinds)}")
        return write(scope, depth - 1)

    # expressions

    def spelled(self) -> Text:
        """Return a text that equals an entity's name."""
        return Text(self.names[0])

    def leaf(self, scope: Variables) -> Expression:
        values: list[Value] = [*self.names, Text("go"), self.spelled(), 1, Truth.TRUE]
        return self.one(*map(Variable, scope), *map(Literal, values), Host(), Self())

    def expression(self, scope: Variables) -> Expression:
        leaf = self.leaf(scope)
        seen = [Apply("nodes", (Variable(name),)) for name in scope if name.startswith("o")]
        go = TupleOf((self.one(Literal(Text("go")), Literal(self.spelled())), leaf))
        one = SetOf((leaf,))
        route = RouteOf((leaf, self.leaf(scope)))
        return self.one(leaf, go, *seen, one, Apply("first", (one,)), route)

    def name(self, scope: Variables) -> Expression:
        seen = [
            Apply("parent", (Literal(self.pick(self.names)), Variable(name)))
            for name in scope
            if name.startswith("o")
        ]
        return self.one(*map(Literal, self.names), Host(), *map(Variable, scope), *seen)

    def test(self, scope: Variables) -> Expression:
        seen = [
            Apply("in", (Literal(self.pick(self.names)), Variable(name)))
            for name in scope
            if name.startswith("o")
        ]
        same = Apply("==", (self.leaf(scope), self.leaf(scope)))
        either = [ShortCircuit(self.pick([False, True]), test, same) for test in seen]
        return self.one(*seen, same, Apply("not", (same,)), *either)

    def members(self, scope: Variables) -> Expression:
        seen = [Variable(name) for name in scope if name.startswith("o")]
        two = (Literal(self.pick(self.names)), Literal(self.pick(self.names)))
        return self.one(*seen, SetOf(two), RouteOf(two))

    def query(self, depth: int = 3) -> QueryOf:
        operator = self.pick([*QueryOperator, None]) if depth else None
        if operator is not None:
            return QueryOf(operator, self.query(depth - 1))
        if self.pick(range(4)) == 3:
            return QueryOf(None, None)
        return QueryOf(None, self.one(Host(), *map(Literal, self.names)))

    # commands

    def write_observe(self, _: Variables, __: int) -> Statement:
        return Observe(self.query())

    def write_control(self, scope: Variables, _: int) -> Statement:
        command = COMMANDS[self.pick(["MOVE_HOST_TO", "MOVE_HOST_TO", *sorted(COMMANDS)])]
        places = [Literal(name) for name in self.names if name.startswith("place")]
        to = self.one(*places, self.name(scope))
        before = [self.name(scope) for _ in command.operands[1:]]
        via = [self.name(scope) for _ in range(self.pick([0, 0, 0, 1, 2]))] if command.travels else []
        return ControlBy(command.name, (*before, to, *via))

    def write_react(self, scope: Variables, depth: int) -> Statement:
        cases = self.cases(scope, depth)
        return React(cases, After(5.0, self.block(scope, depth)) if self.pick([False, False, True]) else None)

    def write_send(self, scope: Variables, _: int) -> Statement:
        return Send(self.expression(scope), Literal(self.pick(AGENT_NAMES)))

    def write_migrate(self, scope: Variables, _: int) -> Statement:
        return Migrate(self.name(scope))

    def write_spawn(self, scope: Variables, _: int) -> Statement:
        behaviour = self.behaviours[self.pick(sorted(self.behaviours))]
        arguments = tuple(self.expression(scope) for _ in behaviour.parameters)
        return Spawn(self.pick(SPAWNED_NAMES), self.name(scope), behaviour.name, arguments)

    # internal computation

    def write_display(self, scope: Variables, _: int) -> Statement:
        return Display(self.expression(scope))

    def write_assign(self, scope: Variables, _: int) -> Statement:
        value = self.expression(scope)
        return Assign(self.fresh(), value)

    def write_match(self, scope: Variables, depth: int) -> Statement:
        otherwise = Case(Anything(), None, self.block(scope, depth))
        return Match(self.expression(scope), (*self.cases(scope, depth), otherwise))

    def cases(self, scope: Variables, depth: int) -> tuple[Case, ...]:
        return tuple(self.case(scope, depth) for _ in range(self.pick([1, 2])))

    def case(self, scope: Variables, depth: int) -> Case:
        letter = self.pick("oov")
        name = self.fresh(letter)
        message: list[CasePattern] = [
            Elements((Exactly(Text("go")), Anything(name))),
            Elements((Exactly(self.spelled()), Anything(name))),
            Anything(name, "message"),
            Anything(name),
        ]
        bound: CasePattern = Anything(name, "observation") if letter == "o" else self.pick(message)
        inside = (*scope, name)
        guard = self.test(inside) if self.pick([False, True]) else None
        tested = (self.add(Tested()),) if guard is not None else ()
        return Case(bound, guard, tested + self.block(inside, depth))

    def write_if(self, scope: Variables, depth: int) -> Statement:
        return If(self.test(scope), self.block(scope, depth), self.block(scope, depth))

    def write_while(self, scope: Variables, depth: int) -> Statement:
        return While(self.test(scope), (self.add(self.write_observe(scope, 0)), *self.block(scope, depth)))

    def write_loop(self, scope: Variables, depth: int) -> Statement:
        return Loop((self.add(self.write_react(scope, 0)), *self.block(scope, depth)))

    def write_for(self, scope: Variables, depth: int) -> Statement:
        variable = self.fresh()
        rest = f"#{variable}"
        each = self.add(ForEach(variable, rest, self.block((*scope, variable), depth)))
        return For(self.members(scope), rest, each)

    def write_choose(self, scope: Variables, depth: int) -> Statement:
        return Choose((self.block(scope, depth), self.block(scope, depth)))

    def write_choose_from(self, scope: Variables, depth: int) -> Statement:
        variable = self.fresh()
        return ChooseFrom(variable, self.members(scope), self.block((*scope, variable), depth, least=1))

    def write_call(self, scope: Variables, _: int) -> Statement:
        behaviour = self.behaviours[self.pick(sorted(self.behaviours))]
        return Call(behaviour.name, tuple(self.expression(scope) for _ in behaviour.parameters))


_FLAT = ("control", "observe", "react", "observe", "react", "control", "send", "migrate", "display", "assign")
_NESTED = ("if", "match", "for", "choose", "choose_from", "loop", "while")


def random_program(
    choose: Callable[[int], int], names: Sequence[Name], agents: int = 1
) -> tuple[Program, tuple[Code, ...]]:
    """Return a well-scoped program of all statements over these names, and the code of its agents.

    `choose(n)` returns a number below n; the constant 0 gives the simplest program. Some of a program's computations
    are faults.
    """
    writer = _Writer(choose, names)
    if choose(2):
        parameter = writer.fresh()
        writer.behaviours["helper"] = Behaviour("helper", (parameter,), writer.block((parameter,), 0))
    code = tuple(writer.block((), 2, least=1) for _ in range(agents))
    return Program(tuple(writer.statements), writer.behaviours, COMMANDS), code
