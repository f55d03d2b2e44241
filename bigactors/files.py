"""Read and write files: bounded in size, and replaced atomically."""

import json
import os
import re
from pathlib import Path
from typing import Any

from bigactors.mistakes import Mistake, unreadable
from physical import PhysicalError, open_file
from physical import read_json as parse_json

MOST_JSON = 64 * 2**20
"""The most bytes of a JSON file that are read."""


def read_bytes(path: str, most: int) -> bytes:
    """Return at most `most` + 1 bytes of a file: one too many reveals a file that is too long."""
    try:
        with open_file(path) as file:
            return file.read(most + 1)
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from error


def read_json(path: str) -> Any:
    """Return the value in a JSON file."""
    try:
        return parse_json(read_bytes(path, MOST_JSON), MOST_JSON)
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, path) from error


def write_json(path: str, value: Any) -> None:
    """Write a value as JSON."""
    write_text(path, json_text(value))


def json_text(value: Any) -> str:
    """Return a value as JSON text in the format of this project."""
    return json.dumps(value, ensure_ascii=False, indent=1) + "\n"


def write_text(path: str, text: str) -> None:
    """Replace a file's text atomically: a reader sees the old text or the new one, never a part."""
    import tempfile  # noqa: PLC0415 - its import is slow, and many commands write no file

    target = Path(os.path.realpath(path))
    try:
        if target.exists() and not target.is_file():
            target.write_text(text, encoding="utf-8")  # a pipe or /dev/stdout cannot be replaced
            return
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", newline="", dir=target.parent, prefix=f".{target.name}.", delete=False
        ) as file:
            _fill(file.name, file, text, target)
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from error


def check_writable(path: str) -> None:
    """Raise Mistake for an unwritable path, before the output is computed."""
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise Mistake("this is a folder, not a file", place=path)
    if not target.parent.is_dir():
        raise Mistake("there is no such folder", place=path)
    if not os.access(target.parent, os.W_OK):
        raise Mistake("nothing can be written into its folder", place=path)


def _fill(name: str, file: Any, text: str, target: Path) -> None:
    try:
        file.write(text)
        file.close()
        os.chmod(name, target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask())
        os.replace(name, target)
    except BaseException:
        file.close()
        Path(name).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def make_folder(path: str) -> Path:
    """Make a folder and its parents."""
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        raise Mistake("there is a file where a folder should be", place=path) from error
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from error
    return Path(path)


def file_stem(name: str) -> str:
    """Return a name made fit for a file name.

    >>> file_stem("never in the basin"), file_stem("../x")
    ('never_in_the_basin', 'x')
    """
    return re.sub(r"[^\w.-]+", "_", name).strip("._")[:80] or "unnamed"


def _unreadable(path: str, error: Exception) -> Mistake:
    if isinstance(error, OSError):
        return unreadable(path, error)
    return Mistake("this is no path of a file", place=repr(path))
