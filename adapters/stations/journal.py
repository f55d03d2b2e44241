"""A station's log on disk: entries are appended before they are sent, so no number is used twice."""

from __future__ import annotations

import fcntl
import json
import os
import time
import zlib
from collections.abc import Iterator
from contextlib import suppress
from itertools import takewhile
from pathlib import Path
from typing import Any, BinaryIO, Final

from msgspec import Struct, to_builtins

from adapters.private_files import open_private, writing
from adapters.stations.entries import MOST_BYTES, Content, Count, Entry, Posted, Took, entry_of, entry_text
from adapters.typed_json import typed
from physical import PhysicalError, read_json

SCHEMA: Final = "bigactors.station/3"
UNSUMMED: Final = "bigactors.station/1"
"""Logs of earlier versions, whose lines have no checksums; they are read, and rewritten with them."""
UNQUOTED: Final = "bigactors.station/2"
"""Logs of earlier versions with checksums. In their parcels, as in those before, texts and names are alike: refused."""

BEGINNING: Final = 2
"""The required lines of a log: its owner, and the numbers used so far."""

SPARE: Final = 10_000
"""The most replaced entries in the file before it is rewritten."""


PASSED: Final = 1_000
"""Numbers skipped after a dropped last entry, since it may have been sent."""


class _Used(Struct, frozen=True):
    """The numbers used so far, and those of parcels to each station."""

    last: Count
    sent: dict[str, Count]


class JournalError(ValueError):
    """A file that is not this station's log of this mission, for the reason in the message."""


class ForeignLog(JournalError):
    """A log of another station or mission, or no log at all."""


class Journal:
    """One station's valid entries with their numbers, in a file that is appended to, and compacted now and then.

    A new log numbers from the time in milliseconds, above every number that a lost log may have used. So does a log
    after a torn or damaged last entry, which is dropped.

    Each line begins with a checksum of itself and of all earlier lines.

    Attributes:
        dropped: The fault of the last line, if it was dropped.
    """

    def __init__(self, path: Path, station: str, digest: str) -> None:
        """Open or create a log; raises JournalError, OSError."""
        self.path = path
        self.station = station
        self.last = 0
        self._head = {"log": SCHEMA, "station": station, "mission": digest}
        self._entries: dict[tuple[str, ...], Entry] = {}
        self._sent: dict[str, int] = {}
        self._spare = 0
        self._sum = 0
        self.dropped = ""
        self._file = _locked(path)
        try:
            is_current = self._read()
            if self.dropped or not self.last:
                self.last = max(self.last + PASSED, time.time_ns() // 1_000_000)
            if self.dropped or not is_current:
                self._rewrite()
        except BaseException:
            self._file.close()
            raise

    # --- queries

    def after(self, number: int, most: int) -> tuple[list[Entry], int]:
        """Return entries after a number, the oldest first, and the number up to which they are complete."""
        found = list(takewhile(lambda entry: entry.number > number, reversed(self._entries.values())))[::-1]
        if len(found) <= most:
            return found, self.last
        return found[:most], found[most - 1].number

    def word(self, key: tuple[str, ...]) -> Content | None:
        """Return the valid entry with a key."""
        entry = self._entries.get(key)
        return None if entry is None else entry.content

    def entries(self) -> Iterator[Entry]:
        """Yield all valid entries, the oldest first."""
        yield from self._entries.values()

    def sent(self, to: str) -> int:
        """Return the number of parcels posted to a station."""
        return self._sent.get(to, 0)

    def took(self, of: str) -> int:
        """Return the index up to which all parcels of a station were taken."""
        word = self.word(("took", of))
        return word.index if isinstance(word, Took) else 0

    def waiting(self, to: str) -> int:
        """Count the parcels that a station has not taken yet."""
        return sum(1 for key in self._entries if key[:2] == ("posted", to))

    # --- changes

    def add(self, contents: list[Content]) -> list[Entry]:
        """Number entries, and write them; the entries that they replace are no longer valid."""
        entries = []
        for content in contents:
            self.last += 1
            entries.append(Entry(self.station, self.last, content))
        self._append([entry_text(entry) for entry in entries])
        for entry in entries:
            self._keep(entry)
        if self._spare > SPARE + len(self._entries):
            self._rewrite()
        return entries

    def taken(self, to: str, index: int) -> None:
        """Remove the parcels that a station has taken."""
        for key, entry in list(self._entries.items()):
            if isinstance(entry.content, Posted) and entry.content.to == to and entry.content.index <= index:
                del self._entries[key]
                self._spare += 1

    def close(self) -> None:
        """Close the file."""
        with suppress(OSError):  # a failed write has been reported
            self._file.close()

    # --- the file

    def _keep(self, entry: Entry) -> None:
        key = entry.content.key
        if self._entries.pop(key, None) is not None:
            self._spare += 1
        self._entries[key] = entry
        self.last = max(self.last, entry.number)
        if isinstance(entry.content, Posted):
            self._sent[entry.content.to] = max(self.sent(entry.content.to), entry.content.index)

    def _read(self) -> bool:
        """Read the file up to its end, or to a torn or damaged last line; return whether it is of this version."""
        self._file.seek(0)
        size = os.fstat(self._file.fileno()).st_size
        is_summed = not self._file.read(1).startswith(b"{")
        self._file.seek(0)
        number, schema = 0, ""
        while self._file.tell() < size:
            number += 1
            try:
                data = self._parsed(self._file.readline(2 * MOST_BYTES), is_summed=is_summed)
                if number == 1:
                    schema = self._check(data, (SCHEMA, UNQUOTED) if is_summed else (UNSUMMED,))
                else:
                    self._take(data, schema)
            except ForeignLog:
                raise
            except ValueError as error:
                if number <= BEGINNING or self._file.tell() < size:
                    raise JournalError(
                        f"{self.path}:{number}: the log is damaged: {error}: "
                        "move it away, and the station begins another with higher numbers"
                    ) from error
                self.dropped = f"{self.path}:{number}: the last entry was dropped: {error}"
        return schema == SCHEMA

    def _parsed(self, line: bytes, *, is_summed: bool) -> Any:
        """Return the content of a line; raises ValueError if it is torn or damaged."""
        if not line.endswith(b"\n"):
            raise ValueError("it is torn, or longer than any entry")
        said, text = (line[:8], line[9:-1]) if is_summed else (b"", line)
        if is_summed:
            found = zlib.crc32(text, self._sum)
            if line[8:9] != b" " or said != b"%08x" % found:
                raise ValueError("its checksum does not match its content")
            self._sum = found
        try:
            return read_json(text, 2 * MOST_BYTES)
        except PhysicalError as error:
            raise ValueError(f"{error.message:.150}") from error

    def _take(self, data: Any, schema: str) -> None:
        match data:
            case {"last": _}:
                used = typed(data, _Used)
                self.last = max(self.last, used.last)
                self._sent |= used.sent
            case _:
                entry = entry_of(self.station, data)
                if isinstance(entry.content, Posted) and schema != SCHEMA:
                    raise ForeignLog(
                        f"{self.path} has parcels of an earlier version: move it away, "
                        "and the station begins another with higher numbers"
                    )
                self._keep(entry)

    def _check(self, head: Any, schemas: tuple[str, ...]) -> str:
        schema = head.get("log") if isinstance(head, dict) else None
        if schema not in schemas:
            raise ForeignLog(f"{self.path} is no log of a station")
        for key in ("station", "mission"):
            if head.get(key) != self._head[key]:
                what = f"{key} '{head.get(key)!s:.80}'"
                raise ForeignLog(f"{self.path} is the log of {what}: move it away, or name another file")
        return str(schema)

    def _append(self, lines: list[str]) -> None:
        found = []
        for line in lines:
            self._sum = zlib.crc32(line.encode(), self._sum)
            found.append(f"{self._sum:08x} {line}\n")
        with writing(self.path):
            self._file.write("".join(found).encode())
            self._file.flush()

    def _rewrite(self) -> None:
        """Rewrite the file with the valid entries; the new file replaces the old one atomically."""
        part = self.path.with_name(self.path.name + ".part")
        part.unlink(missing_ok=True)
        old, self._file, self._sum = self._file, _locked(part), 0
        used = to_builtins(_Used(self.last, self._sent))
        lines = [json.dumps(self._head), json.dumps(used), *map(entry_text, self._entries.values())]
        self._append(lines)
        os.replace(part, self.path)
        old.close()
        self._spare = 0


def _locked(path: Path) -> BinaryIO:
    """Open a file, and lock it against other processes."""
    file = open_private(path, "a+b")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        raise JournalError(f"{path}: another run of this station writes there") from error
    return file
