"""JSON from outside as values of declared types, with bounds; one error names the place of a fault."""

from __future__ import annotations

from typing import Final, TypeVar

import msgspec

from physical import PhysicalError, legible, read_json

MOST_WORDS: Final = 300
"""The most characters of a fault."""

T = TypeVar("T")


def read_typed(text: str | bytes, most: int, kind: type[T]) -> T:
    """Return the value of a type that a JSON text encodes.

    Raises:
        PhysicalError: The text is refused by `read_json`, or its value by `typed`.
    """
    return typed(read_json(text, most), kind)


def typed(data: object, kind: type[T]) -> T:
    """Return plain data as a value of a type; members that the type lacks are ignored.

    Raises:
        PhysicalError: The data do not fit the type: `$.a[2].b` is the place of the fault.

    >>> typed([1, True], list[int])
    Traceback (most recent call last):
    physical.errors.PhysicalError: `$[1]`: expected `int`, got `bool`
    """
    try:
        return msgspec.convert(data, kind)
    except (msgspec.ValidationError, RecursionError) as error:
        raise PhysicalError("form", legible(_fault(str(error)), MOST_WORDS)) from error


def _fault(words: str) -> str:
    """Return a fault in words, its place first."""
    what, at, place = words.replace("Object missing required field", "It lacks").rpartition(" - at ")
    said = what if at else place
    return f"{place if at else '`$`'}: {said[:1].lower()}{said[1:]}"
