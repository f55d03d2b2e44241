"""How the loops are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Loop = TypeVar("Loop", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Loop], Loop]:
    """Return numba's decorator that compiles a loop, which borrows the arrays that it is given: its caller holds them.

    It counts no references to them. Counting took two thirds of the time where arrays stand in named tuples, for each
    look into one counts. A loop that makes arrays itself says `_nrt=True`: numba refuses it otherwise. No C code calls
    loops, so there is no wrapper for it.
    """
    decorator: Any = numba.njit(**{"_nrt": False, "no_cfunc_wrapper": True} | options)
    return decorator  # type: ignore[no-any-return]  # what it makes is called as the loop is


def inner(**options: Any) -> Callable[[Loop], Loop]:
    """Return the decorator of a loop that only other loops call: a call from Python crashes.

    What Python calls has a wrapper that takes each argument apart; those of all inner loops took a fifth of the time
    in which loops are compiled. `tests/checker/engines/fast/test_loops.py` says who calls what.
    """
    return njit(no_cpython_wrapper=True, **options)
