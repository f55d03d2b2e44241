"""Errors for users of bigraphs, as data."""

from __future__ import annotations

from collections.abc import Iterable


class BigraphError(ValueError):
    """A mistake in a bigraph, in a rule or in their text: the finding, the expectation and a remedy.

    `code` is a stable word for the kind of mistake (`arity`, `interface`, `syntax`, ...).
    """

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message} (hint: {self.hint})" if self.hint else self.message


class NotationError(BigraphError):
    """A mistake at a position in a text; `offset` and `length` count characters of `text`.

    If a text has several mistakes, this is the first; `mistakes` holds all of them, sorted by position.
    """

    def __init__(
        self, code: str, message: str, text: str, offset: int, *, length: int = 1, hint: str = ""
    ) -> None:
        super().__init__(code, message, hint)
        self.text = text
        self.offset = min(max(offset, 0), len(text))
        self.length = max(length, 1)
        self.mistakes: tuple[NotationError, ...] = (self,)

    @classmethod
    def of(cls, mistakes: Iterable[NotationError]) -> NotationError:
        """Return the first of several mistakes, with all of them as its `mistakes`."""
        ordered = sorted(mistakes, key=lambda mistake: (mistake.offset, mistake.code, mistake.message))
        first = ordered[0]
        found = cls(first.code, first.message, first.text, first.offset, length=first.length, hint=first.hint)
        found.mistakes = (found, *ordered[1:])
        return found

    @property
    def line(self) -> int:
        """Return the line number, counted from 1."""
        return self.text.count("\n", 0, self.offset) + 1

    @property
    def column(self) -> int:
        """Return the column in characters, counted from 1."""
        return self.offset - (self.text.rfind("\n", 0, self.offset) + 1) + 1

    def render(self, source: str = "<text>") -> str:
        """Return a block for each mistake: the message, its line and a caret below the position."""
        return "\n\n".join(render(mistake, source) for mistake in self.mistakes)

    def __str__(self) -> str:
        return f"{self.line}:{self.column}: {super().__str__()}"


def counted(count: int, one: str) -> str:
    """Return a count with its noun.

    >>> counted(1, "site"), counted(1234, "state")
    ('1 site', '1,234 states')
    """
    return f"{count:,} {one}{'' if count == 1 else 's'}"


_WIDEST = 100


def render(error: NotationError, source: str) -> str:
    """Return `source:line:column: message`, the line, a caret below the position, and the hint.

    A long line is cut to 100 characters around the position.
    """
    start = error.offset - (error.column - 1)
    end = error.text.find("\n", start)
    line = error.text[start : end if end >= 0 else len(error.text)].expandtabs(1)
    cut = max(0, error.column - 1 - _WIDEST // 2) if len(line) > _WIDEST else 0
    shown = line[cut : cut + _WIDEST]
    room = max(1, len(shown) - (error.column - 1 - cut))
    gutter = f"{error.line:>5} | "
    caret = " " * (error.column - 1 - cut) + "^" * min(error.length, room)
    block = [f"{source}:{error.line}:{error.column}: {error.message}", gutter + shown]
    block.append(" " * (len(gutter) - 2) + "| " + caret)
    if error.hint:
        block.append(f"hint: {error.hint}")
    return "\n".join(block)
