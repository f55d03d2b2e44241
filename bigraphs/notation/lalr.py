"""An LALR parser that runs on lark's tables without lark, whose import takes longer than most files.

The tables are plain data. A *builder* makes the value: it has a method for each rule of the grammar, with the span of
the rule's text and the values of its parts as arguments.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from lark import Lark

END: Final = "$END"
Lexer: TypeAlias = "tuple[Sequence[str], dict[str, dict[str, str]]]"
"""The terminals to try, in order; and for some terminals, the words that are keywords instead."""
Reduction: TypeAlias = "tuple[str, int, str | None, bool, Sequence[int | None]]"
"""A rule: its symbol, its length, its method, whether a single part replaces it, and its parts.

A rule without a method passes its parts to the enclosing rule. A part is a number, None for an absent optional part, or
~number for a list of parts.
"""


class Span(NamedTuple):
    """A range of offsets in a text: the first character and the end."""

    start: int = 0
    end: int = 0


class Token(str):
    """A word of a text, with its offset."""

    __slots__ = ("start",)
    start: int

    @property
    def span(self) -> Span:
        """The range of the word in the text."""
        return Span(self.start, self.start + len(self))


class ParsingStopped(Exception):
    """Ends the parsing of a text at its first syntax error."""


class Tables:
    """The tables of a grammar, with a cache of compiled patterns.

    Attributes:
        terminals: For each terminal whether it is literal, and its text or pattern.
        ignored: The terminals without meaning, such as blanks.
        lexers: The lexers; different parser states expect different terminals.
        states: For each state its lexer, and its action for each symbol: a state to shift to, or ~reduction.
        reductions: The rules.
        starts: For each start symbol its first state and its last one.
    """

    def __init__(self, data: dict[str, Any]) -> None:
        self.terminals: dict[str, tuple[bool, str]] = data["terminals"]
        self.ignored = frozenset[str](data["ignored"])
        self.lexers: list[Lexer] = data["lexers"]
        self.states: list[tuple[int, dict[str, int]]] = data["states"]
        self.reductions: list[Reduction] = data["reductions"]
        self.starts: dict[str, tuple[int, int]] = data["starts"]
        self._patterns: dict[str, Callable[[str, int], re.Match[str] | None]] = {}
        self._tried: dict[tuple[int, str], list[tuple[str, int, Any]]] = {}

    def next_token(self, text: str, place: int, lexer: int) -> tuple[str, int, int]:
        """Return the next terminal with its start and end; raises ParsingStopped if none fits."""
        while place < len(text):
            name, end = self._scan(text, place, lexer)
            if name not in self.ignored:
                return name, place, end
            place = end
        return END, place, place

    def _scan(self, text: str, place: int, lexer: int) -> tuple[str, int]:
        first = text[place]
        tried = self._tried.get((lexer, first))
        if tried is None:
            tried = self._tried[lexer, first] = self._candidates(lexer, first)
        for name, length, fits in tried:
            if length:
                if text.startswith(fits, place):
                    return name, place + length
            elif found := fits(text, place):
                end = found.end()
                words = self.lexers[lexer][1].get(name)
                return (words.get(text[place:end], name) if words else name), end
        raise ParsingStopped

    def _candidates(self, lexer: int, first: str) -> list[tuple[str, int, Any]]:
        """Return the terminals that may begin with a character: literals with their lengths, and patterns."""
        found: list[tuple[str, int, Any]] = []
        for name in self.lexers[lexer][0]:
            literal, text = self.terminals[name]
            if not literal:
                if name not in self._patterns:
                    self._patterns[name] = re.compile(text).match
                found.append((name, 0, self._patterns[name]))
            elif text.startswith(first):
                found.append((name, len(text), text))
        return found

    def read(self, text: str, start: str, builder: object) -> Any:
        """Return the builder's value of a text; raises ParsingStopped at the first syntax error."""
        first, last = self.starts[start]
        path, values, spans = [first], list[Any](), list[Span | None]()
        place, name = 0, ""
        while name != END:
            name, begin, place = self.next_token(text, place, self.states[path[-1]][0])
            while (action := self.states[path[-1]][1].get(name)) is not None and action < 0:
                self._reduce(self.reductions[~action], path, values, spans, builder)
                if name == END and path[-1] == last:
                    return values[-1]
            if action is None:
                raise ParsingStopped
            token = Token(text[begin:place])
            token.start = begin
            path.append(action)
            values.append(token)
            spans.append(Span(begin, place))
        raise ParsingStopped

    def _reduce(
        self,
        reduction: Reduction,
        path: list[int],
        values: list[Any],
        spans: list[Span | None],
        builder: object,
    ) -> None:
        """Replace the parts of a rule by the value of the rule."""
        symbol, length, method, single, parts = reduction
        after = len(values) - length
        span = _around(spans[after:])
        found = _Many()
        for part in parts:
            if part is None:
                found.append(None)
            elif part < 0:
                found += values[after + ~part]
            else:
                found.append(values[after + part])
        value: Any = found
        if single and len(found) == 1:
            value = found[0]
        elif method is not None:
            value = getattr(builder, method)(span or Span(), *found)
        del path[after + 1 :], values[after:], spans[after:]
        path.append(self.states[path[-1]][1][symbol])
        values.append(value)
        spans.append(span)


class _Many(list[Any]):
    """The parts of a rule without a value of its own."""


def _around(spans: Sequence[Span | None]) -> Span | None:
    """Return the span of a rule's parts; None if all are empty."""
    written = [span for span in spans if span is not None]
    return Span(written[0].start, written[-1].end) if written else None


def kept_tables(file: Path, grammar: str, make: Callable[[], Lark]) -> Tables:
    """Return a grammar's tables, from the file if it is current; otherwise compute them and try to write the file."""
    with suppress(OSError, ValueError):
        kept = json.loads(file.read_bytes())
        if isinstance(kept, dict) and kept.get("grammar") == grammar:
            return Tables(kept)
    from bigraphs.notation.lalr_tables import tables_of, write_tables  # noqa: PLC0415 - lark takes time to load

    made = tables_of(make())
    write_tables(file, {"grammar": grammar, **made})
    return Tables(made)
