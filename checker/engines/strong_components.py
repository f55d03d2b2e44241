"""Strongly connected components of a graph in compressed sparse rows."""

from typing import Any, Final

import numpy as np

from checker.engines.fast.compiled.numba_loading import load_numba
from checker.engines.graph import Numbers
from checker.engines.tarjan import SearchRoom, divide

COMPILED_FROM: Final = 20_000
"""The number of edges from which the loop is compiled: loading the compiled loop takes as long as this many edges."""


def strong_components(starts: Numbers, targets: Numbers) -> tuple[int, Numbers]:
    """Return the number of components, and for each node its component.

    A component has a smaller number than those from which it is reached. `starts` has the start of the edges of each
    node in `targets`, and the end of the last.
    """
    size = len(starts) - 1
    if len(targets) < COMPILED_FROM:
        component = [-1] * size
        room = SearchRoom(*([0] * size for _ in range(5)))
        return divide(starts.tolist(), targets.tolist(), component, room), np.array(component, np.int32)
    load_numba()
    from checker.engines.compiled_components import divide_compiled  # noqa: PLC0415 - numba loads slowly

    found: Any = np.full(size, -1, np.int32)
    order, low, path, stack = (np.zeros(size, np.int32) for _ in range(4))
    arrays: tuple[Any, ...] = (order, low, path, stack, np.zeros(size, np.int64))
    wide: tuple[Any, Any] = (np.ascontiguousarray(starts, np.int64), np.ascontiguousarray(targets, np.int64))
    return int(divide_compiled(*wide, found, SearchRoom(*arrays))), found
