"""Traces: runs in the paper's notation, that replay step by step."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from checker.exploration import Exploration, Reducer
from semantics.configuration import Configuration, Label, Transition
from semantics.monitor import monitored
from semantics.printing import print_changes
from semantics.successors import expand

SCHEMA = "bigactors.trace/1"
"""The version of the step schema: schema, mission, digest, monitored, and steps of label, choice and changes."""

MOST_STEPS = 1_000_000


@dataclass(frozen=True, slots=True)
class Step:
    """One transition of a trace.

    Attributes:
        label: What it is called.
        choice: Which of the successors of that label was taken, from 0.
        target: The configuration after it.
    """

    label: Label
    choice: int
    target: Configuration


@dataclass(frozen=True, slots=True)
class Trace:
    """A run from the initial configuration.

    Attributes:
        initial: Where it begins.
        steps: Its steps.
        shortest: Whether no other run to its end is shorter; not known where steps were put off (`--reduce por`).
    """

    initial: Configuration
    steps: tuple[Step, ...] = ()
    shortest: bool = field(default=True, compare=False)

    @property
    def called(self) -> str:
        """What it is called in a report."""
        return "a shortest trace" if self.shortest else "a trace"

    def __len__(self) -> int:
        return len(self.steps)

    @property
    def configurations(self) -> tuple[Configuration, ...]:
        """c0, c1, ..."""
        return (self.initial, *(step.target for step in self.steps))

    def extended(self, transition: Transition) -> "Trace":
        """Return the trace with one more step."""
        source = self.configurations[-1]
        steps = (*self.steps, step_of(source, transition.label, transition.target))
        return Trace(self.initial, steps, self.shortest)


def step_of(source: Configuration, label: Label, target: Configuration) -> Step:
    """Return the step between two configurations; labels that print alike are alike, as `replay` knows no more."""
    word = str(label)
    alike = [transition.target for transition in candidates(source) if str(transition.label) == word]
    return Step(label, alike.index(target), target)


def candidates(source: Configuration) -> tuple[Transition, ...]:
    """Return what may follow: transitions in turn first."""
    expansion = expand(source)
    return expansion.transitions + expansion.out_of_turn


def trace_to(found: Exploration, number: int, by: Transition | None = None) -> Trace:
    """Return a trace to a configuration of an exploration: a shortest one, unless steps were put off."""
    if found.reducer is not None:
        return _unfolded(found, found.reducer, number, by)
    path = found.path(number)
    steps = []
    for source, target in pairwise(path):
        label = found.labels[target]
        assert label is not None
        steps.append(step_of(found.configurations[source], label, found.configurations[target]))
    trace = Trace(found.configurations[0], tuple(steps))
    return trace if by is None else trace.extended(by)


def _unfolded(found: Exploration, reducer: Reducer, number: int, by: Transition | None) -> Trace:
    """Return the run of the mission itself to what a configuration of a reduced exploration stands for."""
    initial = found.configurations[0] if found.start is None else found.start
    trace = Trace(initial, (), not reducer.putting_off)
    for transition in reducer.run_to(found, number, by):
        trace = trace.extended(transition)
    return trace


def print_trace(trace: Trace, *, changes: bool = True) -> Iterator[str]:
    """Print a trace in the paper's notation, with what changed under each step."""
    for number, (step, source) in enumerate(zip(trace.steps, trace.configurations, strict=False)):
        yield f"c{number} --{step.label}--> c{number + 1}"
        if changes:
            yield from (f"      {line}" for line in print_changes(source, step.target))


# --- replay ---------------------------------------------------------------------------------------------------


class ReplayError(Exception):
    """A trace that the rules do not allow.

    Attributes:
        step: The number of the step, from 1.
        enabled: What was enabled instead.
    """

    def __init__(self, step: int, label: str, enabled: Sequence[str], cause: str) -> None:
        instead = "\n".join(f"  {other}" for other in enabled) or "  nothing"
        super().__init__(f"step {step}: {label} is not enabled: {cause}\nenabled instead:\n{instead}")
        self.step = step
        self.enabled = tuple(enabled)


def to_json(trace: Trace, mission: str, digest: str) -> dict[str, Any]:
    """Return a trace as plain data, in the step schema."""
    steps = [
        {"label": str(step.label), "choice": step.choice, "changes": list(print_changes(source, step.target))}
        for step, source in zip(trace.steps, trace.configurations, strict=False)
    ]
    remembering = trace.initial.setting.monitored
    return {"schema": SCHEMA, "mission": mission, "digest": digest, "monitored": remembering, "steps": steps}


def replay(initial: Configuration, data: Any) -> Trace:
    """Return the trace that plain data describes, run again through the rules, with the monitor's memory if it had it.

    Raises:
        ReplayError: A step is not allowed.
        ValueError: The data are no trace.
    """
    steps = _steps(data)
    if data.get("monitored") is True and not initial.setting.monitored:
        initial = monitored(initial)
    trace: list[Step] = []
    at = initial
    for number, (label, choice) in enumerate(steps, 1):
        found = candidates(at)
        alike = [transition for transition in found if str(transition.label) == label]
        if choice >= len(alike):
            enabled = sorted({str(transition.label) for transition in found})
            raise ReplayError(number, label, enabled, _cause(len(alike)))
        at = alike[choice].target
        trace.append(Step(alike[choice].label, choice, at))
    return Trace(initial, tuple(trace))


def _cause(alike: int) -> str:
    if alike:
        return (
            f"it has {alike} successors here, fewer than the trace chose from; the mission may have changed"
        )
    return "the mission, its scheduler or its environment may have changed since the trace was written"


def _steps(data: Any) -> list[tuple[str, int]]:
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise ValueError(f"this is no trace: it should be an object with 'schema': '{SCHEMA}'")
    steps = data.get("steps")
    if not isinstance(steps, list) or len(steps) > MOST_STEPS:
        raise ValueError(f"this is no trace: 'steps' should be a list of at most {MOST_STEPS:,} steps")
    return [_step(number, step) for number, step in enumerate(steps, 1)]


def _step(number: int, step: Any) -> tuple[str, int]:
    label, choice = (step.get("label"), step.get("choice", 0)) if isinstance(step, dict) else (None, None)
    if not isinstance(label, str) or isinstance(choice, bool) or not isinstance(choice, int) or choice < 0:
        raise ValueError(f"step {number} should have a 'label' (a text) and a 'choice' (a number from 0)")
    return label, choice
