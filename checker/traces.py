"""Traces: runs in the paper's notation that replay step by step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from checker.engines.contract import Exploration
from checker.engines.original_run import run_to
from checker.properties.findings import Finding
from checker.properties.race_steps import RaceSteps
from checker.properties.races import STALE
from checker.properties.stale_steps import stale_steps
from checker.steps import Step, alike, candidates, step_between, step_of
from physical.wordings import counted
from semantics.observed_steps import Sight
from semantics.races.monitor import monitored
from semantics.state.canonical import digest_of_step
from semantics.state.configuration import Configuration, Transition
from semantics.state.observation_serialization import sight_json, sight_of
from semantics.state.printing import print_changes
from semantics.state.station_partition import Elsewhere
from semantics.successors import expand, turn_of
from semantics.timing.arrivals import is_unfair
from semantics.timing.dates import clock_text

if TYPE_CHECKING:
    from checker.engines.timed.answers import Times
    from checker.engines.timed.first_runs import TimedRun

SCHEMA = "bigactors.trace/1"
"""The version of the step schema: schema, mission, digest, monitored, steps of label, choice and changes, and loop.

Steps of live runs also have their observation, its time, and the digest of their writes.
"""

MOST_STEPS = 1_000_000
MOST_SECONDS = 10_000_000_000


@dataclass(frozen=True, slots=True)
class Trace:
    """A run from the initial configuration.

    Attributes:
        initial: The first configuration.
        steps: Its steps.
        loop: The number of the configuration from which the run repeats for ever; it equals the last one. If it is the
            number of the last itself, the run stays there for ever. None for a finite run.
        dates: The date of each step, in ticks from the start; empty without timing.
        shortest: Whether the trace is certainly a shortest one. It isn't where steps were put
            off (`--reduce por`), nor where to find out would take too long.
        race: The three steps of the stale-observation race that it is a trace of.
        in_turn: Whether requests are served in turn under `fcfs`. In a live run others may go first while a vehicle or
            an operator keeps a request waiting.
    """

    initial: Configuration
    steps: tuple[Step, ...] = ()
    loop: int | None = None
    shortest: bool = field(default=True, compare=False)
    dates: tuple[int, ...] = ()
    race: RaceSteps | None = None
    in_turn: bool = True

    @property
    def called(self) -> str:
        """The description of the trace in a report."""
        return "a shortest trace" if self.shortest else "a trace"

    def __len__(self) -> int:
        return len(self.steps)

    def __repr__(self) -> str:
        return f"<Trace {print_length(self)}>"

    @property
    def configurations(self) -> tuple[Configuration, ...]:
        """c0, c1, ..."""
        return (self.initial, *(step.target for step in self.steps))

    def extended(self, transition: Transition, at: int | None = None) -> Trace:
        """Return the trace with one more step, taken at some tick where it has dates."""
        source = self.configurations[-1]
        steps = (*self.steps, step_of(source, transition.label, transition.target))
        dates = self.dates if at is None else (*self.dates, at)
        return replace(self, steps=steps, dates=dates, loop=None)

    @property
    def moments(self) -> tuple[int, ...]:
        """The date of each step, in milliseconds from the start; empty without dates."""
        timing = self.initial.setting.timing
        return () if timing is None else tuple(date * timing.tick for date in self.dates)

    def date(self, number: int) -> str:
        """Return the date of a step as text; empty without dates."""
        return clock_text(self.moments[number]) if self.moments else ""

    def role(self, number: int) -> str:
        """Return the word of a step, from 1, in the race that this is a trace of; nothing for other steps."""
        return "" if self.race is None else self.race.roles.get(number, "")

    @property
    def told_race(self) -> tuple[str, ...]:
        """The three steps of the race that this is a trace of, line by line."""
        if self.race is None:
            return ()
        return tuple(self.race.told([step.label for step in self.steps], self.configurations))


def trace_to(found: Exploration, number: int, by: Transition | None = None) -> Trace:
    """Return a trace to a configuration of an exploration: a shortest one, unless partial order reduction was applied.

    The transition that the finding is about comes last, if it is its turn.
    """
    if found.times is not None:
        return dated_trace(found.times, found.times.run_before(number, by))
    if by is not None and by.served is not None and not _is_in_turn(found.configurations[number], by):
        by = None
    shortest = found.reducer is None or not found.reducer.putting_off
    if found.reducer is not None and found.reducer.symmetry is not None:
        return _unfolded(found, number, by, shortest=shortest)
    run = [found.configurations[each] for each in found.path(number)]
    steps = tuple(step_between(source, target) for source, target in pairwise(run))
    trace = Trace(run[0], steps, shortest=shortest)
    return trace if by is None else trace.extended(by)


def _is_in_turn(c: Configuration, step: Transition) -> bool:
    return turn_of(step) is None or turn_of(step) in map(turn_of, expand(c).by_agents)


def trace_of(found: Exploration, finding: Finding) -> Trace:
    """Return a trace to a finding; that of a stale-observation race knows its three steps."""
    trace = trace_to(found, finding.at, finding.by)
    if finding.kind != STALE:
        return trace
    return replace(trace, race=stale_steps(trace.initial, trace.steps))


def dated_trace(times: Times, run: TimedRun) -> Trace:
    """Return a run as a trace with dates."""
    trace = Trace(times.initial)
    for transition, date in zip(times.transitions(run), run.dates, strict=True):
        trace = trace.extended(transition, date)
    return trace


def _unfolded(found: Exploration, number: int, by: Transition | None, *, shortest: bool) -> Trace:
    """Return an unreduced run to the configuration that a representative stands for."""
    initial = found.configurations[0] if found.start is None else found.start
    trace = Trace(initial, (), shortest=shortest)
    for transition in run_to(found, number, by):
        trace = trace.extended(transition)
    return trace


def print_trace(trace: Trace, *, changes: bool = True) -> Iterator[str]:
    """Print a trace in the paper's notation, with the changes under each step."""
    for number, (step, source) in enumerate(zip(trace.steps, trace.configurations, strict=False), 1):
        yield print_step(trace, number)
        if changes:
            yield from (f"      {line}" for line in print_changes(source, step.target))
    if trace.loop is not None:
        yield print_loop(trace)


def print_parts(trace: Trace, most: int) -> Iterator[str]:
    """Print the last steps of a trace, and those with a role in a race, in about so many lines; count the others."""
    printed = [
        [print_step(trace, number), *(f"      {line}" for line in print_changes(source, step.target))]
        for number, (step, source) in enumerate(zip(trace.steps, trace.configurations, strict=False), 1)
    ]
    chosen = _fitting(trace, list(map(len, printed)), most)
    number = 0
    while number < len(printed):
        if number in chosen:
            yield from printed[number]
            number += 1
            continue
        after = next((each for each in range(number, len(printed)) if each in chosen), len(printed))
        yield f"... {counted(after - number, 'step')} from c{number} to c{after}: --all"
        number = after
    if trace.loop is not None:
        yield print_loop(trace)


def _fitting(trace: Trace, lengths: list[int], most: int) -> set[int]:
    """Return the numbers, from 0, of the steps that fit: those with a role first, then from the end."""
    backwards = range(len(lengths) - 1, -1, -1)
    chosen: set[int] = set()
    for number in (*(each for each in backwards if trace.role(each + 1)), *backwards):
        if number not in chosen:
            most -= lengths[number]
            if most < 0 and chosen:
                break
            chosen.add(number)
    return chosen


def print_step(trace: Trace, number: int) -> str:
    """Print one step, numbered from 1: its date, its label, and its role in a race."""
    date, role = trace.date(number - 1), trace.role(number)
    label = f"{f'at {date} ' if date else ''}{trace.steps[number - 1].label}"
    return f"c{number - 1} --{label}--> c{number}{f'  [{role}]' if role else ''}"


def print_loop(trace: Trace) -> str:
    """Print the loop of an infinite run."""
    end = len(trace)
    if trace.loop == end:
        return f"c{end} stays for ever: nothing has to happen"
    return f"c{end} = c{trace.loop}: {_steps_of(end - (trace.loop or 0))} from there on, again and again"


def _steps_of(count: int) -> str:
    return "the step" if count == 1 else f"the {count:,} steps"


def print_length(trace: Trace) -> str:
    """Print the kind and the length of a trace."""
    steps = counted(len(trace), "step")
    if trace.loop is None:
        return f"{trace.called}, {steps}"
    run = f"a shortest run of {steps}" if trace.shortest else f"a run of {steps}, not proved shortest"
    if trace.loop == len(trace):
        return f"{run}, at whose end it stays for ever"
    return f"{run}, {_last(len(trace) - trace.loop)} repeated for ever"


def _last(count: int) -> str:
    return "the last one" if count == 1 else f"the last {count:,}"


# --- replay ---------------------------------------------------------------------------------------------------


class ReplayError(Exception):
    """A trace that the rules don't allow.

    Attributes:
        step: The number of the step, from 1.
        enabled: The labels of the transitions enabled instead.
    """

    def __init__(self, step: int, label: str, enabled: Sequence[str], cause: str) -> None:
        instead = "\n".join(f"  {other}" for other in enabled) or "  nothing"
        super().__init__(f"step {step}: {label} is not enabled: {cause}\nenabled instead:\n{instead}")
        self.step = step
        self.enabled = tuple(enabled)


def to_json(trace: Trace, mission: str, digest: str) -> dict[str, Any]:
    """Return a trace as plain data, in the step schema."""
    steps = [
        _step_json(source, step) | dated | ({"role": role} if (role := trace.role(number)) else {})
        for number, (step, source, dated) in enumerate(
            zip(trace.steps, trace.configurations, _dates_json(trace), strict=False), 1
        )
    ]
    remembering = trace.initial.setting.monitored
    data = {"schema": SCHEMA, "mission": mission, "digest": digest, "monitored": remembering, "steps": steps}
    if not trace.in_turn:
        data["in_turn"] = False
    return data if trace.loop is None else data | {"loop": trace.loop}


def _dates_json(trace: Trace) -> Iterator[dict[str, float]]:
    """Yield the date of each step in seconds from the start; nothing without dates."""
    timing = trace.initial.setting.timing
    if timing is None or not trace.dates:
        yield from ({} for _ in trace.steps)
    else:
        yield from ({"at": date * timing.tick / 1000} for date in trace.dates)


def _step_json(source: Configuration, step: Step) -> dict[str, Any]:
    observed = {} if step.sight is None else {"observed": sight_json(step.sight)}
    changes = list(print_changes(source, step.target))
    return {"label": str(step.label), "choice": step.choice, **observed, "changes": changes}


def replay(initial: Configuration, data: Any) -> Trace:
    """Return the trace of plain data, re-run through the rules; with the monitor's memory if it was recorded with it.

    Raises:
        ReplayError: A step is not allowed, or the loop doesn't close.
        ValueError: The data are no trace.
    """
    steps, loop, in_turn = _steps(data), _loop(data), data.get("in_turn") is not False
    if data.get("monitored") is True and not initial.setting.monitored:
        initial = monitored(initial)
    trace: list[Step] = []
    at = initial
    for number, said in enumerate(steps, 1):
        trace.append(_followed(at, number, said, in_turn=in_turn))
        at = trace[-1].target
    dates, race = _dates(initial, trace, data["steps"]), _race(initial, trace, data["steps"])
    return _closed(Trace(initial, tuple(trace), loop, dates=dates, race=race, in_turn=in_turn))


def _race(initial: Configuration, trace: Sequence[Step], said: Sequence[Any]) -> RaceSteps | None:
    """Return the race that plain data mark in a run, once the run itself shows the same steps."""
    marked = {number: each["role"] for number, each in enumerate(said, 1) if "role" in each}
    if not marked:
        return None
    race = stale_steps(initial, trace)
    shown = {} if race is None else race.roles
    for number in sorted(marked.keys() | shown.keys()):
        if marked.get(number) != shown.get(number):
            right = f"the 'role' '{shown[number]}'" if number in shown else "no 'role'"
            raise ValueError(
                f"step {number} should have {right}: the run determines the role of each step in a race"
            )
    return race


def _dates(initial: Configuration, trace: Sequence[Step], said: Sequence[Any]) -> tuple[int, ...]:
    """Return the dates of a run in ticks after a check against its clocks; empty without dates."""
    timing = initial.setting.timing
    if timing is None or not any("at" in each for each in said):
        return ()
    from semantics.timing.dated_runs import DatedRun, UntimelyError  # noqa: PLC0415 - geometry takes its time to load

    run, dates = (
        DatedRun(initial),
        tuple(_date(number, each, timing.tick) for number, each in enumerate(said, 1)),
    )
    for number, (step, date) in enumerate(zip(trace, dates, strict=True), 1):
        try:
            run.take(step.label, step.target, date)
        except UntimelyError as untimely:
            enabled = sorted({str(each.transition.label) for each in run.situation.steps})
            raise ReplayError(number, str(step.label), enabled, str(untimely)) from untimely
    return dates


def _date(number: int, said: Any, tick: int) -> int:
    seconds = said.get("at")
    known = (
        isinstance(seconds, int | float) and not isinstance(seconds, bool) and 0 <= seconds <= MOST_SECONDS
    )
    milliseconds = round(seconds * 1000) if known else 1
    if not known or milliseconds % tick:
        raise ValueError(
            f"step {number} should be taken 'at' a whole number of ticks of {tick} ms, in seconds"
        )
    return milliseconds // tick


def follow(before: Configuration, number: int, said: Any, *, in_turn: bool) -> Step:
    """Return the step of plain data, re-run by the rules, in the turn of `fcfs` or out of it.

    Raises:
        ReplayError: The step is not allowed there, or has another target.
        ValueError: The data are no step.
    """
    return _followed(before, number, _step(number, said), in_turn=in_turn)


def _followed(before: Configuration, number: int, said: _Said, *, in_turn: bool) -> Step:
    label, choice, sight, wrote = said
    same = alike(before, label, sight, in_turn=in_turn)
    if choice >= len(same):
        enabled = sorted({str(each.label) for each in candidates(before, sight, in_turn=in_turn)})
        waits = sight is None and any(str(each.label) == label for each in expand(before).out_of_turn)
        raise ReplayError(number, label, enabled, OUT_OF_TURN if waits else _cause(len(same)))
    taken = same[choice]
    if wrote is not None and digest_of_step(before, taken.target) != wrote:
        changes = print_changes(before, taken.target)
        raise ReplayError(number, label, changes, "it leads to another configuration here")
    return Step(taken.label, choice, taken.target, sight)


def _closed(trace: Trace) -> Trace:
    """Return a trace after a check that its loop closes."""
    if trace.loop is None:
        return trace
    last = trace.configurations[-1]
    expansion = expand(last)
    enabled = sorted({str(transition.label) for transition in expansion.transitions})
    if trace.loop == len(trace) and any(not is_unfair(last, each) for each in expansion.by_agents):
        raise ReplayError(len(trace), "staying for ever", enabled, "some step has to be taken")
    if last != trace.configurations[trace.loop]:
        raise ReplayError(
            len(trace), f"coming round to c{trace.loop}", enabled, "its last step leads elsewhere"
        )
    return trace


OUT_OF_TURN = "it is out of turn: 'scheduler fcfs' serves the oldest request first"


def _cause(alike: int) -> str:
    if alike:
        return (
            f"it has {alike} successors here, fewer than the trace chose from; the mission may have changed"
        )
    return "the mission, its scheduler or its environment may have changed since the trace was written"


_Said = tuple[str, int, Sight | Elsewhere | None, str | None]
"""A step in plain data: its label, its index among the steps of that label, its observation and its digest."""


def _steps(data: Any) -> list[_Said]:
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise ValueError(f"this is no trace: it should be an object with 'schema': '{SCHEMA}'")
    steps = data.get("steps")
    if not isinstance(steps, list) or len(steps) > MOST_STEPS:
        raise ValueError(f"this is no trace: 'steps' should be a list of at most {MOST_STEPS:,} steps")
    return [_step(number, step) for number, step in enumerate(steps, 1)]


def _loop(data: Any) -> int | None:
    loop: int | None = data.get("loop")
    whole = isinstance(loop, int) and not isinstance(loop, bool)
    if loop is not None and not (whole and 0 <= loop <= len(data["steps"])):
        raise ValueError("this is no trace: 'loop' should be the number of one of its configurations")
    return loop


def _step(number: int, step: Any) -> _Said:
    label, choice = (step.get("label"), step.get("choice", 0)) if isinstance(step, dict) else (None, None)
    if not isinstance(label, str) or isinstance(choice, bool) or not isinstance(choice, int) or choice < 0:
        raise ValueError(f"step {number} should have a 'label' (a text) and a 'choice' (a number from 0)")
    try:
        sight = sight_of(step["observed"]) if "observed" in step else None
    except ValueError as error:
        raise ValueError(f"step {number}: {error}") from error
    wrote = step.get("digest")
    return label, choice, sight, wrote if isinstance(wrote, str) else None
