"""Checkpoints: everything from which an exploration goes on after its process was killed.

Rows, origins and counts are saved as they are. What was learned is not: it is learned again from the rows at which it
was learned, in the same order, so that nothing in a checkpoint is ever evaluated. A digest of all columns tells whether
that came to the same.
"""

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from checker.exploration import CheckpointError
from checker.fast.columns import Packing
from checker.fast.engine import Space
from checker.fast.kernel import CROWDS, CUT, EXPANDED, LIMIT, SIZE
from semantics.canonical import canonical

SCHEMA = "bigactors.checkpoint/1"
KEPT = (EXPANDED, SIZE, CUT, CROWDS)
"""What of the loops' state goes on; the rest follows from the mission."""

MOST_BYTES = 1 << 40


@dataclass(frozen=True, slots=True)
class Journey:
    """How far the exploration had come.

    Attributes:
        depth: The distance of what is being expanded.
        layer_end: Where that layer ends.
        seconds: How long it took.
        layers: How large each layer is, up to that one.
    """

    depth: int
    layer_end: int
    seconds: float
    layers: tuple[int, ...] = (1,)


def save(space: Space, journey: Journey, digest: str, path: Path) -> None:
    """Write a checkpoint in the place of the one before: what is there is always whole."""
    columns = space.learner.columns.all
    head = {
        "schema": SCHEMA,
        "digest": digest,
        "limit": int(space.state[LIMIT]),
        "words": space.packing.words,
        "depth": journey.depth,
        "layer_end": journey.layer_end,
        "seconds": journey.seconds,
        "layers": journey.layers,
        "columns": _digest_of_columns(space),
    }
    write_archive(
        path,
        head,
        rows=space.rows.words[: space.size * space.packing.words],
        origins=space.rows.origins[: space.size],
        counts=space.counts.used,
        packing=space.packing.columns[: 3 * len(columns)],
        learned=np.array(space.learned, np.int64).reshape(-1, 4),
        state=space.state[list(KEPT)],
    )


def write_archive(path: Path, head: dict[str, Any], **arrays: NDArray[Any]) -> None:
    """Write arrays and plain data in the place of those before: what is there is always whole."""
    partial = path.with_suffix(".partial")
    path.parent.mkdir(parents=True, exist_ok=True)
    with partial.open("wb") as file:
        kept = {"head": np.frombuffer(json.dumps(head).encode(), np.uint8), **arrays}
        np.savez(file, allow_pickle=False, **kept)
        file.flush()
        os.fsync(file.fileno())
    partial.replace(path)


def resume(space: Space, digest: str, path: Path) -> Journey:
    """Let a new space go on where a checkpoint was written.

    Raises:
        CheckpointError: It is damaged, or of another mission, variation, limit or version.
    """
    head, arrays = read_archive(path, SCHEMA)
    if head.get("digest") != digest or head.get("limit") != int(space.state[LIMIT]):
        raise CheckpointError(f"{path}: this checkpoint is of another mission, variation, limit or version")
    try:
        space.restore(
            Packing(int(head["words"]), arrays["packing"].astype(np.uint64)),
            arrays["rows"].astype(np.uint64),
            arrays["origins"].astype(np.uint32),
            arrays["learned"].astype(np.int64).tolist(),
        )
        space.counts.size = 0
        space.counts.extend(len(space.learner.leaves.rule))
        space.counts.used[: len(arrays["counts"])] = arrays["counts"]
        space.state[list(KEPT)] = arrays["state"]
        layers = tuple(int(size) for size in head["layers"])
        journey = Journey(int(head["depth"]), int(head["layer_end"]), float(head["seconds"]), layers)
    except (ValueError, IndexError, KeyError, TypeError) as error:
        raise CheckpointError(f"{path}: this checkpoint is damaged: {error}") from error
    if _digest_of_columns(space) != head["columns"]:
        raise CheckpointError(f"{path}: what is learned from this checkpoint is not what was learned")
    return journey


def read_archive(path: Path, schema: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the plain data and the arrays of a file that `write_archive` wrote.

    Raises:
        CheckpointError: It is none, or of another schema.
    """
    arrays = _read(path)
    return _head(arrays, path, schema), arrays


def _read(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise CheckpointError(f"{path}: a checkpoint is no larger than {MOST_BYTES:,} bytes")
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, EOFError, BadZipFile) as error:
        raise CheckpointError(f"{path}: this is no checkpoint: {error}") from error


def _head(arrays: dict[str, Any], path: Path, schema: str) -> dict[str, Any]:
    try:
        head = json.loads(arrays["head"].tobytes())
    except (KeyError, ValueError) as error:
        raise CheckpointError(f"{path}: this is no checkpoint: {error}") from error
    if not isinstance(head, dict) or head.get("schema") != schema:
        raise CheckpointError(f"{path}: this is no checkpoint of the schema {schema}")
    return head


def _digest_of_columns(space: Space) -> str:
    found = sha256()
    for line in _lines(space):
        found.update(line.encode("utf-8", "surrogatepass"))
    return found.hexdigest()


def _lines(space: Space) -> Iterator[str]:
    for column in space.learner.columns.all:
        yield canonical((column.place, tuple(column.values)))
