"""Asynchronous printing: while vehicles fly, a thread writes to the terminal, so that the flight never waits for it.

A stopped terminal (Ctrl-S) or an unread pipe blocks its writer. So texts wait in a bounded queue. When the queue is
full, the oldest lines are dropped, and one line reports their number.
"""

from __future__ import annotations

import io
import logging
import os
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final, TextIO

MOST_WAITING: Final = 2_000
"""The most texts in the queue; each is a line or a few."""

PATIENCE: Final = 2.0
"""Seconds that the end of a run waits for the rest of the queue."""

Failed = Callable[[TextIO, OSError], None]
"""Takes a stream that can't be written to, and the error."""


class Printer:
    """A queue of texts, and the thread that writes them."""

    def __init__(self, failed: Failed) -> None:
        self._failed = failed
        self._waiting: deque[tuple[TextIO, str]] = deque()
        self._left_out = 0
        self._writing = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._write_all, name="printing", daemon=True)
        self._thread.start()

    def put(self, stream: TextIO, text: str) -> None:
        """Queue a text for the stream; never wait."""
        with self._changed:
            if len(self._waiting) >= MOST_WAITING:
                self._left_out += self._waiting.popleft()[1].count("\n")
            self._waiting.append((stream, text))
            self._changed.notify_all()

    def is_done(self, patience: float) -> bool:
        """Wait until the queue is empty or `patience` seconds have passed; return whether it is empty."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._waiting and not self._writing, patience)

    def _write_all(self) -> None:
        while True:
            stream, text = self._next()
            try:
                _write(stream, text)
            except OSError as error:
                self._failed(stream, error)
            with self._changed:
                self._writing = False
                self._changed.notify_all()

    def _next(self) -> tuple[TextIO, str]:
        with self._changed:
            self._changed.wait_for(lambda: bool(self._waiting))
            self._writing = True
            if not self._left_out:
                return self._waiting.popleft()
            from physical.wordings import counted  # noqa: PLC0415 - most commands leave out nothing

            count, self._left_out = self._left_out, 0
            return self._waiting[0][0], f"... {counted(count, 'line')} left out: the output was stopped\n"


def _write(stream: TextIO, text: str) -> None:
    """Write to the file descriptor: a thread blocked there holds no lock of the stream."""
    data = text.encode(stream.encoding or "utf-8", stream.errors or "strict")
    while data:
        data = data[os.write(stream.fileno(), data) :]


class _Records(logging.Handler):
    """Sends the log records of libraries to the queue."""

    def emit(self, record: logging.LogRecord) -> None:
        """Queue a record."""
        put(sys.stderr, f"{self.format(record)}\n")


_PRINTERS: Final[list[Printer]] = []


def put(stream: TextIO, text: str) -> bool:
    """Queue a text for the printer, if there is one and the stream is a file; return whether it was queued."""
    if not _PRINTERS or not _is_file(stream):
        return False
    if text:
        _PRINTERS[-1].put(stream, text)
    return True


def _is_file(stream: TextIO) -> bool:
    try:
        return stream.fileno() >= 0
    except (io.UnsupportedOperation, ValueError):
        return False


@contextmanager
def printing_aside(failed: Failed, give_up: Callable[[TextIO], None]) -> Iterator[None]:
    """Let a thread print all output of the body.

    Args:
        failed: Called in that thread with a stream that can't be written to.
        give_up: Called at the end for each stream if the thread is still blocked; it discards all later output.
    """
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    printer, records = Printer(failed), _Records(logging.WARNING)
    _PRINTERS.append(printer)
    logging.getLogger().addHandler(records)
    try:
        yield
    finally:
        logging.getLogger().removeHandler(records)
        _PRINTERS.remove(printer)
        if not printer.is_done(PATIENCE):
            for stream in (sys.stdout, sys.stderr):
                if _is_file(stream):
                    give_up(stream)
