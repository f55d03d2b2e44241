"""Patterns of `react` and `match`: matching and binding."""

from dataclasses import dataclass
from typing import Literal as Choice

from semantics.behaviours.observations import Observation
from semantics.behaviours.values import Value


@dataclass(frozen=True, slots=True)
class Anything:
    """A variable or `_`, for an observation, a message, or either (`of` None)."""

    variable: str | None = None
    of: Choice["observation", "message"] | None = None


@dataclass(frozen=True, slots=True)
class Exactly:
    """One value."""

    value: Value


@dataclass(frozen=True, slots=True)
class Elements:
    """A tuple, element by element."""

    items: tuple["Pattern", ...]


Pattern = Anything | Exactly | Elements
Binding = dict[str, Value]


def bind(pattern: Pattern, value: Value) -> Binding | None:
    """Return the variables that a pattern binds to parts of a value, None if it does not match.

    >>> bind(Elements((Exactly("found"), Anything("place"))), ("found", "spill0"))
    {'place': 'spill0'}
    """
    match pattern:
        case Anything(variable, of):
            if of is not None and (of == "observation") is not isinstance(value, Observation):
                return None
            return {} if variable is None else {variable: value}
        case Exactly(constant):
            return {} if type(value) is type(constant) and value == constant else None
        case Elements(items):
            return _bind_all(items, value)


def _bind_all(items: tuple[Pattern, ...], value: Value) -> Binding | None:
    if not isinstance(value, tuple) or len(value) != len(items):
        return None
    binding: Binding = {}
    for item, part in zip(items, value, strict=True):
        bound = bind(item, part)
        if bound is None:
            return None
        binding |= bound
    return binding


def looks_into(pattern: Pattern) -> bool:
    """Whether a match depends on the value itself, and not only on its being an observation or a message."""
    return not isinstance(pattern, Anything)


def variables(pattern: Pattern) -> frozenset[str]:
    """Return the variables that a pattern binds."""
    match pattern:
        case Anything(variable, _):
            return frozenset() if variable is None else frozenset({variable})
        case Elements(items):
            return frozenset[str]().union(*map(variables, items))
        case _:
            return frozenset()
