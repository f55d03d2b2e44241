"""The change of a check from the reference engine to the fast one, whose loops are compiled in the meantime.

Compilation takes seconds, once after an installation. Another process compiles the loops by a check of the same
mission, and the reference engine goes on: the engine that is ready first decides.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple, Self

from checker.limits import Uncounted
from checker.reduction.refusals import Reduction

if TYPE_CHECKING:
    from semantics.properties.property import Property
    from semantics.state.configuration import Configuration


class Compilation(NamedTuple):
    """The check whose loops are compiled, as the arguments of `check`."""

    initial: Configuration
    properties: tuple[Property, ...]
    reductions: tuple[Reduction, ...]
    threads: int | None
    times: bool
    ways: bool

    def is_done(self) -> bool:
        """Return whether the main loop of the check is in the cache of compiled loops."""
        from checker.engines.fast.compiled.numba_loading import load_numba  # noqa: PLC0415 - numba takes its time to load

        load_numba()
        try:
            from checker.engines.fast.compiled.loop_cache import is_compiled  # noqa: PLC0415 - the same

            return is_compiled(self._main_loop())
        except RuntimeError:  # there is no folder for a cache
            return True

    def _main_loop(self) -> object:
        if self.initial.setting.timing is not None:
            from checker.engines.zones.location_successors import leave  # noqa: PLC0415 - the same

            return leave
        if Reduction.POR in self.reductions:
            from checker.engines.fast.reduce.chosen_rows import store_chosen  # noqa: PLC0415 - the same

            return store_chosen
        from checker.engines.fast.store.kernel import gather  # noqa: PLC0415 - the same

        return gather

    def begin(self) -> subprocess.Popen[bytes]:
        """Compile in another process; raises an error of `pickle` or OSError if that is impossible."""
        job = pickle.dumps(self)
        process = subprocess.Popen(
            [sys.executable, "-m", f"{__package__}.compile_loops"],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        )
        assert process.stdin is not None
        with process.stdin:
            process.stdin.write(job)
        return process


class Handover:
    """The moment at which the fast engine takes over: after some seconds, as soon as its loops are compiled.

    Attributes:
        uncounted: The seconds since that moment, of waiting for the compilation, which count towards no limit.
    """

    def __init__(self, after: float, compilation: Compilation) -> None:
        self.began = monotonic()
        self.after = after
        self.compilation = compilation
        self.uncounted = Uncounted()
        self._process: subprocess.Popen[bytes] | None = None
        self._is_due = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    @property
    def is_waiting(self) -> bool:
        """Whether the loops are being compiled."""
        return self._process is not None

    def is_due(self) -> bool:
        """Return whether the fast engine takes over now; begin the compilation when its time has come."""
        if self._is_due or monotonic() < self.began + self.after:
            return self._is_due
        if self._process is None:
            self._is_due = not _has_cores() or self.compilation.is_done() or not self._begin()
        else:
            self._is_due = self._process.poll() is not None
        self.uncounted.seconds = monotonic() - self.began - self.after
        return self._is_due

    def _begin(self) -> bool:
        try:
            self._process = self.compilation.begin()
        except (
            OSError,
            pickle.PicklingError,
            AttributeError,
            TypeError,
        ):  # the last two for a local function
            return False
        return True


def _has_cores() -> bool:
    """Return whether there is a core for the other process."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return cores > 1
