"""The possible types of values, over-approximated from the text: a value certainly has none of the other types."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from semantics.analysis.traversal import Origin, bindings
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
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Send, Statement
from semantics.behaviours.values import Route, Text, Truth, Value, within

MISTAKEN: Final = Literal("")
"""Stands, by identity, for an expression with a mistake: the mission is refused, and its type is unknown."""


class ValueSort(StrEnum):
    """The sort of a value, by its description in messages."""

    NUMBER = "a number"
    TRUTH = "true or false"
    TEXT = "a text"
    ENTITY = "an entity"
    AGENT = "a bigActor"
    TUPLE = "a tuple"
    SET = "a set"
    ROUTE = "a route"
    OBSERVATION = "an observation"


Sorts = frozenset[ValueSort]
EVERY: Final = Sorts(ValueSort)
NAMES: Final = Sorts({ValueSort.ENTITY, ValueSort.AGENT})
HOLDERS: Final = Sorts({ValueSort.SET, ValueSort.ROUTE})
COLLECTIONS: Final = HOLDERS | {ValueSort.OBSERVATION}

Tag = Text | str | None
"""The fixed text or name that distinguishes tuples of one length."""

Shape = tuple[int, Tag]
"""The length of a tuple, and its first item if that is a fixed text or name."""


@dataclass(frozen=True, slots=True)
class Type:
    """The possible types of a value.

    Attributes:
        sorts: Its possible sorts; empty if it has no value at all.
        members: The possible sorts of the members of its sets and routes.
        tuples: The possible sorts of the items of its tuples, by their shape; None if they are unknown.
    """

    sorts: Sorts
    members: Sorts = frozenset()
    tuples: Mapping[Shape, tuple[Sorts, ...]] | None = field(default_factory=dict)

    def __or__(self, other: Type) -> Type:
        return Type(
            self.sorts | other.sorts, self.members | other.members, _merged(self.tuples, other.tuples)
        )

    def without(self, sort: ValueSort) -> Type:
        """Return the type without one of its sorts."""
        return Type(self.sorts - {sort}, self.members, self.tuples)


def _merged(
    one: Mapping[Shape, tuple[Sorts, ...]] | None, other: Mapping[Shape, tuple[Sorts, ...]] | None
) -> Mapping[Shape, tuple[Sorts, ...]] | None:
    if one is None or other is None:
        return None
    both = {
        shape: tuple(a | b for a, b in zip(one[shape], other[shape], strict=True))
        for shape in one.keys() & other.keys()
    }
    return {**one, **other, **both}


def of(*sorts: ValueSort) -> Type:
    """Return the type of a value of these sorts, with unknown parts."""
    return Type(
        Sorts(sorts), EVERY if HOLDERS & Sorts(sorts) else Sorts(), None if ValueSort.TUPLE in sorts else {}
    )


def sort_of(value: Value, agents: Container[str]) -> ValueSort:
    """Return the sort of a constant; a name that is no bigActor's is an entity's or a place's."""
    if isinstance(value, str):
        return ValueSort.AGENT if value in agents else ValueSort.ENTITY
    return next(sort for type_, sort in _SORT_OF.items() if isinstance(value, type_))


_SORT_OF: Final[Mapping[type, ValueSort]] = {
    Text: ValueSort.TEXT,
    Truth: ValueSort.TRUTH,
    int: ValueSort.NUMBER,
    tuple: ValueSort.TUPLE,
    frozenset: ValueSort.SET,
    Route: ValueSort.ROUTE,
    Observation: ValueSort.OBSERVATION,
}

_TUPLE: Final = Sorts({ValueSort.TUPLE})
ANY: Final = of(*ValueSort)
NOTHING: Final = Type(Sorts())
Types = Mapping[str, Type]


@dataclass(frozen=True)
class Inference:
    """The type inference of a mission: for each variable one type, from the whole text, unreachable statements too.

    `semantics.analysis.value_flow` is finer, and needs a text without mistakes.

    Attributes:
        program: The program of the bigActors.
        entities: The names of entities.
        agents: The names of bigActors.
        said: The messages from outside.
    """

    program: Program
    entities: frozenset[str]
    agents: frozenset[str]
    said: tuple[Value, ...] = ()

    def variables(self) -> Types:
        """Return the possible types of each variable's values: a least fixpoint, since loops lead back."""
        known: dict[str, Type] = {}
        grown = True
        while grown:
            grown = False
            messages = self.messages(known)
            for statement in self.program.statements:
                for variable, given in self.given(statement, known, messages):
                    before = known.get(variable, NOTHING)
                    known[variable] = before | given
                    grown = grown or known[variable] != before
        return known

    def messages(self, known: Types) -> Type:
        """Return the type of all messages, from bigActors and from outside."""
        sent = (each.message for each in self.program.statements if isinstance(each, Send))
        found = NOTHING
        for message in (*map(self.constant, self.said), *(self.type(each, known) for each in sent)):
            found |= message
        return found

    def given(
        self, statement: Statement, known: Types, messages: Type | None = None
    ) -> Iterator[tuple[str, Type]]:
        """Yield the variables that a statement assigns, with the types."""
        received = (ANY if messages is None else messages) | of(ValueSort.OBSERVATION)
        for each in bindings(self.program, statement):
            value = received if each.expression is None else self.type(each.expression, known)
            yield from bound(each.pattern, _part_of(value, each.origin))

    def constant(self, value: Value) -> Type:
        """Return the type of a constant."""
        match value:
            case tuple():
                shape = (len(value), _tag(value[0]) if value else None)
                return Type(
                    Sorts({ValueSort.TUPLE}),
                    tuples={shape: tuple(self.constant(each).sorts for each in value)},
                )
            case frozenset() | Route():
                members = (self.constant(each).sorts for each in within(value))
                return Type(Sorts({sort_of(value, self.agents)}), Sorts().union(*members))
            case _:
                return of(sort_of(value, self.agents))

    def type(self, expression: Expression, known: Types) -> Type:
        """Return the type of an expression."""
        match expression:
            case Literal(value):
                return ANY if expression is MISTAKEN else self.constant(value)
            case Variable(name):
                return known.get(name, NOTHING)
            case Host():
                return of(ValueSort.ENTITY)
            case Self():
                return of(ValueSort.AGENT)
            case ShortCircuit():
                return of(ValueSort.TRUTH)
            case TupleOf(items):
                shape = (len(items), _tag(items[0].value) if isinstance(items[0], Literal) else None)
                return Type(
                    Sorts({ValueSort.TUPLE}),
                    tuples={shape: tuple(self.type(each, known).sorts for each in items)},
                )
            case SetOf(items) | RouteOf(items):
                sort = ValueSort.ROUTE if isinstance(expression, RouteOf) else ValueSort.SET
                return Type(Sorts({sort}), Sorts().union(*(self.type(each, known).sorts for each in items)))
            case Apply(operator, arguments):
                given = [self.type(argument, known) for argument in arguments]
                if operator == "element":
                    return _element(given[0], arguments[1])
                return _RESULTS[operator](*given) if operator in _RESULTS else ANY


def _tag(value: Value) -> Tag:
    return value if isinstance(value, Text | str) else None


def _part_of(value: Type, origin: Origin) -> Type:
    """Return the type that a statement binds; the rest of a loop is a tuple of unknown length."""
    match origin:
        case Origin.MEMBERS:
            return Type(_TUPLE, members_of(value), None)
        case Origin.MEMBER:
            return of(*(value.members if value.sorts == _TUPLE else members_of(value)))
        case _:
            return value


def members_of(collection: Type) -> Sorts:
    """Return the sorts of the members of a set, a route or an observation."""
    seen = NAMES if ValueSort.OBSERVATION in collection.sorts else Sorts()
    return collection.members | seen if HOLDERS & collection.sorts else seen


def bound(pattern: Pattern, value: Type) -> Iterator[tuple[str, Type]]:
    """Yield the variables that a pattern binds, with the types, for a subject of that type."""
    match pattern:
        case Anything(str() as variable, kind):
            seen, told = of(ValueSort.OBSERVATION), value.without(ValueSort.OBSERVATION)
            yield variable, seen if kind == "observation" else told if kind == "message" else value
        case Elements(items):
            parts = _items(items, value)
            for item, sorts in zip(items, parts, strict=True):
                yield from bound(item, of(*sorts))


def may_take(pattern: Pattern, value: Type, inference: Inference) -> bool:
    """Whether a pattern may match a value of that type."""
    match pattern:
        case Anything(_, "observation"):
            return ValueSort.OBSERVATION in value.sorts
        case Anything(_, kind):
            return bool(value.sorts - {ValueSort.OBSERVATION} if kind == "message" else value.sorts)
        case Exactly(constant):
            return bool(inference.constant(constant).sorts & value.sorts)
        case Elements(items):
            parts = zip(items, _items(items, value), strict=True)
            return ValueSort.TUPLE in value.sorts and all(
                may_take(item, of(*sorts), inference) for item, sorts in parts
            )


def compared(pattern: Pattern, value: Type) -> Iterator[tuple[Value, Sorts]]:
    """Yield the constants of a pattern, each with the sorts that it is compared with in tuples of its length."""
    match pattern:
        case Exactly(constant) if value.sorts:
            yield constant, value.sorts
        case Elements(items):
            parts = _items(items, value)
            parts = parts if any(parts) else _items((Anything(),) * len(items), value)
            for item, sorts in zip(items, parts, strict=True):
                yield from compared(item, of(*sorts))


def _items(items: tuple[Pattern, ...], value: Type) -> tuple[Sorts, ...]:
    """Return the sorts of the items of the tuples that a pattern may match."""
    if value.tuples is None:
        return (EVERY,) * len(items)
    wanted = items[0].value if isinstance(items[0], Exactly) else None
    found = [
        sorts
        for (length, first), sorts in value.tuples.items()
        if length == len(items) and (wanted is None or first is None or first == wanted)
    ]
    return tuple(map(Sorts().union, *found)) if found else (Sorts(),) * len(items)


def _element(value: Type, index: Expression) -> Type:
    """Return the type of one item of a tuple, or one stop of a route."""
    if value.tuples is None:
        return ANY
    at = index.value if isinstance(index, Literal) and isinstance(index.value, int) else None
    items = [
        sorts
        for parts in value.tuples.values()
        for position, sorts in enumerate(parts)
        if at is None or at == position
    ]
    stops = value.members if ValueSort.ROUTE in value.sorts else Sorts()
    return of(*stops.union(*items))


def _always(*sorts: ValueSort) -> Callable[..., Type]:
    return lambda *_: of(*sorts)


def _set(members: Iterable[ValueSort]) -> Type:
    return Type(Sorts({ValueSort.SET}), Sorts(members))


def _sum(left: Type, right: Type) -> Type:
    number = of(ValueSort.NUMBER) if ValueSort.NUMBER in left.sorts else NOTHING
    return number | Type(left.sorts & HOLDERS, left.members | members_of(right))


def _part(left: Type, members: Sorts) -> Type:
    """Return the type of a part of a collection: a route for a route, otherwise a set."""
    route = Type(Sorts({ValueSort.ROUTE}), members) if ValueSort.ROUTE in left.sorts else NOTHING
    return route | _set(members) if left.sorts - {ValueSort.ROUTE} else route


def _difference(left: Type, _: Type) -> Type:
    number = of(ValueSort.NUMBER) if ValueSort.NUMBER in left.sorts else NOTHING
    return number | _part(left, members_of(left)) if left.sorts & COLLECTIONS else number


_RESULTS: Final[Mapping[str, Callable[..., Type]]] = {
    **dict.fromkeys(
        ("in", "==", "!=", "<", "<=", ">", ">=", "not", "empty", "linked"), _always(ValueSort.TRUTH)
    ),
    "+": _sum,
    "-": _difference,
    "of": lambda left, _: _part(left, Sorts({ValueSort.ENTITY})),
    "union": lambda left, right: _set(members_of(left) | members_of(right)),
    "minus": lambda left, _: _part(left, members_of(left)),
    "intersect": lambda left, right: _part(left, members_of(left) & members_of(right)),
    "[]": _always(ValueSort.AGENT),
    "nodes": lambda _: _set({ValueSort.ENTITY}),
    "children": lambda *_: _set({ValueSort.ENTITY}),
    "agents": lambda _: _set({ValueSort.AGENT}),
    "kind": _always(ValueSort.TEXT),
    "parent": _always(ValueSort.ENTITY),
    "size": _always(ValueSort.NUMBER),
    "first": lambda value: of(*members_of(value)),
}
"""The result types of operators, given the types of their arguments; unknown for all others."""
