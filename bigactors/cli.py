"""The command `bigactors`: parse the line, run the command, exit with its code; signals end it like Ctrl-C."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Final

from bigactors.arguments import parse_arguments
from bigactors.arguments.parser import command_of
from bigactors.exits import Exit
from bigactors.mistakes import Mistake, describe_bug
from bigactors.terminal import COLOUR, safe_output, tell

ENDING: Final = tuple(
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name)
)


@contextmanager
def ending_as_ctrl_c() -> Iterator[None]:
    """Treat ending signals like Ctrl-C; an ignored signal, as under `nohup`, stays ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard = [each for each in ENDING if signal.getsignal(each) is not signal.SIG_IGN]
    before = {each: signal.signal(each, _interrupt) for each in heard}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the signature of signal handlers
    handler = signal.getsignal(signal.SIGINT)
    if not callable(handler):  # Ctrl-C is ignored, as in a script's background job, but this signal is not
        raise KeyboardInterrupt
    handler(signal.SIGINT, frame)


OBJECTS_BETWEEN_COLLECTIONS: Final = 200_000
"""Python's default of 700 rescans the imported objects again and again: a tenth of the time of a small check."""


def main(line: Sequence[str] | None = None) -> int:
    """Run one command line (default: this process's) and return its exit code."""
    if "_ARGCOMPLETE" in os.environ:  # a shell asks for completions
        from bigactors.commands.completion import complete  # noqa: PLC0415 - it builds the parsers of all commands

        complete()
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    try:
        with safe_output(), ending_as_ctrl_c():
            return run(sys.argv[1:] if line is None else line)
    except Mistake:  # the output itself cannot be written
        return Exit.MISTAKE
    finally:
        if line is None:
            gc.freeze()  # the process ends: a last scan of all objects takes a quarter of a small check


def run(line: Sequence[str]) -> int:
    """Run one command line and report its errors."""
    return reported(lambda: _run(line))


def _run(line: Sequence[str]) -> int:
    options = parse_arguments(line)
    COLOUR.set(options.color)
    return int(command_of(options.command).run(options))


def reported(command: Callable[[], int]) -> int:
    """Run a command, report its errors, and return the exit code."""
    try:
        return command()
    except SystemExit as end:  # after --help and --version
        return int(end.code or 0)
    except Mistake as mistake:
        tell(str(mistake), "" if mistake.place else "bigactors:")
        return Exit.MISTAKE
    except KeyboardInterrupt:
        tell("bigactors: interrupted, nothing is decided")
        return Exit.INCOMPLETE
    except Exception as error:  # any other exception is our bug
        tell(describe_bug(error))
        return Exit.BUG
