"""Cells: a configuration maps cells to values; agents, structure and requests are views over it.

Rules see a configuration only through `read` and `test`, and answer with `Changes`. To record what a rule reads, pass
another `Cells` instead of a configuration: no code in `semantics/` can tell the difference.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from functools import reduce
from itertools import count
from operator import xor
from typing import Any, Protocol, TypeVar
from weakref import WeakValueDictionary

Part = TypeVar("Part")

Cell = tuple[str, ...]
"""The address of one value: what it is, then whose (`("parent", "uav0")`)."""

Changes = dict[Cell, Any]
"""What a rule writes."""

AGENTS: Cell = ("agents",)
NAMES: Cell = ("names",)
QUEUE: Cell = ("queue",)

MONITOR = "watch"
"""Cells whose first word begins so belong to the race monitor; configurations are counted without them."""

VOYAGE = "voyage"
"""Cells whose first word begins so remember where vehicles may be, where a mission says how long flights take.

They bound durations; the rules neither read nor write them.
"""


Question = Callable[..., Any]
"""What may be asked of a cell's value, and some constants; of None too, where there is no such cell (yet)."""

Edit = Callable[..., Any]
"""What makes another value of a cell's value and some constants."""


def is_(value: object, constant: object) -> bool:
    """Ask whether a cell's value is this one."""
    return value == constant


def is_something(value: object) -> bool:
    """Ask whether a cell has a value."""
    return value is not None


def has(value: tuple[object, ...], member: object) -> bool:
    """Ask whether something is among a cell's members."""
    return member in value


class Cells(Protocol):
    """What a rule may do with a configuration."""

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, None where it has none."""

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask one question of a cell: only the yes or no is learned."""

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask one question of a cell that has an answer other than yes or no: only that is learned."""

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of a cell's value, to be written back there: nothing is learned of the value."""

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return what a pointwise definition says of each name: no part depends on another."""


class State(Cells, Protocol):
    """Cells that a rule's conclusion may be written over."""

    def with_(self, changes: Mapping[Cell, Any]) -> "State":
        """Return the cells with these values."""

    def with_each(self, parts: Mapping[str, Changes]) -> "State":
        """Return the cells with what each part of a pointwise definition writes."""

    def changed(self, since: "State") -> Set[Cell]:
        """Return the cells that were written since, as far as these cells come from those."""


class Written:
    """Cells with some changes before them: what a conclusion, or a P' that is being built, is read from."""

    __slots__ = ("cells", "changes")

    def __init__(self, cells: Cells, changes: Changes) -> None:
        self.cells = cells
        self.changes = changes

    def read(self, cell: Cell) -> Any:
        """Return what was written, else what was there."""
        return self.changes[cell] if cell in self.changes else self.cells.read(cell)

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask what was written, else what was there."""
        if cell in self.changes:
            return bool(question(self.changes[cell], *constants))
        return self.cells.test(cell, question, *constants)

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask what was written, else what was there."""
        if cell in self.changes:
            return question(self.changes[cell], *constants)
        return self.cells.ask(cell, question, *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of what was written, else of what was there."""
        if cell in self.changes:
            return edit(self.changes[cell], *constants)
        return self.cells.edited(cell, edit, *constants)

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return what a pointwise definition says of each name."""
        return {name: part(name) for name in names}

    def with_(self, changes: Mapping[Cell, Any]) -> "Written":
        """Return the cells with more written over them."""
        return Written(self.cells, {**self.changes, **changes})

    def with_each(self, parts: Mapping[str, Changes]) -> "Written":
        """Return the cells with what each part writes."""
        return self.with_(merged(parts.values()))

    def changed(self, since: State) -> Set[Cell]:  # noqa: ARG002  # all that was written is known
        """Return the cells that were written."""
        return self.changes.keys()


class Layout:
    """A tuple of cells with its index; rows that share one compare by position."""

    __slots__ = ("__weakref__", "cells", "index")

    def __init__(self, cells: tuple[Cell, ...], index: dict[Cell, int] | None = None) -> None:
        self.cells = cells
        self.index = {cell: position for position, cell in enumerate(cells)} if index is None else index

    def growing(self, cells: Iterable[Cell]) -> "Layout":
        """Return a layout with more cells at its end, which no other row has."""
        more = tuple(cells)
        return Layout(self.cells + more, self.index | dict(zip(more, count(len(self.cells)), strict=False)))

    def __reduce__(self) -> tuple[Any, ...]:
        return (layout_of, (self.cells,))


_LAYOUTS: WeakValueDictionary[tuple[Cell, ...], Layout] = WeakValueDictionary()


def layout_of(cells: tuple[Cell, ...]) -> Layout:
    """Return the one layout of these cells in this order; it is kept as long as a row has it."""
    layout = _LAYOUTS.get(cells)
    return _LAYOUTS.setdefault(cells, Layout(cells)) if layout is None else layout


class Row:
    """An immutable map from cells to values with a hash that is kept up to date by what changes (Zobrist).

    Its cells are sorted unless it has grown: that costs no sorting, but rows that have grown compare by their contents.
    """

    __slots__ = ("_hash", "layout", "values")

    def __init__(self, layout: Layout, values: tuple[Any, ...], digest: int | None = None) -> None:
        self.layout = layout
        self.values = values
        self._hash = _digest(zip(layout.cells, values, strict=True)) if digest is None else digest

    @staticmethod
    def of(contents: Mapping[Cell, Any]) -> "Row":
        """Make a row of a mapping."""
        cells = tuple(sorted(contents))
        return Row(layout_of(cells), tuple(contents[cell] for cell in cells))

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell, None where it has none."""
        position = self.layout.index.get(cell)
        return None if position is None else self.values[position]

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Ask one question of a cell."""
        return bool(question(self.read(cell), *constants))

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Ask one question of a cell."""
        return question(self.read(cell), *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return what an edit makes of a cell's value."""
        return edit(self.read(cell), *constants)

    def each(self, names: Iterable[str], part: Callable[[str], Part]) -> Mapping[str, Part]:
        """Return what a pointwise definition says of each name."""
        return {name: part(name) for name in names}

    def items(self) -> Iterator[tuple[Cell, Any]]:
        """Yield cells with their values, in the order of the layout: sorted unless the row has grown."""
        return zip(self.layout.cells, self.values, strict=True)

    def with_(self, changes: Mapping[Cell, Any]) -> "Row":
        """Return the row with these values; the same object where nothing changes."""
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
        """Return the row with these values, new cells at its end: nothing is sorted, and no old value is hashed."""
        new = {cell: value for cell, value in changes.items() if cell not in self.layout.index}
        if not new:
            return self.with_(changes)
        row = self.with_({cell: value for cell, value in changes.items() if cell not in new})
        digest = hash(row) ^ _digest(new.items())
        return Row(row.layout.growing(new), (*row.values, *new.values()), digest)

    def with_each(self, parts: Mapping[str, Changes]) -> "Row":
        """Return the row with what each part writes."""
        return self.with_(merged(parts.values()))

    def changed(self, since: State) -> Set[Cell]:
        """Return the cells that have another value."""
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
    """Return several writes as one; the later win."""
    changes: Changes = {}
    for each in parts:
        changes |= each
    return changes


def _digest(items: Iterable[tuple[Cell, Any]]) -> int:
    """Return a hash of cells with their values that does not depend on their order."""
    return reduce(xor, map(hash, items), 0)
