"""Keys on disk: a signing key with its newest time stamps, shared by all links that sign with it."""

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
        self._signing = signing.load(path)

    @property
    def key(self) -> bytes:
        """The key."""
        return self._signing.key

    def judge(self, message: Message) -> Verdict:
        """Judge one packet by its frame, and remember its time stamp."""
        self._signing, verdict = signing.check(self._signing, message)
        return verdict

    def stamp(self, now: float) -> int:
        """Return the time stamp to send with."""
        self._signing = signing.stamp(self._signing, now)
        return self._signing.timestamp

    def save(self) -> None:
        """Write it to its file."""
        signing.save(self._signing, self._path)
