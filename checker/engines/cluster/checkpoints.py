"""Checkpoints of a worker, and how it resumes from one.

Rows are kept as they are, beside a digest of each value of each column; values themselves are not, so nothing in a
checkpoint is ever evaluated. A worker that has been started anew learns them again from the rows at which it learned
them. What it had been told by others is told once more: worker by worker, until all know all values of their rows.
"""

from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np

from checker.engines.archive import Kinds, read_archive, write_archive
from checker.engines.cluster import kernel
from checker.engines.cluster.keys import DIGEST
from checker.engines.cluster.shard import Shard, spelling
from checker.engines.contract import CheckpointError
from checker.engines.fast import kernel as loops
from checker.engines.fast.checkpoint import is_time
from checker.engines.fast.columns import Packing
from checker.engines.fast.kernel import CROWDS, CUT, EXPANDED, LIMIT, SIZE
from checker.engines.fast.space import MOST_ROWS

SCHEMA = "bigactors.shard/2"
UNKNOWN = -1
KEPT = (EXPANDED, SIZE, CUT, CROWDS, LIMIT)
"""What of the loops' state goes on."""

KINDS: Final[Kinds] = {
    "rows": np.uint64,
    "origins": np.uint64,
    "packing": np.uint64,
    "places": np.uint8,
    "sizes": np.int64,
    "digests": np.uint8,
    "learned": np.int64,
    "state": np.int64,
}

BLOCK = 1 << 18
LATEST = "latest.checkpoint"
ANOTHER = "this checkpoint is of another mission, variation, limit, version or number of workers"


def path_of(folder: Path, number: int, worker: int) -> Path:
    """Return where a worker's checkpoint of that number is."""
    return folder / f"shard-{number}-{worker}.checkpoint"


@dataclass(frozen=True, slots=True)
class Latest:
    """The last checkpoint that all workers have written.

    Attributes:
        number: Its number.
        layer: The layer that was expanded.
        seconds: How long the exploration had taken.
    """

    number: int
    layer: int
    seconds: float

    @property
    def is_sound(self) -> bool:
        """Tell whether its numbers may be those of a checkpoint."""
        return all(type(each) is int and each >= 0 for each in (self.number, self.layer)) and is_time(
            self.seconds
        )


def write_latest(folder: Path, latest: Latest, digest: str, workers: int) -> None:
    """Note which checkpoint is to be gone back to."""
    head = {"schema": SCHEMA, "digest": digest, "workers": workers, **asdict(latest)}
    write_archive(folder / LATEST, head, {}, ())


def read_latest(folder: Path, digest: str, workers: int) -> Latest | None:
    """Return which checkpoint is to be gone back to, None where there is none.

    Raises:
        CheckpointError: It is damaged, or of something else.
    """
    path = folder / LATEST
    if not path.exists():
        return None
    head, _ = read_archive(path, SCHEMA, {})
    if (head.get("digest"), head.get("workers")) != (digest, workers):
        raise CheckpointError(f"{path}: {ANOTHER}")
    latest = Latest(head.get("number", -1), head.get("layer", -1), head.get("seconds", -1))
    if not latest.is_sound:
        raise CheckpointError(f"{path}: this checkpoint is damaged: its numbers are none of a checkpoint")
    return latest


def save(shard: Shard, folder: Path, number: int, digest: str) -> None:
    """Write a checkpoint."""
    head = {
        "schema": SCHEMA,
        "digest": digest,
        "worker": [shard.me, shard.workers],
        "words": shard.packing.words,
        "layers": [*shard.begins, shard.end],
        "rules": dict(shard.rules()),
        "happened": sorted(shard.happened_before | happened(shard)),
    }
    arrays = (
        shard.rows.words[: shard.size * shard.packing.words],
        shard.rows.origins.kept(shard.size),
        shard.packing.columns,
        np.frombuffer(b"".join(shard.keys.places), np.uint8),
        np.diff(shard.keys.begins).astype(np.int64),
        shard.keys.digests(),
        np.array(sorted({row for row, *_ in shard.learned}), np.int64),
        shard.state[list(KEPT)],
    )
    write_archive(path_of(folder, number, shard.me), head, KINDS, arrays)


def happened(shard: Shard) -> set[str]:
    """Return the words of what the environment did."""
    steps = (shard.learner.steps.get(int(step)) for step in np.flatnonzero(shard.counts.used))
    return {str(label.about) for label in steps if label is not None and label.agent is None}


class Loading:
    """A worker on its way back to a checkpoint.

    Attributes:
        shard: The worker's rows: none until it has finished.
        head: Plain data of the checkpoint.
        rows: Its rows, in the codes that they had.
        packing: Where their columns stand.
        learned: The rows at which something was learned that is to be learned again.
        numbers: For each column of the checkpoint the number of that column now, if it is known.
        codes: For each value of it the code that it has now, if it is known.
    """

    def __init__(self, shard: Shard, folder: Path, number: int, digest: str) -> None:
        path = path_of(folder, number, shard.me)
        self.shard = shard
        self.path = path
        self.head, self.arrays = read_archive(path, SCHEMA, KINDS)
        if self.head.get("digest") != digest or self.head.get("worker") != [shard.me, shard.workers]:
            raise CheckpointError(f"{path}: {ANOTHER}")
        try:
            self._begin()
        except (ValueError, IndexError, KeyError, TypeError) as error:
            raise CheckpointError(f"{path}: this checkpoint is damaged: {error}") from error

    def _begin(self) -> None:
        arrays = self.arrays
        self.packing = Packing(self.head["words"], arrays["packing"])
        self.rows = arrays["rows"]
        self.learned = arrays["learned"].tolist()
        self.places = [each.tobytes() for each in arrays["places"].reshape(-1, DIGEST)]
        self.digests = [each.tobytes() for each in arrays["digests"].reshape(-1, DIGEST)]
        self.begins = np.concatenate(([0], np.cumsum(arrays["sizes"]))).astype(np.int64)
        self.numbers = np.full(len(self.places), UNKNOWN, np.int64)
        self.codes = np.full(len(self.digests), UNKNOWN, np.int64)
        self.codes[self.begins[:-1]] = 0  # with which every worker begins a column
        self.used = np.zeros(len(self.digests), np.bool_)
        if not self._is_sound():
            raise ValueError("its parts don't fit together")
        self.shard.clear()
        self._resolve()

    def _is_sound(self) -> bool:
        """Tell whether rows, columns and values belong together, and mark the values that rows have."""
        where, sizes, count = self.packing, self.arrays["sizes"], len(self.arrays["origins"])
        fits = where.is_sound and len(where.mask) == len(sizes) == len(self.places)
        fits = fits and bool(np.all((sizes > 0) & (sizes <= len(self.digests))))
        fits = fits and int(self.begins[-1]) == len(self.digests)
        fits = fits and len(self.rows) == count * where.words
        fits = fits and all(0 <= row < count for row in self.learned)
        if not fits or not self._has_come_so_far(count):
            return False
        return loops.mark_used(self.rows, where.words, where.columns, self.begins, self.used)

    def _has_come_so_far(self, count: int) -> bool:
        """Tell whether state, layers and what was counted are those of some search."""
        expanded, size, cut, crowded, limit = map(int, self.arrays["state"])
        layers, rules, happened = (self.head[key] for key in ("layers", "rules", "happened"))
        if not (isinstance(layers, list) and isinstance(rules, dict) and isinstance(happened, list)):
            return False
        return (
            all(type(each) is int for each in (*layers, *rules.values()))
            and len(layers) > 1
            and layers == sorted(layers)
            and 0 == layers[0] <= layers[-2] <= expanded <= layers[-1] <= size == count <= limit <= MOST_ROWS
            and 0 <= crowded <= expanded
            and cut >= 0
            and min(rules.values(), default=0) >= 0
            and all(isinstance(word, str) for word in happened)
        )

    def missing(self) -> int:
        """Return how many values of the rows are not known yet."""
        self._resolve()
        return int(np.count_nonzero(self.used & (self.codes == UNKNOWN)))

    def _resolve(self) -> None:
        """Find the codes of what has become known."""
        keys = self.shard.keys
        numbers = {place: number for number, place in enumerate(keys.places)}
        for column, place in enumerate(self.places):
            begin, end = self.begins[column : column + 2]
            number = numbers.get(place)
            if number is None:
                continue
            self.numbers[column] = number
            if (self.codes[begin:end] == UNKNOWN).any():
                known = keys.codes(number)
                self.codes[begin:end] = [known.get(each, UNKNOWN) for each in self.digests[begin:end]]

    def recall(self) -> None:
        """Learn again what can be learned by now, for others too; nothing where all values are known."""
        count = len(self.learned) + 1
        while len(self.learned) < count and (self.codes == UNKNOWN).any():
            count = len(self.learned)
            self.learned = [row for row in self.learned if not self._relearn(row)]
            self._resolve()

    def _relearn(self, row: int) -> bool:
        """Let the rules run on a row once more, if its values are known."""
        shard, where = self.shard, self.packing
        words = self.rows[row * where.words : (row + 1) * where.words]
        old = ((words[where.word] >> where.shift) & where.mask).astype(np.int64)
        codes = self.codes[self.begins[:-1] + old]
        if np.any(codes == UNKNOWN):
            return False
        own = np.zeros(len(shard.learner.columns), np.int64)
        known = self.numbers != UNKNOWN
        own[self.numbers[known]] = codes[known]
        try:
            shard.learn_at(own.tolist())
        except Exception as error:  # rules may do anything where a row is no configuration
            raise CheckpointError(f"{self.path}: this checkpoint is damaged: {error}") from error
        return True

    def finish(self) -> None:
        """Take in the rows, now that all their values are known."""
        shard, size = self.shard, len(self.arrays["origins"])
        read = spelling(
            self.packing, np.where(self.codes == UNKNOWN, 0, self.codes), self.begins, self.numbers
        )
        shard.rows.reserve(size)
        width, hashes = shard.packing.words, np.zeros(BLOCK, np.uint64)
        for first in range(0, size, BLOCK):
            count = min(BLOCK, size - first)
            kernel.translate(
                self.rows,
                first,
                count,
                self.packing.words,
                read,
                shard.packing.columns,
                width,
                shard.rows.words[first * width : (first + count) * width],
                hashes,
            )
        shard.rows.origins.restore(self.arrays["origins"], size)
        shard.state[list(KEPT)] = self.arrays["state"]
        *shard.begins, shard.end = self.head["layers"]
        shard.rules_before = Counter(self.head["rules"])
        shard.happened_before = frozenset(self.head["happened"])
        shard.learned = [(int(row), 0, UNKNOWN, 0) for row in self.arrays["learned"]]
        shard.counts.used[:] = 0
        shard.look_around()
