"""Picture files: which formats are allowed, and the errors where they cannot be written."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bigactors.files import write_text
from bigactors.mistakes import Mistake, unreadable
from bigactors.pages import Story, trace_page
from bigactors.pictures import PictureError, draw_configuration, draw_overview, draw_trace
from checker import Trace
from semantics.state.configuration import Configuration

MOST_PICTURES = 100
"""The longest trace of which every configuration is drawn; of longer ones there is the overview."""


def draw(configuration: Configuration, path: str, title: str, before: Configuration | None = None) -> None:
    """Draw a configuration into a file, with what has changed since the one before."""
    with _mistakes(path):
        draw_configuration(configuration, path, title=title, changed=before)


def draw_run(trace: Trace, folder: Path, title: str, *, each_step: bool) -> None:
    """Draw a trace into a folder: the overview `trace.svg`, and if asked each configuration (0.2 s each)."""
    labels = [step.label for step in trace.steps]
    with _mistakes(str(folder)):
        if each_step and len(trace) <= MOST_PICTURES:
            draw_trace(trace.configurations, labels, folder, title=title, loop=trace.loop)
        else:
            draw_overview(trace.configurations, labels, folder / "trace.svg", title=title, loop=trace.loop)


def draw_lanes(trace: Trace, path: str, title: str) -> None:
    """Draw a trace into a file, its steps in lanes."""
    with _mistakes(path):
        draw_overview(
            trace.configurations, [step.label for step in trace.steps], path, title=title, loop=trace.loop
        )


def write_page(trace: Trace, path: str, title: str, start: int = 0) -> None:
    """Write a trace as a page that steps through it."""
    write_text(path, trace_page(Story(title, "", False, trace, start)))


@contextmanager
def _mistakes(path: str) -> Iterator[None]:
    try:
        yield
    except PictureError as error:
        raise Mistake(str(error), place=path) from error
    except OSError as error:
        raise unreadable(path, error) from error
