"""Termination: the blocks of a program that certainly end, and their possible effects; static.

The code behind a test depends on it if another answer leads to a block that may wait or loop forever.

Requests are assumed to be served. So a `react` certainly ends if an observation was requested before it in the same
block, and a case without a guard takes any observation. A message may never come. A `while` certainly ends if it counts
up to a constant.
"""

from collections.abc import Iterable
from functools import lru_cache

from semantics.analysis.traversal import reachable
from semantics.behaviours.expressions import Apply, Expression, Literal, Variable
from semantics.behaviours.patterns import Anything, Pattern
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Assign,
    Block,
    Call,
    Case,
    Choose,
    ChooseFrom,
    For,
    ForEach,
    If,
    Loop,
    Match,
    Migrate,
    Observe,
    React,
    Statement,
    While,
)

Calls = frozenset[str]
NONE: Calls = frozenset()


@lru_cache(maxsize=1 << 12)
def ends(program: Program, block: Block) -> bool:
    """Whether a block certainly ends, for any results of its tests."""
    return _behind(program, block, 0, NONE) is not None


@lru_cache(maxsize=1 << 12)
def assigned(program: Program, block: Block) -> frozenset[str]:
    """Return the variables that a block may assign."""
    found = (program.statements[number] for number in reachable(program, block))
    return frozenset(each.variable for each in found if isinstance(each, Assign))


@lru_cache(maxsize=1 << 12)
def migrates(program: Program, block: Block) -> bool:
    """Whether a block may request a migration."""
    return any(isinstance(program.statements[number], Migrate) for number in reachable(program, block))


def _behind(program: Program, block: Block, owed: int, calls: Calls) -> int | None:
    """Return how many observations are certainly still to be received behind a block, None if it may not end.

    `owed` is the number before the block; `calls` are the behaviours that enclose it.
    """
    left: int | None = owed
    for number in block:
        if left is None:
            return None
        left = _passed(program, program.statements[number], left, calls)
    return left


def _passed(program: Program, statement: Statement, owed: int, calls: Calls) -> int | None:
    match statement:
        case Observe():
            return owed + 1
        case React():
            return _received(program, statement, owed, calls)
        case If(_, then, otherwise):
            return _least(_behind(program, block, owed, calls) for block in (then, otherwise))
        case Match(_, cases):
            return _least(_behind(program, case.body, owed, calls) for case in cases)
        case Choose(alternatives):
            return _least(_behind(program, block, owed, calls) for block in alternatives)
        case ChooseFrom(_, _, body):
            return _behind(program, body, owed, calls)
        case For(_, _, each):
            return _passed(program, program.statements[each], owed, calls)
        case ForEach(_, _, body):
            return _repeated(program, body, owed, calls)
        case While(test, body):
            return _repeated(program, body, owed, calls) if counts_up(program, test, body) else None
        case Loop():
            return None
        case Call(behaviour):
            inside = calls | {behaviour}
            body = program.behaviours[behaviour].body
            return None if behaviour in calls else _behind(program, body, owed, inside)
        case _:
            return owed


def _received(program: Program, react: React, owed: int, calls: Calls) -> int | None:
    """Return the number owed behind a `react`."""
    surely = owed > 0 and any(each.guard is None and _is_any(each.pattern) for each in react.cases)
    if react.after is None and not surely:
        return None
    ways = [_taken(program, case, owed, calls) for case in react.cases]
    return _least(
        [*ways, *([] if react.after is None else [_behind(program, react.after.body, owed, calls)])]
    )


def _taken(program: Program, case: Case, owed: int, calls: Calls) -> int | None:
    is_observation = isinstance(case.pattern, Anything) and case.pattern.of != "message"
    return _behind(program, case.body, max(owed - is_observation, 0), calls)


def _is_any(pattern: Pattern) -> bool:
    return isinstance(pattern, Anything) and pattern.of != "message"


def _repeated(program: Program, body: Block, owed: int, calls: Calls) -> int | None:
    """Return the number owed behind any number of turns."""
    once = _behind(program, body, owed, calls)
    if once is None or once >= owed:
        return None if once is None else owed
    return None if _behind(program, body, 0, calls) is None else 0


def _least(ways: Iterable[int | None]) -> int | None:
    found = list(ways)
    return None if None in found else min(each for each in found if each is not None)


def counts_up(program: Program, test: Expression, body: Block) -> bool:
    """Whether each turn of a loop adds to a number that its test keeps below a constant."""
    match test:
        case Apply("<" | "<=", (Variable(name), Literal(int()))):
            ups = [number for number in body if _is_step(program.statements[number], name)]
            reach = reachable(program, body)
            given = [n for n in reach if getattr(program.statements[n], "variable", None) == name]
            return bool(ups) and set(given) == set(ups)
        case _:
            return False


def _is_step(statement: Statement, name: str) -> bool:
    match statement:
        case Assign(variable, Apply("+", (Variable(read), Literal(int(number))))):
            return variable == read == name and number > 0
        case _:
            return False


def begun_loops(program: Program, code: Block) -> tuple[int, ...]:
    """Return the loops in whose first turn the code begins, each by the number of statements behind it, sorted."""
    numbered = enumerate(code)
    begun = (at for at, number in numbered if _is_first_turn(program, program.statements[number], code[:at]))
    return tuple(sorted(len(code) - 1 - at for at in begun))


def _is_first_turn(program: Program, loop: Statement, before: Block) -> bool:
    return isinstance(loop, Loop) and before == _unrolled(program, loop.body)


def _unrolled(program: Program, block: Block) -> Block:
    first = program.statements[block[0]] if block else None
    return _unrolled(program, first.body) + block if isinstance(first, Loop) else block
