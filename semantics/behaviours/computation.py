"""Internal computation: one step of `fun` runs from one command, `react` or `choose` to the next.

What is left of an agent to run is a tuple of statement numbers, the next one first. Loops unroll when they come first
(their jump belongs to the step they stand before), so the first statement is always a command, a `react`, a `choose`
or internal.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Final

from semantics.behaviours.expressions import (
    Expression,
    Fault,
    Scope,
    evaluated,
    in_turn,
    members_asked,
    truth,
)
from semantics.behaviours.patterns import bind
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import (
    Assign,
    Block,
    Call,
    Case,
    Choice,
    Choose,
    Display,
    For,
    ForEach,
    If,
    Internal,
    Loop,
    Match,
    Statement,
    Tested,
    While,
)
from semantics.behaviours.values import Value, show
from semantics.races.provenance import NOTHING, Provenance, asking, deciding
from semantics.state.agents import Code, Store

MOST_STEPS: Final = 10_000
"""Internal steps after which a computation that reached no command is said to diverge."""


LOOPS: Final = (Loop, While, ForEach)
"""Statements that come again: what one turn had to pass says nothing of the next, which looks anew."""


Passage = tuple[int, int]
"""A statement and which of its branches was taken, `STEPPED` for the statement itself."""

STEPPED: Final = -1


@dataclass(slots=True)
class Process:
    """One agent's code and variables while it computes, with what each rests on, and what it displays.

    Attributes:
        program: What it runs.
        code: What is left of it to run.
        rests_on: What each statement that is left rests on.
        scope: Its variables.
        shown: What it has displayed.
        passed: What it and its forks have stepped over, and which branches they took: for coverage alone, and in no
            configuration.
        left: The statement that it has left last.
    """

    program: Program
    code: Code
    rests_on: tuple[Provenance, ...]
    scope: Scope
    shown: list[str] = field(default_factory=list)
    passed: list[Passage] = field(default_factory=list)
    left: int = -1

    @property
    def next(self) -> Statement | None:
        """The statement that comes next, None where nothing is left."""
        return self.program.statements[self.code[0]] if self.code else None

    def leave(self) -> Provenance:
        """Drop the first statement and return what got the agent there."""
        here, self.rests_on = self.rests_on[0], self.rests_on[1:]
        self.left, self.code = self.code[0], self.code[1:]
        return here

    def took(self, branch: int) -> None:
        """Note which branch is taken of the statement that was left last."""
        self.passed.append((self.left, branch))

    def enter(self, block: Block, rests_on: Provenance) -> None:
        """Put a block before what is left."""
        self.code = block + self.code
        self.rests_on = (rests_on,) * len(block) + self.rests_on

    def passing(self, tests: Provenance) -> None:
        """Let the rest of the program depend on the tests that led there; the next iteration of a loop does not."""
        if tests:
            turns = (isinstance(self.program.statements[number], LOOPS) for number in self.code)
            kept = zip(self.rests_on, turns, strict=True)
            self.rests_on = tuple(each if turn else each | tests for each, turn in kept)

    def unroll(self) -> None:
        """Take the jumps of loops that come next.

        Raises:
            Fault: A loop jumps for ever.
        """
        jumps = 0
        while isinstance(loop := self.next, Loop):
            number, here = self.code[0], self.leave()
            self.enter((*loop.body, number), here)
            jumps += 1
            if jumps > MOST_STEPS or not loop.body:
                raise Fault("a loop without a command runs for ever", diverges=True)

    def evaluate(self, expression: Expression) -> tuple[Value, Provenance]:
        """Return a value with what it rests on."""
        return evaluated(expression, self.scope)

    def members(self, expression: Expression) -> tuple[tuple[Value, ...], Provenance]:
        """Return what to go through, with what it rests on: of an observation, which names it showed."""
        value, rests_on = self.evaluate(expression)
        return members_of(value), asking(rests_on, members_asked(value))

    def variables(self) -> tuple[Store, tuple[Provenance, ...]]:
        """Return the variables that what is left may read or that are watched, sorted, with what each rests on.

        Nothing rests on what is only watched.
        """
        live, scope = self.program.live(self.code), self.scope
        alive = sorted(live.union(*scope.kept.values()).intersection(scope.store))
        store = tuple((name, scope.store[name]) for name in alive)
        return store, tuple(scope.rests_on.get(name, NOTHING) if name in live else NOTHING for name in alive)

    def fork(self) -> "Process":
        """Return an independent copy."""
        scope = self.scope
        copy = replace(scope, store=dict(scope.store), rests_on=dict(scope.rests_on), used=NOTHING)
        return Process(self.program, self.code, self.rests_on, copy, list(self.shown), self.passed, self.left)


def compute(process: Process) -> Iterator[Process]:
    """Yield the process after all internal computation up to the next command, `react` or `choose`.

    A `choose` that comes first gives one successor for each alternative.

    Raises:
        Fault: The computation fails, or reaches no command within `MOST_STEPS`.
    """
    statement = process.next
    starts = list(_choose(process, statement)) if isinstance(statement, Choice) else [process]
    for start in starts:
        for _ in range(MOST_STEPS):
            start.unroll()
            following = start.next
            if following is None or not isinstance(following, Internal):
                break
            start.passed.append((start.code[0], STEPPED))
            _step(start, following)
        else:
            raise Fault(f"no command is reached within {MOST_STEPS} internal steps", diverges=True)
        yield start


def _choose(process: Process, statement: Choice) -> Iterator[Process]:
    if isinstance(statement, Choose):
        for rank, block in enumerate(statement.alternatives):
            chosen = process.fork()
            chosen.enter(block, chosen.leave())
            chosen.took(rank)
            yield chosen
        return
    members, rests_on = process.members(statement.members)
    if not members:
        raise Fault("there is nothing to choose from")
    for member in dict.fromkeys(members):  # a route may pass one twice
        chosen = process.fork()
        chosen.scope.binding({statement.variable: member}, rests_on)
        chosen.enter(statement.body, chosen.leave() | deciding(rests_on))
        chosen.took(0)
        yield chosen


def members_of(value: Value) -> tuple[Value, ...]:
    """Return what a `for` or `choose` goes through: the stops of a route, or the members of a set or an observation.

    Raises:
        Fault: It is none of these.
    """
    try:
        return in_turn(value)
    except TypeError as error:
        raise Fault(f"{error}, not {show(value)}") from error


def _step(process: Process, statement: Internal) -> None:
    match statement:
        case Tested():
            process.leave()
        case Assign(variable, expression):
            value, rests_on = process.evaluate(expression)
            process.scope.binding({variable: value}, rests_on | process.leave())
        case Display(expression):
            value, _ = process.evaluate(expression)
            process.shown.append(show(value))
            process.leave()
        case If(test, then, otherwise):
            value, rests_on = process.evaluate(test)
            chosen = truth(value)
            process.enter(then if chosen else otherwise, process.leave() | deciding(rests_on))
            process.took(0 if chosen else 1)
        case While(test, body):
            _step_while(process, test, body)
        case For(members, rest, each):
            found, rests_on = process.members(members)
            here = process.leave()
            process.scope.binding({rest: found}, here | rests_on)
            process.enter((each,), here | deciding(rests_on))
        case ForEach(variable, rest, body):
            _step_for(process, variable, rest, body)
        case Match(expression, cases):
            value, rests_on = process.evaluate(expression)
            here = process.leave() | deciding(rests_on)
            if not enter_case(process, cases, value, rests_on, here):
                raise Fault(f"no case of 'match' takes {show(value)}")
        case Call(behaviour, arguments):
            called = process.program.behaviours[behaviour]
            here = process.leave()
            bind_parameters(process, called, arguments, here)
            process.enter(called.body, here)


def _step_while(process: Process, test: Expression, body: Block) -> None:
    value, rests_on = process.evaluate(test)
    here = process.rests_on[0]
    if truth(value):
        process.passed.append((process.code[0], 0))
        process.enter(body, here | deciding(rests_on))
        return
    process.leave()
    process.passing(deciding(rests_on))  # what follows runs only because the test failed


def _step_for(process: Process, variable: str, rest: str, body: Block) -> None:
    members = process.scope.store[rest]
    here = process.rests_on[0]
    if not isinstance(members, tuple) or not members:
        process.leave()
        return
    process.scope.binding(
        {variable: members[0], rest: members[1:]}, here | process.scope.rests_on.get(rest, NOTHING)
    )
    process.passed.append((process.code[0], 0))
    process.enter(body, here)


def enter_case(
    process: Process,
    cases: tuple[Case, ...],
    value: Value,
    rests_on: Provenance,
    here: Provenance,
    *,
    goes_on: bool = False,
) -> bool:
    """Enter the body of the first case whose pattern and guard take a value; False where none does.

    The body rests on the guards that were tried; what the pattern binds, on what the value rests on. What follows rests
    on the guards too, unless it `goes_on` without them.
    """
    rank, tests = first_fitting(process, cases, value, rests_on)
    if rank is None:
        return False
    process.scope.binding(bind(cases[rank].pattern, value) or {}, rests_on)
    if not goes_on and not any(
        each.guard is None and bind(each.pattern, value) is not None for each in cases
    ):
        process.passing(tests - here)
    process.enter(cases[rank].body, here | tests)
    process.took(rank)
    return True


def first_fitting(
    process: Process, cases: tuple[Case, ...], value: Value, rests_on: Provenance
) -> tuple[int | None, Provenance]:
    """Return the rank of the first case whose pattern and guard take a value, and the guards that were tried."""
    tests = NOTHING
    for rank, case in enumerate(cases):
        binding = bind(case.pattern, value)
        if binding is None:
            continue
        if case.guard is not None:
            trial = process.fork()
            trial.scope.binding(binding, rests_on)
            verdict, guard = trial.evaluate(case.guard)
            tests |= deciding(guard)
            if not truth(verdict):
                continue
        return rank, tests
    return None, tests


def bind_parameters(
    process: Process, behaviour: Behaviour, arguments: Iterable[Expression], here: Provenance
) -> None:
    """Give a behaviour's parameters the values of the arguments, all evaluated before."""
    values = [process.evaluate(argument) for argument in arguments]
    for parameter, (value, rests_on) in zip(behaviour.parameters, values, strict=True):
        process.scope.binding({parameter: value}, rests_on | here)
