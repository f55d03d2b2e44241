"""Lanes: a trace with a column for each actor, and the changes of each step."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from wcwidth import ljust, wrap

from checker.traces import Trace
from semantics.state.configuration import Configuration, Label
from semantics.state.differences import Difference, differences
from semantics.state.signature import Name

ENVIRONMENT: Final = "environment"

SERVING: Final = frozenset({"sense", "actuate", "command", "commit", "snd", "migrate"})
"""Rules that serve a request: they act between the requesting agent and the world."""

NARROWEST: Final = 24
NUMBERS: Final = 6


@dataclass(frozen=True, slots=True)
class LaneStep:
    """One step.

    Attributes:
        number: The number of the configuration after it.
        lane: Its index in `Lanes.names`: an agent's lane or the environment's.
        label: Its label.
        changes: Its changes.
    """

    number: int
    lane: int
    label: Label
    changes: tuple[Difference, ...]

    @property
    def serves(self) -> bool:
        """Whether it serves a request, and is no step of the agent's program."""
        return self.label.rule in SERVING

    @property
    def about(self) -> str:
        """The label without the rule and the lane."""
        return str(self.label.about)


@dataclass(frozen=True, slots=True)
class Lanes:
    """A trace in lanes.

    Attributes:
        names: The names of the lanes: the agents, then the environment if it takes a step.
        steps: The steps, from the first.
        loop: The number of the configuration from which the run repeats for ever, if it does: the last is the same.
    """

    names: tuple[Name, ...]
    steps: tuple[LaneStep, ...]
    loop: int | None = None

    @property
    def end(self) -> str:
        """A text about how the run repeats, empty if it doesn't."""
        if self.loop is None:
            return ""
        if self.loop == len(self.steps):
            return f"c{self.loop}, for ever"
        return f"↻ c{len(self.steps)} is c{self.loop}: from there on again and again"


def lanes_of(
    configurations: Sequence[Configuration], labels: Sequence[Label], loop: int | None = None
) -> Lanes:
    """Return a run in lanes; there is one label fewer than configurations."""
    agents = tuple(sorted({a for c in configurations for a in c.alpha.names()}))
    around = any(label.agent is None for label in labels)
    steps = []
    for number, (label, (before, after)) in enumerate(zip(labels, pairwise(configurations), strict=True), 1):
        lane = len(agents) if label.agent is None else agents.index(label.agent)
        steps.append(LaneStep(number, lane, label, differences(before, after)))
    return Lanes((*agents, *([ENVIRONMENT] if around else [])), tuple(steps), loop)


def lanes_of_trace(trace: Trace) -> Lanes:
    """Return a trace in lanes."""
    return lanes_of(trace.configurations, [step.label for step in trace.steps], trace.loop)


def lanes_text(lanes: Lanes, width: int = 100) -> Iterator[str]:
    """Yield lanes line by line, as columns of a page of a given width, or wider if there are many."""
    columns = max(1, len(lanes.names))
    each = max(NARROWEST, (width - NUMBERS) // columns)
    yield _row("", [name[: each - 2] for name in lanes.names], each)
    yield _row("", ["─" * (each - 2)] * columns, each)
    for step in lanes.steps:
        lines = [piece for line in _lines(step) for piece in _wrapped(line, each - 2)]
        for rank, line in enumerate(lines):
            cells = ["│"] * columns
            cells[step.lane] = line
            yield _row(f"c{step.number}" if rank == 0 else "", cells, each)
    if lanes.end:
        yield lanes.end


def _lines(step: LaneStep) -> Iterator[str]:
    yield f"● {step.label.rule}"
    if step.about:
        yield f"  {step.about}"
    yield from (f"  {change}" for change in step.changes)


def _wrapped(line: str, width: int) -> list[str]:
    indent = " " * (len(line) - len(line.lstrip()) + 2)
    return wrap(line, width, subsequent_indent=indent, break_on_hyphens=False) or [""]


def _row(number: str, cells: list[str], width: int) -> str:
    return f"{number:<{NUMBERS}}{''.join(ljust(cell, width) for cell in cells)}".rstrip()
