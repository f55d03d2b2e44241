"""Draw a trace: a picture of each configuration, and an overview with a lane for each agent; time goes down.

The overview of a dated run has a time axis. Steps at one moment follow without a gap; where time passes between two
steps there is a gap in proportion.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from typing import Final

from bigactors.pictures.configuration_picture import draw_configuration
from bigactors.pictures.page import Page, wrapped
from bigactors.pictures.region_marks import RegionMarks
from checker.properties.race_steps import RaceSteps
from checker.reports.lanes import Lanes, LaneStep, Repetition, bounded, folded, lanes_of, lapses, steps_of
from physical.map_style import INK, QUIET
from physical.svg import Paint, Picture
from semantics.state.configuration import Configuration, Label
from semantics.timing.dates import lapse_text

MARGIN: Final = 26.0
NUMBERS: Final = 30.0
DATES: Final = 58.0
LANE: Final = 168.0
CHANGES: Final = 300.0
GUTTER: Final = 14.0
HEAD: Final = 30.0
LEAST_LAPSE, MOST_LAPSE = 13.0, 110.0
"""The height in points of the shortest and of the longest gap between steps in a trace."""

MOST_ROWS: Final = 2_000
"""The most rows of an overview."""

MOST_LINES: Final = 6
"""The most lines about the changes of one step."""

SERVED: Final = ("#e9f7ee", "#4fa672")
AROUND: Final = ("#fdf1e3", "#d08a3c")
AGENT: Final = ("#e8f1fd", "#4f86c6")
TIME: Final = "#4f86c6"
AGAIN: Final = ("#f4f6f8", "#9fadbb")
RACE: Final = "#b3261e"
"""The words *sensed*, *changed* and *acted*."""

LANE_LINE: Final = Paint(stroke="#d8dee4")


@dataclass(frozen=True, slots=True)
class OverviewRow:
    """One step of the overview, or several repeated steps.

    Attributes:
        number: The number of the configuration after it, or after the first of several.
        lane: The rank of its lane.
        colours: The fill and the border, for an agent's own step, a step that serves a request, a step of the
            environment, or several steps.
        rule: The rule, as the box's heading.
        words: The rest of its label, in lines.
        changes: The changes, in lines.
        date: Its date; empty if unknown.
        lapse: The time before it, in milliseconds.
        gap: The height of the gap for that time.
        role: Its role in a stale-observation race; mostly empty.
    """

    number: int
    lane: int
    colours: tuple[str, str]
    rule: str
    words: tuple[str, ...]
    changes: tuple[str, ...]
    date: str = ""
    lapse: int = 0
    gap: float = 0.0
    role: str = ""

    @property
    def box_height(self) -> float:
        """The height of its box."""
        return 19.0 + 10.0 * len(self.words)

    @property
    def height(self) -> float:
        """Its height on the page, with the gap before it."""
        return self.gap + max(self.box_height, 10.5 * len(self.changes) + 6.0) + 9.0


def draw_trace(  # noqa: PLR0913 - all but three are optional, and passed by name
    configurations: Sequence[Configuration],
    labels: Sequence[Label],
    directory: str | Path,
    *,
    title: str | None = None,
    loop: int | None = None,
    moments: Sequence[int] = (),
    race: RaceSteps | None = None,
    marks: RegionMarks | None = None,
) -> tuple[Path, ...]:
    """Write `c00.svg`, `c01.svg`, ... and the overview `trace.svg` into a directory, and return their paths.

    Each label names the step between two configurations, so there is one label fewer. `loop` is the number of the
    configuration to which the run returns for ever; `moments` are the dates of the steps in milliseconds; the steps of
    `race` are marked. The maps show `marks`.

    Raises:
        OSError: A file cannot be written.
    """
    folder = Path(directory)
    digits = max(2, len(str(len(configurations) - 1)))
    names = [f"c{step:0{digits}d}.svg" for step in range(len(configurations))]
    befores = [None, *configurations[:-1]]
    roles = {} if race is None else race.roles
    words = (f"[{roles[number]}] " if number in roles else "" for number in range(1, len(configurations)))
    captions = ["", *(f"{word}{label}" for word, label in zip(words, labels, strict=True))]
    for name, before, c, caption in zip(names, befores, configurations, captions, strict=True):
        heading = " ".join(part for part in (title, Path(name).stem, caption) if part)
        draw_configuration(c, title=heading, changed=before, marks=marks).save(folder / name)
    overview = folder / "trace.svg"
    lanes = lanes_of(configurations, labels, loop, moments, race)
    draw_overview(lanes, title=title, links=names[1:]).save(overview)
    return (*(folder / name for name in names), overview)


def draw_overview(
    lanes: Lanes, *, title: str | None = None, links: Sequence[str] = (), unfolded: bool = False
) -> Picture:
    """Return one picture of a trace: the steps in their lanes from top to bottom, with their changes.

    `links` are the link targets of the boxes in an SVG, one for each step. Consecutive steps that only repeat others
    share a box, unless `unfolded`.
    """
    rows = rows_of(lanes, unfolded=unfolded)
    page = _page(lanes, rows, title and title.rstrip(":"), links)
    return page.picture(title or "trace")


def rows_of(lanes: Lanes, *, unfolded: bool = False) -> tuple[OverviewRow, ...]:
    """Return the steps of a trace as rows of its overview; of a trace that is too long, only the ends."""
    steps = tuple(bounded(lanes.steps if unfolded else tuple(folded(lanes.steps)), MOST_ROWS))
    passing = lapses(steps)
    longest = max(passing, default=0)
    gaps = (max(LEAST_LAPSE, MOST_LAPSE * each / longest) if each else 0.0 for each in passing)
    return tuple(
        replace(_row(step), date=steps_of(step)[0].date, lapse=lapse, gap=gap)
        for step, lapse, gap in zip(steps, passing, gaps, strict=True)
    )


def _row(step: LaneStep | Repetition) -> OverviewRow:
    words = wrapped(step.about, LANE - 26.0, 7.0, 3)
    if isinstance(step, Repetition):
        return OverviewRow(step.number, step.lane, AGAIN, step.heading, words, ())
    colours = SERVED if step.serves else AROUND if step.label.agent is None else AGENT
    return OverviewRow(
        step.number, step.lane, colours, step.label.rule, words, _changes(step), role=step.role
    )


def _changes(step: LaneStep) -> tuple[str, ...]:
    """Return the changes in a few lines."""
    shown = [piece for change in step.changes for piece in wrapped(str(change), CHANGES, 7.0, 2)]
    return tuple(
        shown
        if len(shown) <= MOST_LINES
        else [*shown[: MOST_LINES - 1], f"and {len(shown) - MOST_LINES + 1} lines more"]
    )


def _page(lanes: Lanes, rows: Sequence[OverviewRow], title: str | None, links: Sequence[str]) -> Page:
    left = MARGIN + NUMBERS + (DATES if any(row.date for row in rows) else 0.0)
    starts = [left + rank * (LANE + GUTTER) for rank in range(len(lanes.names))]
    end = left + len(starts) * (LANE + GUTTER)
    top = MARGIN + (24.0 if title else 0.0) + HEAD
    tops = list(accumulate((row.height for row in rows), initial=top))
    page = Page(end + CHANGES + MARGIN, tops[-1] + MARGIN + (HEAD if lanes.end else 0.0))
    if lanes.end:
        page.write(MARGIN, tops[-1] + HEAD, lanes.end, 8.0, bold=True)
    if title:
        page.write(MARGIN, MARGIN + 9, title, 14.0, bold=True, width=page.width - 2 * MARGIN)
    for name, start in zip(lanes.names, starts, strict=True):
        _draw_lane(page, name, start, (top - HEAD, tops[-1]))
    page.heading(end, top - HEAD + 15, "changed", "by each step")
    if left > MARGIN + NUMBERS:
        _draw_axis(page, rows, tops, left - GUTTER)
    for row, begin in zip(rows, tops, strict=False):
        y = begin + row.gap
        page.rule(MARGIN, page.width - MARGIN, y - 2.0)
        page.write(MARGIN, y + 14.0, f"c{row.number}", 8.0, ink=QUIET)
        _draw_row(page, row, starts[row.lane], y + 3.0, links[row.number - 1] if links else None)
        for rank, line in enumerate(row.changes):
            page.write(end, y + 12.5 + rank * 10.5, line, 7.0)
    return page


def _draw_lane(page: Page, name: str, start: float, span: tuple[float, float]) -> None:
    middle = start + LANE / 2
    page.write(middle, span[0] + 15, name, 9.0, bold=True, width=LANE, anchor="middle")
    page.line([(middle, span[0] + HEAD - 6), (middle, span[1])], LANE_LINE)


def _draw_axis(page: Page, rows: Sequence[OverviewRow], tops: Sequence[float], x: float) -> None:
    """Draw the dates of rows, each once, and the time between them."""
    page.write(x, tops[0] - HEAD + 15, "time", 9.0, bold=True, anchor="end")
    page.line([(x, tops[0]), (x, tops[-1])], LANE_LINE)
    for number, (row, y) in enumerate(zip(rows, tops, strict=False)):
        if row.gap:
            page.line([(x, y - 2.0), (x, y + row.gap - 2.0)], Paint(stroke=TIME, width=3.0))
            words = f"+ {lapse_text(row.lapse)}"
            page.write(x - 6.0, y + row.gap / 2 + 0.5, words, 7.0, ink=TIME, anchor="end")
        if row.gap or not number:
            here = y + row.gap
            page.line([(x - 4.0, here - 2.0), (x + 4.0, here - 2.0)], Paint(stroke=TIME, width=1.2))
            page.write(x - 6.0, here + 14.0, row.date, 8.0, anchor="end")


def _draw_row(page: Page, row: OverviewRow, start: float, y: float, link: str | None) -> None:
    fill, border = row.colours
    paint = Paint(fill, RACE, 2.2) if row.role else Paint(fill, border, 1.1)
    page.rectangle((start + 4, y), (LANE - 8, row.box_height), paint, radius=5, link=link)
    page.write(start + 12, y + 12.5, row.rule, 8.0, bold=True, ink=INK)
    if row.role:
        page.write(start + LANE - 12, y + 12.5, row.role, 8.0, bold=True, ink=RACE, anchor="end")
    for rank, line in enumerate(row.words):
        page.write(start + 12, y + 23.0 + rank * 10.0, line, 7.0, ink="#3b4252")
