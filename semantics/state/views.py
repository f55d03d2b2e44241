"""Views compare by what they say, as configurations do."""

from collections.abc import Mapping
from typing import Any, ClassVar

from semantics.state.cells import Cell, Row


class View:
    """A part of a configuration over its cells; two are equal if all of their cells say the same.

    A rule that is recorded reads cells one by one. There a comparison would read all of them unseen, so it raises.

    Attributes:
        SORTS: The cells that it is over, by their first words.
    """

    __slots__ = ()
    SORTS: ClassVar[frozenset[str]] = frozenset()

    def __eq__(self, other: object) -> bool:
        return self.contents() == other.contents() if isinstance(other, type(self)) else NotImplemented

    def __hash__(self) -> int:
        return hash(frozenset(self.contents().items()))

    def contents(self) -> Mapping[Cell, Any]:
        """Return the values of its cells but those of what is not there; raises TypeError within a rule."""
        cells: Any = getattr(self, "cells", None)
        state = getattr(cells, "state", cells)  # a configuration's, or the values themselves
        if not isinstance(state, Row):
            raise TypeError(f"{type(self).__name__} is compared within a rule: compare what it says there")
        return {cell: value for cell, value in state.items() if cell[0] in self.SORTS and value is not None}
