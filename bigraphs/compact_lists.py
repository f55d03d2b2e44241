"""Compact lists: texts in one buffer, and columns with few distinct values."""

from __future__ import annotations

from array import array
from collections.abc import Hashable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeVar, overload

if TYPE_CHECKING:
    from bigraphs.file_columns import FileColumn

Column: TypeAlias = "array[int] | FileColumn"
"""A list of numbers, in memory or in a file."""

Value = TypeVar("Value", bound=Hashable)

_WIDER: Final = {"B": "H", "H": "I"}


class DictionaryColumn(Sequence[Value]):
    """A list with few distinct values: it stores each distinct value once and a code for each position.

    Attributes:
        values: The distinct values, in order of first occurrence.
        codes: For each position the index of its value in `values`.
    """

    __slots__ = ("_numbers", "codes", "values")

    def __init__(self, given: Iterable[Value] = ()) -> None:
        self.values: list[Value] = []
        self.codes: Column = array("B")
        self._numbers: dict[Value, int] = {}
        for value in given:
            self.append(value)

    def append(self, value: Value) -> None:
        """Add a value."""
        self._put(self.code(value))

    def extend(self, other: DictionaryColumn[Value], count: int) -> None:
        """Add the first `count` values of another list."""
        codes = [self.code(value) for value in other.values]
        for code in other.codes[:count]:
            self._put(codes[code])

    def _put(self, code: int) -> None:
        try:
            self.codes.append(code)
        except OverflowError:
            self.codes = array(_WIDER[self.codes.typecode], self.codes)
            self.codes.append(code)

    def spill(self, folder: Path) -> FileColumn:
        """Move the codes to a file in a folder, and return them; raises OSError if that has no room."""
        self.codes = found = spilled(array("I", self.codes), folder)
        return found

    def code(self, value: Value) -> int:
        """Return the code of a value; a new value gets the next code."""
        code = self._numbers.get(value)
        if code is None:
            code = self._numbers[value] = len(self.values)
            self.values.append(value)
        return code

    def __len__(self) -> int:
        return len(self.codes)

    @overload
    def __getitem__(self, place: int) -> Value: ...
    @overload
    def __getitem__(self, place: slice) -> list[Value]: ...
    def __getitem__(self, place: int | slice) -> Value | list[Value]:
        if isinstance(place, slice):
            return [self.values[code] for code in self.codes[place]]
        return self.values[self.codes[place]]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, DictionaryColumn) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]  # mutable


class Texts(Sequence[bytes]):
    """A list of byte strings, stored in one buffer."""

    __slots__ = ("ends", "whole")

    def __init__(self, given: Iterable[bytes] = ()) -> None:
        self.whole: bytearray | FileColumn = bytearray()
        self.ends: Column = array("Q", (0,))
        for text in given:
            self.append(text)

    def append(self, text: bytes) -> None:
        """Add a text."""
        self.whole.extend(text)
        self.ends.append(len(self.whole))

    def spill(self, folder: Path) -> tuple[FileColumn, FileColumn]:
        """Move the texts to files in a folder, and return these; raises OSError if that has no room."""
        self.whole, self.ends = found = spilled(self.whole, folder), spilled(self.ends, folder)
        return found

    def __len__(self) -> int:
        return len(self.ends) - 1

    @overload
    def __getitem__(self, place: int) -> bytes: ...
    @overload
    def __getitem__(self, place: slice) -> list[bytes]: ...
    def __getitem__(self, place: int | slice) -> Any:
        if isinstance(place, slice):
            return [self[each] for each in range(*place.indices(len(self)))]
        start, end = self.ends[place], self.ends[place + 1]
        return bytes(self.whole[start:end])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Texts) and (self.whole, self.ends) == (other.whole, other.ends)

    __hash__ = None  # type: ignore[assignment]  # mutable


class Numbering:
    """Texts numbered from 0 in order of first occurrence.

    The index is an open hash table of their numbers alone. It is exact and at most half full.
    """

    __slots__ = ("_places", "texts")

    def __init__(self) -> None:
        self.texts = Texts()
        self._places = array("I", bytes(4 * 64))  # the number plus 1; 0 marks an empty cell

    def __len__(self) -> int:
        return len(self.texts)

    def find(self, text: bytes) -> int:
        """Return the number of a text, or -1 if it has none."""
        places, whole, ends = self._places, self.texts.whole, self.texts.ends
        last = len(places) - 1
        place = hash(text) & last
        while number := places[place]:
            if whole[ends[number - 1] : ends[number]] == text:
                return number - 1
            place = (place + 1) & last
        return -1

    def add(self, text: bytes) -> int:
        """Give a new text the next number and return it; the caller has checked that the text has none."""
        if 2 * len(self.texts) >= len(self._places):
            self._grow()
        self.texts.append(text)
        self._put(text, len(self.texts))
        return len(self.texts) - 1

    def _put(self, text: bytes, number: int) -> None:
        places, last = self._places, len(self._places) - 1
        place = hash(text) & last
        while places[place]:
            place = (place + 1) & last
        places[place] = number

    def _grow(self) -> None:
        self._places = array("I", bytes(8 * len(self._places)))
        for number, text in enumerate(self.texts, 1):
            self._put(text, number)


def spilled(given: bytearray | Column, folder: Path) -> FileColumn:
    """Return numbers in a file in a folder; raises OSError if that has no room."""
    from bigraphs.file_columns import FileColumn  # noqa: PLC0415 - few explorations spill

    return given if isinstance(given, FileColumn) else FileColumn(given, folder)
