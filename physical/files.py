"""Files that are read: only those that have an end, and that nobody has to be waited for."""

from __future__ import annotations

import errno
import os
import stat
from io import BufferedReader
from os import PathLike
from typing import Final

_NOT_WAITING: Final = getattr(os, "O_NONBLOCK", 0)
"""A named pipe that nobody writes into is opened at once."""

_STRANGE: Final = (
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def open_file(path: str | PathLike[str]) -> BufferedReader:
    """Open a file to read its bytes.

    Raises:
        OSError: It can't be opened, or is a folder, a pipe, a socket or a device.
        ValueError: It is no path.
    """
    return open(path, "rb", opener=_opened)


def opened_itself(path: str, flags: int, mode: int = 0o666) -> int:
    """Open a file for writing, as `open` asks its opener to; never one that a symbolic link leads to.

    Raises:
        OSError: It can't be opened, or is a symbolic link.
    """
    try:
        return os.open(path, flags | os.O_NOFOLLOW | os.O_CLOEXEC, mode)
    except OSError as error:
        if error.errno != errno.ELOOP:
            raise
        message = "this is a symbolic link: name the file that it leads to"
        raise OSError(errno.ELOOP, message, path) from error


def _opened(path: str, flags: int) -> int:
    # a socket can't be opened at all, and a device may do something when it is
    if strange := _strange(os.stat(path).st_mode):
        raise _refused(path, strange)
    handle = os.open(path, flags | _NOT_WAITING)
    if strange := _strange(os.fstat(handle).st_mode):  # it has come to be another since
        os.close(handle)
        raise _refused(path, strange)
    return handle


def _strange(mode: int) -> str:
    return next((called for is_one, called in _STRANGE if is_one(mode)), "")


def _refused(path: str, strange: str) -> OSError:
    return OSError(errno.EINVAL, f"this is {strange}, not a file: save what it yields, and give that", path)
