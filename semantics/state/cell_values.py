"""Cells: a configuration maps cells to values; agents, structure and requests are views over it.

Rules access a configuration only through the methods of `Cells`, and return `Changes`. To record the reads of a rule,
pass another `Cells` instead of a configuration; no code in `semantics/` depends on the difference.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from functools import reduce
from itertools import count
from operator import xor
from typing import Any, Protocol, TypeVar
from weakref import WeakValueDictionary

Part = TypeVar("Part")

Cell = tuple[str, ...]
"""The address of one value: its sort, then its owner (`("parent", "uav0")`)."""

Changes = dict[Cell, Any]
"""The writes of a rule."""

AGENTS: Cell = ("agents",)
NAMES: Cell = ("names",)
QUEUE: Cell = ("queue",)

MONITOR = "watch"
"""The first word of the race monitor's cells; configurations are counted without them."""

VOYAGE = "voyage"
"""The first word of the cells that remember the possible positions of vehicles, in missions with a `timing` section.

They bound durations; the rules neither read nor write them.
"""


Question = Callable[..., Any]
"""A question about a cell's value, with constants; the value is None if there is no such cell (yet)."""

Edit = Callable[..., Any]
"""A function from a cell's value and some constants to a new value."""


def is_(value: object, constant: object) -> bool:
    """Whether a cell's value is this one."""
    return value == constant


def is_something(value: object) -> bool:
    """Whether a cell has a value."""
    return value is not None


def has(value: tuple[object, ...], member: object) -> bool:
    """Whether a cell's value has a member."""
    return member in value


class Cells(Protocol):
    """The access of a rule to a configuration."""

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, None where it has none."""

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the answer to a yes-or-no question about a cell; the caller learns nothing else of its value."""

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return the answer to any other question about a cell; the caller learns nothing else of its value."""

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return an edited value of a cell, to be written back there; the caller learns nothing of the value."""

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return the part of each name in a pointwise definition: no part depends on another."""


class WritableCells(Cells, Protocol):
    """Cells that a rule's conclusion can write."""

    def with_(self, changes: Mapping[Cell, Any]) -> "WritableCells":
        """Return the cells with these values."""

    def with_each(self, parts: Mapping[str, Changes]) -> "WritableCells":
        """Return the cells with the writes of each part of a pointwise definition."""

    def changed(self, since: "WritableCells") -> Set[Cell]:
        """Return the cells written since an earlier state, from which these cells must derive."""


class Written:
    """Cells with some changes over them: the reads of a conclusion, or of a P' under construction."""

    __slots__ = ("cells", "changes")

    def __init__(self, cells: Cells, changes: Changes) -> None:
        self.cells = cells
        self.changes = changes

    def read(self, cell: Cell) -> Any:
        """Return the written value, else the underlying one."""
        return self.changes[cell] if cell in self.changes else self.cells.read(cell)

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the answer for the written value, else for the underlying one."""
        if cell in self.changes:
            return bool(question(self.changes[cell], *constants))
        return self.cells.test(cell, question, *constants)

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return the answer for the written value, else for the underlying one."""
        if cell in self.changes:
            return question(self.changes[cell], *constants)
        return self.cells.ask(cell, question, *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return the edited value, from the written one, else from the underlying one."""
        if cell in self.changes:
            return edit(self.changes[cell], *constants)
        return self.cells.edited(cell, edit, *constants)

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return the part of each name in a pointwise definition."""
        return self.cells.each(names, part)

    def with_(self, changes: Mapping[Cell, Any]) -> "Written":
        """Return the cells with more changes over them."""
        return Written(self.cells, {**self.changes, **changes})

    def with_each(self, parts: Mapping[str, Changes]) -> "Written":
        """Return the cells with the writes of each part."""
        return self.with_(merged(parts.values()))

    def changed(self, since: WritableCells) -> Set[Cell]:  # noqa: ARG002  # all that was written is known
        """Return the cells that were written."""
        return self.changes.keys()


class RowLayout:
    """A tuple of cells with its index; rows that share one compare by position."""

    __slots__ = ("__weakref__", "cells", "index")

    def __init__(self, cells: tuple[Cell, ...], index: dict[Cell, int] | None = None) -> None:
        self.cells = cells
        self.index = {cell: position for position, cell in enumerate(cells)} if index is None else index

    def growing(self, cells: Iterable[Cell]) -> "RowLayout":
        """Return a layout with more cells at its end; no other row shares it."""
        more = tuple(cells)
        return RowLayout(
            self.cells + more, self.index | dict(zip(more, count(len(self.cells)), strict=False))
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return (layout_of, (self.cells,))


_LAYOUTS: WeakValueDictionary[tuple[Cell, ...], RowLayout] = WeakValueDictionary()


def layout_of(cells: tuple[Cell, ...]) -> RowLayout:
    """Return the shared layout of these cells in this order; it lives as long as a row uses it."""
    layout = _LAYOUTS.get(cells)
    return _LAYOUTS.setdefault(cells, RowLayout(cells)) if layout is None else layout


class Row:
    """An immutable map from cells to values, with an incrementally updated hash (Zobrist).

    Its cells are sorted unless it has grown. Growing avoids the sorting, but rows that have grown compare by their
    contents.
    """

    __slots__ = ("_hash", "layout", "values")

    def __init__(self, layout: RowLayout, values: tuple[Any, ...], digest: int | None = None) -> None:
        self.layout = layout
        self.values = values
        self._hash = _digest(zip(layout.cells, values, strict=True)) if digest is None else digest

    @staticmethod
    def of(contents: Mapping[Cell, Any]) -> "Row":
        """Return the row of a mapping."""
        cells = tuple(sorted(contents))
        return Row(layout_of(cells), tuple(contents[cell] for cell in cells))

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, None where it has none."""
        position = self.layout.index.get(cell)
        return None if position is None else self.values[position]

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the answer to a yes-or-no question about a cell."""
        return bool(question(self.read(cell), *constants))

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return the answer to a question about a cell."""
        return question(self.read(cell), *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return an edited value of a cell."""
        return edit(self.read(cell), *constants)

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return the part of each name in a pointwise definition."""
        return {name: part(name) for name in names}

    def items(self) -> Iterator[tuple[Cell, Any]]:
        """Yield cells with their values, in the order of the layout: sorted unless the row has grown."""
        return zip(self.layout.cells, self.values, strict=True)

    def with_(self, changes: Mapping[Cell, Any]) -> "Row":
        """Return the row with these values; the same object if nothing changes."""
        index = self.layout.index
        if any(cell not in index for cell in changes):
            return Row.of({**dict(self.items()), **changes})
        values = list(self.values)
        digest = self._hash
        changed = False
        for cell, value in changes.items():
            position = index[cell]
            old = values[position]
            if old is not value and old != value:
                digest ^= hash((cell, old)) ^ hash((cell, value))
                values[position] = value
                changed = True
        return Row(self.layout, tuple(values), digest) if changed else self

    def growing(self, changes: Mapping[Cell, Any]) -> "Row":
        """Return the row with these values and new cells at its end, without sorting or hashing old values."""
        new = {cell: value for cell, value in changes.items() if cell not in self.layout.index}
        if not new:
            return self.with_(changes)
        row = self.with_({cell: value for cell, value in changes.items() if cell not in new})
        digest = hash(row) ^ _digest(new.items())
        return Row(row.layout.growing(new), (*row.values, *new.values()), digest)

    def with_each(self, parts: Mapping[str, Changes]) -> "Row":
        """Return the row with the writes of each part."""
        return self.with_(merged(parts.values()))

    def changed(self, since: WritableCells) -> Set[Cell]:
        """Return the cells whose value differs."""
        return {cell for cell, value in self.items() if since.read(cell) != value}

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        return (
            isinstance(other, Row)
            and self._hash == other._hash
            and (
                self.values == other.values
                if self.layout is other.layout
                else dict(self.items()) == dict(other.items())
            )
        )

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[Any, ...]:
        return (Row, (self.layout, self.values))  # hashes of strings differ between processes


def merged(parts: Iterable[Changes]) -> Changes:
    """Return the union of several writes; later ones win."""
    changes: Changes = {}
    for each in parts:
        changes |= each
    return changes


def _digest(items: Iterable[tuple[Cell, Any]]) -> int:
    """Return a hash of cells and values that does not depend on their order."""
    return reduce(xor, map(hash, items), 0)
