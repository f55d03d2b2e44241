"""Traces: runs in the paper's notation, that replay step by step."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from checker.exploration import Exploration
from semantics.canonical import digest_of_step
from semantics.configuration import Configuration, Label, Transition
from semantics.monitor import monitored
from semantics.observed import Sight, steps_seen
from semantics.plain import sight_json, sight_of
from semantics.printing import print_changes
from semantics.successors import expand

SCHEMA = "bigactors.trace/1"
"""The version of the step schema: schema, mission, digest, monitored, and steps of label, choice and changes; steps
of live runs also say what was observed, when, and the digest of what they wrote."""

MOST_STEPS = 1_000_000


@dataclass(frozen=True, slots=True)
class Step:
    """One transition of a trace.

    Attributes:
        label: What it is called.
        choice: Which of the successors of that label was taken, from 0.
        target: The configuration after it.
        sight: What was observed, for a step that the world decided (live).
    """

    label: Label
    choice: int
    target: Configuration
    sight: Sight | None = None


@dataclass(frozen=True, slots=True)
class Trace:
    """A run from the initial configuration."""

    initial: Configuration
    steps: tuple[Step, ...] = ()

    def __len__(self) -> int:
        return len(self.steps)

    @property
    def configurations(self) -> tuple[Configuration, ...]:
        """c0, c1, ..."""
        return (self.initial, *(step.target for step in self.steps))

    def extended(self, transition: Transition) -> "Trace":
        """Return the trace with one more step."""
        source = self.configurations[-1]
        return Trace(self.initial, (*self.steps, step_of(source, transition.label, transition.target)))


def step_of(source: Configuration, label: Label, target: Configuration) -> Step:
    """Return the step between two configurations; labels that print alike are alike, as `replay` knows no more."""
    word = str(label)
    alike = [transition.target for transition in candidates(source) if str(transition.label) == word]
    return Step(label, alike.index(target), target)


def step_between(source: Configuration, target: Configuration) -> Step:
    """Return the first step from one configuration to another."""
    label = next(transition.label for transition in candidates(source) if transition.target == target)
    return step_of(source, label, target)


def candidates(source: Configuration) -> tuple[Transition, ...]:
    """Return what may follow: transitions in turn first."""
    expansion = expand(source)
    return expansion.transitions + expansion.out_of_turn


def trace_to(found: Exploration, number: int) -> Trace:
    """Return a shortest trace to a configuration of an exploration."""
    run = [found.configurations[each] for each in found.path(number)]
    return Trace(run[0], tuple(step_between(source, target) for source, target in pairwise(run)))


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
        _step_json(source, step) for step, source in zip(trace.steps, trace.configurations, strict=False)
    ]
    remembering = trace.initial.setting.monitored
    return {"schema": SCHEMA, "mission": mission, "digest": digest, "monitored": remembering, "steps": steps}


def _step_json(source: Configuration, step: Step) -> dict[str, Any]:
    observed = {} if step.sight is None else {"observed": sight_json(step.sight)}
    changes = list(print_changes(source, step.target))
    return {"label": str(step.label), "choice": step.choice, **observed, "changes": changes}


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
    for number, (label, choice, sight, wrote) in enumerate(steps, 1):
        found = candidates(at) if sight is None else tuple(steps_seen(at, sight))
        alike = [transition for transition in found if str(transition.label) == label]
        if choice >= len(alike):
            enabled = sorted({str(transition.label) for transition in found})
            raise ReplayError(number, label, enabled, _cause(len(alike)))
        before, at = at, alike[choice].target
        if wrote is not None and digest_of_step(before, at) != wrote:
            raise ReplayError(
                number, label, print_changes(before, at), "it leads to another configuration here"
            )
        trace.append(Step(alike[choice].label, choice, at, sight))
    return Trace(initial, tuple(trace))


def _cause(alike: int) -> str:
    if alike:
        return (
            f"it has {alike} successors here, fewer than the trace chose from; the mission may have changed"
        )
    return "the mission, its scheduler or its environment may have changed since the trace was written"


def _steps(data: Any) -> list[tuple[str, int, Sight | None, str | None]]:
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise ValueError(f"this is no trace: it should be an object with 'schema': '{SCHEMA}'")
    steps = data.get("steps")
    if not isinstance(steps, list) or len(steps) > MOST_STEPS:
        raise ValueError(f"this is no trace: 'steps' should be a list of at most {MOST_STEPS:,} steps")
    return [_step(number, step) for number, step in enumerate(steps, 1)]


def _step(number: int, step: Any) -> tuple[str, int, Sight | None, str | None]:
    label, choice = (step.get("label"), step.get("choice", 0)) if isinstance(step, dict) else (None, None)
    if not isinstance(label, str) or isinstance(choice, bool) or not isinstance(choice, int) or choice < 0:
        raise ValueError(f"step {number} should have a 'label' (a text) and a 'choice' (a number from 0)")
    try:
        sight = sight_of(step["observed"]) if "observed" in step else None
    except ValueError as error:
        raise ValueError(f"step {number}: {error}") from error
    wrote = step.get("digest")
    return label, choice, sight, wrote if isinstance(wrote, str) else None
