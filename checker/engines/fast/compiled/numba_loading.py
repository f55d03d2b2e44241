"""Loading numba without scipy's linear algebra, unless other code compiles too: our loops use none."""

import sys
from contextvars import ContextVar
from typing import Final

ALONE: Final[ContextVar[bool]] = ContextVar("ALONE", default=False)
"""Whether only our loops are compiled in this process, as on the command line."""

BLAS: Final = "scipy.linalg.cython_blas"


def load_numba() -> None:
    """Load numba's support for running loops.

    At its first run, numba looks for BLAS by importing all of `scipy.linalg`, which takes as long as a small check. It
    looks only once; without BLAS, it can't compile `np.cov` and `np.corrcoef` in this process. So BLAS is hidden during
    the search, only in a process of our own.
    """
    if not ALONE.get() or BLAS in sys.modules:
        return
    from numba.core.registry import cpu_target  # noqa: PLC0415 - numba takes its time to load

    sys.modules[BLAS] = None  # type: ignore[assignment]  # Python's mark for a module that can't be imported
    try:
        cpu_target.typing_context.refresh()
        cpu_target.target_context.refresh()
    finally:
        del sys.modules[BLAS]
