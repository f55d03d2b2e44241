"""Progress reports during numba's compilation, which happens once after an installation: its results are cached."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from time import monotonic

from numba.core.event import Event, Listener, register, unregister

from checker.engines.contract import Options, Progress, Reporter
from checker.limits import Uncounted

KIND = "numba:compile"


class _Compiling(Listener):
    """A counter of compiled functions and of compile time; the compilation of one function may nest in another's."""

    def __init__(self, report: Reporter | None, uncounted: Uncounted) -> None:
        self.report, self.uncounted = report, uncounted
        self.functions = self.depth = 0
        self.began = 0.0

    def on_start(self, event: Event) -> None:  # noqa: ARG002 - as numba calls it
        self.depth += 1
        if self.depth == 1:
            self.began = monotonic()
        self.functions += 1
        if self.report is not None:
            self.report(Progress(0, 0, 0, 0, 0.0, compiling=self.functions))

    def on_end(self, event: Event) -> None:  # noqa: ARG002 - as numba calls it
        """Report nothing at the end: the next progress report implies it."""
        self.depth -= 1
        if self.depth == 0:
            self.uncounted.seconds += monotonic() - self.began


@contextmanager
def compilation_uncounted(options: Options) -> Iterator[Options]:
    """Report each function that numba compiles, and exclude compile time from the limits of the returned options.

    Functions loaded from numba's cache are not reported.
    """
    uncounted = Uncounted()
    listener = _Compiling(options.report, uncounted)
    register(KIND, listener)  # type: ignore[no-untyped-call]  # numba ships no types
    try:
        yield replace(options, limits=replace(options.limits, uncounted=uncounted))
    finally:
        unregister(KIND, listener)  # type: ignore[no-untyped-call]
