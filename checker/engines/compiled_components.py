"""The compiled loop of strongly connected components."""

from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.tarjan import divide

try:
    divide_compiled = njit(cache=True)(divide)
except RuntimeError as error:
    if "locator" not in str(error):
        raise
    divide_compiled = njit()(divide)  # there is no folder in which numba may keep it: it compiles in a second
