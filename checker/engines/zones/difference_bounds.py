"""Difference bound matrices (DBMs) as compiled loops: zones given by bounds on differences of clocks.

`d[i, j]` is the upper bound of x_i - x_j, where x_0 is 0. So `d[i, 0]` is the greatest value of clock i, and `-d[0, i]`
the least. Clock values are integers, and all bounds are closed. In a canonical matrix no bound can be tightened (Dill
1989). All functions except `close` and `extrapolate` require a canonical matrix and keep it canonical.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import Final

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import njit

Matrix = NDArray[np.int32]

FREE: Final = np.int32(1 << 29)
"""The missing bound; the sum of two fits the type."""

MOST: Final = 1 << 27
"""The largest constant for clocks."""

NONE: Final = -1
"""The constant of a clock without comparisons."""


@njit(cache=True)
def close(d: Matrix, size: int) -> bool:
    """Tighten all bounds to the canonical matrix; False for an empty zone (Floyd and Warshall)."""
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
    """Intersect with x_i - x_j <= bound; False for an empty result."""
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
def end(d: Matrix, size: int, clocks: Matrix, most: Matrix) -> None:
    """Intersect with the deadlines; the result must not be empty."""
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
    """Extrapolate a zone by the largest lower and upper constants of its clocks.

    This is Extra+LU (Behrmann, Bouyer, Larsen, Pelanek 2006): values in the zone simulate the added ones, so
    reachability is the same. The resulting matrix is canonical.
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
