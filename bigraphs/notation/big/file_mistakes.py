"""The collection of mistakes in a text, so that all are reported at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from bigraphs.errors import NotationError
from bigraphs.notation.lalr import Span
from bigraphs.notation.spelling import did_you_mean

MOST: Final = 100
"""The largest number of reported mistakes."""


class Findings:
    """The mistakes found so far in one text; equal mistakes at one position count once."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._found: dict[tuple[int, str, str], NotationError] = {}
        self._warned: dict[tuple[int, str, str], NotationError] = {}

    def __len__(self) -> int:
        return len(self._found)

    def add(self, code: str, message: str, span: Span, hint: str = "") -> None:
        """Add a mistake."""
        key = (span.start, code, message)
        if key not in self._found and len(self._found) < MOST:
            length = span.end - span.start
            self._found[key] = NotationError(code, message, self.text, span.start, length=length, hint=hint)

    def take(self, other: Findings) -> None:
        """Add the mistakes of another collection."""
        self._found |= other._found

    def warn(self, other: Findings) -> None:
        """Add the mistakes of another collection as warnings: they are in unused declarations."""
        self._warned |= other._found

    @property
    def warnings(self) -> tuple[NotationError, ...]:
        """Return the warnings, by position."""
        return tuple(self._warned[key] for key in sorted(self._warned))[:MOST]

    def unknown(self, what: str, name: str, span: Span, known: Iterable[str], how: str = "") -> None:
        """Add a mistake for an undeclared name; the hint is a similar declared name or the form of a declaration."""
        hint = did_you_mean(name, known) or f"declare it with {(how or _KEYWORD[what]).format(name=name)}"
        self.add("name", f"unknown {what} '{name}'", span, hint)

    def raise_any(self) -> None:
        """Raise the mistakes, if there are any."""
        if self._found:
            raise NotationError.of(self._found.values())


_KEYWORD: Final = {
    "control": "'ctrl'",
    "bigraph": "'big'",
    "rule": "'react'",
    "value": "'int', 'float' or 'string', or give a constant of a file by --const {name}=VALUE",
}
