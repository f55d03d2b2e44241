"""The progress of an exploration on one line of a terminal, and its end by Ctrl-C."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, TextIO

from bigactors.terminal import broken, is_terminal, paint, write
from checker.limits import Interruption
from physical.wordings import counted

if TYPE_CHECKING:
    from checker import Progress

COMPILING = "compiling loops, some seconds once after an installation"


class Watch:
    """The observer of an exploration: shows its progress on one line, and holds the wish to end it.

    Attributes:
        interruption: The wish to end, set by Ctrl-C or by the caller.
    """

    def __init__(self, name: str, stream: TextIO, interruption: Interruption | None = None) -> None:
        self.name = name
        self.stream = stream
        self.shown = 0
        self.is_told = False
        self.interruption = interruption or Interruption()

    @property
    def interrupted(self) -> bool:
        """Whether the exploration is to end."""
        return self.interruption.is_due()

    def __call__(self, progress: Progress) -> None:
        """Show the progress on a terminal; elsewhere, only report once that loops are being compiled."""
        if is_terminal(self.stream):
            self.rewrite(describe(self.name, progress))
        elif progress.compiling and not self.is_told:
            self.is_told = True
            write(self.stream, f"{self.name}: {COMPILING}\n", flush=True)

    def rewrite(self, text: str) -> None:
        """Replace the last text."""
        import shutil  # noqa: PLC0415 - it loads compressors, and only terminals need it

        width = shutil.get_terminal_size().columns - 1
        text = broken(text, width).split("\n")[0][:width]
        write(self.stream, "\r" + paint(text.ljust(min(self.shown, width)), "faint", self.stream), flush=True)
        self.shown = len(text)

    def clear(self) -> None:
        """Clear the line."""
        if self.shown:
            write(self.stream, "\r" + " " * self.shown + "\r", flush=True)
            self.shown = 0

    def interrupt(self, signum: int, frame: FrameType | None) -> None:  # noqa: ARG002 - the signature of signal handlers
        """Record a Ctrl-C; the next one ends the program at once."""
        self.interruption.wish()
        signal.signal(signal.SIGINT, signal.default_int_handler)


def describe(name: str, progress: Progress) -> str:
    """Return the progress of an exploration in one line.

    >>> from checker import Progress
    >>> describe("m", Progress(configurations=12000, transitions=30000, depth=7, frontier=450, rate=5300.2))
    'm: 12,000 configurations, depth 7, frontier 450, 5,300/s, no estimate while layers grow'
    >>> describe("m", Progress(0, 0, 0, 0, 0.0, compiling=7))
    'm: compiling loops, some seconds once after an installation: function 7'
    """
    if progress.compiling:
        return f"{name}: {COMPILING}: function {progress.compiling}"
    return (
        f"{name}: {counted(progress.configurations, 'configuration')}, depth {progress.depth}, "
        f"frontier {progress.frontier:,}, {progress.rate:,.0f}/s, "
        f"{describe_rest(progress)}"
    )


def describe_rest(progress: Progress) -> str:
    """Return the estimated rest of an exploration as a range, if there is an estimate.

    >>> from checker import Progress
    >>> from checker.engines.estimate import SizeEstimate
    >>> describe_rest(Progress(12_000, 30_000, 7, 450, 10.0, SizeEstimate(12_000, 13_150)))
    'up to 13,000 in all as layers fall now, 45 s to 3 min more'
    """
    if progress.estimate is None or progress.left is None:
        return "no estimate while layers grow"
    soonest, latest = map(rounded_time, progress.left)
    time = soonest if soonest == latest else f"{soonest} to {latest}"
    return f"up to {rounded(progress.estimate.most, progress.configurations):,} in all as layers fall now, {time} more"


def rounded(number: int, least: int) -> int:
    """Return a number rounded to two digits, but at least the known minimum.

    >>> rounded(1_234_567, 0), rounded(101_000, 100_900)
    (1200000, 100900)
    """
    unit = int(10 ** max(len(str(number)) - 2, 0))
    return max(round(number / unit) * unit, least)


def rounded_time(seconds: float) -> str:
    """Return a rounded duration with its unit.

    >>> [rounded_time(t) for t in (0.2, 45.0, 170.0, 20_000.0)]
    ['1 s', '45 s', '3 min', '6 h']
    """
    for unit, length, until in (("s", 1, 100), ("min", 60, 100), ("h", 3600, 72)):
        if seconds < until * length:
            return f"{max(1, round(seconds / length))} {unit}"
    return f"{round(seconds / 86_400):,} d"


@contextmanager
def watching(name: str, interruption: Interruption | None = None) -> Iterator[Watch]:
    """Watch a check: report progress on a terminal, or compilation elsewhere; Ctrl-C ends the check as incomplete."""
    watch = Watch(name, sys.stderr, interruption)
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, watch.interrupt) if main else None
    try:
        yield watch
    finally:
        watch.clear()
        if main:
            signal.signal(signal.SIGINT, before)
