"""The mistakes found so far: every phase adds its own, and none stops at the first."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from bigraphs.notation.spelling import did_you_mean
from physical.wordings import counted
from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source
from specs.syntax import Name, Node, Span

MOST_SHOWN: Final = 100
MOST_SUGGESTIONS: Final = 50
LONGEST: Final = 60


class Findings:
    """Collects the mistakes and warnings of one mission."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self._found: dict[Diagnostic, None] = {}
        self._warned: dict[Diagnostic, None] = {}
        self._suggested = 0
        self.unread: set[str] = set()

    def __len__(self) -> int:
        return len(self._found)

    def add(self, code: Code, where: Node | Span, message: str, hint: str = "") -> None:
        """Add a mistake, once."""
        span = where if isinstance(where, Span) else where.span
        self._found.setdefault(Diagnostic(code, span, message, hint))

    def warn(self, code: Code, where: Node | Span, message: str, hint: str = "") -> None:
        """Add a warning, once."""
        span = where if isinstance(where, Span) else where.span
        self._warned.setdefault(Diagnostic(code, span, message, hint))

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """The warnings, by position."""
        return MissionError(self.source, self._warned).diagnostics

    def unknown(
        self,
        name: Name,
        among: Iterable[str],
        *,
        sort: str = "name",
        code: Code = Code.UNKNOWN_NAME,
        otherwise: str = "",
    ) -> None:
        """Report an unknown name, with similar names as a hint, or else `otherwise`.

        A name that an unreadable file may declare is not reported.
        """
        if sort in self.unread:
            return
        hint = self.suggest(name.text, among) or otherwise
        self.add(code, name, f"unknown {sort} '{shorten(name.text)}'", hint)

    def suggest(self, word: str, among: Iterable[str]) -> str:
        """Return `did you mean ...?`, or an empty text; after fifty look-ups always empty, since they are slow."""
        self._suggested += 1
        return "" if self._suggested > MOST_SUGGESTIONS else did_you_mean(word, among)

    def error(self) -> MissionError:
        """Return the mistakes as one error, by position: the first hundred, and the number of the others."""
        found = MissionError(self.source, self._found).diagnostics
        shown, more = found[:MOST_SHOWN], found[MOST_SHOWN:]
        if more:
            told = f"{counted(len(more), 'more mistake')} from here on"
            rest = Diagnostic(Code.TOO_MANY_MISTAKES, more[0].span, told)
            shown = (*shown, rest)
        return MissionError(self.source, shown, self.warnings)


def shorten(text: str) -> str:
    """Cut a long word for a message."""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def a(word: str) -> str:
    """Return a word with its article.

    >>> a("OilSpill"), a("UAV"), a("Vessel")
    ('an OilSpill', 'a UAV', 'a Vessel')
    """
    spelt = word[1:2].isupper()
    vowel = word[:1] in "AEFHILMNORSX" if spelt else word[:1].lower() in "aeiou"
    return f"an {word}" if vowel else f"a {word}"
