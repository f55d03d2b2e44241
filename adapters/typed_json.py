"""JSON from outside as values of declared types, with bounds; one error names the place of a fault."""

from __future__ import annotations

from typing import Annotated, Final, TypeVar

import msgspec
from msgspec import Meta, Struct
from msgspec.structs import asdict

from physical import PhysicalError, legible, read_json
from physical.untrusted_text import MAX_WORD

MOST_WORDS: Final = 300
"""The most characters of a fault."""

Text = Annotated[str, Meta(max_length=MAX_WORD)]
Word = Annotated[str, Meta(min_length=1, max_length=MAX_WORD)]
"""A name, once `check_printable` has checked its characters."""

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

    >>> typed({"a": [1, 2]}, dict[str, tuple[int, int]])
    {'a': (1, 2)}
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


def check_printable(value: Struct, *unchecked: str) -> None:
    """Raise PhysicalError for a text in some fields that cannot be printed, or has spaces only; it may be empty."""
    for name, part in asdict(value).items():
        texts = (part,) if isinstance(part, str) else part if isinstance(part, tuple | dict) else ()
        for text in () if name in unchecked else texts:
            if isinstance(text, str) and text and not (text.isprintable() and text.strip()):
                raise PhysicalError("form", f"`$.{name}`: {text!r:.60} is not printable")
