"""The canonical encoding of values, the same in every process; digests are computed from it."""

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from hashlib import sha256
from itertools import compress
from operator import ne
from typing import Any

from semantics.state.cells import Cell, Row
from semantics.state.configuration import Configuration

SLICE = 64
"""How many values are compared at once."""


def canonical(value: Any) -> str:
    """Write a value so that equal values, and only those, are written alike in every process.

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
    """Return the SHA-256 of a value as it is written canonically."""
    return "sha256:" + sha256(canonical(value).encode("utf-8", "surrogatepass")).hexdigest()


def written(before: Configuration, after: Configuration) -> dict[Cell, Any]:
    """Return the cells that a step wrote, with their new values; both configurations are stored ones."""
    old, new = before.state, after.state
    assert isinstance(old, Row)
    assert isinstance(new, Row)
    cells, known = new.layout.cells, old.layout.cells
    if cells is not known and cells[: len(known)] != known:  # the new row has not grown from the old one
        return {cell: value for cell, value in new.items() if old.read(cell) != value}
    was = old.values + (None,) * (len(new.values) - len(old.values))
    return {cells[at]: new.values[at] for at in _differing(was, new.values)}


def _differing(old: tuple[Any, ...], new: tuple[Any, ...]) -> Iterator[int]:
    """Yield where two tuples differ, which is mostly nowhere: slices are compared before their members are."""
    for first in range(0, len(new), SLICE):
        one, other = old[first : first + SLICE], new[first : first + SLICE]
        if one != other:
            yield from (
                at for at, (was, value) in enumerate(zip(one, other, strict=True), first) if was != value
            )


def digest_of_step(before: Configuration, after: Configuration) -> str:
    """Return a digest of what a step wrote: of a line of requests, what has come in the place of what."""
    return digest(
        {cell: _changed(before.read(cell), value) for cell, value in written(before, after).items()}
    )


def _changed(old: Any, new: Any) -> Any:
    """Return what of a tuple has changed: how many parts before and behind it have not, and the others."""
    if not isinstance(old, tuple) or type(new) is not tuple:
        return new
    shorter = min(len(old), len(new))
    kept = _first_difference(old, new, shorter)
    behind = _first_difference(reversed(old), reversed(new), shorter - kept)
    return (kept, behind, new[kept : len(new) - behind])


def _first_difference(one: Iterable[Any], other: Iterable[Any], most: int) -> int:
    return next(compress(range(most), map(ne, one, other)), most)
