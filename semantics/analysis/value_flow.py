"""Value flow: an over-approximation, from the text, of each bigActor's variables, hosts and messages.

It is a least fixpoint: a variable may hold every value that a reachable statement may assign to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final, TypeGuard

from semantics.analysis.abstract_values import (
    ANYTHING,
    NOTHING,
    NUMBER,
    OBSERVATION,
    TRUTH,
    Abstract,
    Vocabulary,
    bound,
    constant,
    join,
    members,
    named,
    tuple_of,
    word,
)
from semantics.analysis.control_instances import instances
from semantics.analysis.overapproximation import Overapproximation
from semantics.analysis.traversal import BoundPattern, Origin, bindings, reachable
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
from semantics.behaviours.observations import All, Nodes, Observation, Of, Query
from semantics.behaviours.program import Program
from semantics.behaviours.reaction_rules import Reaction
from semantics.behaviours.statements import Block, ControlBy, ForEach, Migrate, React, Send, Spawn, Statement
from semantics.behaviours.values import Text, Value, within
from semantics.environment import Says
from semantics.fixpoints import closure
from semantics.state.configuration import Configuration
from semantics.state.requests import MGR, SND
from semantics.state.setting import Setting
from semantics.state.signature import NO_ENTITIES, REGION, Name


@dataclass(slots=True)
class PossibleBehaviour:
    """The possible behaviour of one bigActor.

    Attributes:
        starts: The blocks that it may begin with.
        statements: The statements that it may reach.
        hosts: Its possible hosts.
        given: The possible values of each variable.
    """

    starts: set[Block] = field(default_factory=set)
    statements: set[int] = field(default_factory=set)
    hosts: Abstract = NOTHING
    given: dict[str, Abstract] = field(default_factory=dict)


class ValueFlow:
    """The possible behaviours of all bigActors: of all runs of a text, or of those from one configuration.

    Attributes:
        entities: All entities, as an abstract value.
        roles: The possible behaviour of each bigActor that may ever exist.
        first: The bigActors at the beginning; no bigActor ever leaves.

    Args:
        setting: The mission.
        bounds: The bounds of the first configuration; None for all runs of the text, with entities first seen later.
    """

    def __init__(self, setting: Setting, bounds: Overapproximation | None = None) -> None:
        self.setting = setting
        self.bounds = bounds
        self.program: Program = setting.program
        self.entities = Abstract(kinds=frozenset({*setting.signature.kinds, *setting.kinds.values()}))
        self.roles: dict[Name, PossibleBehaviour] = {}
        self._grown = True
        self._posted: dict[Name, Abstract] = {}
        for each in _says(setting):
            self._post(each.agent, each.message)
        if bounds is None:
            for agent, block in self.program.bodies.items():
                self._begin(agent, block, word(self.program.homes[agent]))
            for agent in self._posted:
                self.roles.setdefault(agent, PossibleBehaviour())
        else:
            self._begin_from(bounds.initial)
        self.first = frozenset(self.roles)
        while self._grown:
            self._grown = False
            self._vocabulary = self.vocabulary_of(setting)
            self._grow()

    @property
    def agents(self) -> tuple[Name, ...]:
        """All bigActors that may ever exist, sorted."""
        return tuple(sorted(self.roles))

    def __getitem__(self, agent: Name) -> PossibleBehaviour:
        return self.roles[agent]

    def vocabulary_of(self, setting: Setting) -> Vocabulary:
        """Return the vocabulary of the mission, in a setting that may name entities first seen later."""
        return Vocabulary(setting.kinds.get, frozenset(self.roles))

    def variable(self, agent: Name, name: str) -> Abstract:
        """Return the possible values of an agent's variable, or of one kept for a property."""
        role = self.roles[agent]
        kept = (
            role.given.get(variable, NOTHING)
            for variable, keys in self.program.kept.get(agent, {}).items()
            if name in keys
        )
        return join((role.given.get(name, NOTHING), *kept))

    # --- spawned bigActors --------------------------------------------------------------------------------------

    def may_come(self, agent: Name) -> bool:
        """Return whether an agent that doesn't exist may exist later."""
        return agent in self.roles and agent not in self.first

    def descendants(self, reach: Iterable[int]) -> frozenset[Name]:
        """Return the agents that these statements may spawn, directly or through others."""
        return closure(self._spawned(reach), lambda agent: self._spawned(self[agent].statements))

    def _spawned(self, numbers: Iterable[int]) -> frozenset[Name]:
        statements = (self.program.statements[number] for number in numbers)
        return frozenset(each.name for each in statements if isinstance(each, Spawn))

    # --- messages and values --------------------------------------------------------------------------------------

    def messages(self, agent: Name) -> Abstract:
        """Return the possible messages to an agent, from agents and from outside."""
        return self._mail(agent, self._sent())

    def _sent(self) -> list[tuple[Abstract, Abstract]]:
        """Return the possible receivers and contents of each `send`."""
        return [
            (self.names(sender, each.to), self.value(sender, each.message))
            for sender in self.agents
            for each in self._statements(sender)
            if isinstance(each, Send)
        ]

    def _mail(self, agent: Name, sent: Iterable[tuple[Abstract, Abstract]]) -> Abstract:
        fits = self._vocabulary.fits
        return join((self._posted.get(agent, NOTHING), *(each for to, each in sent if fits(agent, to))))

    def names(self, agent: Name, expression: Expression) -> Abstract:
        """Return the names that an expression may denote."""
        return named(self.value(agent, expression))

    def value(self, agent: Name, expression: Expression) -> Abstract:
        """Return the possible values of an expression."""
        match expression:
            case Literal(value):
                return constant(value)
            case Host():
                return self.roles[agent].hosts
            case Self():
                return word(agent)
            case Variable(name):
                return self.roles[agent].given.get(name, NOTHING)
            case ShortCircuit():
                return TRUTH
            case TupleOf(items):
                return tuple_of(tuple(self.value(agent, each) for each in items))
            case SetOf(items):
                return Abstract(sets=join(self.value(agent, each) for each in items)) | NOTHING
            case RouteOf(items):
                return Abstract(routes=join(self.value(agent, each) for each in items)) | NOTHING
            case Apply(operator, arguments):
                given = [self.value(agent, each) for each in arguments]
                return _RESULTS[operator](self, *given) if operator in _RESULTS else ANYTHING

    def members(self, value: Abstract) -> Abstract:
        """Return the possible members of a set, a route or an observation."""
        return members(value, replace(self.entities, agents=True, words=frozenset({REGION})))

    def parents(self, node: Abstract) -> Abstract:
        """Return the places in which an observation may have shown some nodes."""
        if self.bounds is None:
            return self.entities | _SEEN_PLACES
        held = map(self.bounds.holders, self._among(self.setting.kinds, named(node)))
        return Abstract(words=NO_ENTITIES.union(*held))

    def may_be(self, constants: Abstract, value: Abstract) -> bool:
        """Return whether a value may be one of some constants."""
        others = constants != Abstract(constants.words)
        return others or any(self._vocabulary.fits(each, value) for each in constants.words)

    # --- names ----------------------------------------------------------------------------------------------------

    def hosts(self, agent: Name) -> tuple[Name, ...]:
        """Return the possible hosts of an agent, sorted."""
        return self._among(self.setting.kinds, self.roles[agent].hosts)

    def named_entities(self, agent: Name, expression: Expression) -> tuple[Name, ...]:
        """Return the entities that an expression may name, sorted."""
        return self._among(self.setting.kinds, self.names(agent, expression))

    def receivers(self, agent: Name, expression: Expression) -> tuple[Name, ...]:
        """Return the agents that an expression may name, sorted."""
        return self._among(self.roles, self.names(agent, expression))

    def _among(self, known: Iterable[Name], value: Abstract) -> tuple[Name, ...]:
        open_ended = value.anything or value.kinds or value.agents
        names = known if open_ended else value.words.intersection(known)
        return tuple(sorted(str(name) for name in names if self._vocabulary.fits(name, value)))

    def query(self, agent: Name, template: QueryOf) -> Query:
        """Return a query for all possible names in a template; it observes at least as much."""
        argument = template.argument
        if argument is None:
            return All()
        inner = (
            self.query(agent, argument)
            if isinstance(argument, QueryOf)
            else Nodes(self.named_entities(agent, argument))
        )
        return inner if template.operator is None else Of(template.operator, inner)

    def reactions(self, agent: Name, control: ControlBy) -> tuple[Reaction, ...] | None:
        """Return the reactions that a control of an agent may request; None if there are too many."""
        return instances(self.program, control.name, self.names_of(agent, control))

    def names_of(self, agent: Name, control: ControlBy) -> tuple[tuple[Name, ...], ...]:
        """Return the hosts of an agent, and the entities that each argument of its control may name."""
        return self.hosts(agent), *(self.named_entities(agent, each) for each in control.arguments)

    # --- the fixpoint -----------------------------------------------------------------------------------------

    def _begin_from(self, initial: Configuration) -> None:
        """Begin with the bigActors, the variables, the messages and the requests of a configuration."""
        rests = {each.rest for each in self.program.statements if isinstance(each, ForEach)}
        for agent in initial.alpha.names():
            self._begin(agent, initial.alpha.code(agent), word(initial.alpha.host(agent)))
            for variable, value in initial.alpha.store(agent):
                shorter = variable in rests and isinstance(value, tuple)  # a loop takes its members from it
                of = Abstract(lists=join(map(constant, within(value)))) if shorter else constant(value)
                self._give(agent, variable, of)
            for message in initial.alpha.mailbox(agent):
                self._post(agent, message)
            for pending in initial.eta.of(agent):
                match pending.request:
                    case MGR(_, host):
                        self._host(agent, word(host))
                    case SND(_, to, message):
                        self._post(to, message)

    def _statements(self, agent: Name) -> list[Statement]:
        return [self.program.statements[number] for number in sorted(self.roles[agent].statements)]

    def _grow(self) -> None:
        sent = self._sent()
        for agent in self.agents:
            received: Abstract | None = None
            for statement in self._statements(agent):
                taker = agent
                if isinstance(statement, React) and received is None:
                    received = self._mail(agent, sent) | OBSERVATION
                elif isinstance(statement, Migrate):
                    self._host(agent, self.names(agent, statement.host))
                elif isinstance(statement, Spawn):
                    taker = statement.name
                    block = self.program.behaviours[statement.behaviour].body
                    self._begin(taker, block, self.names(agent, statement.host))
                for each in bindings(self.program, statement):
                    value = self._bound(agent, each, received or OBSERVATION)
                    for variable, part in (bound(each.pattern, value, self._vocabulary) or {}).items():
                        self._give(taker, variable, part)

    def _bound(self, agent: Name, binding: BoundPattern, received: Abstract) -> Abstract:
        if binding.expression is None:
            return received
        value = self.value(agent, binding.expression)
        match binding.origin:
            case Origin.MEMBERS:
                return Abstract(lists=self.members(value))
            case Origin.MEMBER:
                return self.members(value) | _element(self, replace(value, routes=None), NUMBER)
            case _:
                return value

    def _begin(self, agent: Name, block: Block, hosts: Abstract) -> None:
        role = self.roles.setdefault(agent, PossibleBehaviour())
        if block not in role.starts:
            role.starts.add(block)
            role.statements |= reachable(self.program, block)
            self._grown = True
        self._host(agent, hosts)

    def _host(self, agent: Name, hosts: Abstract) -> None:
        role = self.roles[agent]
        places = self.entities if hosts.anything else hosts
        self._grown |= (role.hosts | places) != role.hosts
        role.hosts |= places

    def _post(self, agent: Name, message: Value) -> None:
        self._posted[agent] = self._posted.get(agent, NOTHING) | constant(message)

    def _give(self, agent: Name, variable: str, value: Abstract) -> None:
        given = self.roles[agent].given
        before = given.get(variable, NOTHING)
        given[variable] = before | value
        self._grown |= given[variable] != before


@dataclass(frozen=True, slots=True)
class _Held:
    """A setting that is not part of the cache's key."""

    setting: Setting = field(compare=False)


@lru_cache(maxsize=8)
def _flow_of(_program: Program, _says: tuple[Says, ...], held: _Held) -> ValueFlow:
    return ValueFlow(held.setting)


def flow_of(setting: Setting) -> ValueFlow:
    """Return the value flow of a mission's text; entities that come into sight later do not change it."""
    return _flow_of(setting.program, _says(setting), _Held(setting))


def _says(setting: Setting) -> tuple[Says, ...]:
    return tuple(each for each in setting.environment if isinstance(each, Says))


# --- operators --------------------------------------------------------------------------------------------


def _sum(flow: ValueFlow, left: Abstract, right: Abstract) -> Abstract:
    if left.anything:
        return ANYTHING
    return join(
        (
            NUMBER if int in left.plain else NOTHING,
            NOTHING if left.sets is None else Abstract(sets=left.sets | flow.members(right)),
            NOTHING if left.routes is None else Abstract(routes=left.routes | (right.routes or NOTHING)),
        )
    )


def _part(flow: ValueFlow, left: Abstract, *_: Abstract) -> Abstract:
    """Return the possible parts of a collection; a part of an observation is a set."""
    if left.anything:
        return ANYTHING
    seen = Observation in left.plain
    inside = flow.members(Abstract(sets=left.sets, plain=left.plain))
    return join(
        (
            Abstract(sets=inside) if seen or left.sets is not None else NOTHING,
            NOTHING if left.routes is None else Abstract(routes=left.routes),
        )
    )


def _difference(flow: ValueFlow, left: Abstract, right: Abstract) -> Abstract:
    number = NUMBER if int in left.plain else NOTHING
    return _part(flow, left, right) | number


def _is_name(word: Name | Text) -> TypeGuard[Name]:
    return isinstance(word, str)


def _of_kind(flow: ValueFlow, left: Abstract, kind: Abstract) -> Abstract:
    part = _part(flow, left)
    is_known = not (kind.anything or kind.kinds or kind.agents)
    wanted = frozenset(filter(_is_name, kind.words)) if is_known else flow.entities.kinds
    if part.anything:
        return join((Abstract(sets=Abstract(kinds=wanted)), Abstract(routes=Abstract(kinds=wanted))))

    def kept(inside: Abstract) -> Abstract:
        if inside.anything:
            return Abstract(kinds=wanted)
        names = filter(_is_name, inside.words)
        words = frozenset(each for each in names if flow.setting.kinds.get(each) in wanted)
        return Abstract(words, inside.kinds & wanted)

    return Abstract(
        sets=None if part.sets is None else kept(part.sets),
        routes=None if part.routes is None else kept(part.routes),
    )


def _element(_: ValueFlow, value: Abstract, _index: Abstract) -> Abstract:
    if value.anything:
        return ANYTHING
    several = [each for each in (value.routes, value.lists) if each is not None]
    return join((*several, *(item for items in value.tuples for item in items)))


def _of_family(flow: ValueFlow, family: Abstract, node: Abstract) -> Abstract:
    """Return the members of a family that some nodes may denote."""
    pairs = NOTHING if family.sets is None else family.sets
    if family.anything or pairs.anything:
        return ANYTHING
    return join(items[1] for items in pairs.tuples if len(items) > 1 and flow.may_be(items[0], node))


_SEEN_PLACES: Final = Abstract(words=NO_ENTITIES)

_RESULTS: Final[Mapping[str, Callable[..., Abstract]]] = {
    **dict.fromkeys(("in", "==", "!=", "<", "<=", ">", ">=", "not", "empty", "linked"), lambda *_: TRUTH),
    "+": _sum,
    "-": _difference,
    "of": _of_kind,
    "union": lambda flow, a, b: Abstract(sets=flow.members(a) | flow.members(b)),
    "minus": _part,
    "intersect": _part,
    "size": lambda *_: NUMBER,
    "nodes": lambda flow, _: Abstract(sets=flow.entities | _SEEN_PLACES),
    "children": lambda flow, *_: Abstract(sets=flow.entities),
    "agents": lambda *_: Abstract(sets=Abstract(agents=True)),
    "kind": lambda flow, _: Abstract(words=frozenset(map(Text, flow.entities.kinds))),
    "parent": lambda flow, node, _: flow.parents(node),
    "first": lambda flow, value: flow.members(value),
    "element": _element,
    "[]": _of_family,
}
"""The results of operators on abstract arguments."""
