"""Roles: the statements that each agent may reach, the values of its variables, and its possible hosts.

They are a least fixpoint over the text, not over runs: a variable holds the names that any reachable statement may
assign. A value may be any name, unless it is a constant, a host, or the observed place of something.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from semantics.analysis.overapproximation import Names, Overapproximation, transitive_closure
from semantics.analysis.possible_messages import may_take
from semantics.analysis.traversal import reachable
from semantics.behaviours.expressions import (
    Apply,
    Expression,
    Host,
    Literal,
    QueryOf,
    RouteOf,
    Self,
    SetOf,
    TupleOf,
    Variable,
)
from semantics.behaviours.observations import All, Nodes, Of, Query
from semantics.behaviours.patterns import Anything, Elements, Pattern, variables
from semantics.behaviours.statements import (
    Assign,
    Call,
    ChooseFrom,
    For,
    ForEach,
    Match,
    Migrate,
    React,
    Send,
    Spawn,
    Statement,
)
from semantics.behaviours.values import Route, Text, Truth, Value, within
from semantics.environment import Says
from semantics.state.requests import MGR, SND
from semantics.state.signature import NO_ENTITIES, Name


@dataclass(slots=True)
class AgentRole:
    """The role of one agent.

    Attributes:
        statements: The numbers of the statements that it may reach.
        hosts: Its possible hosts.
        named: For each variable the names that it may hold; None for any.
    """

    statements: set[int] = field(default_factory=set)
    hosts: set[Name] = field(default_factory=set)
    named: dict[str, Names | None] = field(default_factory=dict)


class Roles:
    """The roles of all first agents and of those that may be spawned.

    Attributes:
        first: The first agents; no agent ever leaves.
    """

    def __init__(self, bounds: Overapproximation) -> None:
        self.bounds = bounds
        self.program = bounds.setting.program
        self.roles: dict[Name, AgentRole] = {}
        alpha = bounds.initial.alpha
        self.first: Names = frozenset(alpha.names())
        for agent in alpha.names():
            moving = (p.request.host for p in bounds.initial.eta.of(agent) if isinstance(p.request, MGR))
            held = {variable: _spelled(value) for variable, value in alpha.store(agent)}
            self.roles[agent] = AgentRole(
                set(reachable(self.program, alpha.code(agent))), {alpha.host(agent), *moving}, held
            )
        while self._grow():
            pass

    def __getitem__(self, agent: Name) -> AgentRole:
        return self.roles[agent]

    @property
    def agents(self) -> tuple[Name, ...]:
        """Every agent that may ever exist, sorted."""
        return tuple(sorted(self.roles))

    def may_come(self, agent: Name) -> bool:
        """Return whether an agent that doesn't exist may exist later."""
        return agent in self.roles and agent not in self.first

    def descendants(self, reach: Iterable[int]) -> Names:
        """Return the agents that these statements may spawn, directly or through others."""
        return transitive_closure(
            self._spawned(reach), lambda agent: self._spawned(self.roles[agent].statements)
        )

    def _spawned(self, numbers: Iterable[int]) -> Names:
        statements = (self.program.statements[number] for number in numbers)
        return frozenset(each.name for each in statements if isinstance(each, Spawn))

    # --- possible names of expressions ------------------------------------------------------------------------

    def names(self, agent: Name, expression: Expression) -> Names | None:
        """Return the possible names of a value, or of the members of a set or a route; None for any."""
        match expression:
            case Literal(value):
                return _spelled(value)
            case Host():
                return frozenset(self.roles[agent].hosts)
            case Self():
                return frozenset({agent})
            case Variable(name):
                return self.roles[agent].named.get(name, frozenset())
            case SetOf(items) | RouteOf(items):
                return _either(self.names(agent, item) for item in items)
            case Apply("+" | "union", parts):
                return _either(self.names(agent, each) for each in parts)
            case Apply("-" | "minus" | "intersect" | "of" | "first" | "element", (first, *_)):
                return self.names(agent, first)
            case Apply("[]", (Literal(frozenset(members)), node)):
                return self._members(members, self.names(agent, node))
            case Apply("parent", (node, _)):
                return self._places(self.names(agent, node))
            case _:
                return None

    def _members(self, members: Iterable[Value], nodes: Names | None) -> Names:
        """Return the members of a family that some nodes may denote."""
        pairs = (each for each in members if isinstance(each, tuple))
        return frozenset(str(agent) for node, agent in pairs if nodes is None or node in nodes)

    def _places(self, nodes: Names | None) -> Names:
        """Return the places in which an observation may have shown some nodes."""
        among = self.bounds.names if nodes is None else nodes & self.bounds.names
        return NO_ENTITIES.union(*map(self.bounds.holders, among))

    def entities(self, agent: Name, expression: Expression) -> tuple[Name, ...]:
        """Return the entities that an expression may name, sorted."""
        found = self.names(agent, expression)
        return tuple(sorted(self.bounds.names if found is None else found & self.bounds.names))

    def receivers(self, agent: Name, expression: Expression) -> tuple[Name, ...]:
        """Return the agents that an expression may name, sorted."""
        found = self.names(agent, expression)
        return tuple(each for each in self.agents if found is None or each in found)

    def query(self, agent: Name, template: QueryOf) -> Query:
        """Return a query for all possible names in a template; it observes at least as much."""
        argument = template.argument
        if argument is None:
            return All()
        inner = (
            self.query(agent, argument)
            if isinstance(argument, QueryOf)
            else Nodes(self.entities(agent, argument))
        )
        return inner if template.operator is None else Of(template.operator, inner)

    # --- the fixpoint -----------------------------------------------------------------------------------------

    def _grow(self) -> bool:
        before = self._size()
        for agent in self.agents:
            for number in sorted(self.roles[agent].statements):
                self._flow(agent, self.program.statements[number])
        return self._size() != before

    def _size(self) -> tuple[int, ...]:
        sets = [(len(role.statements), len(role.hosts)) for role in self.roles.values()]
        named = [names for role in self.roles.values() for names in role.named.values()]
        anything = sum(names is None for names in named)
        return (*(n for pair in sets for n in pair), len(named), anything, sum(map(len, filter(None, named))))

    def _flow(self, agent: Name, statement: Statement) -> None:
        match statement:
            case Assign(variable, expression):
                self._bind(agent, variable, self.names(agent, expression))
            case For(members, rest, _):
                self._bind(agent, rest, self.names(agent, members))
            case ForEach(variable, rest, _):
                self._bind(agent, variable, self.roles[agent].named.get(rest, frozenset()))
            case ChooseFrom(variable, members, _):
                self._bind(agent, variable, self.names(agent, members))
            case React(cases):
                for case in cases:
                    self._receive(agent, case.pattern)
            case Match(_, cases):
                for variable in frozenset[str]().union(*(variables(case.pattern) for case in cases)):
                    self._bind(agent, variable, None)
            case Call(behaviour, arguments):
                self._pass(agent, agent, behaviour, arguments)
            case Migrate(host):
                self.roles[agent].hosts.update(self.entities(agent, host))
            case Spawn(name, host, behaviour, arguments):
                role = self.roles.setdefault(name, AgentRole())
                role.hosts.update(self.entities(agent, host))
                role.statements |= reachable(self.program, self.program.behaviours[behaviour].body)
                self._pass(agent, name, behaviour, arguments)

    def _receive(self, agent: Name, pattern: Pattern) -> None:
        """Bind a pattern's variables to the possible parts of messages; to any value if it may take an observation."""
        if not isinstance(pattern, Elements):
            for variable in variables(pattern):
                self._bind(agent, variable, None)
            return
        for speaker, message in self._messages():
            if may_take(pattern, message):
                self._take(agent, pattern, speaker, message)

    def _take(self, agent: Name, pattern: Pattern, speaker: Name, message: Expression) -> None:
        match pattern, message:
            case Anything(str(variable), _), _:
                self._bind(agent, variable, self.names(speaker, message))
            case Elements(items), TupleOf(parts):
                for item, part in zip(items, parts, strict=True):
                    self._take(agent, item, speaker, part)
            case Elements(items), Literal(tuple(parts)):
                for item, value in zip(items, parts, strict=True):
                    self._take(agent, item, speaker, Literal(value))
            case _:
                for variable in variables(pattern):
                    self._bind(agent, variable, None)

    def _messages(self) -> Iterator[tuple[Name, Expression]]:
        """Yield all messages that agents or the environment may send, each with an agent that may evaluate it."""
        initial = self.bounds.initial
        for agent in self.agents:
            for number in sorted(self.roles[agent].statements):
                statement = self.program.statements[number]
                if isinstance(statement, Send):
                    yield agent, statement.message
        for agent in initial.alpha.names():
            yield from ((agent, Literal(value)) for value in initial.alpha.mailbox(agent))
            pending = (each.request for each in initial.eta.of(agent))
            yield from ((agent, Literal(each.message)) for each in pending if isinstance(each, SND))
        for clause in initial.setting.environment:
            if isinstance(clause, Says):
                yield clause.agent, Literal(clause.message)

    def _pass(self, giver: Name, taker: Name, behaviour: str, arguments: tuple[Expression, ...]) -> None:
        parameters = self.program.behaviours[behaviour].parameters
        for parameter, argument in zip(parameters, arguments, strict=True):
            self._bind(taker, parameter, self.names(giver, argument))

    def _bind(self, agent: Name, variable: str, names: Names | None) -> None:
        named = self.roles[agent].named
        named[variable] = _either([named.get(variable, frozenset()), names])


def _either(several: Iterable[Names | None]) -> Names | None:
    found: set[Name] = set()
    for names in several:
        if names is None:
            return None
        found |= names
    return frozenset(found)


def _spelled(value: object) -> Names | None:
    """Return the names in a constant; None for a value that may hold any."""
    if isinstance(value, str):
        return frozenset({value})
    if isinstance(value, frozenset | Route):
        return _either(map(_spelled, within(value)))
    return frozenset() if isinstance(value, int | Truth | Text) else None
