"""The point at which a parse stopped: the word found there, the word before it, and the words expected."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from lark import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.grammar import ParserRun, keywords, may_follow, spellings, terminal, terminals
from specs.preprocessing import Prepared
from specs.syntax.nodes import Span

_WORD: Final = re.compile(
    r'[0-9.]{1,30}+\s?[°º][^,()\n]*|"(?:[^"\\\n]|\\.)*+"|\w+|<->|<>|\[\]|=>|==|!=|<=|>=|->|\|\||&&|\S'
)
_NAME: Final = re.compile(r"[^\W\d_]\w*")
LINE_NUMBERS: Final = "printed line numbers must count on from the line of BigActor"
"""The hint for a wrong line number: after one, all others are wrong too."""

_SEEN: Final = 200  # characters searched backwards for the previous word


@dataclass(frozen=True, slots=True)
class Word:
    """A word or symbol of the text, or its end (an empty `text`)."""

    text: str
    span: Span

    @property
    def is_name(self) -> bool:
        """Whether it has the form of a name; it may be a reserved word."""
        return bool(_NAME.fullmatch(self.text))

    @property
    def is_number(self) -> bool:
        """Whether it is a number."""
        return self.text[:1].isdecimal()

    @property
    def shown(self) -> str:
        """The word in the form of messages."""
        if not self.text:
            return "the end of the file"
        if self.text.startswith('"') and len(self.text) > 1:
            return "a string"
        return f"'{self.text if len(self.text) <= 40 else self.text[:37] + '...'}'"


@dataclass(frozen=True, slots=True)
class ParsePoint:
    """The point at which a parse stopped.

    Attributes:
        found: The word there.
        before: The word before it.
        accepted: The words and symbols expected there.
        sorts: The grammar's names of everything expected there.
        prepared: The text.
        instead: Whether a single word is expected in place of the one found, which does not fit behind that word.
    """

    found: Word
    before: Word
    accepted: frozenset[str]
    sorts: frozenset[str]
    prepared: Prepared
    instead: bool = False

    @property
    def following(self) -> Word:
        """The word after the one found."""
        return word_at(self.prepared.text, self.found.span.end)

    @property
    def is_first(self) -> bool:
        """Whether the word found is the first of its line."""
        text, start = self.prepared.text, self.found.span.start
        return not text[text.rfind("\n", 0, start) + 1 : start].strip()

    @property
    def in_expression(self) -> bool:
        """Whether the text before is an expression that may continue."""
        return bool(self.accepted & {"of", "&&"})

    @property
    def at_expression(self) -> bool:
        """Whether an expression may begin here."""
        return "SELF" in self.accepted

    @property
    def at_statement(self) -> bool:
        """Whether a statement may begin here."""
        return "skip" in self.accepted

    @property
    def at_declaration(self) -> bool:
        """Whether a declaration may begin here."""
        return "signature" in self.accepted

    def mistake(self, code: Code, message: str, hint: str = "") -> Diagnostic:
        """Return a diagnostic at the word found."""
        return Diagnostic(code, self.found.span, message, hint)


def offset_of(found: UnexpectedInput, prepared: Prepared) -> int:
    """Return the offset at which a parse stopped."""
    if isinstance(found, UnexpectedToken):
        return len(prepared.text) if found.token.type == "$END" else int(found.token.start_pos or 0)
    if isinstance(found, UnexpectedCharacters):
        return found.pos_in_stream or 0
    return len(prepared.text)


def situation(prepared: Prepared, offset: int, run: ParserRun) -> ParsePoint:
    """Return the situation of a parse that stopped at `offset`, or at the end."""
    sorts = frozenset(run.accepts())
    spelt = frozenset(word for sort in sorts if (word := spellings().get(sort)))
    found = word_at(prepared.text, offset)
    return ParsePoint(
        found,
        word_before(prepared.text, offset),
        spelt,
        sorts,
        prepared,
        len(sorts) == 1 and found.is_name and not _fits_behind(run, next(iter(sorts)), found),
    )


def _fits_behind(run: ParserRun, sort: str, found: Word) -> bool:
    """Return whether a word fits behind a missing one; false if a list's item may end between them."""
    follows = may_follow(run, sort, terminals().get(found.text, "NAME"))
    return follows and not may_follow(run, sort, terminal(";"))


def word_at(text: str, offset: int) -> Word:
    """Return the word at or after `offset`, or the end just behind the last word."""
    found = _WORD.search(text, offset)
    if found is None:
        end = len(text.rstrip())
        return Word("", Span(end, end))
    return Word(found.group(), Span(found.start(), found.end()))


def words_from(text: str, offset: int) -> Iterator[Word]:
    """Yield the words and symbols from `offset` on."""
    for found in _WORD.finditer(text, offset):
        yield Word(found.group(), Span(found.start(), found.end()))


def word_before(text: str, offset: int) -> Word:
    """Return the last word that ends at or before `offset`, searched over a short distance."""
    start = max(0, offset - _SEEN, text.rfind("\n", 0, text.rfind("\n", 0, max(0, offset - 1))) + 1)
    last = Word("", Span(offset, offset))
    for found in _WORD.finditer(text, start, offset):
        last = Word(found.group(), Span(found.start(), found.end()))
    return last


def open_brackets(text: str, offset: int) -> list[int]:
    """Return the offsets of the open brackets at `offset`, outermost first."""
    waiting = []
    for found in _WORD.finditer(text, 0, offset):
        if found.group() in "([{":
            waiting.append(found.start())
        elif found.group() in ")]}" and waiting:
            waiting.pop()
    return waiting


def line_of(text: str, offset: int) -> int:
    """Return the number of the line with `offset`, counted from 1."""
    return text.count("\n", 0, offset) + 1


def is_keyword(word: Word) -> bool:
    """Return whether a word is a keyword of the language."""
    return word.text in keywords()
