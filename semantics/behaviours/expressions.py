"""Expressions of the host language, and their evaluation with the provenance of the value."""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from semantics.behaviours.observations import All, Nodes, Observation, Of, Query, QueryOperator
from semantics.behaviours.values import (
    LARGEST_NUMBER,
    MOST_PARTS,
    Route,
    Text,
    Truth,
    Value,
    in_order,
    parts,
    show,
    within,
)
from semantics.races.provenance import ANY, EVERYTHING, MEMBERS, NOTHING, SIZE, Key, Provenance, asking
from semantics.state.signature import UNKNOWN, Name


class Fault(Exception):
    """An agent's computation fails or diverges: an error of the mission, found on a run.

    Attributes:
        agent: The agent.
        diverges: Whether the computation reaches no command, instead of failing.
    """

    def __init__(self, message: str, *, diverges: bool = False) -> None:
        super().__init__(message)
        self.agent: Name = ""
        self.diverges = diverges


@dataclass(frozen=True, slots=True)
class Literal:
    """A constant."""

    value: Value


@dataclass(frozen=True, slots=True)
class Variable:
    """The value of a variable."""

    name: str


@dataclass(frozen=True, slots=True)
class Host:
    """`HOST`: the current host of the agent."""


@dataclass(frozen=True, slots=True)
class Self:
    """`SELF`: the agent's own name."""


@dataclass(frozen=True, slots=True)
class Apply:
    """An operator of `OPERATORS` applied to arguments."""

    operator: str
    arguments: tuple["Expression", ...]


@dataclass(frozen=True, slots=True)
class ShortCircuit:
    """`a or b` (`stop_at` true) and `a and b` (`stop_at` false), with short-circuit evaluation."""

    stop_at: bool
    first: "Expression"
    second: "Expression"


@dataclass(frozen=True, slots=True)
class TupleOf:
    """A tuple."""

    items: tuple["Expression", ...]


@dataclass(frozen=True, slots=True)
class SetOf:
    """A set."""

    items: tuple["Expression", ...]


@dataclass(frozen=True, slots=True)
class RouteOf:
    """A route."""

    items: tuple["Expression", ...]


@dataclass(frozen=True, slots=True)
class QueryOf:
    """A query with expressions at its leaves; without an operator it denotes the nodes that the expression names."""

    operator: QueryOperator | None
    argument: "Expression | QueryOf | None"


Expression = Literal | Variable | Host | Self | Apply | ShortCircuit | TupleOf | SetOf | RouteOf


@dataclass(slots=True)
class EvaluationScope:
    """The environment of an expression, and the provenance of its evaluation so far.

    Attributes:
        store: Variables.
        rests_on: The provenance of each variable; empty if the race monitor is off.
        kinds: The kind of each entity.
        kept: The names under which each variable's values are kept to the end of the run (`Program.kept`).
        placed: The provenance of the choice of the host.
        used: The provenance of the variables, hosts and observations read so far.
    """

    agent: Name
    host: Name
    store: dict[str, Value]
    rests_on: dict[str, Provenance]
    kinds: Mapping[Name, str]
    kept: Mapping[str, frozenset[str]]
    placed: Provenance = NOTHING
    used: Provenance = field(default=NOTHING)

    def binding(self, names: Mapping[str, Value], provenance: Provenance) -> None:
        """Assign values with one provenance to variables."""
        self.rests_on.update(dict.fromkeys(names, provenance))
        for name, value in names.items():
            self.store[name] = value
            self.store.update(dict.fromkeys(self.kept.get(name, ()), value))


def evaluate(expression: Expression, scope: EvaluationScope) -> Value:
    """Return the value of an expression.

    Raises:
        Fault: An operator was given arguments that it does not accept.
    """
    match expression:
        case Literal(value):
            return value
        case Variable(name):
            scope.used |= scope.rests_on.get(name, NOTHING)
            return scope.store[name]
        case Host():
            scope.used |= scope.placed
            return scope.host
        case Self():
            return scope.agent
        case TupleOf(items):
            return _small(tuple(evaluate(item, scope) for item in items))
        case SetOf(items):
            return _small(frozenset(evaluate(item, scope) for item in items))
        case RouteOf(items):
            return _small(Route(tuple(evaluate(item, scope) for item in items)))
        case ShortCircuit(stop_at, first, second):
            value = truth(evaluate(first, scope))
            return Truth.of(value) if value is stop_at else Truth.of(truth(evaluate(second, scope)))
        case Apply(operator, arguments):
            return _apply(OPERATORS[operator], operator, arguments, scope)


def evaluated(expression: Expression, scope: EvaluationScope) -> tuple[Value, Provenance]:
    """Return the value of an expression with its provenance."""
    before, scope.used = scope.used, NOTHING
    value = evaluate(expression, scope)
    provenance, scope.used = scope.used, before | scope.used
    return value, provenance


def _apply(
    operator: "Operator", name: str, arguments: tuple[Expression, ...], scope: EvaluationScope
) -> Value:
    before, scope.used = scope.used, NOTHING
    values = [evaluate(argument, scope) for argument in arguments]
    keys = tuple(operator.asks(*values)) if scope.used else ()
    scope.used = before | asking(scope.used, keys)
    try:
        return operator.apply(scope, *values)
    except (TypeError, ValueError, KeyError, IndexError) as error:
        shown = ", ".join(map(show, values))
        raise Fault(f"'{name}' can't be computed of ({shown}): {error}") from error


def _small(value: Value) -> Value:
    if parts(value) > MOST_PARTS:
        raise Fault(f"a value has more than {MOST_PARTS} parts")
    return value


def truth(value: Value) -> bool:
    """Return the Python boolean of a truth value.

    Raises:
        Fault: The value is no truth value.
    """
    if isinstance(value, Truth):
        return bool(value)
    raise Fault(f"a test needs true or false, not {show(value)}")


def query_of(template: QueryOf, scope: EvaluationScope) -> Query:
    """Return the query with `HOST`, variables and other expressions resolved.

    Raises:
        Fault: A leaf is neither a name nor a set or route of names.
    """
    argument = template.argument
    if argument is None:
        return All()
    inner = (
        query_of(argument, scope)
        if isinstance(argument, QueryOf)
        else Nodes(names_in(evaluate(argument, scope)))
    )
    return inner if template.operator is None else Of(template.operator, inner)


def names_in(value: Value) -> tuple[Name, ...]:
    """Return the names that a value denotes: itself, or its members.

    Raises:
        Fault: It denotes none.
    """
    members = in_order(_members(value)) if isinstance(value, frozenset | Route) else (value,)
    if not all(isinstance(member, str) for member in members):
        raise Fault(f"a name was expected, not {show(value)}")
    return tuple(str(member) for member in members)


def name_in(value: Value) -> Name:
    """Return the one name that a value denotes.

    Raises:
        Fault: It denotes none or several.
    """
    names = names_in(value)
    if len(names) != 1:
        raise Fault(f"one name was expected, not {show(value)}")
    return names[0]


# --- operators ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Operator:
    """One operator or function of the language.

    Attributes:
        arity: The number of its arguments.
        summary: One line for the reference page.
        apply: Its meaning, as a function of the scope and the values.
        asks: The questions that it asks of the observations among its arguments.
    """

    arity: int
    summary: str
    apply: Callable[..., Value]
    asks: Callable[..., tuple[Key, ...]] = lambda *_: (EVERYTHING,)


def _members(value: Value) -> frozenset[Value]:
    if isinstance(value, Observation):
        return frozenset(value.members) | frozenset(value.agents)
    if isinstance(value, frozenset | Route):
        return frozenset(within(value))
    raise TypeError("a set, a route or an observation was expected")


def _each(value: Value) -> Collection[Value]:
    """Return the members of a set or an observation, or the stops of a route in order, repetitions included."""
    return value.stops if isinstance(value, Route) else _members(value)


def _only(value: Value, wanted: Callable[[Value], bool]) -> Value:
    """Return the collection of the wanted members; that of a route is a route."""
    kept = filter(wanted, _each(value))
    return Route(tuple(kept)) if isinstance(value, Route) else frozenset(kept)


def _number(value: Value) -> int:
    if isinstance(value, int):
        return value
    raise TypeError("a number was expected")


def _bounded(number: int) -> int:
    if abs(number) >= LARGEST_NUMBER:
        raise ValueError(f"a number has more than {len(str(LARGEST_NUMBER)) - 1} digits")
    return number


def _name(value: Value) -> Name:
    if isinstance(value, str):
        return value
    raise TypeError("a name was expected")


def _seen(value: Value) -> Observation:
    if isinstance(value, Observation):
        return value
    raise TypeError("an observation was expected")


def _add(_: EvaluationScope, a: Value, b: Value) -> Value:
    if isinstance(a, Route) and isinstance(b, Route):
        return _small(Route(a.stops + b.stops))
    return a | _members(b) if isinstance(a, frozenset) else _bounded(_number(a) + _number(b))


def _subtract(_: EvaluationScope, a: Value, b: Value) -> Value:
    return _bounded(_number(a) - _number(b)) if isinstance(a, int) else _minus(_, a, b)


def _minus(_: EvaluationScope, a: Value, b: Value) -> Value:
    without = _members(b)
    return _only(a, lambda member: member not in without)


def _intersect(_: EvaluationScope, a: Value, b: Value) -> Value:
    both = _members(b)
    return _only(a, lambda member: member in both)


def _of_kind(scope: EvaluationScope, value: Value, kind: Value) -> Value:
    return _only(value, lambda item: isinstance(item, str) and scope.kinds.get(item) == kind)


def _first(_: EvaluationScope, value: Value) -> Value:
    members = in_turn(value)
    if not members:
        raise ValueError(f"the {'route' if isinstance(value, Route) else 'set'} is empty")
    return members[0]


def in_turn(value: Value) -> tuple[Value, ...]:
    """Return the members of a set or an observation in canonical order, or the stops of a route in order."""
    return value.stops if isinstance(value, Route) else in_order(_members(value))


def _element(_: EvaluationScope, value: Value, index: Value) -> Value:
    items = within(value)
    if not isinstance(items, tuple) or not 0 <= _number(index) < len(items):
        raise IndexError("no such element")
    return items[_number(index)]


def _member(_: EvaluationScope, family: Value, entity: Value) -> Value:
    for each in within(family):
        if isinstance(each, tuple) and each[0] == entity:
            return each[1]
    known = ", ".join(sorted(str(each[1]) for each in within(family) if isinstance(each, tuple))[:5])
    raise Fault(f"there is no member for {show(entity)}: the family's members are {known or 'none'}")


def _compare(holds: Callable[[int, int], bool]) -> Callable[..., Value]:
    return lambda _, a, b: Truth.of(holds(_number(a), _number(b)))


def _linked(_: EvaluationScope, a: Value, b: Value, seen: Value) -> Value:
    observation = _seen(seen)
    return Truth.of(bool(observation.links(_name(a)) & observation.links(_name(b))))


def members_asked(*values: Value, key: Key = MEMBERS) -> tuple[Key, ...]:
    """Return the questions asked by an operator on members: the whole observation if one is inside another value.

    `ANY` stands for an unknown value: either question may be asked.
    """
    return _asked(key, ANY in values, any(map(_holds_observation, values)))


def _in_asked(name: Value, _: Value) -> tuple[Key, ...]:
    """Return the questions of `in`: finding an observation in a set compares its whole contents."""
    return _asked(("in", str(name)), name == ANY, _holds_observation((name,)))


def _asked(key: Key, either: bool, everything: bool) -> tuple[Key, ...]:
    if either:
        return (key, EVERYTHING)
    return (EVERYTHING,) if everything else (key,)


def _holds_observation(value: Value) -> bool:
    """Whether an observation is part of a tuple, a set or a route."""
    return any(isinstance(part, Observation) or _holds_observation(part) for part in within(value))


def _keys(*kinds: str) -> Callable[..., tuple[Key, ...]]:
    return lambda *values: tuple((kind, str(value)) for kind, value in zip(kinds, values, strict=False))


OPERATORS: Mapping[str, Operator] = {
    "in": Operator(
        2,
        "whether a name is in a set or a route, or was shown in an observation",
        lambda _, x, y: Truth.of(x in (y if isinstance(y, Observation) else _members(y))),
        _in_asked,
    ),
    "==": Operator(
        2, "whether two values are the same", lambda _, x, y: Truth.of(type(x) is type(y) and x == y)
    ),
    "!=": Operator(
        2, "whether two values differ", lambda _, x, y: Truth.of(type(x) is not type(y) or x != y)
    ),
    "<": Operator(2, "whether a number is less than another", _compare(lambda a, b: a < b)),
    "<=": Operator(2, "whether a number is at most another", _compare(lambda a, b: a <= b)),
    ">": Operator(2, "whether a number is more than another", _compare(lambda a, b: a > b)),
    ">=": Operator(2, "whether a number is at least another", _compare(lambda a, b: a >= b)),
    "+": Operator(
        2, "the sum of two numbers, the union of two sets, one route behind another", _add, members_asked
    ),
    "-": Operator(2, "the difference of two numbers, sets or routes", _subtract, members_asked),
    "not": Operator(1, "the contrary of a truth value", lambda _, x: Truth.of(not truth(x))),
    "of": Operator(2, "the members of a kind", _of_kind, members_asked),
    "union": Operator(
        2, "the members of either set", lambda _, a, b: _members(a) | _members(b), members_asked
    ),
    "minus": Operator(
        2,
        "the members of the first set that are not in the second",
        _minus,
        members_asked,
    ),
    "intersect": Operator(2, "the members of both sets", _intersect, members_asked),
    "size": Operator(
        1,
        "how many members a set, a route or an observation has",
        lambda _, a: len(_each(a)),
        partial(members_asked, key=SIZE),
    ),
    "empty": Operator(
        1,
        "whether a set, a route or an observation has no member",
        lambda _, a: Truth.of(not _each(a)),
        members_asked,
    ),
    "nodes": Operator(
        1,
        "the nodes that an observation shows, as a set",
        lambda _, a: frozenset(_seen(a).shown),
        members_asked,
    ),
    "agents": Operator(
        1,
        "the agents that an observation shows, as a set",
        lambda _, a: frozenset(_seen(a).agents),
        members_asked,
    ),
    "kind": Operator(1, "the kind of an entity, as a text", lambda scope, a: Text(scope.kinds[_name(a)])),
    "parent": Operator(
        2,
        "the place in which an observation saw a node; `unknown` if it did not see it, `region` if it is in no place",
        lambda _, x, o: _seen(o).parent(_name(x)) or UNKNOWN,
        _keys("parent"),
    ),
    "children": Operator(
        2,
        "the nodes that an observation saw in a place",
        lambda _, x, o: _seen(o).children(_name(x)),
        _keys("children"),
    ),
    "linked": Operator(
        3, "whether an observation saw two nodes on one link", _linked, _keys("links", "links")
    ),
    "first": Operator(
        1, "the first member of a route, or of a set in the order of names", _first, members_asked
    ),
    "[]": Operator(2, "the member of a family for an entity", _member),
    "element": Operator(2, "one element of a tuple or a route, counted from 0", _element),
}


def free(expression: Any) -> frozenset[str]:
    """Return the variables that an expression or a query reads."""
    return frozenset(leaf.name for leaf in leaves(expression) if isinstance(leaf, Variable))


def reads_host(expression: Any) -> bool:
    """Whether an expression or a query reads `HOST`."""
    return any(isinstance(leaf, Host) for leaf in leaves(expression))


def leaves(expression: Any) -> Iterator[Expression]:
    """Yield the constants, variables and names in an expression or a query."""
    atoms = Literal | Variable | Host | Self
    return (each for each in subexpressions(expression) if isinstance(each, atoms))


def subexpressions(expression: Any) -> Iterator[Expression]:
    """Yield an expression, or that of a query, with all its parts."""
    if not isinstance(expression, QueryOf | None):
        yield expression
    for part in direct_parts(expression):
        yield from subexpressions(part)


def direct_parts(expression: Any) -> tuple[Any, ...]:
    """Return the direct parts of an expression or a query."""
    match expression:
        case Apply(_, parts) | TupleOf(parts) | SetOf(parts) | RouteOf(parts):
            return parts
        case ShortCircuit(_, first, second):
            return (first, second)
        case QueryOf(_, argument):
            return (argument,)
        case _:
            return ()


def leaf_of(query: QueryOf) -> tuple[Expression, ...]:
    """Return the whole expression at the leaf of a query, if it has one."""
    inner = query.argument
    return () if inner is None else leaf_of(inner) if isinstance(inner, QueryOf) else (inner,)
