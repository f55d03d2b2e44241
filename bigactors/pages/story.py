"""The content of a trace's page: its rows, and its configurations with their pictures, each held once."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import Final

from bigactors.pictures import Panels, Picture
from checker import Trace
from checker.reports.lanes import Lanes, LaneStep, Repetition, Row, bounded, folded, lanes_of_trace
from semantics.state.configuration import Configuration

MOST_PICTURES: Final = 100
"""The most pictures that a page holds of each model."""

MOST_ROWS: Final = 1_500
"""The most rows that a page begins with."""

MOST_FRAMES: Final = 2_000
"""The most configurations that a page holds which do not look alike."""


@dataclass(frozen=True, slots=True)
class Story:
    """What a page tells.

    Attributes:
        title: What it is called.
        about: What the trace is evidence of; may be empty.
        violated: Whether that is a violation.
        trace: The trace.
        start: Which configuration is shown first.
        drawn: How many pictures are drawn of each model: those around the start, or of a page that starts with the
            first configuration the last ones.
        note: Where it comes from, such as the digest of the mission.
        details: More of what it is evidence of, line by line.
        times: When each step was taken, in seconds; empty where nobody knows.
        unfolded: Whether steps that repeat others have a row each.
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


@dataclass(frozen=True, slots=True)
class Frame:
    """A configuration of the page, and how it was come to; one frame stands for all that look alike.

    Attributes:
        number: The number of the first that looks so.
        count: How many do.
        step: The step to it, None to the first configuration.
        c: The configuration.
        before: The one before it.
        logical: The picture of L, None where it is not drawn.
        physical: The picture of P.
    """

    number: int
    count: int
    step: LaneStep | None
    c: Configuration
    before: Configuration | None
    logical: Picture | None
    physical: Picture | None

    @property
    def label(self) -> str:
        """How it was come to."""
        return "the first configuration" if self.step is None else str(self.step.label)

    @property
    def role(self) -> str:
        """What the step to it is in a stale-observation race; mostly nothing."""
        return "" if self.step is None else self.step.role


@dataclass(frozen=True, slots=True)
class Telling:
    """A story as a page holds it.

    Attributes:
        story: The story.
        lanes: Its steps.
        rows: The rows that the page begins with.
        frames: What the page holds of configurations.
        order: The index in `frames` of each configuration of the trace, None where the page doesn't hold it.
    """

    story: Story
    lanes: Lanes
    rows: tuple[Row, ...]
    frames: tuple[Frame, ...]
    order: tuple[int | None, ...]

    @property
    def seconds(self) -> tuple[float, ...]:
        """When each configuration was come to, in seconds since the first step; empty where nobody knows."""
        times = self.story.times
        return (0.0, *(max(0.0, time - times[0]) for time in times)) if times else ()

    @property
    def left_out(self) -> tuple[str, ...]:
        """What of the trace the page does not hold, and how to see it, in lines."""
        missing = [number for number, frame in enumerate(self.order) if frame is None]
        undrawn = sum(frame.count for frame in self.frames if None in (frame.logical, frame.physical))
        of = f"of {len(self.order):,} configurations"
        remedy = "a page made by `show` with --step K has those around c_K"
        span = f", between c{missing[0]} and c{missing[-1]}" if missing else ""
        return (
            *([f"{len(missing):,} {of} are left out{span}: {remedy}"] if missing else []),
            *([f"{undrawn:,} {of} are not drawn: {remedy}"] if undrawn else []),
        )


def telling(story: Story) -> Telling:
    """Return what a page tells of a story: of one that is too long its ends and what is around the start."""
    lanes = lanes_of_trace(story.trace)
    steps = lanes.steps if story.unfolded else tuple(folded(lanes.steps))
    rows = tuple(bounded(steps, MOST_ROWS, story.start))
    looks = _looks(story.trace)
    held = sorted(_held(rows, looks))
    places = {look: place for place, look in enumerate(held)}
    return Telling(
        story, lanes, rows, _frames(story, lanes, held, looks), tuple(places.get(look) for look in looks)
    )


def _looks(trace: Trace) -> tuple[int, ...]:
    """Return for each configuration the first that looks like it: it comes after the same one, by the same step."""
    configurations = trace.configurations
    labels = ("", *(str(step.label) for step in trace.steps))
    roles = (trace.role(number) for number in range(len(configurations)))
    first: dict[object, int] = {}
    looks = zip((None, *configurations), configurations, labels, roles, strict=False)
    return tuple(first.setdefault(look, number) for number, look in enumerate(looks))


def _held(rows: Sequence[Row], looks: Sequence[int]) -> Iterable[int]:
    """Return the looks that a page has room for: those of its rows, then those of what is folded in them."""
    own = (row.number for row in rows if isinstance(row, LaneStep))
    again = (step.number for row in rows if type(row) is Repetition for step in row.steps)
    return islice(dict.fromkeys(looks[number] for number in chain([0], own, again)), MOST_FRAMES)


def _frames(story: Story, lanes: Lanes, held: Sequence[int], looks: Sequence[int]) -> tuple[Frame, ...]:
    configurations, counts = story.trace.configurations, Counter(looks)
    panels = Panels.of(configurations, min(story.drawn, MOST_PICTURES))
    frames = {}
    for number in sorted(held, key=lambda number: abs(number - (story.start or len(looks)))):
        c, before = configurations[number], configurations[number - 1] if number else None
        pictures = panels.logical(c, before), panels.physical(c, before)
        step = lanes.steps[number - 1] if number else None
        frames[number] = Frame(number, counts[number], step, c, before, *pictures)
    return tuple(frames[number] for number in held)
