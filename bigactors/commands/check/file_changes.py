"""Detect saved files by their content, whether an editor rewrites a file in place or replaces it by a rename."""

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread
from time import sleep, time_ns
from typing import Final, TypeAlias

from checker import Interruption
from physical import open_file

INTERVAL: Final = 0.2
"""Seconds between two polls of the files."""

SETTLED: Final = 0.1
"""Seconds without a change after which a save is complete: until then, an editor may still write."""

RECENT: Final = 2_000_000_000
"""Nanoseconds within which two writes may carry the same time stamp."""


@dataclass(frozen=True, slots=True)
class Seen:
    """The state of a file at a poll.

    Attributes:
        digest: The digest of its content; None for an unreadable file.
        stamp: Its inode, size and time of change; None where a recent change makes them unreliable.
    """

    digest: bytes | None
    stamp: tuple[int, int, int] | None = None


Looks: TypeAlias = Mapping[Path, Seen]


def look(paths: Iterable[Path], before: Looks | None = None) -> dict[Path, Seen]:
    """Return the state of each file now; only read those that may have changed since the poll before."""
    return {path: _look(path, (before or {}).get(path)) for path in paths}


def _look(path: Path, before: Seen | None) -> Seen:
    try:
        status = path.stat()
        stamp = (status.st_ino, status.st_size, status.st_mtime_ns)
        if before is not None and before.stamp == stamp:
            return before
        with open_file(path) as file:
            digest = hashlib.file_digest(file, "sha256").digest()
    except (OSError, ValueError):
        return Seen(None)
    return Seen(digest, stamp if time_ns() - status.st_mtime_ns > RECENT else None)


def changed(before: Looks, now: Looks) -> tuple[Path, ...]:
    """Return the files whose content has changed."""
    return tuple(
        path for path in sorted(now) if path not in before or before[path].digest != now[path].digest
    )


def wait_for_save(seen: Looks) -> tuple[Path, ...]:
    """Wait until files have changed and nothing writes them any more; return them."""
    while True:
        now = look(seen, seen)
        if changed(seen, now):
            sleep(SETTLED)
            later = look(seen, now)
            if not changed(now, later) and (saved := changed(seen, later)):
                return saved
        else:
            sleep(INTERVAL)


@contextmanager
def interrupted_by_save(seen: Looks) -> Iterator[tuple[Interruption, Event]]:
    """Interrupt the body as soon as a file is saved; the event is set then."""
    interruption, saved, done = Interruption(), Event(), Event()

    def poll() -> None:
        while not done.wait(INTERVAL):
            if changed(seen, look(seen, seen)):
                saved.set()
                interruption.wish()
                return

    thread = Thread(target=poll, daemon=True)
    thread.start()
    try:
        yield interruption, saved
    finally:
        done.set()
        thread.join()
