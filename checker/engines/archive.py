"""Archives: plain data and arrays in one file, with a digest of the whole content.

The digest detects accidents and careless edits. It is no signature: whoever can write the file can compute a new one.
So readers still validate every number.
"""

import json
import os
import re
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import CheckpointError
from physical import PhysicalError, open_file, opened_itself, read_json

FIRST = re.compile(rb"bigactors archive 1 ([0-9a-f]{64}) ([0-9]{1,9})\n")
MOST_FIRST, MOST_ABOUT = 128, 1 << 27
"""The most bytes of the first line, and of the plain data."""

Kinds = Mapping[str, type[np.generic]]
"""The arrays of an archive in order, each with its type of numbers."""


def write_archive(path: Path, head: dict[str, Any], kinds: Kinds, arrays: Sequence[NDArray[Any]]) -> None:
    """Replace an archive by plain data and arrays; readers always find a complete file.

    Raises:
        OSError: The file can't be written.
    """
    rows = [
        np.ascontiguousarray(array, kind).ravel() for kind, array in zip(kinds.values(), arrays, strict=True)
    ]
    about = json.dumps({"head": head, "lengths": [len(each) for each in rows]}).encode()
    found = sha256(about)
    for each in rows:
        found.update(each.view(np.uint8).data)
    partial = path.with_suffix(".partial")
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with open(partial, "wb", opener=opened_itself) as file:
            file.write(b"bigactors archive 1 %s %d\n" % (found.hexdigest().encode(), len(about)))
            file.write(about)
            for each in rows:
                file.write(each.view(np.uint8).data)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


def read_archive(path: Path, schema: str, kinds: Kinds) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return the plain data and the arrays of a file that `write_archive` wrote.

    Raises:
        CheckpointError: The file is no archive, was altered, or has another schema.
    """
    try:
        with open_file(path) as file:
            return _read(file, schema, kinds)
    except OSError as error:
        raise CheckpointError(f"{path}: this checkpoint can't be read: {error.strerror}") from error
    except PhysicalError as error:
        raise CheckpointError(f"{path}: this is no checkpoint: {error.message}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise CheckpointError(f"{path}: this is no checkpoint: {error}") from error


def _read(file: BinaryIO, schema: str, kinds: Kinds) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    first = FIRST.fullmatch(file.readline(MOST_FIRST))
    if first is None or int(first[2]) > MOST_ABOUT:
        raise ValueError("its first line is not that of a checkpoint")
    about = file.read(int(first[2]))
    data = read_json(about, MOST_ABOUT)
    if not isinstance(data, dict):
        raise ValueError("its header is not an object")
    head, lengths = data["head"], data["lengths"]
    if not isinstance(head, dict) or head.get("schema") != schema:
        raise ValueError(f"it is not of the schema {schema}")
    if len(lengths) != len(kinds) or not all(type(each) is int and each >= 0 for each in lengths):
        raise ValueError("it has other arrays")
    told = sum(count * np.dtype(kind).itemsize for kind, count in zip(kinds.values(), lengths, strict=True))
    rest = os.fstat(file.fileno()).st_size - file.tell()
    if told != rest:
        raise ValueError(f"its arrays need {told:,} bytes, and it has {rest:,}")
    found, arrays = sha256(about), {}
    for (name, kind), count in zip(kinds.items(), lengths, strict=True):
        arrays[name] = np.empty(count, kind)
        file.readinto(arrays[name].view(np.uint8).data)  # type: ignore[attr-defined]  # a file that was opened has it
        found.update(arrays[name].view(np.uint8).data)
    if found.hexdigest().encode() != first[1]:
        raise ValueError("its digest differs from that of its content: it was altered")
    return head, arrays
