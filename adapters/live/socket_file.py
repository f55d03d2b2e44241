"""A Unix socket in the file system: bound by one process at a time, and served even without free descriptors."""

from __future__ import annotations

import errno
import fcntl
import os
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from socket import AF_UNIX, SOCK_STREAM, socket
from typing import Final

BACKLOG: Final = 100
SPARE: Final = 4
"""Descriptors kept in reserve."""

LOCKED: Final = 1.0
"""Seconds of waiting for another process that is about to bind a socket in the same folder."""

SPENT: Final = (errno.EMFILE, errno.ENFILE)


@contextmanager
def bound(path: Path) -> Iterator[socket]:
    """Listen at a path that only its user may open, and remove it in the end if it is still this socket's.

    Raises:
        OSError: It can't be bound; FileExistsError if a process listens there, or it is no socket.
    """
    with socket(AF_UNIX, SOCK_STREAM) as server:
        server.setblocking(False)
        with _alone_in(path.parent):
            if is_taken(path):
                raise FileExistsError(errno.EEXIST, "another run listens there", str(path))
            with suppress(FileNotFoundError):
                if stat.S_ISSOCK(path.lstat().st_mode):
                    path.unlink()
            mask = os.umask(0o177)
            try:
                server.bind(str(path))
            finally:
                os.umask(mask)
            server.listen(BACKLOG)
            own = _identity(path)
        try:
            yield server
        finally:
            if _identity(path) == own:
                path.unlink(missing_ok=True)


def is_taken(path: Path) -> bool:
    """Return whether a process listens at a path, even stopped or busy; a refused connection shows that none does."""
    with socket(AF_UNIX, SOCK_STREAM) as asking:
        asking.setblocking(False)
        try:
            asking.connect(str(path))
        except BlockingIOError:
            return True  # its queue of connections is full
        except OSError:
            return False
        return True


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = path.lstat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Keep others from binding in a folder meanwhile, if the file system allows a lock."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        end = time.monotonic() + LOCKED
        while not _is_locked(descriptor) and time.monotonic() < end:
            time.sleep(0.01)
        yield
    finally:
        os.close(descriptor)


def _is_locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True  # the file system has no locks
    return True


class Reserve:
    """Spare descriptors for clients that must be served even if the process has no others left."""

    def __init__(self) -> None:
        self._spare: list[int] = []
        self.fill()

    def fill(self) -> None:
        """Open the missing spare descriptors, within the limit of the process."""
        with suppress(OSError):
            while len(self._spare) < SPARE:
                self._spare.append(os.open(os.devnull, os.O_RDONLY | os.O_CLOEXEC))

    def accepted(self, server: socket) -> socket | None:
        """Return the next connection, None if none can be taken now."""
        try:
            return server.accept()[0]
        except OSError as error:
            if error.errno not in SPENT or not self._spare:
                return None
        os.close(self._spare.pop())
        with suppress(OSError):
            return server.accept()[0]
        return None

    def close(self) -> None:
        """Close all spare descriptors."""
        while self._spare:
            os.close(self._spare.pop())
