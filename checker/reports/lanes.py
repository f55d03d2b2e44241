"""Lanes: a trace with a column for each actor, and the changes of each step."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Final

from wcwidth import ljust, wrap

from checker.properties.race_steps import RaceSteps
from checker.traces import Trace
from semantics.state.configuration import Configuration, Label
from semantics.state.differences import Difference, differences
from semantics.state.signature import Name
from semantics.timing.dates import clock_text

ENVIRONMENT: Final = "environment"

SERVING: Final = frozenset({"sense", "actuate", "command", "commit", "snd", "migrate"})
"""Rules that serve a request: they act between the requesting agent and the world."""

LEAST_REPEATED: Final = 8
"""The least number of consecutive repeated steps that are folded into one line."""

WORLD: Final = frozenset({"L", "P", "E"})
"""The parts of a configuration outside the agents."""

COUNTED: Final = re.compile(r"(?<= = )-?\d+$")
"""The new number of a variable; it may differ from one round of a loop to the next."""

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
        at: Its date in milliseconds from the start; None if the run has no dates.
        role: Its role in a stale-observation race: *sensed*, *changed* or *acted*; empty for most steps.
    """

    number: int
    lane: int
    label: Label
    changes: tuple[Difference, ...]
    at: int | None = None
    role: str = ""

    @property
    def date(self) -> str:
        """Its date as text; empty without dates."""
        return "" if self.at is None else clock_text(self.at)

    @property
    def serves(self) -> bool:
        """Whether it serves a request, and is no step of the agent's program."""
        return self.label.rule in SERVING

    @property
    def about(self) -> str:
        """The label without the rule and the lane."""
        return self.label.details

    @property
    def last(self) -> int:
        """The number of the configuration after it, as of a `Repetition`."""
        return self.number

    @property
    def deed(self) -> tuple[str, tuple[str, ...]]:
        """The step and its changes, without the values of counters."""
        return str(self.label), tuple(COUNTED.sub("#", str(change)) for change in self.changes)


@dataclass(frozen=True, slots=True)
class Repetition:
    """Consecutive steps that only repeat earlier ones since the world last changed, such as a loop of observations.

    Attributes:
        steps: Those steps.
    """

    steps: tuple[LaneStep, ...]

    @property
    def number(self) -> int:
        """The number of the configuration after the first one."""
        return self.steps[0].number

    @property
    def last(self) -> int:
        """The number of the configuration after the last one."""
        return self.steps[-1].number

    @property
    def lane(self) -> int:
        """The lane of most of its steps."""
        return Counter(step.lane for step in self.steps).most_common(1)[0][0]

    @property
    def role(self) -> str:
        """Nothing: a step of a race has a row of its own."""
        return ""

    @property
    def heading(self) -> str:
        """The number of steps."""
        return f"↻ {len(self.steps):,} steps, to c{self.last}"

    @property
    def about(self) -> str:
        """The repeated rules, with their counts."""
        counts = Counter(step.label.rule for step in self.steps)
        return "again " + ", ".join(f"{rule} ×{count:,}" for rule, count in counts.items())


@dataclass(frozen=True, slots=True)
class LeftOut(Repetition):
    """Consecutive steps for which a report has no room."""

    @property
    def heading(self) -> str:
        """The number of steps."""
        return f"⋯ {len(self.steps):,} steps, to c{self.last}"

    @property
    def about(self) -> str:
        """The words for omitted steps."""
        return "left out here"


Row = LaneStep | Repetition
"""One line of a run."""


@dataclass(frozen=True, slots=True)
class Lanes:
    """A trace in lanes.

    Attributes:
        names: The names of the lanes: the agents, then the environment if it takes a step.
        steps: The steps, from the first.
        loop: The number of the configuration from which the run repeats for ever, if it does; it equals the last.
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
    configurations: Sequence[Configuration],
    labels: Sequence[Label],
    loop: int | None = None,
    moments: Sequence[int] = (),
    race: RaceSteps | None = None,
) -> Lanes:
    """Return a run in lanes; there is one label fewer than configurations, and a moment, in milliseconds, for each."""
    roles = {} if race is None else race.roles
    agents = tuple(sorted({a for c in dict.fromkeys(configurations) for a in c.alpha.names()}))
    around = any(label.agent is None for label in labels)
    told = {pair: differences(*pair) for pair in dict.fromkeys(pairwise(configurations))}
    steps = []
    for number, (label, pair) in enumerate(zip(labels, pairwise(configurations), strict=True), 1):
        lane = len(agents) if label.agent is None else agents.index(label.agent)
        at = moments[number - 1] if moments else None
        steps.append(LaneStep(number, lane, label, told[pair], at, roles.get(number, "")))
    return Lanes((*agents, *([ENVIRONMENT] if around else [])), tuple(steps), loop)


def lanes_of_trace(trace: Trace) -> Lanes:
    """Return a trace in lanes."""
    labels = [step.label for step in trace.steps]
    return lanes_of(trace.configurations, labels, trace.loop, trace.moments, trace.race)


def folded(steps: Sequence[LaneStep]) -> Iterator[Row]:
    """Yield the steps in their order; steps that only repeat others since the last change of the world are folded.

    A step of a race is never folded.
    """
    known: set[object] = set()
    again: list[LaneStep] = []
    for step in steps:
        if any(change.part in WORLD for change in step.changes):
            known.clear()
        if step.deed in known and not step.role:
            again.append(step)
            continue
        yield from _again(again)
        again = []
        known.add(step.deed)
        yield step
    yield from _again(again)


def _again(steps: list[LaneStep]) -> Iterator[Row]:
    if len(steps) < LEAST_REPEATED:
        yield from steps
    else:
        yield Repetition(tuple(steps))


def bounded(rows: Sequence[Row], most: int, around: int = 0) -> Iterator[Row]:
    """Yield the rows if they are at most so many; else the first, the last and those around a step, a third each.

    The steps of a race are kept, wherever they are.
    """
    third, count = most // 3, len(rows)
    at = next((number for number, row in enumerate(rows) if around <= row.last), count)
    near = (range(third), range(at - third // 2, at + third // 2), range(count - third, count))
    for kept, group in groupby(
        enumerate(rows),
        lambda each: count <= most or bool(each[1].role) or any(each[0] in r for r in near),
    ):
        found = [row for _, row in group]
        if kept:
            yield from found
        else:
            yield LeftOut(tuple(step for row in found for step in steps_of(row)))


def steps_of(row: Row) -> tuple[LaneStep, ...]:
    """Return the steps of a row."""
    return row.steps if isinstance(row, Repetition) else (row,)


def lapses(rows: Sequence[Row]) -> tuple[int, ...]:
    """Return the time before each row, in milliseconds; zeros for a run without dates."""
    moments = [(steps_of(row)[0].at, steps_of(row)[-1].at) for row in rows]
    ends = [0, *(end or 0 for _, end in moments)]
    return tuple((begin or 0) - end for (begin, _), end in zip(moments, ends, strict=False))


def lanes_text(lanes: Lanes, width: int = 100, *, unfolded: bool = False) -> Iterator[str]:
    """Yield lanes line by line, as columns of a page of a given width, or wider if there are many."""
    columns = max(1, len(lanes.names))
    each = max(NARROWEST, (width - NUMBERS) // columns)
    yield _row("", [name[: each - 2] for name in lanes.names], each)
    yield _row("", ["─" * (each - 2)] * columns, each)
    for step in lanes.steps if unfolded else folded(lanes.steps):
        lines = [piece for line in _lines(step) for piece in _wrapped(line, each - 2)]
        for rank, line in enumerate(lines):
            cells = ["│"] * columns
            cells[step.lane] = line
            yield _row(f"c{step.number}" if rank == 0 else "", cells, each)
    if lanes.end:
        yield lanes.end


def _lines(step: Row) -> Iterator[str]:
    if isinstance(step, Repetition):
        yield from (step.heading, f"  {step.about}")
        return
    role = f"  [{step.role}]" if step.role else ""
    yield f"● {step.label.rule}{f' at {step.date}' if step.date else ''}{role}"
    if step.about:
        yield f"  {step.about}"
    yield from (f"  {change}" for change in step.changes)


def _wrapped(line: str, width: int) -> list[str]:
    indent = " " * (len(line) - len(line.lstrip()) + 2)
    return wrap(line, width, subsequent_indent=indent, break_on_hyphens=False) or [""]


def _row(number: str, cells: list[str], width: int) -> str:
    return f"{number:<{NUMBERS}}{''.join(ljust(cell, width) for cell in cells)}".rstrip()
