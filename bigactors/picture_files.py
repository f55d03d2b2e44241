"""Picture files: the allowed formats, and the errors of writing."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bigactors.files import write_text
from bigactors.mistakes import Mistake, unreadable
from bigactors.pages import Story, page_of, telling
from bigactors.pages.timeline_page import timeline_page
from bigactors.pictures import draw_configuration, draw_overview, draw_trace
from bigactors.pictures.hitting_times import Curve, draw_curves
from bigactors.pictures.region_marks import RegionMarks
from bigactors.pictures.timeline import draw_timeline
from checker import Trace
from checker.properties.schedule import Schedule
from checker.reports.lanes import lanes_of_trace
from physical.svg import PictureError
from semantics.state.configuration import Configuration

MOST_PICTURES = 100
"""The longest trace with a drawing of every configuration. Longer traces get only the overview."""


def draw(
    configuration: Configuration,
    path: str,
    title: str,
    before: Configuration | None = None,
    marks: RegionMarks | None = None,
) -> None:
    """Draw a configuration into a file, with the changes since the one before, and marks of regions."""
    with _mistakes(path):
        draw_configuration(configuration, title=title, changed=before, marks=marks).save(path)


def draw_run(
    trace: Trace, folder: Path, title: str, *, each_step: bool, marks: RegionMarks | None = None
) -> None:
    """Draw a trace into a folder: the overview `trace.svg`, and with `each_step` every configuration (0.2 s each)."""
    labels = [step.label for step in trace.steps]
    with _mistakes(str(folder)):
        if each_step and len(trace) <= MOST_PICTURES:
            draw_trace(
                trace.configurations,
                labels,
                folder,
                title=title,
                loop=trace.loop,
                moments=trace.moments,
                race=trace.race,
                marks=marks,
            )
        else:
            draw_overview(lanes_of_trace(trace), title=title).save(folder / "trace.svg")


def draw_lanes(trace: Trace, path: str, title: str, *, unfolded: bool = False) -> None:
    """Draw a trace into a file, with its steps in lanes."""
    with _mistakes(path):
        draw_overview(lanes_of_trace(trace), title=title, unfolded=unfolded).save(path)


def draw_schedule(schedule: Schedule, path: str, title: str) -> None:
    """Draw the timeline of all flights into a file."""
    with _mistakes(path):
        if Path(path).suffix.lower() in (".html", ".htm"):
            write_text(path, timeline_page(schedule, title))
        else:
            draw_timeline(schedule, title=title).save(path)


def draw_first_times(curves: Sequence[Curve], path: str, title: str, **words: Any) -> None:
    """Draw the first times at which predicates hold into a file; see `draw_curves`."""
    with _mistakes(path):
        draw_curves(curves, title=title, **words).save(path)


def write_page(story: Story, path: str) -> tuple[str, ...]:
    """Write a trace as a page that steps through it; return the parts that the page leaves out."""
    told = telling(story)
    write_text(path, page_of(told))
    return told.left_out


@contextmanager
def _mistakes(path: str) -> Iterator[None]:
    try:
        yield
    except PictureError as error:
        raise Mistake(str(error), place=path) from error
    except OSError as error:
        raise unreadable(path, error) from error
