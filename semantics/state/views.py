"""Views compare by their contents, as configurations do."""

from collections.abc import Mapping
from typing import Any, ClassVar

from semantics.state.cell_values import Cell, Row


class CellView:
    """A part of a configuration over its cells; two views are equal if all of their cells are.

    Within a recorded rule a comparison raises TypeError, since it would read all cells without recording them.

    Attributes:
        SORTS: The first words of its cells.
    """

    __slots__ = ()
    SORTS: ClassVar[frozenset[str]] = frozenset()

    def __eq__(self, other: object) -> bool:
        return self.contents() == other.contents() if isinstance(other, type(self)) else NotImplemented

    def __hash__(self) -> int:
        return hash(frozenset(self.contents().items()))

    def contents(self) -> Mapping[Cell, Any]:
        """Return the values of its cells, except None; raises TypeError within a rule."""
        cells: Any = getattr(self, "cells", None)
        state = getattr(cells, "state", cells)  # the cells of a configuration, or the row itself
        if not isinstance(state, Row):
            raise TypeError(f"{type(self).__name__} is compared within a rule: compare its values there")
        return {cell: value for cell, value in state.items() if cell[0] in self.SORTS and value is not None}
