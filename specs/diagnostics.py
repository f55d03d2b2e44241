"""The user's mistakes as data, and their printed form."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Final

from specs.codes import Code
from specs.syntax.nodes import Span

_TAB: Final = 4
_WIDEST: Final = 100  # the most columns shown of a line
_CUT: Final = "…"
_BEFORE: Final = 40  # the least number of these before the caret in a cut line


@dataclass(frozen=True, slots=True)
class Source:
    """A mission's text and its name in messages; its line ends are line feeds."""

    name: str
    text: str = field(repr=False)

    def line(self, offset: int) -> int:
        """Return the number of the line with `offset`, counted from 1."""
        return self.text.count("\n", 0, offset) + 1

    def column(self, offset: int) -> int:
        """Return the column of `offset` in its line, in characters counted from 1."""
        return offset - self.line_start(offset) + 1

    def line_start(self, offset: int) -> int:
        """Return the offset of the first character of the line with `offset`."""
        return self.text.rfind("\n", 0, offset) + 1

    def line_text(self, offset: int) -> str:
        """Return the line with `offset`, without its end."""
        end = self.text.find("\n", offset)
        return self.text[self.line_start(offset) : end if end >= 0 else len(self.text)]


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A mistake: `message` names the found and the expected text, `hint` the remedy."""

    code: Code
    span: Span
    message: str
    hint: str = ""


class MissionError(Exception):
    """The mistakes in a mission by position, printed as rendered blocks, and its warnings."""

    def __init__(
        self, source: Source, diagnostics: Iterable[Diagnostic], warnings: tuple[Diagnostic, ...] = ()
    ) -> None:
        self.source = source
        self.diagnostics = tuple(sorted(diagnostics, key=_position))
        self.warnings = warnings
        super().__init__(source, self.diagnostics)

    def __str__(self) -> str:
        return render_all(self.diagnostics, self.source)


def render_all(diagnostics: Iterable[Diagnostic], source: Source) -> str:
    """Return the mistakes as printed, by position, with an empty line between two."""
    return "\n\n".join(render(item, source) for item in sorted(diagnostics, key=_position))


def render(diagnostic: Diagnostic, source: Source) -> str:
    """Return `name:line:column: code: message`, the line, a caret under the mistake, and the hint.

    The column counts characters from 1. A line wider than a hundred columns is cut around the caret; a mistake over
    several lines is underlined in the first.
    """
    start = min(diagnostic.span.start, len(source.text))
    line = source.line(start)
    head = f"{source.name}:{line}:{source.column(start)}: {diagnostic.code.number}: {diagnostic.message}"
    shown, caret = _underline(source.line_text(start), source.column(start) - 1, diagnostic.span)
    margin = " " * len(str(line))
    block = [head, f"  {line} | {shown}".rstrip(), f"  {margin} | {caret}"]
    if diagnostic.hint:
        block.append(f"  hint: {diagnostic.hint}")
    return "\n".join(block)


def _underline(line: str, first: int, span: Span) -> tuple[str, str]:
    last = min(max(first + span.end - span.start, first + 1), max(len(line), first + 1))
    start, cells, more = _window(line, first)
    before = bool(start) + sum(len_ for _, len_ in cells[: first - start])
    under = sum(len_ for _, len_ in cells[first - start : last - start]) if first < len(line) else 1
    shown = "".join(text for text, _ in cells)
    return f"{_CUT if start else ''}{shown}{_CUT if more else ''}", " " * before + "^" * max(under, 1)


def _window(line: str, first: int) -> tuple[int, list[tuple[str, int]], bool]:
    """Return the part of a line around `first`: its start, its characters with widths, and whether the rest is cut."""
    start = 0 if len(line) <= _WIDEST else max(0, min(first - _BEFORE, len(line) - _WIDEST))
    cells, width = list[tuple[str, int]](), 0
    for character in line[start:]:
        cell = _cell(character)
        width += cell[1]
        if width > _WIDEST:
            return start, cells, True
        cells.append(cell)
    return start, cells, False


def _cell(character: str) -> tuple[str, int]:
    """Return the printed form of a character, and its width in terminal columns."""
    if character == "\t":
        return " " * _TAB, _TAB
    if not character.isprintable():
        return "\N{REPLACEMENT CHARACTER}", 1
    if unicodedata.combining(character):
        return character, 0
    return character, 2 if unicodedata.east_asian_width(character) in "WF" else 1


def _position(diagnostic: Diagnostic) -> tuple[Span, str, str]:
    return diagnostic.span, diagnostic.code.number, diagnostic.message
