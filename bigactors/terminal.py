"""Terminal output: safe in any encoding, quiet after a closed pipe, coloured, and wrapped between words."""

import codecs
import errno
import os
import re
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final, TextIO

from bigactors.asynchronous_printing import printing_aside, put
from bigactors.mistakes import Mistake

COLOUR: ContextVar[str] = ContextVar("COLOUR", default="auto")
"""The value of `--color`: auto, always or never."""

DRAWN: Final = re.compile(r"\s*\d* \| |.*[│├└─]")
"""A line that is aligned with another one, in an excerpt of a file or a drawing: it is never wrapped."""

COLOURS = {"red": "31", "green": "32", "yellow": "33", "faint": "2"}

_PLAIN = {
    "✓": "+", "✗": "x", "⟨": "<", "⟩": ">", "↦": "|->", "⇒": "=>", "→": "->", "∅": "{}", "⊕": "(+)", "′": "'",
    "α": "alpha", "β": "beta", "γ": "gamma", "η": "eta", "σ": "sigma", "∈": "in", "∪": "u", "·": ".", "…": "...",
    "─": "-", "−": "-", "×": "x", "₀": "0", "�": "?",
    "├": "|", "│": "|", "└": "`",
}  # fmt: skip
"""ASCII substitutes of the paper's notation, for output that cannot show it."""


def _plain(error: UnicodeError) -> tuple[str | bytes, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_PLAIN.get(sign, "?") for sign in error.object[error.start : error.end]), error.end


@contextmanager
def safe_output() -> Iterator[None]:
    """Replace characters that the encoding lacks, and flush the output at the end."""
    _open_closed()
    codecs.register_error("bigactors.plain", _plain)
    for stream in (sys.stdout, sys.stderr):
        if getattr(stream, "errors", "") in ("strict", "backslashreplace", "surrogateescape"):
            stream.reconfigure(errors="bigactors.plain")  # type: ignore[union-attr]  # only a TextIOWrapper has errors
    try:
        yield
    finally:
        write(sys.stdout, "", flush=True)
        write(sys.stderr, "", flush=True)


def _open_closed() -> None:
    """Open standard streams closed by the shell (`>&-`) on nothing: else a written file would get their descriptor."""
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest free descriptor is this one
    if sys.stdin is None:
        sys.stdin = os.fdopen(0, encoding="utf-8", closefd=False)
    if sys.stdout is None:
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
    if sys.stderr is None:
        sys.stderr = os.fdopen(2, "w", encoding="utf-8", closefd=False)


def say(line: str = "") -> None:
    """Print a line of the answer."""
    write(sys.stdout, f"{fitted(line, sys.stdout)}\n")


def say_text(text: str, *, flush: bool = False) -> None:
    """Print a text as it is."""
    write(sys.stdout, text, flush=flush)


def tell(text: str, mark: str = "") -> None:
    """Print a message on the standard error: a mistake, a warning, a written path; `mark` precedes it in red.

    A message may quote files, so terminal control characters are replaced.
    """
    write(sys.stdout, "", flush=True)
    shown = "".join(
        sign if sign.isprintable() or sign in "\n\t" else "\N{REPLACEMENT CHARACTER}" for sign in text
    )
    marked = f"{paint(mark, 'red', sys.stderr)} {shown}" if mark else shown
    write(sys.stderr, f"{fitted(marked, sys.stderr)}\n", flush=True)


def fitted(text: str, stream: TextIO) -> str:
    """Return a text, wrapped to the width of the stream if that is a terminal."""
    if not is_terminal(stream):
        return text
    import shutil  # noqa: PLC0415 - it loads compressors, and only terminals need it

    columns = shutil.get_terminal_size().columns
    return "\n".join(broken(line, columns) for line in text.split("\n"))


def broken(line: str, columns: int) -> str:
    """Return a line wrapped between words to a number of columns; continuation lines are indented further.

    >>> print(broken("  hint: say what --max-memory is to be", 20))
      hint: say what
        --max-memory is
        to be
    """
    if (line.isascii() and len(line) <= columns) or DRAWN.match(line):
        return line
    from wcwidth import wrap  # noqa: PLC0415 - most lines are short

    indent = len(line) - len(line.lstrip(" "))
    further = " " * min(indent + 2, columns // 2) if indent else ""
    return "\n".join(
        wrap(line, columns, subsequent_indent=further, break_long_words=False, break_on_hyphens=False)
    )


def paint(text: str, colour: str, stream: TextIO) -> str:
    """Return a text in a colour, if the stream shows colours."""
    return f"\033[{COLOURS[colour]}m{text}\033[0m" if shows_colours(stream) else text


def shows_colours(stream: TextIO) -> bool:
    """Return whether a stream has colours, by `--color`, else by NO_COLOR or FORCE_COLOR, else if it is a terminal."""
    if COLOUR.get() != "auto":
        return COLOUR.get() == "always"
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or (is_terminal(stream) and os.environ.get("TERM") != "dumb")


def is_terminal(stream: TextIO) -> bool:
    """Return whether a stream is a terminal."""
    return not stream.closed and stream.isatty()


def write(stream: TextIO, text: str, *, flush: bool = False) -> None:
    """Write a text, or discard it after a closed pipe; raises Mistake for any other error.

    During a flight, a thread writes it (`flying_output`).
    """
    if put(stream, text):
        return
    try:
        stream.write(text)
        if flush:
            stream.flush()
    except OSError as error:
        if not _discarded(stream, error):
            raise Mistake(f"cannot write the output: {error.strerror or error}") from error


@contextmanager
def flying_output() -> Iterator[None]:
    """Print in a thread: a stopped terminal does not stop the flight, and a failing one is reported."""

    def failed(stream: TextIO, error: OSError) -> None:
        if not _discarded(stream, error):
            tell(f"cannot write the output: {error.strerror or error}")

    with printing_aside(failed, _discard):
        yield


def _discarded(stream: TextIO, error: OSError) -> bool:
    """Discard all further output; return whether the cause is a reader that has gone."""
    gone = isinstance(error, BrokenPipeError) or _was_terminal(stream, error)
    _discard(stream)
    return gone


def _was_terminal(stream: TextIO, error: OSError) -> bool:
    """Return whether the error is a write to a closed terminal."""
    return error.errno == errno.EIO and stat.S_ISCHR(os.fstat(stream.fileno()).st_mode)


def _discard(stream: TextIO) -> None:
    """Discard further output: its reader has gone, but the verdict stays the same."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
