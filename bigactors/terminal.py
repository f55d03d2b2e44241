"""Printing to the terminal: safe in any encoding, quiet after a closed pipe, coloured on a terminal only."""

import codecs
import errno
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from bigactors.mistakes import Mistake

COLOURS = {"red": "31", "green": "32", "yellow": "33", "faint": "2"}

_PLAIN = {
    "✓": "+", "✗": "x", "⟨": "<", "⟩": ">", "↦": "|->", "⇒": "=>", "→": "->", "∅": "{}", "⊕": "(+)", "′": "'",
    "α": "alpha", "β": "beta", "γ": "gamma", "η": "eta", "σ": "sigma", "∈": "in", "∪": "u", "·": ".", "…": "...",
    "─": "-", "−": "-", "×": "x", "₀": "0", "�": "?",
    "├": "|", "│": "|", "└": "`",
}  # fmt: skip
"""How the paper's notation is written where the output cannot show it."""


def _plain(error: UnicodeError) -> tuple[str | bytes, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_PLAIN.get(sign, "?") for sign in error.object[error.start : error.end]), error.end


@contextmanager
def safe_output() -> Iterator[None]:
    """Replace characters that the encoding lacks, and flush the output at the end."""
    codecs.register_error("bigactors.plain", _plain)
    for stream in (sys.stdout, sys.stderr):
        if getattr(stream, "errors", "") in ("strict", "backslashreplace", "surrogateescape"):
            stream.reconfigure(errors="bigactors.plain")  # type: ignore[union-attr]  # only a TextIOWrapper has errors
    try:
        yield
    finally:
        write(sys.stdout, "", flush=True)
        write(sys.stderr, "", flush=True)


def say(line: str = "") -> None:
    """Print a line of the answer."""
    write(sys.stdout, f"{line}\n")


def say_text(text: str, *, flush: bool = False) -> None:
    """Print a text as it is."""
    write(sys.stdout, text, flush=flush)


def tell(text: str, mark: str = "") -> None:
    """Print a side message: a mistake, a warning, the path of a written file; `mark` stands before it in red.

    It may quote files, so terminal control characters are removed.
    """
    write(sys.stdout, "", flush=True)
    shown = "".join(
        sign if sign.isprintable() or sign in "\n\t" else "\N{REPLACEMENT CHARACTER}" for sign in text
    )
    write(sys.stderr, f"{paint(mark, 'red', sys.stderr)} {shown}\n" if mark else f"{shown}\n", flush=True)


def paint(text: str, colour: str, stream: TextIO) -> str:
    """Return a text in a colour, if the stream shows colours."""
    return f"\033[{COLOURS[colour]}m{text}\033[0m" if shows_colours(stream) else text


def shows_colours(stream: TextIO) -> bool:
    """Tell whether a stream is a terminal whose user has not asked for no colours (no-color.org)."""
    return is_terminal(stream) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def is_terminal(stream: TextIO) -> bool:
    """Tell whether a stream is a terminal."""
    return not stream.closed and stream.isatty()


def write(stream: TextIO, text: str, *, flush: bool = False) -> None:
    """Write a text, and discard it after a closed pipe; raises Mistake for any other error."""
    try:
        stream.write(text)
        if flush:
            stream.flush()
    except OSError as error:
        gone = isinstance(error, BrokenPipeError) or _was_terminal(stream, error)
        _discard(stream)
        if gone:
            return
        raise Mistake(f"cannot write the output: {error.strerror or error}") from error


def _was_terminal(stream: TextIO, error: OSError) -> bool:
    """Tell whether a terminal was written to that has been closed."""
    return error.errno == errno.EIO and stat.S_ISCHR(os.fstat(stream.fileno()).st_mode)


def _discard(stream: TextIO) -> None:
    """Discard further output: the reader has gone, but the verdict stays the same."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
