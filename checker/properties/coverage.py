"""Coverage: the statements, branches and clauses of a mission that no run reaches.

It is a pure function of the mission and its visited parts, independent of the engine.
"""

from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from itertools import chain
from typing import Final

from checker.properties.visited_statements import Visited, passages
from semantics.behaviours.computation import STEPPED, Passage
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Block,
    Call,
    Choose,
    ChooseFrom,
    ControlBy,
    For,
    ForEach,
    If,
    Loop,
    Match,
    React,
    Spawn,
    Statement,
    Tested,
    While,
    branches,
    inner_blocks,
)
from semantics.fixpoints import closure
from semantics.state.configuration import Configuration


@dataclass(frozen=True, slots=True)
class CoverageCount:
    """The number of reached items, and of all items."""

    reached: int
    of: int


@dataclass(frozen=True, slots=True)
class Gap:
    """A part of the mission that no run reaches.

    Attributes:
        line: Its first line, from 1; 0 if unknown.
        sort: `statement`, `branch`, `behaviour`, `rule` or `clause`.
        message: A sentence about it.
    """

    line: int
    sort: str
    message: str


@dataclass(frozen=True, slots=True)
class Coverage:
    """The reached parts of a mission's text.

    Attributes:
        complete: Whether everything reachable was visited; else a gap is only unreached so far.
        statements: The reached statements.
        branches: The reached cases, alternatives and outcomes of tests.
        rules: The used rules of the mission's own.
        clauses: The clauses of the environment that happened.
        lines: The lines with a reached part, in order.
        unreached: The lines with statements, cases or clauses, none of them reached.
        gaps: The unreached parts, from the top of the text; one within another is left out.
    """

    complete: bool
    statements: CoverageCount
    branches: CoverageCount
    rules: CoverageCount
    clauses: CoverageCount
    lines: tuple[int, ...]
    unreached: tuple[int, ...]
    gaps: tuple[Gap, ...]


def coverage(initial: Configuration, visited: Visited, *, complete: bool) -> Coverage:
    """Return the coverage of a mission with this initial configuration."""
    setting = initial.setting
    found = reached(initial, visited)
    happened = [not visited.happened.isdisjoint(clause.words) for clause in setting.environment]
    clauses = tuple(zip(setting.clause_lines, happened, strict=False))
    lines = [*found.lines(), *clauses]
    met = {line for line, was in lines if was}
    starts = [initial.alpha.code(a) for a in initial.alpha.names()]
    missing = (Gap(line, "clause", "this never happens") for line, was in clauses if not was)
    gaps = {*found.gaps(starts), *found.idle(), *missing}
    return Coverage(
        complete,
        CoverageCount(len(found.written & found.numbers), len(found.written)),
        CoverageCount(len(found.taken), len(found.branches)),
        CoverageCount(len(found.rules & found.used), len(found.rules)),
        CoverageCount(sum(happened), len(happened)),
        tuple(sorted(met - {0})),
        tuple(sorted({line for line, _ in lines} - met - {0})),
        tuple(sorted(gaps, key=lambda gap: (gap.line, gap.sort, gap.message))),
    )


def reached(initial: Configuration, visited: Visited) -> "ProgramCoverage":
    """Return the reached parts of the program, from the agents' positions and their executed statements."""
    setting = initial.setting
    computed = {passage for moment in visited.moments for passage in passages(setting, moment)}
    passed = computed | visited.passed
    stood = {code[0] for codes in visited.codes.values() for code in codes if code}
    stepped = {number for number, branch in passed if branch == STEPPED}
    numbers, first = _with_loops(setting.program, stood | stepped), setting.program.copies
    taken = frozenset((first.get(number, number), rank) for number, rank in passed if rank != STEPPED)
    return ProgramCoverage(setting.program, frozenset(first.get(number, number) for number in numbers), taken)


def _with_loops(program: Program, reached: Set[int]) -> frozenset[int]:
    """Add the entered loops; a jump into a loop belongs to the step that reaches its body."""
    found = set(reached)
    loops = [(number, s) for number, s in enumerate(program.statements) if isinstance(s, Loop) and s.body]
    for number, loop in reversed(loops):  # inner ones have the higher numbers
        if loop.body[0] in found:
            found.add(number)
    return frozenset(found)


_NOTHING_FITS: Final[Mapping[type, str]] = {
    React: "no case of this react is ever taken: it waits for ever",
    Match: "no case of this match is ever taken",
}


def _inside(program: Program, block: Block) -> frozenset[int]:
    """Return the numbers of the statements of a block, nested ones included."""
    statements = program.statements
    return closure(
        block, lambda number: chain.from_iterable(each.block for each in inner_blocks(statements[number]))
    )


class ProgramCoverage:
    """A program with its reached statements and taken branches; the text of a family counts once."""

    def __init__(self, program: Program, numbers: frozenset[int], taken: frozenset[Passage]) -> None:
        self.program, self.numbers, self.taken = program, numbers, taken
        statements = [(n, s) for n, s in enumerate(program.statements) if n not in program.copies]
        self.written = frozenset(n for n, s in statements if not isinstance(s, Tested | ForEach))
        self.branches = [(n, rank) for n, s in statements for rank in range(len(branches(s)))]
        self.rules = frozenset(name for sort, name in program.declared if sort == "rule")
        at = (program.statements[number] for number in numbers)
        self.used = frozenset(each.name for each in at if isinstance(each, ControlBy))

    def lines(self) -> list[tuple[int, bool]]:
        """Return the lines of statements and of cases, each with whether it was reached."""
        program = self.program
        stated = [(program.line(number), number in self.numbers) for number in sorted(self.written)]
        lines = sorted(program.branch_lines.items())
        begun = [(line, branch in self.taken) for branch, line in lines if branch[0] not in program.copies]
        return stated + begun

    def gaps(self, starts: Iterable[Block]) -> Iterator[Gap]:
        """Yield the gaps of agents' bodies and of behaviours."""
        for start in starts:
            yield from self.within(tuple(number for number in start if number not in self.program.copies))
        called = self.called()
        for name, behaviour in sorted(self.program.behaviours.items()):
            if behaviour.body and behaviour.body[0] not in self.numbers:
                if name in called:
                    continue  # its call is a gap already
                line = self.program.declared.get(("behaviour", name), self.program.line(behaviour.body[0]))
                yield Gap(line, "behaviour", f"behaviour '{name}' is never run")
            else:
                yield from self.within(behaviour.body)

    def called(self) -> frozenset[str]:
        """Return the behaviours that the agents' text calls, directly or through others."""
        program = self.program
        calls = [
            (number, statement.behaviour)
            for number, statement in enumerate(program.statements)
            if isinstance(statement, Call | Spawn)
        ]
        within = {
            number: name
            for name, behaviour in program.behaviours.items()
            for number in _inside(program, behaviour.body)
        }
        first = (name for number, name in calls if number not in within)
        return closure(first, lambda caller: (name for number, name in calls if within.get(number) == caller))

    def idle(self) -> Iterator[Gap]:
        """Yield the mission's rules that no control names."""
        named = {each.name for each in self.program.statements if isinstance(each, ControlBy)}
        for name in self.rules - self.used - named:
            yield Gap(self.program.declared["rule", name], "rule", f"rule '{name}' is never used")

    def within(self, block: Block) -> Iterator[Gap]:
        """Yield the gaps of a block; its first unreached statement stands for the rest."""
        for number in block:
            if number not in self.numbers:
                yield Gap(self.program.line(number), "statement", "this is never reached")
                return
            statement = self.program.statements[number]
            if isinstance(statement, Loop):
                yield from self.within(statement.body)
            elif isinstance(statement, React | Match) and self.is_end(number, statement):
                yield self.end(number, statement)
                return
            else:
                yield from self.below(number, statement)

    def is_end(self, number: int, statement: Statement) -> bool:
        """Return whether no run continues after this statement."""
        ranks = range(len(branches(statement)))
        return bool(ranks) and not any((number, rank) in self.taken for rank in ranks)

    def end(self, number: int, statement: Statement) -> Gap:
        """Return the single gap of a statement after which no run continues."""
        if len(branches(statement)) == 1:
            return self.untaken(number, statement, 0)
        return Gap(self.program.line(number), "statement", _NOTHING_FITS[type(statement)])

    def below(self, number: int, statement: Statement) -> Iterator[Gap]:
        """Yield the gaps of a statement's branches."""
        if isinstance(statement, For):
            yield from self.below(statement.each, self.program.statements[statement.each])
        for rank, block in enumerate(branches(statement)):
            if (number, rank) in self.taken:
                yield from self.within(block)
            else:
                yield self.untaken(number, statement, rank)

    def untaken(self, number: int, statement: Statement, rank: int) -> Gap:
        """Return the gap of a branch: a case at its own line, an outcome at the line of its test."""
        if isinstance(statement, React | Match | Choose):
            sort = "alternative" if isinstance(statement, Choose) else "case"
            if isinstance(statement, React) and rank == len(statement.cases):
                sort = "'after' branch"
            return Gap(self.program.branch_line(number, rank), "branch", f"this {sort} is never taken")
        message = {
            (If, 0): "this condition is never true",
            (If, 1): "this condition is never false",
            (While, 0): "this condition is never true",
            (ForEach, 0): "the collection to go through is always empty",
            (ChooseFrom, 0): "the collection to choose from is always empty",
        }[type(statement), rank]
        return Gap(self.program.line(number), "branch", message)
