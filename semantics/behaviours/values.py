"""The values of behaviours: names, texts, numbers, booleans, tuples, sets, routes and observations."""

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Final, Union

if TYPE_CHECKING:
    from semantics.behaviours.observations import Observation


class Truth(Enum):
    """A truth value of the host language, distinct from the numbers (in Python `True == 1`)."""

    FALSE = "false"
    TRUE = "true"

    def __bool__(self) -> bool:
        return self is Truth.TRUE

    @staticmethod
    def of(value: bool) -> "Truth":
        """Return the truth value of a Python boolean."""
        return Truth.TRUE if value else Truth.FALSE


@dataclass(frozen=True, slots=True)
class Text:
    """A text of the mission, such as `"handover"`; never equal to a name, even with the same characters."""

    characters: str


@dataclass(frozen=True, slots=True)
class Route:
    """`[a, b, a]`: values in order, with repetitions; never equal to a tuple."""

    stops: tuple["Value", ...]


Value = Union[str, Text, int, Truth, tuple["Value", ...], frozenset["Value"], Route, "Observation"]
"""A Python string is the name of an entity, a bigActor or a kind; a quoted text of the mission is a `Text`."""

ESCAPES: Final = str.maketrans({'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t"})
"""The escape sequences of a text."""

LARGEST_NUMBER = 10**18
"""The bound on the absolute value of numbers: printing, comparing and storing them stays cheap."""

MOST_PARTS = 1000
"""The most parts of a tuple, set or route, nested parts included."""


def parts(value: Value) -> int:
    """Return the number of a value and its nested parts, with repetitions."""
    return 1 + sum(map(parts, within(value)))


def within(value: Value) -> "tuple[Value, ...] | frozenset[Value]":
    """Return the parts of a tuple, a set or a route; empty for any other value."""
    if isinstance(value, Route):
        return value.stops
    return value if isinstance(value, tuple | frozenset) else ()


def order_key(value: Value) -> tuple[str, str]:
    """Return a key that orders values of any types canonically, the same in every process."""
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
    if isinstance(value, Text):
        return ("text", value.characters)
    return (type(value).__name__, repr(value))  # an observation's text omits some of its contents


def in_order(values: "frozenset[Value] | tuple[Value, ...]") -> tuple[Value, ...]:
    """Return the members of a set in canonical order.

    >>> in_order(frozenset({"b", 2, "a", -1, 10}))
    (-1, 2, 10, 'a', 'b')
    """
    return tuple(sorted(values, key=order_key))


def show(value: Value) -> str:
    """Return a value in the notation of the mission language: a name as it is, a text in quotes.

    >>> show((Text("found"), frozenset({"b0", "a0"})))
    '("found", {a0, b0})'
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Text):
        return f'"{value.characters.translate(ESCAPES)}"'
    if isinstance(value, Truth):
        return value.value
    if isinstance(value, tuple):
        return f"({', '.join(map(show, value))})"
    if isinstance(value, Route):
        return f"[{', '.join(map(show, value.stops))}]"
    if isinstance(value, frozenset):
        return f"{{{', '.join(map(show, in_order(value)))}}}"
    return str(value)


def spoken(value: Value) -> str:
    """Return a value as a reader expects it: a single text without its quotes, all else in the language's notation.

    >>> spoken(Text("no answer")), spoken((Text("go"), "base"))
    ('no answer', '("go", base)')
    """
    return value.characters if isinstance(value, Text) else show(value)
