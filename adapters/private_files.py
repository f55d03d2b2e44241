"""Private files (recordings, logs, keys), readable by their owner only; errors of writing have the file's name."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final, cast

from physical import opened_itself

OWNER: Final = 0o600


def open_private(path: Path, mode: str, buffering: int = -1) -> BinaryIO:
    """Open a binary file that only its owner may read and write; an existing file is restricted before it is used.

    Raises:
        OSError: It can't be opened, or is a symbolic link.
    """
    return cast("BinaryIO", open(path, mode, buffering, opener=_opened))


def others_may_read(path: Path) -> str:
    """Return the mode of a file if others may access it, in the form of `chmod`; else an empty text."""
    mode = stat.S_IMODE(path.stat().st_mode)
    return f"{mode:04o}" if mode & 0o077 else ""


def _opened(path: str, flags: int) -> int:
    handle = opened_itself(path, flags, OWNER)
    try:
        if stat.S_ISREG(os.fstat(handle).st_mode):  # not /dev/null
            os.fchmod(handle, OWNER)
    except BaseException:
        os.close(handle)
        raise
    return handle


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Add the name of the unwritten file to an OSError inside."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
