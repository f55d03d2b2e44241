"""Key files: a signing key with its newest time stamps, shared by all links that sign with it.

The file is always ahead of the packets sent and accepted: it is written before them, with a reserve.
"""

from __future__ import annotations

from pathlib import Path

from adapters.mavlink import signing
from adapters.mavlink.message import MavlinkMessage
from adapters.mavlink.signing import Verdict


class Keeper:
    """Signs, checks signatures, and stores the state that must survive a run.

    Raises PhysicalError if the file is not such a state.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._signing = self._reserved = signing.load(path)
        self.trouble = ""
        """The reason why the file could not be written, if any."""

    @property
    def key(self) -> bytes:
        """The key."""
        return self._signing.key

    def judge(self, message: MavlinkMessage) -> Verdict:
        """Check the signature of one packet, and remember its time stamp."""
        self._signing, verdict = signing.check(self._signing, message)
        self._reserve()
        return verdict

    def stamp(self, now: float) -> int:
        """Return the time stamp to send with."""
        self._signing = signing.stamp(self._signing, now)
        self._reserve()
        return self._signing.timestamp

    def save(self) -> None:
        """Write the state to its file, at the end of a run."""
        self._write(self._signing)

    def _reserve(self) -> None:
        if not signing.covers(self._reserved, self._signing):
            self._write(signing.ahead(self._signing))

    def _write(self, state: signing.Signing) -> None:
        self._reserved = state  # a failed write is retried after the same time
        try:
            signing.save(state, self._path)
        except OSError as error:
            self.trouble = error.strerror or str(error)
