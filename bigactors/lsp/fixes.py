"""Quick fixes of mistakes: replacements of text that an editor offers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.syntax import Span

_MEANT: Final = re.compile(r"did you mean '([^']+)'\?")
_DECLARE: Final = re.compile(r"declare it: (signature|world) \{ ((?:kind|channel) [\w:.\-]+) \}")
_PUT_BEFORE: Final = {
    Code.MISSING_ARROW: "=> ",
    Code.MISSING_EQUALS: "= ",
    Code.MISSING_COMMA: ", ",
}
_INSTEAD: Final = {Code.SINGLE_EQUALS: "=="}
_SURPLUS: Final = {Code.UNKNOWN_CHARACTER: "leave it out", Code.UNOPENED_BRACKET: "remove it"}
_QUOTES: Final = "strings take straight double quotes"
_QUOTED: Final = re.compile(r"[^\w\s]([^\"\n]*?)['`\u2018\u2019\u201c\u201d\u201e\u00ab\u00bb]")
_STANDARD: Final = "signature standard"


@dataclass(frozen=True, slots=True)
class Fix:
    """A replacement of text, with its title."""

    title: str
    span: Span
    text: str


def fixes(found: Diagnostic, text: str) -> Iterator[Fix]:
    """Yield the replacements that mend a mistake."""
    start, end = found.span.start, found.span.end
    if meant := _MEANT.search(found.hint):
        yield Fix(f"Write '{meant[1]}'", found.span, meant[1])
    if found.code in _INSTEAD:
        yield Fix(f"Write '{_INSTEAD[found.code]}'", found.span, _INSTEAD[found.code])
    if found.code in _PUT_BEFORE:
        sign = _PUT_BEFORE[found.code]
        place = len(text[:start].rstrip()) if sign == ", " else start
        yield Fix(
            f"Put '{sign.strip()}' before it", Span(place, place), sign.rstrip() if sign == ", " else sign
        )
    if found.code in _SURPLUS and found.hint.startswith(_SURPLUS[found.code]):
        yield Fix("Remove it", found.span, "")
    if found.hint.startswith(_QUOTES):
        quoted = _QUOTED.match(text, start)
        span = Span(start, quoted.end()) if quoted else found.span
        yield Fix("Write straight quotes", span, f'"{quoted[1]}"' if quoted else '"')
    if found.hint == f"write: {_STANDARD}":
        place = _behind_header(text)
        yield Fix(f"Write '{_STANDARD}'", Span(place, place), f"{_STANDARD}\n\n")
    if found.code is Code.UNCLOSED_STRING:
        yield Fix('Close the string with "', Span(end, end), '"')
    if declared := _DECLARE.search(found.hint):
        yield _declaration(text, declared[1], declared[2])


def _declaration(text: str, section: str, entry: str) -> Fix:
    """Return the fix that adds a declaration to its section, or adds a new section."""
    begin = re.search(rf"^{section}\b[^{{\n]*\{{", text, re.MULTILINE)
    title = f"Declare '{entry}'"
    if begin:
        return Fix(title, Span(begin.end(), begin.end()), f"\n  {entry}")
    place = _behind_header(text)
    return Fix(title, Span(place, place), f"{section} {{\n  {entry}\n}}\n\n")


def _behind_header(text: str) -> int:
    header = re.match(r"(?:\s|//[^\n]*|#[^\n]*)*(?:mission\s+\w+\s*)?", text)
    return header.end() if header else 0
