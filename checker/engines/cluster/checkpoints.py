"""Checkpoints of a worker, and resuming from them.

A checkpoint stores rows, and a digest of each value of each column. It stores no values, so nothing in it is ever
evaluated. A restarted worker learns the values again from the rows at which it learned them first. The workers exchange
them once more, until all know all values of their rows.
"""

from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from checker.engines.archive import Kinds, read_archive, write_archive
from checker.engines.cluster import kernel
from checker.engines.cluster.row_keys import DIGEST
from checker.engines.cluster.shard import Shard, spelling
from checker.engines.contract import CheckpointError
from checker.engines.fast.model.columns import Packing
from checker.engines.fast.model.learned_model import CROWDS, CUT, EXPANDED, LIMIT, SIZE
from checker.engines.fast.search.checkpoint import is_time
from checker.engines.fast.store import repacking
from checker.engines.fast.store.origins import Elsewhere
from checker.engines.fast.store.row_store import MOST_ROWS
from checker.engines.fast.store.rows import Rows

SCHEMA = "bigactors.shard/3"
UNKNOWN = -1
KEPT = (EXPANDED, SIZE, CUT, CROWDS, LIMIT)
"""The entries of the loops' state in a checkpoint."""

KINDS: Final[Kinds] = {
    "rows": np.uint64,
    "pieces": np.uint64,
    "nodes": np.uint64,
    "origins": np.uint64,
    "packing": np.uint64,
    "places": np.uint8,
    "sizes": np.int64,
    "digests": np.uint8,
    "learned": np.int64,
    "movers": np.uint32,
    "leads": np.int64,
    "state": np.int64,
}

LATEST = "latest.checkpoint"
ANOTHER = "this checkpoint is of another mission, variation, limit, version or number of workers"


def path_of(folder: Path, number: int, worker: int) -> Path:
    """Return the path of a worker's checkpoint."""
    return folder / f"shard-{number}-{worker}.checkpoint"


@dataclass(frozen=True, slots=True)
class Latest:
    """The last checkpoint that all workers have written.

    Attributes:
        number: Its number.
        layer: The layer in expansion.
        seconds: The time of the exploration so far.
    """

    number: int
    layer: int
    seconds: float

    @property
    def is_sound(self) -> bool:
        """Whether the numbers may be those of a checkpoint."""
        return all(type(each) is int and each >= 0 for each in (self.number, self.layer)) and is_time(
            self.seconds
        )


def write_latest(folder: Path, latest: Latest, digest: str, workers: int) -> None:
    """Note the checkpoint from which to resume."""
    head = {"schema": SCHEMA, "digest": digest, "workers": workers, **asdict(latest)}
    write_archive(folder / LATEST, head, {}, ())


def read_latest(folder: Path, digest: str, workers: int) -> Latest | None:
    """Return the checkpoint from which to resume, None if there is none.

    Raises:
        CheckpointError: It is damaged, or of another exploration.
    """
    path = folder / LATEST
    if not path.exists():
        return None
    head, _ = read_archive(path, SCHEMA, {})
    if (head.get("digest"), head.get("workers")) != (digest, workers):
        raise CheckpointError(f"{path}: {ANOTHER}")
    latest = Latest(head.get("number", -1), head.get("layer", -1), head.get("seconds", -1))
    if not latest.is_sound:
        raise CheckpointError(f"{path}: this checkpoint is damaged: its counters are not valid")
    return latest


def save(shard: Shard, folder: Path, number: int, digest: str) -> None:
    """Write a worker's checkpoint."""
    store = shard.store
    head = {
        "schema": SCHEMA,
        "digest": digest,
        "worker": [shard.me, shard.workers],
        "words": store.packing.words,
        "layers": [*shard.begins, shard.end],
        "rules": dict(shard.rules()),
        "allowed": shard.allowed,
        "happened": sorted(shard.happened_before | happened(shard)),
    }
    arrays = (
        store.rows.words[: store.size * store.rows.kept],
        *store.rows.interned,
        store.rows.origins.kept(store.size),
        store.packing.columns,
        np.frombuffer(b"".join(shard.keys.places), np.uint8),
        np.diff(shard.keys.begins).astype(np.int64),
        shard.keys.digests(),
        np.array(sorted(shard.learned), np.int64),
        *_paths(shard),
        store.state[list(KEPT)],
    )
    write_archive(path_of(folder, number, shard.me), head, KINDS, arrays)


def _paths(shard: Shard) -> tuple[NDArray[Any], ...]:
    """Return the movers and the leads of the rows; empty without partial-order reduction."""
    if shard.choosing is None:
        return np.zeros(0), np.zeros(0)
    return shard.choosing.paths.movers.room[: shard.size], shard.paths.leads.room[: shard.size]


def happened(shard: Shard) -> set[str]:
    """Return the names of the environment's events that occurred."""
    taken = np.flatnonzero(shard.expander.met.used)
    steps = (shard.model.learner.steps.get(int(step)) for step in taken)
    return {str(label.about) for label in steps if label is not None and label.agent is None}


class Loading:
    """A worker while it returns to a checkpoint.

    Attributes:
        shard: The worker's shard, without rows until the end.
        head: The checkpoint's plain data.
        rows: Its rows, in the codes of that time.
        packing: The packing of that time.
        learned: The rows from which something must still be learned again.
        numbers: The present number of each column of the checkpoint, if known.
        codes: The present code of each of its values, if known.
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
        if not self.packing.is_sound:
            raise ValueError("its rows lack some of its columns")
        kept = (arrays[each] for each in ("rows", "origins", "pieces", "nodes"))
        self.rows = Rows.of(Elsewhere, self.packing.words, len(arrays["origins"]), *kept)
        self.learned = arrays["learned"].tolist()
        self.places = [each.tobytes() for each in arrays["places"].reshape(-1, DIGEST)]
        self.digests = [each.tobytes() for each in arrays["digests"].reshape(-1, DIGEST)]
        self.begins = np.concatenate(([0], np.cumsum(arrays["sizes"]))).astype(np.int64)
        self.numbers = np.full(len(self.places), UNKNOWN, np.int64)
        self.codes = np.full(len(self.digests), UNKNOWN, np.int64)
        self.codes[self.begins[:-1]] = 0  # every worker's first value of a column
        self.used = np.zeros(len(self.digests), np.bool_)
        if not self._is_sound():
            raise ValueError("its parts don't fit together")
        self.shard.clear()
        self._resolve()

    def _is_sound(self) -> bool:
        """Return whether rows, columns and values fit together, and mark the values that occur in rows."""
        where, sizes, count = self.packing, self.arrays["sizes"], len(self.arrays["origins"])
        fits = len(where.mask) == len(sizes) == len(self.places)
        fits = fits and bool(np.all((sizes > 0) & (sizes <= len(self.digests))))
        fits = fits and int(self.begins[-1]) == len(self.digests)
        fits = fits and all(0 <= row < count for row in self.learned)
        if self.shard.choosing is not None:
            movers, leads = self.arrays["movers"], self.arrays["leads"]
            fits = fits and len(movers) == len(leads) == count and bool(np.all(leads >= 0))
            fits = fits and not np.any(movers > len(self.shard.choosing.everyone))
        if not fits or not self._has_come_so_far(count):
            return False
        known = (where.words, where.columns, self.begins, self.used)
        return all(repacking.mark_used(words, *known) for _, words in self.rows.blocks(count))

    def _has_come_so_far(self, count: int) -> bool:
        """Return whether state, layers and counts are possible in a search."""
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
            and type(self.head["allowed"]) is int
            and self.head["allowed"] >= sum(rules.values())
        )

    def missing(self) -> int:
        """Return the number of values in rows that are not known yet."""
        self._resolve()
        return int(np.count_nonzero(self.used & (self.codes == UNKNOWN)))

    def _resolve(self) -> None:
        """Find the codes of values that have become known."""
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
        """Learn again from all rows whose values are known; do nothing if all values are known."""
        count = len(self.learned) + 1
        while len(self.learned) < count and (self.codes == UNKNOWN).any():
            count = len(self.learned)
            self.learned = [row for row in self.learned if not self._relearn(row)]
            self._resolve()

    def _relearn(self, row: int) -> bool:
        """Run the rules on a row again if its values are known; return whether they are."""
        shard, where = self.shard, self.packing
        words = self.rows.row(row)
        old = ((words[where.word] >> where.shift) & where.mask).astype(np.int64)
        codes = self.codes[self.begins[:-1] + old]
        if np.any(codes == UNKNOWN):
            return False
        own = np.zeros(len(shard.model.learner.columns), np.int64)
        known = self.numbers != UNKNOWN
        own[self.numbers[known]] = codes[known]
        try:
            shard.learn_at(own.tolist())
        except Exception as error:  # on a row that is no configuration, rules may fail in any way
            raise CheckpointError(f"{self.path}: this checkpoint is damaged: {error}") from error
        return True

    def finish(self) -> None:
        """Load the rows; all their values must be known."""
        shard, store, size = self.shard, self.shard.store, len(self.arrays["origins"])
        read = spelling(
            self.packing, np.where(self.codes == UNKNOWN, 0, self.codes), self.begins, self.numbers
        )
        unknown = self.numbers[read.varying.astype(np.int64)] == UNKNOWN  # all rows have their first values
        read = read._replace(varying=read.varying[~unknown])
        shard.look_around()
        for _, words in self.rows.blocks(size):
            batch, count = shard.expander.batch, len(words) // self.packing.words
            where = (store.packing.columns, store.packing.words)
            kernel.translate(words, 0, count, self.packing.words, read, *where, batch.kept, batch.hashes)
            store.add(batch, (0, count), shard.model.making)
            if store.compress():
                shard.model.see()
        if store.size != size:
            raise CheckpointError(f"{self.path}: this checkpoint is damaged: some of its rows are equal")
        store.rows.origins.restore(self.arrays["origins"], size)
        store.state[list(KEPT)] = self.arrays["state"]
        *shard.begins, shard.end = self.head["layers"]
        shard.rules_before = Counter(self.head["rules"])
        shard.happened_before = frozenset(self.head["happened"])
        shard.learned = set(self.arrays["learned"].tolist())
        shard.allowed_before = self.head["allowed"]
        shard.expander.counts.used[:] = shard.expander.met.used[:] = 0
        if shard.choosing is not None:
            shard.choosing.paths.reserve(store.rows.room)
            shard.choosing.paths.movers.room[:size] = self.arrays["movers"]
            shard.paths.leads.grow(store.rows.room)
            shard.paths.leads.room[:size] = self.arrays["leads"]
