"""Errors of a user of bigraphs, as data."""

from __future__ import annotations

from collections.abc import Iterable


class BigraphError(ValueError):
    """A mistake in a bigraph, a rule or a text of one: what was found and expected, and what to do.

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
    """A mistake at a place in a text; `offset` and `length` count characters of `text`.

    Where a text has several, this is the first, and `mistakes` has them all, sorted by position.
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
        """Return the first of some mistakes, knowing the others."""
        ordered = sorted(mistakes, key=lambda mistake: (mistake.offset, mistake.code, mistake.message))
        first = ordered[0]
        found = cls(first.code, first.message, first.text, first.offset, length=first.length, hint=first.hint)
        found.mistakes = (found, *ordered[1:])
        return found

    @property
    def line(self) -> int:
        """Count lines from 1."""
        return self.text.count("\n", 0, self.offset) + 1

    @property
    def column(self) -> int:
        """Count characters of the line from 1."""
        return self.offset - (self.text.rfind("\n", 0, self.offset) + 1) + 1

    def render(self, source: str = "<text>") -> str:
        """Return the mistakes, each as a block with the line it is in and a caret beneath."""
        return "\n\n".join(render(mistake, source) for mistake in self.mistakes)

    def __str__(self) -> str:
        return f"{self.line}:{self.column}: {super().__str__()}"


_WIDEST = 100


def render(error: NotationError, source: str) -> str:
    """Return `source:line:column: message`, the line, a caret under the place, and the hint.

    Of a long line, only the hundred characters around the place are shown.
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
