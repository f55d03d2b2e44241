"""Checkpoints: the state from which an exploration continues after its process was killed.

A checkpoint stores rows, origins and counts, and with partial-order reduction the paths of its cycle proviso. It stores
no decision tree: the trees, and the tables of symmetry, are learned again from the same rows in the same order, so
nothing in a checkpoint is ever evaluated. A digest of all columns verifies the result.
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
from checker.engines.fast.model.columns import Packing
from checker.engines.fast.model.learned_model import CROWDS, CUT, EXPANDED, LIMIT, SIZE
from checker.engines.fast.search.row_search import RowSearch
from checker.engines.fast.search.rule_model import RuleModel
from checker.engines.fast.store.rows import Rows
from semantics.state.canonical import canonical

SCHEMA = "bigactors.checkpoint/6"
KEPT = (EXPANDED, SIZE, CUT, CROWDS)
"""The entries of the loops' state in a checkpoint; the others follow from the mission."""

PATHS = ("movers", "led", "leads", "sets", "followed", "ends")
"""The arrays of the cycle proviso's paths."""

RECOUNTED = 1 << 22
"""The number of rows for which a resumed exploration recomputes transitions: some seconds' work."""

ROWS: Final[Kinds] = {
    "rows": np.uint64,
    "pieces": np.uint64,
    "nodes": np.uint64,
    "origins": np.uint64,
    "packing": np.uint64,
    "learned": np.int64,
}
"""The arrays of the rows of a model and of its journal."""

KINDS: Final[Kinds] = {
    **ROWS,
    "counts": np.int64,
    "met": np.int64,
    "movers": np.uint32,
    "led": np.uint64,
    "leads": np.uint64,
    "sets": np.uint64,
    "followed": np.uint64,
    "ends": np.uint64,
    "state": np.int64,
}


@dataclass(frozen=True, slots=True)
class Journey:
    """The progress of an exploration.

    Attributes:
        depth: The distance of the layer that is being expanded.
        layer_end: The first row after that layer.
        seconds: The time taken so far.
        layers: The size of each layer, up to that one.
    """

    depth: int
    layer_end: int
    seconds: float
    layers: tuple[int, ...] = (1,)

    @property
    def is_sound(self) -> bool:
        """Whether the numbers are consistent."""
        sizes = (*self.layers, self.depth, self.layer_end)
        whole = all(type(each) is int and each >= 0 for each in sizes) and is_time(self.seconds)
        return whole and len(self.layers) == self.depth + 1 and sum(self.layers) == self.layer_end


def is_time(seconds: object) -> bool:
    """Return whether a value is a number of seconds."""
    return type(seconds) in {int, float} and 0 <= seconds < math.inf  # type: ignore[operator]  # a number


def save(search: RowSearch, journey: Journey, digest: str, path: Path) -> None:
    """Write a checkpoint; it replaces the previous one atomically.

    Raises:
        OSError: The file can't be written.
    """
    head = {
        "schema": SCHEMA,
        "digest": digest,
        "limit": int(search.store.state[LIMIT]),
        "words": search.store.packing.words,
        "depth": journey.depth,
        "layer_end": journey.layer_end,
        "seconds": journey.seconds,
        "layers": journey.layers,
        "columns": digest_of_columns(search.model),
    }
    expander = search.expander
    arrays = (
        *kept_rows(search.model),
        expander.counts.used,
        expander.met.used if search.choosing is not None else expander.met.used[:0],
        *_paths(search),
        search.store.state[list(KEPT)],
    )
    write_archive(path, head, KINDS, arrays)


def kept_rows(model: RuleModel) -> tuple[NDArray[Any], ...]:
    """Return the rows of a model and its journal as arrays (see `ROWS`)."""
    store, rows = model.store, model.store.rows
    return (
        rows.words[: store.size * rows.kept],
        *rows.interned,
        rows.origins.kept(store.size),
        store.packing.columns[: 3 * len(model.learner.columns)],
        np.array(model.learned, np.int64),
    )


def restore_rows(model: RuleModel, words: int, size: int, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Continue in a model from the rows of another one of the same mission.

    Raises:
        ValueError, IndexError: The arrays are not those of such a model.
    """
    learned = list(map(tuple, arrays["learned"].reshape(-1, 4).tolist()))
    where = Packing(words, arrays["packing"])
    if not where.is_sound:
        raise ValueError("its rows lack some of its columns")
    kept = (arrays[each] for each in ("rows", "origins", "pieces", "nodes"))
    model.restore(where, Rows.of(model.store.format.origins, where.words, size, *kept), size, learned)


def _paths(search: RowSearch) -> tuple[NDArray[Any], ...]:
    """Return the stored paths of partial-order reduction; empty without it."""
    if search.choosing is None:
        return (np.zeros(0, np.uint64),) * len(PATHS)
    return search.choosing.paths.kept(search.size, search.expanded)


def resume(search: RowSearch, digest: str, path: Path) -> Journey:
    """Continue in a new search from a checkpoint.

    Raises:
        CheckpointError: It is damaged, or of another mission, variation, limit or version.
    """
    head, arrays = read_archive(path, SCHEMA, KINDS)
    store, expander = search.store, search.expander
    if head.get("digest") != digest or head.get("limit") != int(store.state[LIMIT]):
        raise CheckpointError(f"{path}: this checkpoint is of another mission, variation, limit or version")
    try:
        journey = Journey(head["depth"], head["layer_end"], head["seconds"], tuple(head["layers"]))
        _check(arrays, journey, int(store.state[LIMIT]))
        expanded, size = map(int, arrays["state"][:2])
        restore_rows(search.model, head["words"], size, arrays)
        if store.origin(size - 1) > expanded:
            raise ValueError("some row was reached from a later one")
        choosing, counts, met = search.choosing, arrays["counts"], arrays["met"]
        if choosing is not None:
            paths = tuple(arrays[name] for name in PATHS)
            choosing.paths.restore(paths, size, expanded, len(choosing.everyone))
            _check_counts(search, met, arrays["state"])
            taken = np.bincount(choosing.paths.steps(), minlength=len(counts))
            if np.any(counts > met) or (choosing.paths.has_transitions and not np.array_equal(taken, counts)):
                raise ValueError("it followed other transitions than it counted")
        _check_counts(search, counts, arrays["state"])
        _recount(search, counts if choosing is None else met, arrays["state"])
        expander.met.used[: len(met)] = met
        expander.counts.used[: len(counts)] = counts
        store.state[list(KEPT)] = arrays["state"]
    except (ValueError, IndexError, KeyError, TypeError) as error:
        raise CheckpointError(f"{path}: this checkpoint is damaged: {error}") from error
    if digest_of_columns(search.model) != head["columns"]:
        raise CheckpointError(
            f"{path}: the rules learned from this checkpoint differ from those recorded in it"
        )
    return journey


def _check(arrays: dict[str, NDArray[Any]], journey: Journey, limit: int) -> None:
    """Raise ValueError unless state and layers satisfy the invariants of a search."""
    expanded, size, cut, crowded = map(int, arrays["state"])
    if not journey.is_sound:
        raise ValueError("its layers and rows do not fit together")
    begin = journey.layer_end - journey.layers[-1]
    if not begin <= expanded <= journey.layer_end <= size <= limit:
        raise ValueError("its last expanded row is outside its last layer")
    if cut < 0 or (cut and size != limit) or not 0 <= crowded <= expanded:
        raise ValueError("its counts of omitted steps are not possible")


def _check_counts(search: RowSearch, counts: NDArray[np.int64], state: NDArray[np.int64]) -> None:
    """Raise ValueError unless the counts are possible: a row takes each transition at most once."""
    expanded, size = int(state[0]), int(state[1])
    if (
        len(counts) != len(search.model.learner.leaves.rule)
        or np.any(counts < 0)
        or np.any(counts > expanded)
    ):
        raise ValueError("its counts of transitions are wrong")
    if int(counts.sum()) < size - 1:
        raise ValueError("it has more rows than transitions")


def _recount(search: RowSearch, counts: NDArray[np.int64], state: NDArray[np.int64]) -> None:
    """Recompute the transitions of expanded rows; raise ValueError if counts or rows differ.

    A transition may have been forgotten and learned again under another number, so transitions are compared by label.
    In a large search only the first and the last rows are recomputed; the counts must then be at least as large.
    """
    expanded, size, cut = map(int, state[:3])
    half = RECOUNTED // 2
    parts = (range(expanded),) if expanded <= RECOUNTED else (range(half), range(expanded - half, expanded))
    found, reached = Counter[int](), np.zeros(size, np.bool_)
    reached[0] = True
    for _, steps, targets in (each for part in parts for each in search.expander.edges(part)):
        taken = np.bincount(steps)
        found.update({int(step): int(taken[step]) for step in np.flatnonzero(taken)})
        if not cut and search.choosing is None and np.any(targets < 0):
            raise ValueError("it lacks successors of its rows")
        reached[targets[targets >= 0]] = True
    rest = expanded - sum(map(len, parts))
    told, again = _by_label(search, dict(enumerate(counts.tolist()))), _by_label(search, found)
    if told != again and not (rest and told >= again):
        raise ValueError("its counts of transitions are wrong")
    if not rest and not reached.all():
        raise ValueError("some row is no successor of an earlier row")


def _by_label(search: RowSearch, counts: Mapping[int, int]) -> Counter[tuple[int, str]]:
    """Return the number of times that transitions were taken, by rule and label."""
    learner = search.model.learner
    rules, steps = learner.leaves.rule.room, learner.steps
    found = Counter[tuple[int, str]]()
    for step, count in counts.items():
        if count:
            found[int(rules[step]), str(steps.get(step))] += count
    return found


def digest_of_columns(model: RuleModel) -> str:
    """Return a digest of the values of all columns, in order: of everything that rows are made of."""
    found = sha256()
    for line in _lines(model):
        found.update(line.encode("utf-8", "surrogatepass"))
    return found.hexdigest()


def _lines(model: RuleModel) -> Iterator[str]:
    for column in model.learner.columns.all:
        yield canonical((column.place, tuple(column.values)))
