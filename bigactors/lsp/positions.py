"""Conversion between offsets in a text and an editor's positions: lines, and code units within them."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Final

_LINE_END: Final = re.compile(r"\r\n|\n|\r")
UNITS: Final = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
"""The codec and the bytes of a code unit for each encoding of the protocol."""


@dataclass(frozen=True, slots=True)
class LineStarts:
    r"""The beginnings of a text's lines, and the encoding in which an editor counts within them.

    >>> lines = LineStarts("a\r\nb🚁c", "utf-16")
    >>> lines.position(5), lines.offset(1, 3)
    ((1, 3), 5)
    """

    text: str
    encoding: str
    starts: list[int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        starts = [0, *(found.end() for found in _LINE_END.finditer(self.text))]
        object.__setattr__(self, "starts", starts)

    def position(self, offset: int) -> tuple[int, int]:
        """Return the line of an offset, counted from 0, and the units before the offset in it."""
        line = bisect_right(self.starts, offset) - 1
        return line, self._units(self.text[self.starts[line] : offset])

    def offset(self, line: int, units: int) -> int:
        """Return the offset of a position. Past the end of a line it is that end; within a character, its beginning."""
        if line >= len(self.starts):
            return len(self.text)
        start = self.starts[line]
        end = self.starts[line + 1] if line + 1 < len(self.starts) else len(self.text)
        within = _LINE_END.sub("", self.text[start:end])
        if within.isascii():
            return start + min(units, len(within))
        counted = 0
        for place, character in enumerate(within):
            counted += self._units(character)
            if counted > units:
                return start + place
        return start + len(within)

    def _units(self, text: str) -> int:
        if text.isascii():
            return len(text)
        codec, size = UNITS[self.encoding]
        return len(text.encode(codec, "surrogatepass")) // size
