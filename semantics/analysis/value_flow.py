"""Value flow: an over-approximation, from the text, of each bigActor's variables, hosts and messages.

It is a least fixpoint: a variable may hold every value that a reachable statement may assign to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final, TypeGuard

from semantics.admission.program_points import once
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
from semantics.analysis.traversal import reachable
from semantics.behaviours.expressions import (
    Apply,
    Expression,
    Host,
    Literal,
    RouteOf,
    Self,
    SetOf,
    ShortCircuit,
    TupleOf,
    Variable,
)
from semantics.behaviours.observations import Observation
from semantics.behaviours.program import Program
from semantics.behaviours.statements import (
    Assign,
    Block,
    Call,
    Case,
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
from semantics.behaviours.values import Text
from semantics.environment import Says
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
    """The roles of all bigActors that the text declares or spawns, and the messages that it sends."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.program: Program = setting.program
        self.roles: dict[Name, PossibleBehaviour] = {}
        self.entities = Abstract(kinds=frozenset({*setting.signature.kinds, *setting.kinds.values()}))
        self._grown = True
        for agent, block in self.program.bodies.items():
            self._begin(agent, block, word(self.program.homes[agent]))
        for each in _says(setting):
            self.roles.setdefault(each.agent, PossibleBehaviour())
        while self._grown:
            self._grown = False
            self._grow()

    @property
    def agents(self) -> frozenset[Name]:
        """All bigActors that may ever exist."""
        return frozenset(self.roles)

    def vocabulary_of(self, setting: Setting) -> Vocabulary:
        """Return the vocabulary of the mission, in a setting that may name entities first seen later."""
        return Vocabulary(setting.kinds.get, self.agents)

    def variable(self, agent: Name, name: str) -> Abstract:
        """Return the possible values of an agent's variable, or of one kept for a property."""
        role = self.roles[agent]
        kept = (
            role.given.get(variable, NOTHING)
            for variable, keys in self.program.kept.get(agent, {}).items()
            if name in keys
        )
        return join((role.given.get(name, NOTHING), *kept))

    def once(self, agent: Name) -> frozenset[int]:
        """Return the statements that an agent takes at most once."""
        return once(self.program, self.roles[agent].starts)

    def messages(self, agent: Name) -> Abstract:
        """Return the possible messages to an agent, from agents and from outside."""
        found = (
            self.value(sender, statement.message)
            for sender in sorted(self.roles)
            for statement in self._statements(sender)
            if isinstance(statement, Send) and self._may_be(agent, sender, statement.to)
        )
        said = (constant(each.message) for each in _says(self.setting) if each.agent == agent)
        return join((*found, *said))

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
                return self.variable(agent, name)
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

    # --- the fixpoint -----------------------------------------------------------------------------------------

    def _statements(self, agent: Name) -> Iterator[Statement]:
        yield from (self.program.statements[number] for number in sorted(self.roles[agent].statements))

    def _grow(self) -> None:
        for agent in sorted(self.roles):
            received: Abstract | None = None
            for statement in list(self._statements(agent)):
                if isinstance(statement, React):
                    received = self.messages(agent) if received is None else received
                    self._cases(agent, statement.cases, received | OBSERVATION)
                else:
                    self._flow(agent, statement)

    def _flow(self, agent: Name, statement: Statement) -> None:
        match statement:
            case Assign(variable, expression):
                self._give(agent, variable, self.value(agent, expression))
            case For(several, rest, _):
                self._give(agent, rest, Abstract(lists=self.members(self.value(agent, several))))
            case ForEach(variable, rest, _):
                self._give(agent, variable, self.roles[agent].given.get(rest, NOTHING).lists or NOTHING)
            case ChooseFrom(variable, several, _):
                self._give(agent, variable, self.members(self.value(agent, several)))
            case Match(expression, cases):
                self._cases(agent, cases, self.value(agent, expression))
            case Call(behaviour, arguments):
                self._pass(agent, agent, behaviour, arguments)
            case Migrate(host):
                self._host(agent, self.names(agent, host))
            case Spawn(name, host, behaviour, arguments):
                block = self.program.behaviours[behaviour].body
                self._begin(name, block, self.names(agent, host))
                self._pass(agent, name, behaviour, arguments)

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

    def _give(self, agent: Name, variable: str, value: Abstract) -> None:
        given = self.roles[agent].given
        before = given.get(variable, NOTHING)
        given[variable] = before | value
        self._grown |= given[variable] != before

    def _cases(self, agent: Name, cases: Iterable[Case], value: Abstract) -> None:
        for case in cases:
            for variable, taken in (
                bound(case.pattern, value, self.vocabulary_of(self.setting)) or {}
            ).items():
                self._give(agent, variable, taken)

    def _pass(self, giver: Name, taker: Name, behaviour: str, arguments: tuple[Expression, ...]) -> None:
        parameters = self.program.behaviours[behaviour].parameters
        for parameter, argument in zip(parameters, arguments, strict=True):
            self._give(taker, parameter, self.value(giver, argument))

    def _may_be(self, name: Name, agent: Name, expression: Expression) -> bool:
        return self.vocabulary_of(self.setting).fits(name, self.names(agent, expression))


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


def _of_family(_: ValueFlow, family: Abstract, _node: Abstract) -> Abstract:
    pairs = NOTHING if family.sets is None else family.sets
    if family.anything or pairs.anything:
        return ANYTHING
    return join(items[1] for items in pairs.tuples if len(items) > 1)


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
    "parent": lambda flow, *_: flow.entities | _SEEN_PLACES,
    "first": lambda flow, value: flow.members(value),
    "element": _element,
    "[]": _of_family,
}
"""The results of operators on abstract arguments."""
