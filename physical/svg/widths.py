"""Widths of text, from the tables of the font files that also draw it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise
from pathlib import Path
from struct import iter_unpack, unpack_from
from typing import Final

FONTS: Final = (
    Path(__file__).parent / "fonts" / "DejaVuSans.ttf",
    Path(__file__).parent / "fonts" / "DejaVuSans-Bold.ttf",
)
"""The regular and the bold font, both without slant."""

UNKNOWN: Final = 1.0
"""The width of a character that the font lacks, as a share of the font size: that of most other scripts."""


@dataclass(frozen=True, slots=True)
class Widths:
    """The widths of characters as shares of the font size, and corrections for pairs of characters."""

    characters: Mapping[int, float]
    pairs: Mapping[tuple[int, int], float]


@lru_cache(maxsize=1 << 12)
def text_width(text: str, size: float, bold: bool = False) -> float:
    """Return the width of a line of text, in the unit of the font size."""
    font = widths_of(FONTS[bold])
    letters = [ord(letter) for letter in text]
    total = sum(font.characters.get(letter, UNKNOWN) for letter in letters)
    return size * (total + sum(font.pairs.get(pair, 0.0) for pair in pairwise(letters)))


def shortened(text: str, width: float, size: float, bold: bool = False) -> str:
    """Return the text, cut with an ellipsis if it is wider than `width`."""
    if text_width(text, size, bold) <= width:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        fits = text_width(text[:middle].rstrip() + "…", size, bold) <= width
        low, high = (middle, high) if fits else (low, middle - 1)
    return text[:low].rstrip() + "…"


@cache
def widths_of(path: Path) -> Widths:
    """Read the widths in a TrueType file."""
    font = path.read_bytes()
    (count,) = unpack_from(">H", font, 4)
    records = (unpack_from(">4sLLL", font, 12 + 16 * number) for number in range(count))
    tables = {name.decode(): font[start : start + length] for name, _, start, length in records}
    (units,) = unpack_from(">H", tables["head"], 18)
    (measured,) = unpack_from(">H", tables["hhea"], 34)
    advances = [advance for advance, _ in iter_unpack(">Hh", tables["hmtx"][: 4 * measured])]
    glyphs = dict(_glyphs(tables["cmap"]))
    letters: dict[int, list[int]] = {}
    for letter, glyph in glyphs.items():
        letters.setdefault(glyph, []).append(letter)
    return Widths(
        {letter: advances[min(glyph, measured - 1)] / units for letter, glyph in glyphs.items()},
        {
            (one, other): value / units
            for left, right, value in _corrections(tables.get("kern", b""))
            for one in letters.get(left, ())
            for other in letters.get(right, ())
        },
    )


def _glyphs(table: bytes) -> Iterator[tuple[int, int]]:
    """Yield characters with their glyphs, from the subtable of segmented coverage (format 12)."""
    (count,) = unpack_from(">H", table, 2)
    starts = (unpack_from(">HHL", table, 4 + 8 * number)[2] for number in range(count))
    start = next(start for start in starts if unpack_from(">H", table, start) == (12,))
    (groups,) = unpack_from(">L", table, start + 12)
    for first, last, glyph in iter_unpack(">LLL", table[start + 16 : start + 16 + 12 * groups]):
        yield from zip(range(first, last + 1), range(glyph, glyph + last - first + 1), strict=True)


def _corrections(table: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield pairs of glyphs with their correction, from the first subtable of kerning (format 0)."""
    if not table:
        return
    (pairs,) = unpack_from(">H", table, 10)
    yield from iter_unpack(">HHh", table[18 : 18 + 6 * pairs])
