"""The content of a trace's page: its configurations, each with its pictures."""

from dataclasses import dataclass, replace
from typing import Final

from bigactors.pictures import Panels, Picture
from checker import Trace
from physical.messages import counted
from semantics.state.configuration import Configuration

MOST_PICTURES: Final = 100
"""The most configurations that are drawn; of a longer trace the last ones."""


MOST_FRAMES: Final = 2_000
"""The most configurations that a page holds; of a longer trace the last ones."""


@dataclass(frozen=True, slots=True)
class Story:
    """What a page tells.

    Attributes:
        title: What it is called.
        about: What the trace is evidence of; may be empty.
        violated: Whether that is a violation.
        trace: The trace.
        start: Which configuration is shown first.
        drawn: How many configurations are drawn, the last ones.
        note: Where it comes from, such as the digest of the mission.
        details: More of what it is evidence of, line by line.
        first: How many configurations are left out before the trace.
    """

    title: str
    about: str
    violated: bool
    trace: Trace
    start: int = 0
    drawn: int = MOST_PICTURES
    note: str = ""
    details: tuple[str, ...] = ()
    first: int = 0


@dataclass(frozen=True, slots=True)
class Frame:
    """One configuration of the page.

    Attributes:
        label: How it was come to.
        c: The configuration.
        before: The one before it.
        logical: The picture of L, None where it is not drawn.
        physical: The picture of P.
    """

    label: str
    c: Configuration
    before: Configuration | None
    logical: Picture | None
    physical: Picture | None


def latest(story: Story) -> Story:
    """Return a story whose trace a page can hold: of one that is too long its end."""
    left_out = len(story.trace) + 1 - MOST_FRAMES
    if left_out <= 0:
        return story
    trace = Trace(story.trace.configurations[left_out], story.trace.steps[left_out:])
    return replace(story, trace=trace, first=left_out, start=max(0, story.start - left_out))


def frames_of(story: Story) -> tuple[Frame, ...]:
    """Return the configurations of a trace with their pictures."""
    configurations = story.trace.configurations
    panels = Panels.of(configurations)
    begin = f"after {counted(story.first, 'step')} left out" if story.first else "the first configuration"
    labels = [begin, *(str(step.label) for step in story.trace.steps)]
    first_drawn = max(0, len(configurations) - max(1, min(story.drawn, MOST_PICTURES)))
    found = []
    for number, (label, c) in enumerate(zip(labels, configurations, strict=True)):
        before = configurations[number - 1] if number else None
        drawn = number >= first_drawn
        logical = panels.logical(c, before) if drawn else None
        found.append(Frame(label, c, before, logical, panels.physical(c, before) if drawn else None))
    return tuple(found)
