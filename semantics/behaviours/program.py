"""A program: the numbered statements of a mission, and the variables that it keeps."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Protocol

from semantics.behaviours.expressions import Expression, QueryOf, free
from semantics.behaviours.patterns import variables
from semantics.behaviours.statements import (
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
    While,
    branches,
)
from semantics.state.agents import written
from semantics.state.signature import Name

if TYPE_CHECKING:
    from semantics.behaviours.reaction_rules import Reaction

Names = frozenset[str]
NONE: Names = frozenset()


@dataclass(frozen=True, slots=True)
class Behaviour:
    """`def name(parameters) = { body }`; the parameters' names are unique in the whole program."""

    name: str
    parameters: tuple[str, ...]
    body: Block


@dataclass(frozen=True, slots=True)
class VariableOf:
    """`a.x`: the last value that bigActor a assigned to a variable written x.

    Attributes:
        agent: The bigActor.
        variables: All its variables with that written name, sorted; each binding is a separate variable.
    """

    agent: Name
    variables: tuple[str, ...]

    @property
    def key(self) -> str:
        """The name under which its value is kept: its own, or a shared one for several with the same written name."""
        return self.variables[0] if len(self.variables) == 1 else f"{written(self.variables[0])}#"

    def __str__(self) -> str:
        return f"{self.agent}.{written(self.variables[0])}"


class ReactionMaker(Protocol):
    """A command or a rule of a mission."""

    def __call__(self, host: Name, *arguments: Name) -> "Reaction":
        """Return R ⇒ R'."""

    def made_from(self, reaction: "Reaction", host: Name) -> tuple[Name, ...] | None:
        """Return the host and the arguments of a reaction, None if another command or rule made it.

        Args:
            reaction: The reaction.
            host: The host, in case the reaction does not depend on it.
        """


@dataclass(frozen=True, eq=False)
class Program:
    """All statements of a mission, by number.

    Attributes:
        statements: The statements.
        behaviours: The parametrised behaviours.
        reactions: Commands and named rules: from the host and the arguments to a `Reaction`, and back.
        lines: The line of each statement in the mission's text (from 1), if it has one.
        branch_lines: The lines of cases and alternatives, by statement and rank.
        declared: The line of each declaration, by sort (`rule`, `behaviour`) and name.
        bodies: The initial code of each declared bigActor.
        homes: The initial host of each declared bigActor.
        copies: For each statement of a family's later members, the statement of the first member that it repeats.
        watched: The variables that properties mention; they are kept to the end of the run.
    """

    statements: tuple[Statement, ...] = ()
    behaviours: Mapping[str, Behaviour] = field(default_factory=dict)
    reactions: Mapping[str, "ReactionMaker"] = field(default_factory=dict)
    lines: tuple[int, ...] = ()
    branch_lines: Mapping[tuple[int, int], int] = field(default_factory=dict)
    declared: Mapping[tuple[str, str], int] = field(default_factory=dict)
    bodies: Mapping[Name, Block] = field(default_factory=dict)
    homes: Mapping[Name, Name] = field(default_factory=dict)
    copies: Mapping[int, int] = field(default_factory=dict)
    watched: frozenset[VariableOf] = frozenset()

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields only: the cached functions can't be sent to another process."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    def line(self, number: int) -> int:
        """Return the line of a statement, 0 if it has none."""
        return self.lines[number] if number < len(self.lines) else 0

    def branch_line(self, number: int, rank: int) -> int:
        """Return the line of a branch: its own, else that of its first statement, else its statement's."""
        body = branches(self.statements[number])[rank]
        first = self.line(body[0]) if body else 0
        return self.branch_lines.get((number, rank)) or first or self.line(number)

    @cached_property
    def _reads(self) -> list[Names]:
        """The variables that each statement may read before it binds them: a least fixpoint, since loops lead back."""
        reads = [NONE] * len(self.statements)
        grown = True
        while grown:
            after = [_reads(statement, reads, self.statements) for statement in self.statements]
            grown, reads = after != reads, after
        return reads

    @cached_property
    def live(self) -> Callable[[Block], Names]:
        """Return the function from code to the variables that it may read; all others are forgotten."""
        return lru_cache(maxsize=1 << 14)(lambda code: _live(code, self._reads, self.statements))

    def watching(self, variables: frozenset[VariableOf]) -> "Program":
        """Return the program with more variables kept to the end of the run."""
        return self if variables <= self.watched else replace(self, watched=self.watched | variables)

    @cached_property
    def kept(self) -> Mapping[Name, Mapping[str, Names]]:
        """For each bigActor and variable, the names under which its values are kept to the end of the run."""
        found: dict[Name, dict[str, Names]] = {}
        for each in self.watched:
            keys = found.setdefault(each.agent, {})
            for variable in each.variables:
                keys[variable] = keys.get(variable, NONE) | {each.key}
        return found


def _live(block: Block, reads: list[Names], statements: tuple[Statement, ...]) -> Names:
    live = NONE
    for number in reversed(block):
        statement = statements[number]
        live = reads[number] | (live - {statement.variable} if isinstance(statement, Assign) else live)
    return live


def _reads(  # noqa: PLR0912  # one case for each kind of statement
    statement: Statement, reads: list[Names], statements: tuple[Statement, ...]
) -> Names:
    def live(block: Block) -> Names:
        return _live(block, reads, statements)

    def of_cases(cases: Iterable[Case]) -> Names:
        return NONE.union(*((free(case.guard) | live(case.body)) - variables(case.pattern) for case in cases))

    match statement:
        case Observe(expression) | Migrate(expression) | Assign(_, expression) | Display(expression):
            return free(expression)
        case Send(message, to):
            return free(message) | free(to)
        case ControlBy(_, arguments) | Call(_, arguments):
            return NONE.union(*map(free, arguments))
        case Spawn(_, host, _, arguments):
            return free(host).union(*map(free, arguments))
        case If(test, then, otherwise):
            return free(test) | live(then) | live(otherwise)
        case While(test, body):
            return free(test) | live(body)
        case Loop(body):
            return live(body)
        case For(members, rest, each):
            return free(members) | (reads[each] - {rest})
        case ForEach(variable, rest, body):
            return (live(body) - {variable}) | {rest}
        case ChooseFrom(variable, members, body):
            return free(members) | (live(body) - {variable})
        case Choose(alternatives):
            return NONE.union(*map(live, alternatives))
        case Match(value, cases):
            return free(value) | of_cases(cases)
        case React(cases, after):
            return of_cases(cases) | (NONE if after is None else live(after.body))
        case _:
            return NONE


@lru_cache(maxsize=1 << 12)
def reachable(program: Program, code: Block) -> frozenset[int]:
    """Return the statements that code may reach, without those of the agents it spawns."""
    return frozenset[int]().union(*(_within(program, number) for number in code))


@lru_cache(maxsize=1 << 12)
def _within(program: Program, first: int) -> frozenset[int]:
    """Return the statements that a statement may reach, itself included."""
    seen: set[int] = set()
    waiting = [first]
    while waiting:
        number = waiting.pop()
        if number not in seen:
            seen.add(number)
            waiting.extend(leads_to(program, program.statements[number]))
    return frozenset(seen)


def leads_to(program: Program, statement: Statement) -> Iterator[int]:
    """Yield the statements inside a statement, or in the behaviour that it calls."""
    match statement:
        case If(_, then, otherwise):
            yield from (*then, *otherwise)
        case While(_, body) | Loop(body) | ForEach(_, _, body) | ChooseFrom(_, _, body):
            yield from body
        case For(_, _, each):
            yield each
        case Choose(alternatives):
            yield from (number for block in alternatives for number in block)
        case React() | Match():
            yield from (number for block in branches(statement) for number in block)
        case Call(behaviour):
            yield from program.behaviours[behaviour].body


def expressions_of(statement: Statement) -> Iterable[Expression]:
    """Return the expressions whose value decides a step, or is kept, sent or used."""
    match statement:
        case Assign(_, expression) | If(expression, _, _) | While(expression, _) | For(expression, _, _):
            return (expression,)
        case ChooseFrom(_, expression, _) | Migrate(expression):
            return (expression,)
        case Send(message, to):
            return (message, to)
        case ControlBy(_, arguments) | Call(_, arguments):
            return arguments
        case Match(value, cases):
            return (value, *_guards(cases))
        case React(cases):
            return _guards(cases)
        case Observe(query):
            return _leaves(query)
        case Spawn(_, host, _, arguments):
            return (host, *arguments)
        case _:
            return ()


def _guards(cases: tuple[Case, ...]) -> tuple[Expression, ...]:
    return tuple(case.guard for case in cases if case.guard is not None)


def _leaves(query: QueryOf) -> tuple[Expression, ...]:
    inner = query.argument
    return () if inner is None else _leaves(inner) if isinstance(inner, QueryOf) else (inner,)
