"""Key files: a signing key with its newest time stamps, shared by all links that sign with it.

The file is always ahead of what was sent and believed: it is written before that, and then not again for a while.
"""

from __future__ import annotations

from pathlib import Path

from adapters.mavlink import signing
from adapters.mavlink.message import Message
from adapters.mavlink.signing import Verdict


class Keeper:
    """Signs, judges signatures, and keeps what must not be forgotten between two runs.

    Raises PhysicalError where the file is no such state.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._signing = self._reserved = signing.load(path)
        self.trouble = ""
        """Why the file could not be written, if it could not."""

    @property
    def key(self) -> bytes:
        """The key."""
        return self._signing.key

    def judge(self, message: Message) -> Verdict:
        """Judge one packet by its frame, and remember its time stamp."""
        self._signing, verdict = signing.check(self._signing, message)
        self._reserve()
        return verdict

    def stamp(self, now: float) -> int:
        """Return the time stamp to send with."""
        self._signing = signing.stamp(self._signing, now)
        self._reserve()
        return self._signing.timestamp

    def save(self) -> None:
        """Write it to its file as it is, at the end of a run."""
        self._write(self._signing)

    def _reserve(self) -> None:
        if not signing.covers(self._reserved, self._signing):
            self._write(signing.ahead(self._signing))

    def _write(self, state: signing.Signing) -> None:
        self._reserved = state  # where it can't be written now, it is tried again after as long
        try:
            signing.save(state, self._path)
        except OSError as error:
            self.trouble = error.strerror or str(error)
