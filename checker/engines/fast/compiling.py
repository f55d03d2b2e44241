"""What is told while numba compiles: once after an installation, since what is compiled is kept."""

from collections.abc import Iterator
from contextlib import contextmanager

from numba.core.event import Event, Listener, register, unregister

from checker.engines.contract import Progress, Reporter

KIND = "numba:compile"


class _Compiling(Listener):
    def __init__(self, report: Reporter) -> None:
        self.report = report
        self.functions = 0

    def on_start(self, event: Event) -> None:  # noqa: ARG002 - as numba calls it
        self.functions += 1
        self.report(Progress(0, 0, 0, 0, 0.0, compiling=self.functions))

    def on_end(self, event: Event) -> None:
        """Nothing is told of the end: the next progress says that it goes on."""


@contextmanager
def compilation_reported(report: Reporter | None) -> Iterator[None]:
    """Report each function that numba compiles; what it has kept is loaded, and not reported."""
    if report is None:
        yield
        return
    listener = _Compiling(report)
    register(KIND, listener)  # type: ignore[no-untyped-call]  # numba ships no types
    try:
        yield
    finally:
        unregister(KIND, listener)  # type: ignore[no-untyped-call]
