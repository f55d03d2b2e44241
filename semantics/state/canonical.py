"""The canonical encoding of values, the same in every process, and digests of it."""

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from hashlib import sha256
from itertools import compress
from operator import ne
from typing import Any

from semantics.state.cell_values import Cell, Row
from semantics.state.configuration import Configuration

SLICE = 64
"""The number of values compared at once."""


def canonical(value: Any) -> str:
    """Return the canonical text of a value: the same in every process for equal values, different for others.

    >>> canonical({("b",): frozenset({2, 1}), ("a",): None})
    "{('a',): None, ('b',): {1, 2}}"
    """
    match value:
        case dict():
            return f"{{{', '.join(sorted(f'{canonical(key)}: {canonical(item)}' for key, item in value.items()))}}}"
        case frozenset():
            return f"{{{', '.join(sorted(map(canonical, value)))}}}"
        case tuple():
            return f"({', '.join(map(canonical, value))}{',' if len(value) == 1 else ''})"
        case _ if is_dataclass(value) and not isinstance(value, type):
            parts = (f"{each.name}={canonical(getattr(value, each.name))}" for each in fields(value))
            return f"{type(value).__name__}({', '.join(parts)})"
        case _:
            return repr(value)


def digest(value: Any) -> str:
    """Return the SHA-256 of a value's canonical text."""
    return "sha256:" + sha256(canonical(value).encode("utf-8", "surrogatepass")).hexdigest()


def written(before: Configuration, after: Configuration) -> dict[Cell, Any]:
    """Return the cells that a step changed, with their new values; both states must be rows."""
    old, new = before.state, after.state
    assert isinstance(old, Row)
    assert isinstance(new, Row)
    cells, known = new.layout.cells, old.layout.cells
    if cells is not known and cells[: len(known)] != known:  # the layouts are unrelated
        return {cell: value for cell, value in new.items() if old.read(cell) != value}
    was = old.values + (None,) * (len(new.values) - len(old.values))
    return {cells[at]: new.values[at] for at in _differing(was, new.values)}


def _differing(old: tuple[Any, ...], new: tuple[Any, ...]) -> Iterator[int]:
    """Yield the positions at which two tuples differ; slices are compared first, since most of them are equal."""
    for first in range(0, len(new), SLICE):
        one, other = old[first : first + SLICE], new[first : first + SLICE]
        if one != other:
            yield from (
                at for at, (was, value) in enumerate(zip(one, other, strict=True), first) if was != value
            )


def digest_of_step(before: Configuration, after: Configuration) -> str:
    """Return a digest of a step's writes; of a line of requests only the changed part counts."""
    return digest(
        {cell: _changed(before.read(cell), value) for cell, value in written(before, after).items()}
    )


def _changed(old: Any, new: Any) -> Any:
    """Return the change of a tuple: the numbers of unchanged members before and behind it, and its new members."""
    if not isinstance(old, tuple) or type(new) is not tuple:
        return new
    shorter = min(len(old), len(new))
    kept = _first_difference(old, new, shorter)
    behind = _first_difference(reversed(old), reversed(new), shorter - kept)
    return (kept, behind, new[kept : len(new) - behind])


def _first_difference(one: Iterable[Any], other: Iterable[Any], most: int) -> int:
    return next(compress(range(most), map(ne, one, other)), most)
