"""Abstract values: sets of values, over-approximated from the text."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import reduce
from typing import Final

from semantics.behaviours.observations import AGENT, Fact, Observation
from semantics.behaviours.patterns import Anything, Elements, Exactly, Pattern, variables
from semantics.behaviours.values import Route, Text, Truth, Value
from semantics.state.signature import REGION, Name

DEEPEST: Final = 6
"""The greatest depth of an abstract value; deeper ones widen to `ANYTHING`, so the analysis ends."""


@dataclass(frozen=True, slots=True)
class Abstract:
    """A set of values.

    Attributes:
        words: These names and texts.
        kinds: Every entity of these kinds.
        agents: Whether it contains the names of all bigActors.
        plain: Every number (`int`), truth value (`Truth`) or observation (`Observation`).
        tuples: Tuples of fixed length: for each shape, the abstract values of its items.
        lists: The items of tuples of any length; None if it contains no such tuple.
        sets: The members of sets; None if it contains no set.
        routes: The stops of routes; None if it contains no route.
        anything: Whether it contains every value.
    """

    words: frozenset[Name | Text] = frozenset()
    kinds: frozenset[str] = frozenset()
    agents: bool = False
    plain: frozenset[type] = frozenset()
    tuples: frozenset[tuple[Abstract, ...]] = frozenset()
    lists: Abstract | None = None
    sets: Abstract | None = None
    routes: Abstract | None = None
    anything: bool = False

    def __or__(self, other: Abstract) -> Abstract:
        if self.anything or other.anything:
            return ANYTHING
        if self == other:
            return self
        return _bounded(
            Abstract(
                self.words | other.words,
                self.kinds | other.kinds,
                self.agents or other.agents,
                self.plain | other.plain,
                _merged((*self.tuples, *other.tuples)),
                _either(self.lists, other.lists),
                _either(self.sets, other.sets),
                _either(self.routes, other.routes),
            )
        )

    @property
    def parts(self) -> Iterator[Abstract]:
        """The abstract values of its items, members and stops."""
        yield from (item for items in self.tuples for item in items)
        yield from (each for each in (self.lists, self.sets, self.routes) if each is not None)


NOTHING: Final = Abstract()
ANYTHING: Final = Abstract(anything=True)
NUMBER: Final = Abstract(plain=frozenset({int}))
TRUTH: Final = Abstract(plain=frozenset({Truth}))
OBSERVATION: Final = Abstract(plain=frozenset({Observation}))


def join(several: Iterable[Abstract]) -> Abstract:
    """Return the union of several abstract values."""
    return reduce(Abstract.__or__, several, NOTHING)


def tuple_of(items: tuple[Abstract, ...]) -> Abstract:
    """Return the tuples of these items."""
    return _bounded(Abstract(tuples=frozenset({items})))


def word(value: Name | Text) -> Abstract:
    """Return the abstract value of one name or text."""
    return Abstract(words=frozenset({value}))


def constant(value: Value) -> Abstract:
    """Return the abstract value of a constant."""
    match value:
        case str() | Text():
            return word(value)
        case tuple():
            return tuple_of(tuple(map(constant, value)))
        case frozenset():
            return _bounded(Abstract(sets=join(map(constant, value))))
        case Route(stops):
            return _bounded(Abstract(routes=join(map(constant, stops))))
        case Truth():
            return TRUTH
        case int():
            return NUMBER
        case _:
            return OBSERVATION


def _bounded(value: Abstract) -> Abstract:
    return ANYTHING if _depth(value) > DEEPEST else value


def _depth(value: Abstract) -> int:
    return 1 + max(map(_depth, value.parts), default=0)


def _either(one: Abstract | None, other: Abstract | None) -> Abstract | None:
    return other if one is None else one if other is None else one | other


def _shape(items: tuple[Abstract, ...]) -> tuple[int, Name | Text | None]:
    """Return the length of tuples, and their first item if that is a single name or text."""
    first = items[0] if items else NOTHING
    is_fixed = len(first.words) == 1 and first == Abstract(first.words)
    return len(items), next(iter(first.words)) if is_fixed else None


def _merged(tuples: Iterable[tuple[Abstract, ...]]) -> frozenset[tuple[Abstract, ...]]:
    found: dict[tuple[int, Name | Text | None], tuple[Abstract, ...]] = {}
    for items in tuples:
        known = found.get(_shape(items))
        found[_shape(items)] = (
            items if known is None else tuple(a | b for a, b in zip(known, items, strict=True))
        )
    return frozenset(found.values())


# --- membership ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names of a mission.

    Attributes:
        kinds: The kind of each entity.
        agents: All bigActors that may ever exist.
    """

    kinds: Callable[[Name], str | None]
    agents: frozenset[Name]

    def fits(self, value: Value, abstract: Abstract) -> bool:
        """Whether a value is in a set of values; an observation may only mention existing entities and bigActors."""
        if isinstance(value, Observation):
            return (abstract.anything or Observation in abstract.plain) and self.observes(value)
        if isinstance(value, str):
            return abstract.anything or self._names(value, abstract)
        if isinstance(value, Text):
            return abstract.anything or value in abstract.words
        if isinstance(value, tuple):
            return self._all(value, abstract) or any(
                len(items) == len(value) and all(map(self.fits, value, items)) for items in abstract.tuples
            )
        if isinstance(value, frozenset | Route):
            return self._holds(value, abstract)
        return abstract.anything or type(value) in abstract.plain

    def _names(self, value: Name, abstract: Abstract) -> bool:
        if value in abstract.words or self.kinds(value) in abstract.kinds:
            return True
        return abstract.agents and value in self.agents

    def _all(self, value: tuple[Value, ...], abstract: Abstract) -> bool:
        items = ANYTHING if abstract.anything else abstract.lists
        return items is not None and all(self.fits(each, items) for each in value)

    def _holds(self, value: frozenset[Value] | Route, abstract: Abstract) -> bool:
        is_route = isinstance(value, Route)
        members = ANYTHING if abstract.anything else abstract.routes if is_route else abstract.sets
        within = value.stops if isinstance(value, Route) else value
        return members is not None and all(self.fits(each, members) for each in within)

    def observes(self, seen: Observation) -> bool:
        """Whether an observation mentions only this mission's entities and bigActors."""
        return all(self._says(name, fact) for name, fact in seen.facts)

    def _says(self, name: Name, fact: Fact) -> bool:
        if name.startswith(AGENT):
            return name.removeprefix(AGENT) in self.agents and fact == Fact(shown=True)
        if name == REGION:
            return fact.parent is None and not fact.links
        there = fact.parent in (None, REGION) or self.kinds(str(fact.parent)) is not None
        return self.kinds(name) is not None and there


def members(value: Abstract, observed: Abstract) -> Abstract:
    """Return the possible members of sets, routes and observations; `observed` are those of any observation."""
    if value.anything:
        return ANYTHING
    inside = [each for each in (value.sets, value.routes) if each is not None]
    return join([*inside, observed] if Observation in value.plain else inside)


def named(value: Abstract) -> Abstract:
    """Return the names that a value denotes: itself, or its members."""
    if value.anything:
        return ANYTHING
    words = frozenset(each for each in value.words if isinstance(each, str))
    own = Abstract(words, value.kinds, value.agents)
    return join([own, *(each for each in (value.sets, value.routes) if each is not None)])


# --- patterns ---------------------------------------------------------------------------------------------


def bound(pattern: Pattern, value: Abstract, known: Vocabulary) -> dict[str, Abstract] | None:
    """Return the variables that a pattern binds to parts of a value; None if it never matches."""
    match pattern:
        case Anything(variable, of):
            taken = _of_sort(value, of)
            return None if taken == NOTHING else {} if variable is None else {variable: taken}
        case Exactly(wanted):
            return {} if known.fits(wanted, value) else None
        case Elements(items):
            if value.anything:
                return dict.fromkeys(variables(pattern), ANYTHING)
            return _bound_items(items, value, known)


def _of_sort(value: Abstract, of: str | None) -> Abstract:
    if of == "observation":
        may_be = value.anything or Observation in value.plain
        return OBSERVATION if may_be else NOTHING
    if of == "message" and not value.anything:
        return replace(value, plain=value.plain - {Observation})
    return value


def _bound_items(
    items: tuple[Pattern, ...], value: Abstract, known: Vocabulary
) -> dict[str, Abstract] | None:
    shapes = [parts for parts in value.tuples if len(parts) == len(items)]
    shapes += [] if value.lists is None else [(value.lists,) * len(items)]
    found: dict[str, Abstract] | None = None
    for parts in shapes:
        each = [bound(item, part, known) for item, part in zip(items, parts, strict=True)]
        if None not in each:
            found = found or {}
            for binding in each:
                for name, taken in (binding or {}).items():
                    found[name] = found.get(name, NOTHING) | taken
    return found
