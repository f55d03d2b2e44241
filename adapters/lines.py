"""Lines from chunks of bytes, in bounded memory for any input."""

from __future__ import annotations

from typing import Final

MAX_LINE: Final = 8_192
"""The longest line in bytes; the beginning of a longer one is passed on, for its reader to refuse."""


class Lines:
    """One stream of lines; `whole` if a chunk's end ends a line, as a datagram's does."""

    def __init__(self, *, whole: bool = False) -> None:
        self._rest = b""
        self._whole = whole
        self._skipping = False

    def feed(self, chunk: bytes) -> list[bytes]:
        """Return the complete lines, without their ends."""
        *lines, rest = (self._rest + chunk).split(b"\n")
        if self._skipping and lines:
            lines, self._skipping = lines[1:], False
        if self._skipping:
            rest = b""
        if self._whole or len(rest) > MAX_LINE:
            self._skipping = not self._whole
            lines, rest = ([*lines, rest] if rest else lines), b""
        self._rest = rest
        return [line.rstrip(b"\r") for line in lines if line.strip()]

    def end(self) -> list[bytes]:
        """Return the last line, if it lacks its end."""
        return self.feed(b"\n") if self._rest else []

    @property
    def held(self) -> int:
        """The number of bytes that wait for the rest of their line."""
        return len(self._rest)
