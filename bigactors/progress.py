"""How far an exploration has come, on one line of a terminal; and its end by Ctrl-C."""

import shutil
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TextIO

from bigactors.terminal import is_terminal, paint
from checker import Progress


class Watch:
    """What is told about an exploration now and then: shows a line, and ends it if the user has pressed Ctrl-C.

    Attributes:
        interrupted: Whether Ctrl-C was pressed.
    """

    def __init__(self, name: str, stream: TextIO) -> None:
        self.name = name
        self.stream = stream
        self.shown = 0
        self.interrupted = False

    def __call__(self, progress: Progress) -> None:
        """Show the progress.

        Raises:
            KeyboardInterrupt: The user has asked for the end; between two configurations, so that all counts hold.
        """
        if self.interrupted:
            raise KeyboardInterrupt
        if is_terminal(self.stream):
            self.rewrite(describe(self.name, progress))

    def rewrite(self, text: str) -> None:
        """Put a text in the place of the last."""
        width = shutil.get_terminal_size().columns - 1
        text = text[:width]
        self.stream.write("\r" + paint(text.ljust(min(self.shown, width)), "faint", self.stream))
        self.stream.flush()
        self.shown = len(text)

    def clear(self) -> None:
        """Take the line away."""
        if self.shown:
            self.stream.write("\r" + " " * self.shown + "\r")
            self.stream.flush()
            self.shown = 0

    def interrupt(self, signum: int, frame: FrameType | None) -> None:  # noqa: ARG002 - as signal handlers are called
        """Note a Ctrl-C; the next one ends the program at once."""
        self.interrupted = True
        signal.signal(signal.SIGINT, signal.default_int_handler)


def describe(name: str, progress: Progress) -> str:
    """Say in one line how far an exploration has come.

    >>> describe("m", Progress(configurations=12000, transitions=30000, depth=7, frontier=450, rate=5300.2))
    'm: 12,000 configurations, depth 7, frontier 450, 5,300/s'
    """
    return (
        f"{name}: {progress.configurations:,} configurations, depth {progress.depth}, "
        f"frontier {progress.frontier:,}, {progress.rate:,.0f}/s"
    )


@contextmanager
def watching(name: str) -> Iterator[Watch]:
    """Watch a check: progress on a terminal, quiet in a pipe; Ctrl-C makes the check incomplete."""
    watch = Watch(name, sys.stderr)
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, watch.interrupt) if main else None
    try:
        yield watch
    finally:
        watch.clear()
        if main:
            signal.signal(signal.SIGINT, before)
