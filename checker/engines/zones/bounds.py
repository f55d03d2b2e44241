"""Difference bound matrices, as compiled loops: sets of ages of clocks, given by bounds of their differences.

`d[i, j]` bounds x_i - x_j from above, x_0 being always 0: so `d[i, 0]` is the most that clock i may show, and
`-d[0, i]` the least. Ages are whole, and all bounds closed. A matrix is canonical where no bound can be tightened
(Dill 1989); all functions here but `close` and `extrapolate` expect that, and keep it.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (what numba compiles is typed by numba: mypy takes its integers for Python's)

from typing import Final

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.loops import inner, njit

Matrix = NDArray[np.int32]

FREE: Final = np.int32(1 << 29)
"""Stands for no bound; two of them may be added."""

MOST: Final = 1 << 27
"""The largest constant that clocks may be compared with."""

NONE: Final = -1
"""Stands for the constant of a clock that is compared with none."""


@njit(cache=True)
def close(d: Matrix, size: int) -> bool:
    """Tighten all bounds; False where no ages are within them (Floyd and Warshall)."""
    for k in range(size):
        for i in range(size):
            over = d[i, k]
            if over < FREE and i != k:
                for j in range(size):
                    if d[k, j] < FREE:
                        d[i, j] = min(d[i, j], over + d[k, j])
    for i in range(size):  # noqa: SIM110 - numba compiles no generators
        if d[i, i] < 0:
            return False
    return True


@njit(cache=True)
def restrict(d: Matrix, size: int, i: int, j: int, bound: int) -> bool:
    """Take only ages with x_i - x_j <= bound; False where there are none."""
    if bound >= d[i, j]:
        return True
    if d[j, i] + bound < 0:
        return False
    for k in range(size):
        over = d[k, i]
        if over < FREE:
            for m in range(size):
                if d[j, m] < FREE:
                    d[k, m] = min(d[k, m], over + bound + d[j, m])
    return True


@njit(cache=True)
def let_pass(d: Matrix, size: int, clocks: Matrix, most: Matrix) -> None:
    """Let any time pass that takes no clock over its bound: none of them is past it before."""
    d[1:size, 0] = FREE
    end(d, size, clocks, most)


@inner(cache=True)
def end(d: Matrix, size: int, clocks: Matrix, most: Matrix) -> None:
    """Take only ages at which no clock is over its bound: there are some."""
    for i in range(1, size):
        for k in range(len(clocks)):
            if d[i, clocks[k]] < FREE:
                d[i, 0] = min(d[i, 0], d[i, clocks[k]] + most[k])
    for i in range(1, size):
        if d[i, 0] < FREE:
            for j in range(1, size):
                if i != j:
                    d[i, j] = min(d[i, j], d[i, 0] + d[0, j])


@njit(cache=True)
def extrapolate(d: Matrix, size: int, lower: Matrix, upper: Matrix) -> None:
    """Forget what no bound tells apart: those from below, and those from above, are at most so large, clock by clock.

    That is Extra+LU (Behrmann, Bouyer, Larsen, Pelanek 2006): what is added can do nothing that was not possible
    before. The matrix is canonical again afterwards.
    """
    changed = False
    for i in range(1, size):
        past = -d[0, i] > lower[i]
        for j in range(size):
            told = d[i, j] <= lower[i] and not past and (j == 0 or -d[0, j] <= upper[j])
            if i != j and d[i, j] < FREE and not told:
                d[i, j] = FREE
                changed = True
    for j in range(1, size):
        if -d[0, j] > upper[j] + 1:
            d[0, j] = -(upper[j] + 1)
            changed = True
    if changed:
        close(d, size)
