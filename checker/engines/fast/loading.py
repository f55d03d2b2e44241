"""How numba is loaded: without scipy's linear algebra where nobody else compiles, since our loops use none."""

import sys
from contextvars import ContextVar
from typing import Final

ALONE: Final[ContextVar[bool]] = ContextVar("ALONE", default=False)
"""Whether only our loops are compiled in this process: that of the command line."""

BLAS: Final = "scipy.linalg.cython_blas"


def load_numba() -> None:
    """Load what numba needs to run loops.

    When it first runs one it looks for BLAS through all of `scipy.linalg`, which takes as long as a small check. It
    looks once: where it finds none, it compiles no `np.cov` and no `np.corrcoef` in this process. So BLAS is hidden
    from it, while it looks, in a process of ours only.
    """
    if not ALONE.get() or BLAS in sys.modules:
        return
    from numba.core.registry import cpu_target  # noqa: PLC0415 - numba takes its time to load

    sys.modules[BLAS] = None  # type: ignore[assignment]  # as Python marks what is not to be found
    try:
        cpu_target.typing_context.refresh()
        cpu_target.target_context.refresh()
    finally:
        del sys.modules[BLAS]
