"""The statements of bigActors."""

from __future__ import annotations

from typing import TypeAlias

from semantics.behaviours.durations import UNITS
from specs.syntax.actions import Action
from specs.syntax.expressions import Expression, Query
from specs.syntax.nodes import Name, Node, node
from specs.syntax.patterns import Pattern


@node
class Case(Node):
    """`case pattern if guard => statements`: one alternative of a `react` or a `match`."""

    pattern: Pattern
    guard: Expression | None
    body: tuple[Statement, ...]


@node
class Observe(Node):
    """`observe(q)`: request an observation."""

    query: Query


@node
class Control(Node):
    """`control(r)`: request a control action."""

    action: Action


@node
class Duration(Node):
    """`90 s`, `10 min`, `1.5 h`, `100 ms`: seconds, minutes, hours or milliseconds."""

    value: float
    unit: str

    @property
    def seconds(self) -> float:
        """The duration in seconds."""
        return self.value * UNITS[self.unit]


@node
class After(Node):
    """`after 10 min => statements`: the statements of an agent that has waited so long at a `react`.

    It stands behind the cases. The step `timeout` is possible while no case takes any received observation or message.
    A live run takes it after that time, a check without times at any moment of the wait.
    """

    duration: Duration
    body: tuple[Statement, ...]


@node
class React(Node):
    """`react { case ... after 10 min => ... }`: wait for an observation or a message that a case matches.

    The `after` branch is optional.
    """

    cases: tuple[Case, ...]
    after: After | None = None


@node
class Send(Node):
    """`send e to a`, or `send(e, a)`: send a message to an agent."""

    message: Expression
    recipient: Expression


@node
class Migrate(Node):
    """`migrate(h)`: request to move the agent to another host."""

    host: Expression


@node
class Call(Node):
    """`visit(oilSpill0)`: run a behaviour defined by `def`."""

    behaviour: Name
    arguments: tuple[Expression, ...]


@node
class Spawn(Node):
    """`spawn(visit(place0), hosted_at uav0)`, or `spawn b hosted_at uav0 with_behavior visit(place0)`.

    Start a new bigActor.
    """

    name: Name | None
    behaviour: Call
    host: Expression


@node
class Display(Node):
    """`display(e)`: show a value to the observer of the run; the configuration stays the same."""

    value: Expression


@node
class Let(Node):
    """`let x = e`: bind a new variable."""

    variable: Name
    value: Expression


@node
class Assign(Node):
    """`x = e`: give a bound variable another value."""

    variable: Name
    value: Expression


@node
class If(Node):
    """`if e { ... } else if e { ... } else { ... }`: a conditional.

    Attributes:
        condition: The first condition.
        then: The statements if it is true.
        otherwise: The statements if not; for `else if`, a single `If`.
    """

    condition: Expression
    then: tuple[Statement, ...]
    otherwise: tuple[Statement, ...]


@node
class Loop(Node):
    """`loop { ... }`: repeat for ever."""

    body: tuple[Statement, ...]


@node
class While(Node):
    """`while e { ... }`: repeat while the condition is true."""

    condition: Expression
    body: tuple[Statement, ...]


@node
class For(Node):
    """`for x in e { ... }`: repeat for each stop of a route, or each member of a set or an observation.

    A route is visited in its order, a set and an observation in the order of names.
    """

    variable: Name
    collection: Expression
    body: tuple[Statement, ...]


@node
class Match(Node):
    """`match e { case ... }`: take the first case that matches a value."""

    subject: Expression
    cases: tuple[Case, ...]


@node
class Alternative(Node):
    """`case => statements`, or one block of `choose { ... } or { ... }`."""

    body: tuple[Statement, ...]


@node
class Choose(Node):
    """`choose { case => ... case => ... }`, or `choose { ... } or { ... }`: take any alternative; all are explored."""

    alternatives: tuple[Alternative, ...]


@node
class ChooseFrom(Node):
    """`choose x in e { ... }`: bind x to any one element; all are explored."""

    variable: Name
    collection: Expression
    body: tuple[Statement, ...]


@node
class Skip(Node):
    """`skip`: do nothing."""


Statement: TypeAlias = (
    Observe
    | Control
    | React
    | Send
    | Migrate
    | Spawn
    | Display
    | Let
    | Assign
    | If
    | Loop
    | While
    | For
    | Match
    | Choose
    | ChooseFrom
    | Call
    | Skip
)
