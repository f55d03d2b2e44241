"""Opening of input files: only regular files, which end and do not block."""

from __future__ import annotations

import errno
import os
import stat
from io import BufferedReader
from os import PathLike
from typing import Final

_NOT_WAITING: Final = getattr(os, "O_NONBLOCK", 0)
"""Opens a named pipe without a writer at once."""

_STRANGE: Final = (
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def open_file(path: str | PathLike[str]) -> BufferedReader:
    """Open a file for reading bytes.

    Raises:
        OSError: If it can't be opened, or is a folder, a pipe, a socket or a device.
        ValueError: If the path is invalid.
    """
    return open(path, "rb", opener=_opened)


def opened_itself(path: str, flags: int, mode: int = 0o666) -> int:
    """Open a file for writing, as an opener of `open`; symbolic links are refused.

    Raises:
        OSError: If it can't be opened, or is a symbolic link.
    """
    try:
        return os.open(path, flags | os.O_NOFOLLOW | os.O_CLOEXEC, mode)
    except OSError as error:
        if error.errno != errno.ELOOP:
            raise
        message = "this is a symbolic link: name the file that it leads to"
        raise OSError(errno.ELOOP, message, path) from error


def _opened(path: str, flags: int) -> int:
    # checked before the open: a socket can't be opened, and opening a device may have effects
    if strange := _strange(os.stat(path).st_mode):
        raise _refused(path, strange)
    handle = os.open(path, flags | _NOT_WAITING)
    if strange := _strange(os.fstat(handle).st_mode):  # the file was replaced in between
        os.close(handle)
        raise _refused(path, strange)
    return handle


def _strange(mode: int) -> str:
    return next((called for is_one, called in _STRANGE if is_one(mode)), "")


def _refused(path: str, strange: str) -> OSError:
    return OSError(
        errno.EINVAL, f"this is {strange}, not a file: save its content to a file, and give that", path
    )
