"""How the loops are compiled."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Loop = TypeVar("Loop", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Loop], Loop]:
    """Return numba's decorator that compiles a loop, which borrows the arrays that it is given: its caller holds them.

    It counts no references to them. Counting took two thirds of the time where arrays stand in named tuples, for each
    look into one counts. A loop that makes arrays itself says `_nrt=True`: numba refuses it otherwise.
    """
    decorator: Any = numba.njit(**{"_nrt": False} | options)
    return decorator  # type: ignore[no-any-return]  # what it makes is called as the loop is
