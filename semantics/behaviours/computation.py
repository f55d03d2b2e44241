"""Internal computation: one step of `fun` runs from one command, `react` or `choose` to the next.

The code that an agent has left to run is a tuple of statement numbers, the next one first. A loop that comes first is
unrolled: its jump belongs to the step before it. So the first statement is always a command, a `react`, a `choose` or
internal.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Final

from semantics.analysis.termination import assigned, ends, migrates
from semantics.behaviours.expressions import (
    EvaluationScope,
    Expression,
    Fault,
    evaluated,
    in_turn,
    members_asked,
    truth,
)
from semantics.behaviours.patterns import bind, looks_into
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.statements import (
    After,
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
from semantics.behaviours.values import Value, show, spoken
from semantics.races.provenance import NOTHING, Provenance, asking, deciding
from semantics.state.agents import Code, Store

MOST_STEPS: Final = 10_000
"""The most internal steps before a command; a longer computation counts as divergent."""


Passage = tuple[int, int]
"""A statement and the branch taken, `STEPPED` for the statement itself."""

STEPPED: Final = -1


@dataclass(slots=True)
class Process:
    """One agent's code and variables during a computation, with their provenance and its output.

    Attributes:
        program: The program.
        code: The code left to run.
        rests_on: The provenance of each statement of the code.
        scope: Its variables.
        shown: The output of `display`.
        passed: The statements and branches that it and its forks have passed; only for coverage, in no configuration.
        left: The last statement that it left.
        begun: The loops that it is in, each by the number of statements behind it. Tests in one turn of a loop do not
            affect the next.
    """

    program: Program
    code: Code
    rests_on: tuple[Provenance, ...]
    scope: EvaluationScope
    shown: list[str] = field(default_factory=list)
    passed: list[Passage] = field(default_factory=list)
    left: int = -1
    begun: frozenset[int] = frozenset()

    @property
    def next(self) -> Statement | None:
        """The next statement, None if no code is left."""
        return self.program.statements[self.code[0]] if self.code else None

    def leave(self) -> Provenance:
        """Drop the first statement and return its provenance."""
        here, self.rests_on = self.rests_on[0], self.rests_on[1:]
        self.left, self.code = self.code[0], self.code[1:]
        self.begun -= {len(self.code)}
        return here

    def took(self, branch: int) -> None:
        """Record the branch taken of the statement left last."""
        self.passed.append((self.left, branch))

    def enter(self, block: Block, rests_on: Provenance) -> None:
        """Prepend a block to the code."""
        self.code = block + self.code
        self.rests_on = (rests_on,) * len(block) + self.rests_on

    def turn(self, body: Block, here: Provenance) -> None:
        """Prepend the body of the loop that comes next, and mark the loop as begun."""
        self.begun |= {len(self.code) - 1}
        self.enter(body, here)

    def passing(self, tests: Provenance) -> None:
        """Add tests to the provenance of all code except loops that have begun."""
        if tests:
            behind = range(len(self.code) - 1, -1, -1)
            kept = zip(self.rests_on, behind, strict=True)
            self.rests_on = tuple(each if rank in self.begun else each | tests for each, rank in kept)

    def might(self, ways: Iterable[Block], tests: Provenance, *, waits: bool = False) -> None:
        """Record the control dependence on tests whose other answers lead to one of these alternatives.

        If an alternative may not end, or the agent would wait, all remaining code depends on the tests. Otherwise only
        the variables and the host that an alternative may change do.
        """
        if not tests:
            return
        blocks = tuple(ways)
        if waits or not all(ends(self.program, block) for block in blocks):
            self.passing(tests)
        scope = self.scope
        for name in frozenset[str]().union(*(assigned(self.program, block) for block in blocks)):
            if name in scope.store:
                scope.rests_on[name] = scope.rests_on.get(name, NOTHING) | tests
        if any(migrates(self.program, block) for block in blocks):
            scope.placed |= tests

    def unroll(self) -> None:
        """Take the jumps of loops that come next.

        Raises:
            Fault: A loop jumps for ever.
        """
        jumps = 0
        while isinstance(loop := self.next, Loop):
            self.turn(loop.body, self.rests_on[0])
            jumps += 1
            if jumps > MOST_STEPS or not loop.body:
                raise Fault("a loop without a command runs for ever", diverges=True)

    def evaluate(self, expression: Expression) -> tuple[Value, Provenance]:
        """Return the value of an expression with its provenance."""
        return evaluated(expression, self.scope)

    def members(self, expression: Expression) -> tuple[tuple[Value, ...], Provenance]:
        """Return the members to iterate over, with their provenance: for an observation, the question for its names."""
        value, rests_on = self.evaluate(expression)
        return members_of(value), asking(rests_on, members_asked(value))

    def variables(self) -> tuple[Store, tuple[Provenance, ...]]:
        """Return the variables that the code may read or that properties watch, sorted, with their provenance.

        A variable that is only watched has no provenance.
        """
        live, scope = self.program.live(self.code), self.scope
        alive = sorted(live.union(*scope.kept.values()).intersection(scope.store))
        store = tuple((name, scope.store[name]) for name in alive)
        return store, tuple(scope.rests_on.get(name, NOTHING) if name in live else NOTHING for name in alive)

    def fork(self) -> "Process":
        """Return an independent copy."""
        scope = self.scope
        copy = replace(scope, store=dict(scope.store), rests_on=dict(scope.rests_on), used=NOTHING)
        return replace(self, scope=copy, shown=list(self.shown))


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
    for member in dict.fromkeys(members):  # a route may contain one twice
        chosen = process.fork()
        chosen.scope.binding({statement.variable: member}, rests_on)
        chosen.enter(statement.body, chosen.leave() | deciding(rests_on))
        chosen.took(0)
        yield chosen


def members_of(value: Value) -> tuple[Value, ...]:
    """Return the members for a `for` or `choose`: the stops of a route, or the members of a set or an observation.

    Raises:
        Fault: The value is none of these.
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
            process.shown.append(spoken(value))
            process.leave()
        case If(test, then, otherwise):
            value, rests_on = process.evaluate(test)
            chosen, tests = truth(value), deciding(rests_on)
            here = process.leave()
            process.might((otherwise if chosen else then,), tests)
            process.enter(then if chosen else otherwise, here | tests)
            process.took(0 if chosen else 1)
        case While(test, body):
            _step_while(process, test, body)
        case For(members, rest, each):
            found, rests_on = process.members(members)
            here, tests = process.leave(), deciding(rests_on)
            process.might(((each,),), tests)
            process.scope.binding({rest: found}, here | rests_on)
            process.enter((each,), here | tests)
        case ForEach(variable, rest, body):
            _step_for(process, variable, rest, body)
        case Match(expression, cases):
            value, rests_on = process.evaluate(expression)
            asked = deciding(rests_on) if look_into(cases) else NOTHING
            if not enter_case(process, cases, value, rests_on, asked, () if _takes_all(cases) else None):
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
        process.turn(body, here | deciding(rests_on))
        return
    process.leave()
    process.might((body,), deciding(rests_on), waits=True)  # the code behind runs only since the test failed


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
    process.turn(body, here)


def enter_case(
    process: Process,
    cases: tuple[Case, ...],
    value: Value,
    rests_on: Provenance,
    asked: Provenance,
    otherwise: Block | None,
) -> bool:
    """Leave a `match` or `react` for the first case whose pattern and guard take a value; False if none does.

    The body depends on the tests in `asked`, which led to the value, and on the guards tried. The variables of the
    pattern depend on the provenance of the value.

    The code behind depends on these tests if another answer would have led elsewhere (`Process.might`): to another
    case, or to `otherwise` if no case takes the value. Without `otherwise` the agent waits.
    """
    rank, tried = first_fitting(process, cases, value, rests_on)
    if rank is None:
        return False
    there = process.leave()
    here = there.union(asked, *(tests for _, tests in tried))
    process.scope.binding(bind(cases[rank].pattern, value) or {}, rests_on)
    rest = () if otherwise is None else (otherwise,)
    others = [case.body for case in cases if case is not cases[rank]] if look_into(cases) else []
    process.might((*others, *rest), asked - there, waits=otherwise is None)  # else the value may not come
    for each, tests in tried:
        if each == rank:
            after = _fitting(cases[rank + 1 :], value)
            waits = otherwise is None and all(case.guard is not None for case in after)
            process.might((*(case.body for case in after), *rest), tests, waits=waits)
        else:
            process.might((cases[each].body,), tests)
    process.enter(cases[rank].body, here)
    process.took(rank)
    return True


def look_into(cases: tuple[Case, ...]) -> bool:
    """Whether the choice of a case depends on the value, apart from guards."""
    return any(looks_into(case.pattern) for case in cases)


def _takes_all(cases: tuple[Case, ...]) -> bool:
    return any(case.guard is None and not looks_into(case.pattern) for case in cases)


def _fitting(cases: tuple[Case, ...], value: Value) -> list[Case]:
    """Return the cases that may take a value, up to the first that certainly does."""
    found: list[Case] = []
    for case in cases:
        if bind(case.pattern, value) is not None:
            found.append(case)
            if case.guard is None:
                break
    return found


Tried = tuple[tuple[int, Provenance], ...]
"""The guards tried: the rank of each case, and the provenance of its guard."""


def give_up(process: Process, cases: tuple[Case, ...], after: After, refused: Tried) -> None:
    """Leave a `react` for its `after` branch, given the guards that refused all values."""
    here = process.leave()
    for rank, tests in refused:
        process.might((cases[rank].body,), tests)
        here |= tests
    process.enter(after.body, here)


def first_fitting(
    process: Process, cases: tuple[Case, ...], value: Value, rests_on: Provenance
) -> tuple[int | None, Tried]:
    """Return the rank of the first case whose pattern and guard take a value, and the guards tried."""
    tried: list[tuple[int, Provenance]] = []
    for rank, case in enumerate(cases):
        binding = bind(case.pattern, value)
        if binding is None:
            continue
        if case.guard is not None:
            trial = process.fork()
            trial.scope.binding(binding, rests_on)
            verdict, guard = trial.evaluate(case.guard)
            tried.append((rank, deciding(guard)))
            if not truth(verdict):
                continue
        return rank, tuple(tried)
    return None, tuple(tried)


def bind_parameters(
    process: Process, behaviour: Behaviour, arguments: Iterable[Expression], here: Provenance
) -> None:
    """Bind a behaviour's parameters to the values of the arguments, all evaluated first."""
    values = [process.evaluate(argument) for argument in arguments]
    for parameter, (value, rests_on) in zip(behaviour.parameters, values, strict=True):
        process.scope.binding({parameter: value}, rests_on | here)
