"""Checkpoints: the state from which an exploration continues after its process was killed.

Rows, origins and counts are saved as they are. What was learned is not: it is learned again from the rows at which it
was learned, in the same order, so that nothing in a checkpoint is ever evaluated. A digest of all columns tells whether
that came to the same.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from checker.engines.archive import Kinds, read_archive, write_archive
from checker.engines.contract import CheckpointError
from checker.engines.fast.columns import Packing
from checker.engines.fast.kernel import CROWDS, CUT, EXPANDED, LIMIT, SIZE
from checker.engines.fast.rows import Rows
from checker.engines.fast.space import Space
from semantics.state.canonical import canonical

SCHEMA = "bigactors.checkpoint/5"
KEPT = (EXPANDED, SIZE, CUT, CROWDS)
"""What of the loops' state goes on; the rest follows from the mission."""

RECOUNTED = 1 << 22
"""Of how many rows the transitions are taken once more: some seconds' work."""

KINDS: Final[Kinds] = {
    "rows": np.uint64,
    "pieces": np.uint64,
    "nodes": np.uint64,
    "origins": np.uint64,
    "counts": np.int64,
    "packing": np.uint64,
    "learned": np.int64,
    "state": np.int64,
}


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

    @property
    def is_sound(self) -> bool:
        """Tell whether its numbers fit together."""
        sizes = (*self.layers, self.depth, self.layer_end)
        whole = all(type(each) is int and each >= 0 for each in sizes) and is_time(self.seconds)
        return whole and len(self.layers) == self.depth + 1 and sum(self.layers) == self.layer_end


def is_time(seconds: object) -> bool:
    """Tell whether something is a number of seconds."""
    return type(seconds) in {int, float} and 0 <= seconds < math.inf  # type: ignore[operator]  # a number


def save(space: Space, journey: Journey, digest: str, path: Path) -> None:
    """Write a checkpoint in the place of the one before: what is there is always whole.

    Raises:
        OSError: It can't be written there.
    """
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
    arrays = (
        space.rows.words[: space.size * space.rows.kept],
        *space.rows.interned,
        space.rows.origins.kept(space.size),
        space.counts.used,
        space.packing.columns[: 3 * len(columns)],
        np.array(space.learned, np.int64),
        space.state[list(KEPT)],
    )
    write_archive(path, head, KINDS, arrays)


def resume(space: Space, digest: str, path: Path) -> Journey:
    """Let a new space go on where a checkpoint was written.

    Raises:
        CheckpointError: It is damaged, or of another mission, variation, limit or version.
    """
    head, arrays = read_archive(path, SCHEMA, KINDS)
    if head.get("digest") != digest or head.get("limit") != int(space.state[LIMIT]):
        raise CheckpointError(f"{path}: this checkpoint is of another mission, variation, limit or version")
    try:
        journey = Journey(head["depth"], head["layer_end"], head["seconds"], tuple(head["layers"]))
        _check(arrays, journey, int(space.state[LIMIT]))
        learned = arrays["learned"].reshape(-1, 4).tolist()
        where = Packing(head["words"], arrays["packing"])
        if not where.is_sound:
            raise ValueError("its columns stand nowhere in its rows")
        size = int(arrays["state"][1])
        kept = (arrays[each] for each in ("rows", "origins", "pieces", "nodes"))
        rows = Rows.of(where.words, size, *kept)
        if rows.origins.origin(size - 1, size) > arrays["state"][0]:
            raise ValueError("some row was reached from a later one")
        space.restore(where, rows, size, learned)
        _check_counts(space, arrays["counts"], arrays["state"])
        if space.choosing is None:
            _recount(space, arrays["counts"], arrays["state"])
        space.counts.used[: len(arrays["counts"])] = arrays["counts"]
        space.state[list(KEPT)] = arrays["state"]
    except (ValueError, IndexError, KeyError, TypeError) as error:
        raise CheckpointError(f"{path}: this checkpoint is damaged: {error}") from error
    if _digest_of_columns(space) != head["columns"]:
        raise CheckpointError(f"{path}: what is learned from this checkpoint is not what was learned")
    return journey


def _check(arrays: dict[str, NDArray[Any]], journey: Journey, limit: int) -> None:
    """Hold what is read of a search to what any search keeps; raises ValueError."""
    expanded, size, cut, crowded = map(int, arrays["state"])
    if not journey.is_sound:
        raise ValueError("its layers and rows do not fit together")
    begin = journey.layer_end - journey.layers[-1]
    if not begin <= expanded <= journey.layer_end <= size <= limit:
        raise ValueError("it has come to no row of its last layer")
    if cut < 0 or (cut and size != limit) or not 0 <= crowded <= expanded:
        raise ValueError("it left out what it can't have left out")


def _check_counts(space: Space, counts: NDArray[np.int64], state: NDArray[np.int64]) -> None:
    """Hold counts to what they may be: each row takes a transition once at the most; raises ValueError."""
    expanded, size = int(state[0]), int(state[1])
    if len(counts) != len(space.learner.leaves.rule) or np.any(counts < 0) or np.any(counts > expanded):
        raise ValueError("its transitions were not taken so often")
    if int(counts.sum()) < size - 1:
        raise ValueError("it has more rows than transitions")


def _recount(space: Space, counts: NDArray[np.int64], state: NDArray[np.int64]) -> None:
    """Take the transitions of rows that were expanded once more, and hold counts and rows to them; raises ValueError.

    What was learned of them may have been forgotten since, so transitions are compared by what they are called. Of many
    rows the first and the last are taken: transitions were taken at least as often.
    """
    expanded, size, cut = map(int, state[:3])
    half = RECOUNTED // 2
    parts = (range(expanded),) if expanded <= RECOUNTED else (range(half), range(expanded - half, expanded))
    found, reached = Counter[int](), np.zeros(size, np.bool_)
    reached[0] = True
    for _, steps, targets in (each for part in parts for each in space.edges(part)):
        taken = np.bincount(steps)
        found.update({int(step): int(taken[step]) for step in np.flatnonzero(taken)})
        if not cut and np.any(targets < 0):
            raise ValueError("it lacks what follows from its rows")
        reached[targets[targets >= 0]] = True
    rest = expanded - sum(map(len, parts))
    told, again = _by_label(space, dict(enumerate(counts.tolist()))), _by_label(space, found)
    if told != again and not (rest and told >= again):
        raise ValueError("its transitions were not taken so often")
    if not rest and not reached.all():
        raise ValueError("some row follows from none before it")


def _by_label(space: Space, counts: Mapping[int, int]) -> Counter[tuple[int, str]]:
    """Return how often transitions were taken, by their rules and labels."""
    rules, steps = space.learner.leaves.rule.room, space.learner.steps
    found = Counter[tuple[int, str]]()
    for step, count in counts.items():
        if count:
            found[int(rules[step]), str(steps.get(step))] += count
    return found


def _digest_of_columns(space: Space) -> str:
    found = sha256()
    for line in _lines(space):
        found.update(line.encode("utf-8", "surrogatepass"))
    return found.hexdigest()


def _lines(space: Space) -> Iterator[str]:
    for column in space.learner.columns.all:
        yield canonical((column.place, tuple(column.values)))
