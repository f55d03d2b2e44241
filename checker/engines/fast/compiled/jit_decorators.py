"""Decorators that compile the loops."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import types

from checker.engines.fast.compiled.loop_cache import LoopCache

Loop = TypeVar("Loop", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Loop], Loop]:
    """Return numba's decorator for a loop that borrows its arrays: the caller holds them.

    The loop counts no references. Counting took two thirds of the time for arrays in named tuples, since each access
    counts. A loop that creates arrays needs `_nrt=True`; numba refuses it otherwise. There is no wrapper for C code,
    which never calls loops.
    """
    decorator: Any = numba.njit(**{"_nrt": False, "no_cfunc_wrapper": True} | options)

    def compiled(loop: Loop) -> Loop:
        found: Any = decorator(loop)
        compile_for = found.compile
        if options.get("cache"):
            found._cache = LoopCache(loop)  # noqa: SLF001 - numba has no other way to say when a cache is void
            compile_for = found._cache.compiling_alone()(compile_for)  # noqa: SLF001
        found.compile = for_wide_integers(compile_for)
        return found  # type: ignore[no-any-return]  # it has the loop's signature

    return compiled


def for_wide_integers(compile_for: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Compile a loop once for all integers: a constant and an element of an array arrive as 64 bits.

    numba alone compiles it anew for each: a third of the compile time.
    """
    return lambda signature: compile_for(tuple(map(widened, signature)))


def widened(argument: Any) -> Any:
    """Return the type of an argument, with signed integers of 64 bits."""
    found: Any = types.unliteral(argument)  # type: ignore[no-untyped-call]  # numba ships no types
    return types.int64 if found in types.signed_domain else found


def inner(**options: Any) -> Callable[[Loop], Loop]:
    """Return the decorator of a loop that only other loops call: a call from Python crashes.

    A loop callable from Python has a wrapper that unpacks each argument. The wrappers of all inner loops took a fifth
    of the compile time. `tests/checker/engines/fast/test_jit_decorators.py` lists the callers of each.
    """
    return njit(no_cpython_wrapper=True, **options)
