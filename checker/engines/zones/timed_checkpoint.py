"""Checkpoints of a timed search: its rows, what was learned from them, and the locations whose edges are known.

Zones are not stored. A search that goes on makes them again, from the known automaton: so none has to be believed.
"""

from pathlib import Path
from typing import Final

import numpy as np

from checker.engines.archive import Kinds, read_archive, write_archive
from checker.engines.contract import CheckpointError
from checker.engines.fast.search.checkpoint import ROWS, digest_of_columns, is_time, kept_rows, restore_rows
from checker.engines.zones.timed_automaton_of import Network

SCHEMA = "bigactors.timed_checkpoint/1"
KINDS: Final[Kinds] = {**ROWS, "left": np.int64}


def save(network: Network, seconds: float, digest: str, path: Path) -> None:
    """Write a checkpoint; it replaces the previous one atomically.

    Raises:
        OSError: The file can't be written.
    """
    head = {
        "schema": SCHEMA,
        "digest": digest,
        "size": network.size,
        "words": network.store.packing.words,
        "seconds": seconds,
        "columns": digest_of_columns(network.model),
    }
    write_archive(path, head, KINDS, (*kept_rows(network.model), network.automaton.left()))


def digest_in(path: Path) -> object:
    """Return the digest in a checkpoint; raises CheckpointError if it is damaged."""
    return read_archive(path, SCHEMA, KINDS)[0].get("digest")


def resume(network: Network, digest: str, path: Path) -> float:
    """Continue in a new network from a checkpoint; return the seconds that its search had taken.

    Raises:
        CheckpointError: It is damaged, or of another mission, variation, limit or version.
    """
    head, arrays = read_archive(path, SCHEMA, KINDS)
    if head.get("digest") != digest:
        raise CheckpointError(f"{path}: this checkpoint is of another mission, variation, limit or version")
    try:
        seconds, size = head["seconds"], head["size"]
        if not is_time(seconds) or type(size) is not int or size < 1:
            raise ValueError("its numbers are wrong")
        restore_rows(network.model, head["words"], size, arrays)
        network.begin()
        network.leave_again(arrays["left"])
        if network.size != size:
            raise ValueError("it lacks successors of its rows")
    except (ValueError, IndexError, KeyError, TypeError) as error:
        raise CheckpointError(f"{path}: this checkpoint is damaged: {error}") from error
    if digest_of_columns(network.model) != head["columns"]:
        raise CheckpointError(
            f"{path}: the rules learned from this checkpoint differ from those recorded in it"
        )
    return float(seconds)
