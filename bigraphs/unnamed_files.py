"""Unnamed files for data that leaves the memory: nothing of them remains, however the process ends."""

from __future__ import annotations

import os
import weakref
from pathlib import Path
from tempfile import TemporaryFile


def unnamed_file(owner: object, folder: Path) -> int:
    """Return the descriptor of a new file in a folder; it is closed with its owner.

    Raises:
        OSError: There is no such folder, or it can't be written.
    """
    with TemporaryFile(dir=folder) as opened:
        file = os.dup(opened.fileno())
    weakref.finalize(owner, os.close, file)
    return file


def reserve(file: int, size: int) -> None:
    """Allocate the full size of a file: a write to a hole that can't be filled would kill the process."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
    else:
        os.ftruncate(file, size)
