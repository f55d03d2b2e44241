"""The values of behaviours: names, texts, numbers, booleans, tuples, sets, routes and observations."""

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Union

if TYPE_CHECKING:
    from semantics.behaviours.observations import Observation


class Truth(Enum):
    """A truth value of the host language, kept apart from the numbers (in Python `True == 1`)."""

    FALSE = "false"
    TRUE = "true"

    def __bool__(self) -> bool:
        return self is Truth.TRUE

    @staticmethod
    def of(value: bool) -> "Truth":
        """Lift a Python boolean."""
        return Truth.TRUE if value else Truth.FALSE


@dataclass(frozen=True, slots=True)
class Route:
    """`[a, b, a]`: values in their order, each as often as it is written; never equal to a tuple."""

    stops: tuple["Value", ...]


Value = Union[str, int, Truth, tuple["Value", ...], frozenset["Value"], Route, "Observation"]
"""Names and texts are both strings: a text that spells a name is that name."""


LARGEST_NUMBER = 10**18
"""Numbers lie between this and its negative: what is printed, compared and stored stays small."""

MOST_PARTS = 1000
"""How many parts a tuple, set or route may have, parts of parts included."""


def parts(value: Value) -> int:
    """Count a value and its parts, as often as they occur."""
    return 1 + sum(map(parts, within(value)))


def within(value: Value) -> "tuple[Value, ...] | frozenset[Value]":
    """Return the parts of a tuple, a set or a route; nothing of another value."""
    if isinstance(value, Route):
        return value.stops
    return value if isinstance(value, tuple | frozenset) else ()


def order_key(value: Value) -> tuple[str, str]:
    """Order values of any types canonically, the same in every process."""
    if isinstance(value, frozenset):
        return ("frozenset", repr(sorted(order_key(item) for item in value)))
    if isinstance(value, tuple):
        return ("tuple", repr([order_key(item) for item in value]))
    if isinstance(value, Route):
        return ("route", repr([order_key(item) for item in value.stops]))
    if isinstance(value, int):
        return ("int", f"{value + LARGEST_NUMBER:019d}")
    if isinstance(value, str | Truth):
        return (type(value).__name__, str(value))
    return (type(value).__name__, repr(value))  # an observation shows less than it holds


def in_order(values: "frozenset[Value] | tuple[Value, ...]") -> tuple[Value, ...]:
    """Return the members of a set in canonical order.

    >>> in_order(frozenset({"b", 2, "a", -1, 10}))
    (-1, 2, 10, 'a', 'b')
    """
    return tuple(sorted(values, key=order_key))


def show(value: Value, names: "frozenset[str] | None" = None) -> str:
    """Print a value in the notation of the mission language; a text that is no known name is quoted.

    >>> show(("found", frozenset({"b0", "a0"})), frozenset({"a0", "b0"}))
    '("found", {a0, b0})'
    """
    if isinstance(value, str):
        return value if names is None or value in names else f'"{value}"'
    if isinstance(value, Truth):
        return value.value
    if isinstance(value, tuple):
        return f"({', '.join(show(item, names) for item in value)})"
    if isinstance(value, Route):
        return f"[{', '.join(show(item, names) for item in value.stops)}]"
    if isinstance(value, frozenset):
        return f"{{{', '.join(show(item, names) for item in in_order(value))}}}"
    return str(value)
