"""Rename a symbol at all its occurrences without changing the meaning of any other name."""

from __future__ import annotations

import re
from typing import Final

from bigactors.lsp.edited_mission import Reading
from specs.diagnostics import Source
from specs.grammar import RESERVED
from specs.syntax import Span

_NAME: Final = re.compile(r"[^\W\d_]\w*")
_CHANNEL: Final = re.compile(r"\w+(?:[:.\-]\w+)*")


class RenameRefused(Exception):
    """The reason why a symbol cannot be renamed, for the user."""


def renamable(reading: Reading, offset: int) -> Span:
    """Return the span of the name at an offset; raises Refused if there is none or it is declared in another file."""
    found = reading.occurrences.at(offset)
    if found is None:
        raise RenameRefused("there is no name of this mission here")
    if found.symbol not in reading.occurrences.declared:
        raise RenameRefused(f"'{found.symbol.name}' is not declared in this file")
    if reading.recovered.mistakes:
        raise RenameRefused(
            "the file has syntax errors: correct them first, since the unreadable parts may contain names"
        )
    return found.span


def rename(reading: Reading, offset: int, name: str) -> tuple[Span, ...]:
    """Return the spans to replace by the new name; raises Refused if that would change a meaning."""
    renamable(reading, offset)
    found = reading.occurrences.at(offset)
    if found is None:
        raise AssertionError(offset)
    shape = _CHANNEL if found.symbol.sort == "channel" else _NAME
    if not shape.fullmatch(name):
        raise RenameRefused(f"'{name}' is no name: letters, digits and _, a letter first")
    if name in RESERVED:
        raise RenameRefused(f"'{name}' is a word of the language")
    spans = tuple(each.span for each in reading.occurrences.of(found.symbol))
    after = Reading(Source(reading.source.name, replaced(reading.text, spans, name)), reading.directory)
    if after.recovered.mistakes:
        raise RenameRefused(f"'{name}' cannot stand there: {after.recovered.mistakes[0].message}")
    if _pattern(reading) != _pattern(after):
        raise RenameRefused(f"'{name}' has a meaning already where it would stand: choose another name")
    new = set(_said(after)) - set(_said(reading))
    if len(after.diagnosis.mistakes) > len(reading.diagnosis.mistakes):
        raise RenameRefused(f"with that name there is a new mistake: {min(new)}")
    return spans


def _said(reading: Reading) -> list[str]:
    return [found.message for found in reading.diagnosis.mistakes]


def replaced(text: str, spans: tuple[Span, ...], by: str) -> str:
    """Return a text with the spans replaced."""
    pieces, last = [], 0
    for span in spans:
        pieces += [text[last : span.start], by]
        last = span.end
    return "".join([*pieces, text[last:]])


def _pattern(reading: Reading) -> list[tuple[int, str]]:
    """Return for each name the index of its symbol's first occurrence, and its sort: a correct renaming keeps both."""
    first: dict[object, int] = {}
    found: list[tuple[int, str]] = []
    for number, each in enumerate(reading.occurrences.all):
        found.append((first.setdefault(each.symbol, number), each.symbol.sort))
    return found
