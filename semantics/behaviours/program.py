"""A program: the numbered statements of a mission, and the variables that it keeps."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, Protocol

from semantics.behaviours.expressions import free
from semantics.behaviours.statements import (
    Assign,
    Block,
    Display,
    ForEach,
    Statement,
    branches,
    inner_blocks,
    operands,
)
from semantics.fixpoints import fixpoint
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

        def grow(reads: list[Names]) -> list[Names]:
            return [_reads(statement, reads, self.statements) for statement in self.statements]

        return fixpoint(grow, [NONE] * len(self.statements))

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


def _reads(statement: Statement, reads: list[Names], statements: tuple[Statement, ...]) -> Names:
    shown = (statement.value,) if isinstance(statement, Display) else operands(statement)
    own = frozenset({statement.rest}) if isinstance(statement, ForEach) else NONE
    inner = (
        (free(each.guard) | _live(each.block, reads, statements)) - each.binds
        for each in inner_blocks(statement)
    )
    return own.union(*map(free, shown), *inner)
