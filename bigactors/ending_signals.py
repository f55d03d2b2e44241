"""Signals that end a process: all are answered like Ctrl-C until the exit code stands, and then ignored."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from bigactors.exits import Exit

ENDING: Final = tuple(
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name)
)


def as_process(command: Callable[[], int]) -> int:
    """Run a command whose exit code is that of this process, which must end, and return the code.

    From the return on, signals that end a process are ignored: Python would answer them with their default action
    while it ends, and the process would have another exit code than the one that its output explains.
    """
    code: int = Exit.INCOMPLETE
    try:
        with ending_as_ctrl_c(put_back=False):
            code = command()
            _ignore()
    except KeyboardInterrupt:  # after the command has caught another one, or while its output is flushed
        _ignore()
    return code


@contextmanager
def ending_as_ctrl_c(*, put_back: bool = True) -> Iterator[None]:
    """Treat ending signals like Ctrl-C; an ignored signal, as under `nohup`, stays ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard = [each for each in ENDING if signal.getsignal(each) is not signal.SIG_IGN]
    before = {each: signal.signal(each, _interrupt) for each in heard}
    try:
        yield
    finally:
        for each, handler in before.items() if put_back else ():
            signal.signal(each, handler)


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the signature of signal handlers
    handler = signal.getsignal(signal.SIGINT)
    if not callable(handler):  # Ctrl-C is ignored, as in a script's background job, but this signal is not
        raise KeyboardInterrupt
    handler(signal.SIGINT, frame)


def _ignore() -> None:
    if threading.current_thread() is threading.main_thread():
        for each in (*ENDING, signal.SIGINT):  # SIGINT last: the others are answered by its handler
            signal.signal(each, signal.SIG_IGN)
