"""Pictures as files: what may be asked of them, and what is said where they cannot be written."""

from pathlib import Path

from bigactors.mistakes import Mistake, unreadable
from bigactors.pictures import draw_configuration, draw_trace
from checker import Trace
from semantics.configuration import Configuration

FORMATS = (".svg", ".png")


def draw(configuration: Configuration, path: str, title: str) -> None:
    """Draw a configuration into a file."""
    _check_format(path)
    try:
        draw_configuration(configuration, Path(path), title=title)
    except OSError as error:
        raise unreadable(path, error) from error


def draw_run(trace: Trace, path: str, title: str) -> None:
    """Draw a trace into a file."""
    _check_format(path)
    try:
        draw_trace(trace, Path(path), title=title)
    except OSError as error:
        raise unreadable(path, error) from error


def _check_format(path: str) -> None:
    if Path(path).suffix.lower() not in FORMATS:
        raise Mistake("a picture is an .svg or a .png file", "give such a name with --output", path)
