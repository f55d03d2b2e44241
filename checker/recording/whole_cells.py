"""A rule's accesses to whole cells, recorded in one configuration."""

from collections.abc import Callable
from typing import Any

from checker.recording.access_recording import Asked, CellRecorder, CellSource, Conclusion
from checker.recording.value_templates import settled
from semantics.behaviours.observations import Fact
from semantics.state.cell_values import Cell, Changes, Row
from semantics.state.configuration import Configuration, Transition
from semantics.state.signature import Name


class _Whole(CellSource):
    """Cells with undivided values."""

    def __init__(self, row: Row) -> None:
        self.row = row

    def skeleton(self, cell: Cell) -> Any:
        return self.row.read(cell)

    def fact(self, cell: Cell, number: int, name: Name) -> Fact:
        raise NotImplementedError  # values are undivided


def recorded_cells(c: Configuration, varies: Callable[[Cell], bool]) -> tuple[Asked, Configuration]:
    """Return a record of questions about cells that vary, and a configuration that fills it."""
    assert isinstance(c.state, Row)
    recorder = CellRecorder(_Whole(c.state), c.state, varies, frozenset())
    return recorder.scopes[0].asked, Configuration(c.setting, recorder)


def writes_of(step: Transition) -> Changes:
    """Return the writes of a recorded step, fully evaluated."""
    state = step.target.state
    assert isinstance(state, Conclusion)
    return {cell: settled(state.read(cell)) for cell in sorted(state.changed(state))}
