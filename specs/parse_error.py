"""Where a parse stopped: the word found there, the word before it, and the words expected."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from lark import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.grammar import Run, keywords, may_follow, spellings, terminal, terminals
from specs.preprocessing import Prepared
from specs.syntax.nodes import Span

_WORD: Final = re.compile(
    r'[0-9.]{1,30}+\s?[°º][^,()\n]*|"(?:[^"\\\n]|\\.)*+"|\w+|<->|<>|\[\]|=>|==|!=|<=|>=|->|\|\||&&|\S'
)
_NAME: Final = re.compile(r"[^\W\d_]\w*")
LINE_NUMBERS: Final = "printed line numbers must count on from the line of BigActor"
"""The hint at a line number that does not: where one is wrong, the others are too."""

_SEEN: Final = 200  # characters looked back for the previous word


@dataclass(frozen=True, slots=True)
class Word:
    """A word or symbol of the text, or its end (an empty `text`)."""

    text: str
    span: Span

    @property
    def is_name(self) -> bool:
        """Whether it could be a name, but for being reserved."""
        return bool(_NAME.fullmatch(self.text))

    @property
    def is_number(self) -> bool:
        """Whether it is a number."""
        return self.text[:1].isdecimal()

    @property
    def shown(self) -> str:
        """The word as messages show it."""
        if not self.text:
            return "the end of the file"
        if self.text.startswith('"') and len(self.text) > 1:
            return "a string"
        return f"'{self.text if len(self.text) <= 40 else self.text[:37] + '...'}'"


@dataclass(frozen=True, slots=True)
class Situation:
    """Where a parse stopped.

    Attributes:
        found: The word there.
        before: The word before it.
        accepted: The words and symbols that could stand there.
        sorts: The grammar's names of all that could.
        prepared: The text.
        instead: Whether one word alone could stand there, in the place of the one found: behind it that doesn't fit.
    """

    found: Word
    before: Word
    accepted: frozenset[str]
    sorts: frozenset[str]
    prepared: Prepared
    instead: bool = False

    @property
    def following(self) -> Word:
        """The word behind the one that was found."""
        return word_at(self.prepared.text, self.found.span.end)

    @property
    def is_first(self) -> bool:
        """Whether the word found is the first of its line."""
        text, start = self.prepared.text, self.found.span.start
        return not text[text.rfind("\n", 0, start) + 1 : start].strip()

    @property
    def in_expression(self) -> bool:
        """Whether what is before is an expression that could go on."""
        return bool(self.accepted & {"of", "&&"})

    @property
    def at_expression(self) -> bool:
        """Whether an expression could begin here."""
        return "SELF" in self.accepted

    @property
    def at_statement(self) -> bool:
        """Whether a statement could begin here."""
        return "observe" in self.accepted

    @property
    def at_declaration(self) -> bool:
        """Whether a declaration could begin here."""
        return "signature" in self.accepted

    def mistake(self, code: Code, message: str, hint: str = "") -> Diagnostic:
        """Return a diagnostic at the word that was found."""
        return Diagnostic(code, self.found.span, message, hint)


def offset_of(found: UnexpectedInput, prepared: Prepared) -> int:
    """Return where a parse stopped."""
    if isinstance(found, UnexpectedToken):
        return len(prepared.text) if found.token.type == "$END" else int(found.token.start_pos or 0)
    if isinstance(found, UnexpectedCharacters):
        return found.pos_in_stream or 0
    return len(prepared.text)


def situation(prepared: Prepared, offset: int, run: Run) -> Situation:
    """Describe a parse that stopped at `offset`, or at the end."""
    sorts = frozenset(run.accepts())
    spelt = frozenset(word for sort in sorts if (word := spellings().get(sort)))
    found = word_at(prepared.text, offset)
    return Situation(
        found,
        word_before(prepared.text, offset),
        spelt,
        sorts,
        prepared,
        len(sorts) == 1 and found.is_name and not _fits_behind(run, next(iter(sorts)), found),
    )


def _fits_behind(run: Run, sort: str, found: Word) -> bool:
    """Tell whether a word fits behind one that is missing: not where an item of a list may end between them."""
    follows = may_follow(run, sort, terminals().get(found.text, "NAME"))
    return follows and not may_follow(run, sort, terminal(";"))


def word_at(text: str, offset: int) -> Word:
    """Return the word that begins at `offset`, or the end just behind the last word."""
    found = _WORD.search(text, offset)
    if found is None:
        end = len(text.rstrip())
        return Word("", Span(end, end))
    return Word(found.group(), Span(found.start(), found.end()))


def words_from(text: str, offset: int) -> Iterator[Word]:
    """Yield the words and symbols that begin at `offset` or behind it."""
    for found in _WORD.finditer(text, offset):
        yield Word(found.group(), Span(found.start(), found.end()))


def word_before(text: str, offset: int) -> Word:
    """Return the last word that ends at or before `offset`, looked for a little way back."""
    start = max(0, offset - _SEEN, text.rfind("\n", 0, text.rfind("\n", 0, max(0, offset - 1))) + 1)
    last = Word("", Span(offset, offset))
    for found in _WORD.finditer(text, start, offset):
        last = Word(found.group(), Span(found.start(), found.end()))
    return last


def open_brackets(text: str, offset: int) -> list[int]:
    """Return the offsets of the brackets that are open at `offset`, outermost first."""
    waiting = []
    for found in _WORD.finditer(text, 0, offset):
        if found.group() in "([{":
            waiting.append(found.start())
        elif found.group() in ")]}" and waiting:
            waiting.pop()
    return waiting


def line_of(text: str, offset: int) -> int:
    """Return the number of the line that holds `offset`, counted from 1."""
    return text.count("\n", 0, offset) + 1


def is_keyword(word: Word) -> bool:
    """Whether a word is one of the language's own."""
    return word.text in keywords()
