"""Statements of a behaviour: commands, one rule each, and internal computation, for `fun`."""

from dataclasses import dataclass

from semantics.behaviours.durations import duration_text
from semantics.behaviours.expressions import Expression, QueryOf, leaf_of
from semantics.behaviours.patterns import Pattern, variables
from semantics.state.signature import Name

Block = tuple[int, ...]
"""The numbers of consecutive statements."""


# --- commands: one rule each -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Observe:
    """`observe(q)`."""

    query: QueryOf


@dataclass(frozen=True, slots=True)
class ControlBy:
    """`control(R ⇒ R')`: `name` is a command of `commands.COMMANDS`, or a rule of the mission."""

    name: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Case:
    """`case pattern if guard => body`."""

    pattern: Pattern
    guard: Expression | None
    body: Block


@dataclass(frozen=True, slots=True)
class After:
    """`after 10 min => body`: the longest wait of a `react`, and the code that follows it."""

    seconds: float  # not int: a statement number is an int
    body: Block = ()

    def __str__(self) -> str:
        return f"after {duration_text(self.seconds)}"


@dataclass(frozen=True, slots=True)
class React:
    """`react { cases after d => body }`: the first case that matches takes one observation or message.

    The `after` branch may be taken if no case takes any value that has come.
    """

    cases: tuple[Case, ...]
    after: After | None = None


@dataclass(frozen=True, slots=True)
class Send:
    """`send(m, b)`."""

    message: Expression
    to: Expression


@dataclass(frozen=True, slots=True)
class Migrate:
    """`migrate(h)`."""

    host: Expression


@dataclass(frozen=True, slots=True)
class Spawn:
    """`spawn NAME hosted_at h with_behavior b(args)`."""

    name: Name
    host: Expression
    behaviour: str
    arguments: tuple[Expression, ...]


# --- internal statements: `fun` --------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Assign:
    """`let x = e` and `x = e`."""

    variable: str
    value: Expression


@dataclass(frozen=True, slots=True)
class Display:
    """`display(e)`: shown to the operator, without effect on the configuration."""

    value: Expression


@dataclass(frozen=True, slots=True)
class Tested:
    """The guard of the case that was taken: its test is the first step of the body."""


@dataclass(frozen=True, slots=True)
class If:
    """`if e { then } else { otherwise }`."""

    test: Expression
    then: Block
    otherwise: Block = ()


@dataclass(frozen=True, slots=True)
class While:
    """`while e { body }`."""

    test: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class For:
    """`for x in e { ... }`: evaluates e, and iterates over its members by `each`, a `ForEach`.

    The stops of a route keep their order; the members of a set or an observation have the canonical order.
    """

    members: Expression
    rest: str
    each: int


@dataclass(frozen=True, slots=True)
class ForEach:
    """Take the next member of `rest`, if there is one."""

    variable: str
    rest: str
    body: Block


@dataclass(frozen=True, slots=True)
class Match:
    """`match e { cases }`: the first case that matches; a fault if there is none."""

    value: Expression
    cases: tuple[Case, ...]


@dataclass(frozen=True, slots=True)
class Call:
    """`b(args)`: the behaviour's body in its place."""

    behaviour: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Choose:
    """`choose { b } or { b' }`: one successor for each alternative."""

    alternatives: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class ChooseFrom:
    """`choose x in e { body }`: one successor for each member."""

    variable: str
    members: Expression
    body: Block


@dataclass(frozen=True, slots=True)
class Loop:
    """`loop { body }`."""

    body: Block
    outermost: bool = False


Command = Observe | ControlBy | React | Send | Migrate | Spawn
Choice = Choose | ChooseFrom
Internal = Assign | Display | Tested | If | While | For | ForEach | Match | Call
Statement = Command | Choice | Internal | Loop


@dataclass(frozen=True, slots=True)
class InnerBlock:
    """A block inside a statement: the guard before it, if it has one, and the variables that entering it binds."""

    block: Block
    guard: Expression | None = None
    binds: frozenset[str] = frozenset()


def inner_blocks(statement: Statement) -> tuple[InnerBlock, ...]:
    """Return the blocks inside a statement, in written order."""
    match statement:
        case If(_, then, otherwise):
            return (InnerBlock(then), InnerBlock(otherwise))
        case React(cases, after):
            return (*map(_of_case, cases), *(() if after is None else (InnerBlock(after.body),)))
        case Match(_, cases):
            return tuple(map(_of_case, cases))
        case Choose(alternatives):
            return tuple(map(InnerBlock, alternatives))
        case While(_, body) | Loop(body):
            return (InnerBlock(body),)
        case ForEach(variable, _, body) | ChooseFrom(variable, _, body):
            return (InnerBlock(body, None, frozenset({variable})),)
        case For(_, rest, each):
            return (InnerBlock((each,), None, frozenset({rest})),)
        case _:
            return ()


def _of_case(case: Case) -> InnerBlock:
    return InnerBlock(case.body, case.guard, variables(case.pattern))


def branches(statement: Statement) -> tuple[Block, ...]:
    """Return the blocks of which a statement takes one; of a loop that may be skipped, only its body."""
    return () if isinstance(statement, For | Loop) else tuple(each.block for each in inner_blocks(statement))


def operands(statement: Statement) -> tuple[Expression, ...]:
    """Return the expressions that a statement evaluates itself: without guards, and without those that it displays."""
    match statement:
        case Assign(_, expression) | If(expression) | While(expression) | For(expression) | Match(expression):
            return (expression,)
        case ChooseFrom(_, expression) | Migrate(expression):
            return (expression,)
        case Send(message, to):
            return (message, to)
        case ControlBy(_, arguments) | Call(_, arguments):
            return arguments
        case Spawn(_, host, _, arguments):
            return (host, *arguments)
        case Observe(query):
            return leaf_of(query)
        case _:
            return ()


def at_internal(statement: Statement | None) -> bool:
    """Whether the next step is internal: `fun`."""
    return isinstance(statement, Internal | Choice)
