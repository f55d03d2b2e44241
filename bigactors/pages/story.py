"""The content of a trace's page: its rows, and its configurations with their pictures, each stored once."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import Final

from bigactors.pictures import Panel, Panels, RegionMarks
from checker import Trace
from checker.reports.lanes import Lanes, LaneStep, Repetition, Row, bounded, folded, lanes_of_trace
from semantics.state.configuration import Configuration

MOST_PICTURES: Final = 100
"""The most pictures of each model in a page."""

MOST_ROWS: Final = 1_500
"""The most rows of a page when it opens."""

MOST_FRAMES: Final = 2_000
"""The most different configurations in a page."""


@dataclass(frozen=True, slots=True)
class Story:
    """The input of a trace's page.

    Attributes:
        title: The title.
        about: The claim that the trace supports; may be empty.
        violated: Whether the claim is a violation.
        trace: The trace.
        start: The number of the configuration shown first.
        drawn: The most pictures of each model. They show the configurations nearest to the start; if it is 0, the last
            ones.
        note: The origin, such as the digest of the mission.
        details: More lines about the claim.
        times: The time of each step in seconds; empty if unknown.
        unfolded: Whether repeated steps have a row each.
        marks: The regions that the maps show.
    """

    title: str
    about: str
    violated: bool
    trace: Trace
    start: int = 0
    drawn: int = MOST_PICTURES
    note: str = ""
    details: tuple[str, ...] = ()
    times: tuple[float, ...] = ()
    unfolded: bool = False
    marks: RegionMarks | None = None


@dataclass(frozen=True, slots=True)
class PageFrame:
    """A configuration of the page, with the step to it; one frame stands for all identical ones.

    Attributes:
        number: The number of the first such configuration.
        count: The number of such configurations.
        step: The step to it, None for the first configuration.
        c: The configuration.
        before: The one before it.
        logical: The picture of L, None if it is not drawn.
        physical: The picture of P.
    """

    number: int
    count: int
    step: LaneStep | None
    c: Configuration
    before: Configuration | None
    logical: Panel | None
    physical: Panel | None

    @property
    def label(self) -> str:
        """The label of the step to it."""
        return "the first configuration" if self.step is None else str(self.step.label)

    @property
    def role(self) -> str:
        """The role of the step to it in a stale-observation race; mostly empty."""
        return "" if self.step is None else self.step.role


@dataclass(frozen=True, slots=True)
class PageContent:
    """The content of a page.

    Attributes:
        story: The story.
        lanes: Its steps.
        rows: The rows of the page when it opens.
        frames: The stored configurations.
        order: The index in `frames` of each configuration of the trace, None for one that is left out.
    """

    story: Story
    lanes: Lanes
    rows: tuple[Row, ...]
    frames: tuple[PageFrame, ...]
    order: tuple[int | None, ...]

    @property
    def seconds(self) -> tuple[float, ...]:
        """The time of each configuration in seconds since the first step; empty if unknown."""
        times = self.story.times
        return (0.0, *(max(0.0, time - times[0]) for time in times)) if times else ()

    @property
    def left_out(self) -> tuple[str, ...]:
        """Lines on the configurations that the page leaves out, and how to see them."""
        missing = [number for number, frame in enumerate(self.order) if frame is None]
        undrawn = sum(frame.count for frame in self.frames if None in (frame.logical, frame.physical))
        of = f"of {len(self.order):,} configurations"
        remedy = "a page made by `show` with --step K has those around c_K"
        span = f", between c{missing[0]} and c{missing[-1]}" if missing else ""
        return (
            *([f"{len(missing):,} {of} are left out{span}: {remedy}"] if missing else []),
            *([f"{undrawn:,} {of} are not drawn: {remedy}"] if undrawn else []),
        )


def telling(story: Story) -> PageContent:
    """Return the content of a story's page; of a long story, the ends and the part around the start."""
    lanes = lanes_of_trace(story.trace)
    steps = lanes.steps if story.unfolded else tuple(folded(lanes.steps))
    rows = tuple(bounded(steps, MOST_ROWS, story.start))
    looks = _looks(story.trace)
    held = sorted(_held(rows, looks))
    places = {look: place for place, look in enumerate(held)}
    return PageContent(
        story, lanes, rows, _frames(story, lanes, held, looks), tuple(places.get(look) for look in looks)
    )


def _looks(trace: Trace) -> tuple[int, ...]:
    """Return for each configuration the first identical one: it follows the same configuration by the same step."""
    configurations = trace.configurations
    labels = ("", *(str(step.label) for step in trace.steps))
    roles = (trace.role(number) for number in range(len(configurations)))
    first: dict[object, int] = {}
    looks = zip((None, *configurations), configurations, labels, roles, strict=False)
    return tuple(first.setdefault(look, number) for number, look in enumerate(looks))


def _held(rows: Sequence[Row], looks: Sequence[int]) -> Iterable[int]:
    """Return the frames that fit into a page: those of its rows, then those folded in them."""
    own = (row.number for row in rows if isinstance(row, LaneStep))
    again = (step.number for row in rows if type(row) is Repetition for step in row.steps)
    return islice(dict.fromkeys(looks[number] for number in chain([0], own, again)), MOST_FRAMES)


def _frames(story: Story, lanes: Lanes, held: Sequence[int], looks: Sequence[int]) -> tuple[PageFrame, ...]:
    configurations, counts = story.trace.configurations, Counter(looks)
    panels = Panels.of(configurations, min(story.drawn, MOST_PICTURES), story.marks)
    frames = {}
    for number in sorted(held, key=lambda number: abs(number - (story.start or len(looks)))):
        c, before = configurations[number], configurations[number - 1] if number else None
        pictures = panels.logical(c, before), panels.physical(c, before)
        step = lanes.steps[number - 1] if number else None
        frames[number] = PageFrame(number, counts[number], step, c, before, *pictures)
    return tuple(frames[number] for number in held)
