"""Draw a schedule of all flights and messages over all runs as a Gantt chart; time goes to the right.

Each flight is a bar from its earliest beginning to its latest end. The bar is full while the vehicle is under way in
every run with that flight: from the latest beginning to the earliest end. A bar without a latest end reaches the right
edge, and is open there.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from bigactors.pictures.page import Page
from checker.properties.critical_path import interval_text
from checker.properties.schedule import EventDates, MessageDates, Milestone, PossibleFlight, Schedule
from physical.map_style import QUIET
from physical.svg import Paint, Picture, text_width

MARGIN: Final = 26.0
CHART: Final = 560.0
ROW: Final = 26.0
HEAD: Final = 24.0
BAR: Final = 13.0
LEAST_NAMES: Final = 90.0
MOST_NAMES: Final = 240.0

FLIGHT: Final = ("#d5e5f8", "#4f86c6")
MESSAGE: Final = ("#fbe9d3", "#d08a3c")
TRUE: Final = ("#d6f0df", "#3f8f60")

STEPS: Final = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14_400, 43_200, 86_400)
"""Seconds between two marks of the axis."""

MOST_MARKS: Final = 10


@dataclass(frozen=True, slots=True)
class Bar:
    """One line of the chart, in seconds from the start.

    Attributes:
        name: The flight or the property.
        words: The text beside the bar.
        colours: Its light and its full colour.
        begins: Its earliest and its latest beginning; the latest may be infinite.
        ends: Its earliest and its latest end; both may be infinite.
    """

    name: str
    words: str
    colours: tuple[str, str]
    begins: tuple[float, float]
    ends: tuple[float, float]

    @property
    def surely(self) -> tuple[float, float] | None:
        """The interval in which it is certainly under way, None if there is none."""
        begin, end = self.begins[1], self.ends[0]
        return (begin, end) if begin < end < math.inf else None


def draw_timeline(schedule: Schedule, *, title: str) -> Picture:
    """Return one picture of a schedule."""
    groups = list(groups_of(schedule))
    bars = [bar for _, each in groups for bar in each]
    names = [text_width(bar.name, 8.0) for bar in bars] or [0.0]
    left = MARGIN + min(max(LEAST_NAMES, max(names) + 18.0), MOST_NAMES)
    span = span_of(bars)
    top = MARGIN + 44.0
    bottom = top + HEAD * len(groups) + ROW * len(bars)
    page = Page(left + CHART + MARGIN + 12.0, bottom + 46.0 + MARGIN)
    page.write(MARGIN, MARGIN + 9, title, 14.0, bold=True, width=page.width - 2 * MARGIN)
    page.write(MARGIN, MARGIN + 26, _legend(bars), 8.0, ink=QUIET, width=page.width - 2 * MARGIN)
    _draw_axis(page, left, (top, bottom), span)
    y = top
    for heading, each in groups:
        page.rule(MARGIN, left + CHART, y)
        page.write(MARGIN, y + 15.0, heading, 9.5, bold=True)
        y += HEAD
        for bar in each:
            _draw_bar(page, bar, left, y, span)
            y += ROW
    return page.picture(title)


def groups_of(schedule: Schedule) -> Iterator[tuple[str, tuple[Bar, ...]]]:
    """Yield the bars of each vehicle, then those of messages and of the `time` properties."""
    for vehicle in sorted({each.vehicle for each in schedule.flights}):
        flights = (each for each in schedule.flights if each.vehicle == vehicle)
        yield vehicle, tuple(_flight_bar(schedule, each) for each in flights)
    if schedule.messages:
        yield "messages", tuple(_message_bar(schedule, each) for each in schedule.messages)
    if schedule.milestones:
        yield "first true", tuple(_milestone_bar(schedule, each) for each in schedule.milestones)


def _flight_bar(schedule: Schedule, flight: PossibleFlight) -> Bar:
    name = f"{flight.origin} → {flight.destination}"
    begins, ends = (_seconds(schedule, each) for each in (flight.begins, flight.ends))
    words = f"{interval_text(flight.takes, schedule.tick)}, by {flight.agent}"
    if flight.ends.is_never:
        return Bar(name, f"{words}, never ends", FLIGHT, begins, (math.inf, math.inf))
    return Bar(name, words, FLIGHT, begins, ends)


def _message_bar(schedule: Schedule, message: MessageDates) -> Bar:
    begins, ends = (_seconds(schedule, each) for each in (message.begins, message.ends))
    words = interval_text(message.takes, schedule.tick)
    return Bar(f"{message.agent} → {message.to}", words, MESSAGE, begins, ends)


def _milestone_bar(schedule: Schedule, milestone: Milestone) -> Bar:
    earliest, latest = _seconds(schedule, milestone.moments)
    if milestone.moments.is_never:
        return Bar(milestone.name, "never", TRUE, (0.0, 0.0), (0.0, 0.0))
    never = ", if at all" if milestone.moments.may_never else ""
    first = schedule.clock(milestone.moments.earliest)
    last = schedule.clock(milestone.moments.latest)
    said = f"{first} to {last}" if last else f"{first} or later"
    return Bar(milestone.name, f"{said}{never}", TRUE, (earliest, earliest), (earliest, latest))


def _seconds(schedule: Schedule, moments: EventDates) -> tuple[float, float]:
    latest = moments.latest if schedule.complete else math.inf
    return moments.earliest * schedule.tick / 1000, latest * schedule.tick / 1000


def span_of(bars: list[Bar]) -> float:
    """Return the length of the axis in seconds: a little more than the latest bounded moment."""
    known = [each for bar in bars for each in (*bar.begins, *bar.ends) if math.isfinite(each)]
    endless = any(math.isinf(bar.ends[1]) for bar in bars)
    return max(max(known, default=0.0) * (1.25 if endless else 1.02), 1.0)


def marks(span: float) -> tuple[float, ...]:
    """Return the labelled seconds of the axis.

    >>> marks(1700.0)
    (0, 300, 600, 900, 1200, 1500)
    """
    step = next((each for each in STEPS if span / each <= MOST_MARKS), None)
    step = step or 86_400 * math.ceil(span / 86_400 / MOST_MARKS)
    return tuple(range(0, int(span) + 1, step))


def _legend(bars: list[Bar]) -> str:
    said = ["light: in some run, from the earliest to the latest"]
    said += ["full: under way in every run that has it then"] if any(bar.surely for bar in bars) else []
    said += (
        ["open at the right: nothing bounds the latest"] if any(math.isinf(b.ends[1]) for b in bars) else []
    )
    return "; ".join(said)


def _draw_axis(page: Page, left: float, rows: tuple[float, float], span: float) -> None:
    from semantics.timing.dates import clock_text  # noqa: PLC0415 - few pictures need it

    top, bottom = rows
    for second in marks(span):
        x = left + CHART * second / span
        page.line([(x, top), (x, bottom + 5.0)], Paint(stroke="#e3e8ee", width=0.8))
        page.write(x, bottom + 17.0, clock_text(int(second) * 1000), 8.0, ink=QUIET, anchor="middle")
    page.write(left, bottom + 34.0, "from the start of the mission", 8.0, ink=QUIET)


def _draw_bar(page: Page, bar: Bar, left: float, y: float, span: float) -> None:
    def at(seconds: float) -> float:
        return left + CHART * min(seconds, span) / span

    page.write(MARGIN + 10.0, y + 12.5, bar.name, 8.0, width=left - MARGIN - 16.0)
    light, full = bar.colours
    begin, end = at(bar.begins[0]), at(bar.ends[1])
    _box(page, begin, max(end, begin + 2.0), y, light, full)
    if bar.surely is not None:
        _box(page, at(bar.surely[0]), at(bar.surely[1]), y, full, full)
    if math.isinf(bar.ends[1]):
        edge = left + CHART
        page.line([(edge, y + 1.0), (edge, y + 3.5 + BAR)], Paint(stroke="#fff", width=2.0))
        page.write(edge + 3.0, y + 12.5, "…", 9.0, ink=full)
    _write_beside(page, bar, begin, max(end, begin + 2.0), y, left)


def _box(page: Page, begin: float, end: float, y: float, fill: str, edge: str) -> None:
    page.rectangle((begin, y + 2.5), (end - begin, BAR), Paint(fill, edge, 0.9))


def _write_beside(page: Page, bar: Bar, begin: float, end: float, y: float, left: float) -> None:
    """Write a bar's words to its right, else to its left, else into it."""
    width = text_width(bar.words, 7.5)
    if end + 5.0 + width <= left + CHART:
        page.write(end + 5.0, y + 12.5, bar.words, 7.5, ink=QUIET, halo=True)
    elif begin - 5.0 - width >= left:
        page.write(begin - 5.0, y + 12.5, bar.words, 7.5, ink=QUIET, anchor="end", halo=True)
    else:
        page.write(begin + 5.0, y + 12.5, bar.words, 7.5, width=end - begin - 10.0)
