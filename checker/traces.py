"""Traces: runs in the paper's notation, that replay step by step."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from checker.engines.contract import Exploration
from checker.properties.inspections import is_unfair
from checker.reduction.unfolding import run_to
from physical.messages import counted
from semantics.observed_steps import Sight, steps_seen
from semantics.races.monitor import monitored
from semantics.state.brief import cut
from semantics.state.canonical import digest_of_step
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.observation_serialization import sight_json, sight_of
from semantics.state.partition import Elsewhere
from semantics.state.printing import print_changes
from semantics.state.requests import Received
from semantics.successors import expand

SCHEMA = "bigactors.trace/1"
"""The version of the step schema: schema, mission, digest, monitored, steps of label, choice and changes, and loop;
steps of live runs also say what was observed, when, and the digest of what they wrote."""

MOST_STEPS = 1_000_000


@dataclass(frozen=True, slots=True)
class Step:
    """One transition of a trace.

    Attributes:
        label: Its label.
        choice: The index of the chosen successor among those with that label.
        target: The configuration after it.
        sight: The observation, for a step that the world decided (live).
    """

    label: Label
    choice: int
    target: Configuration
    sight: Sight | Elsewhere | None = None

    def __repr__(self) -> str:
        return f"<Step {cut(self.label)}>"


@dataclass(frozen=True, slots=True)
class Trace:
    """A run from the initial configuration.

    Attributes:
        initial: The first configuration.
        steps: Its steps.
        loop: The number of the configuration from which the run repeats for ever: the last is the same. If it is the
            last itself, nothing has to happen there, and the run stays. None where the run is not for ever.
        shortest: Whether it is certain that no other run that shows the same is shorter: not where steps were put
            off (`--reduce por`), nor where to find out would take too long.
    """

    initial: Configuration
    steps: tuple[Step, ...] = ()
    loop: int | None = None
    shortest: bool = field(default=True, compare=False)

    @property
    def called(self) -> str:
        """What it is called in a report."""
        return "a shortest trace" if self.shortest else "a trace"

    def __len__(self) -> int:
        return len(self.steps)

    def __repr__(self) -> str:
        return f"<Trace {print_length(self)}>"

    def _repr_html_(self) -> str:
        from bigactors.notebook import trace_html  # noqa: PLC0415 - what notebooks show is built on values

        return trace_html(self)

    @property
    def configurations(self) -> tuple[Configuration, ...]:
        """c0, c1, ..."""
        return (self.initial, *(step.target for step in self.steps))

    def extended(self, transition: Transition) -> "Trace":
        """Return the trace with one more step."""
        source = self.configurations[-1]
        steps = (*self.steps, step_of(source, transition.label, transition.target))
        return Trace(self.initial, steps, shortest=self.shortest)


def step_of(source: Configuration, label: Label, target: Configuration) -> Step:
    """Return the step between two configurations; labels that print alike are alike, as `replay` knows no more.

    What an observation is received without is looked up.
    """
    if isinstance(label.about, Received):
        same = (
            t.label for t in candidates(source) if t.target == target and isinstance(t.label.about, Received)
        )
        label = next(found for found in same if found.agent == label.agent)
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


def trace_to(found: Exploration, number: int, by: Transition | None = None) -> Trace:
    """Return a trace to a configuration of an exploration: a shortest one, unless steps were put off."""
    if found.reducer is not None:
        return _unfolded(found, number, by, shortest=not found.reducer.putting_off)
    run = [found.configurations[each] for each in found.path(number)]
    trace = Trace(run[0], tuple(step_between(source, target) for source, target in pairwise(run)))
    return trace if by is None else trace.extended(by)


def _unfolded(found: Exploration, number: int, by: Transition | None, *, shortest: bool) -> Trace:
    """Return the run of the mission itself to what a configuration of a reduced exploration stands for."""
    initial = found.configurations[0] if found.start is None else found.start
    trace = Trace(initial, (), shortest=shortest)
    for transition in run_to(found, number, by):
        trace = trace.extended(transition)
    return trace


def print_trace(trace: Trace, *, changes: bool = True) -> Iterator[str]:
    """Print a trace in the paper's notation, with what changed under each step."""
    for number, (step, source) in enumerate(zip(trace.steps, trace.configurations, strict=False)):
        yield f"c{number} --{step.label}--> c{number + 1}"
        if changes:
            yield from (f"      {line}" for line in print_changes(source, step.target))
    if trace.loop is not None:
        yield print_loop(trace)


def print_loop(trace: Trace) -> str:
    """Print where a run that goes on for ever comes round."""
    end = len(trace)
    if trace.loop == end:
        return f"c{end} stays for ever: nothing has to happen"
    return f"c{end} = c{trace.loop}: {_steps_of(end - (trace.loop or 0))} from there on, again and again"


def _steps_of(count: int) -> str:
    return "the step" if count == 1 else f"the {count:,} steps"


def print_length(trace: Trace) -> str:
    """Print what a trace is, and how long."""
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
    data = {"schema": SCHEMA, "mission": mission, "digest": digest, "monitored": remembering, "steps": steps}
    return data if trace.loop is None else data | {"loop": trace.loop}


def _step_json(source: Configuration, step: Step) -> dict[str, Any]:
    observed = {} if step.sight is None else {"observed": sight_json(step.sight)}
    changes = list(print_changes(source, step.target))
    return {"label": str(step.label), "choice": step.choice, **observed, "changes": changes}


def replay(initial: Configuration, data: Any) -> Trace:
    """Return the trace that plain data describes, run again through the rules, with the monitor's memory if it had it.

    Raises:
        ReplayError: A step is not allowed, or the run doesn't come round where it should.
        ValueError: The data are no trace.
    """
    steps, loop = _steps(data), _loop(data)
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
    return _closed(Trace(initial, tuple(trace), loop))


def _closed(trace: Trace) -> Trace:
    """Return a trace after a look at where it comes round."""
    if trace.loop is None:
        return trace
    last = trace.configurations[-1]
    expansion = expand(last)
    enabled = sorted({str(transition.label) for transition in expansion.transitions})
    if trace.loop == len(trace) and any(not is_unfair(last, each) for each in expansion.by_agents):
        raise ReplayError(len(trace), "staying for ever", enabled, "something has to be done")
    if last != trace.configurations[trace.loop]:
        raise ReplayError(
            len(trace), f"coming round to c{trace.loop}", enabled, "its last step leads elsewhere"
        )
    return trace


def _cause(alike: int) -> str:
    if alike:
        return (
            f"it has {alike} successors here, fewer than the trace chose from; the mission may have changed"
        )
    return "the mission, its scheduler or its environment may have changed since the trace was written"


def _steps(data: Any) -> list[tuple[str, int, Sight | Elsewhere | None, str | None]]:
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


def _step(number: int, step: Any) -> tuple[str, int, Sight | Elsewhere | None, str | None]:
    label, choice = (step.get("label"), step.get("choice", 0)) if isinstance(step, dict) else (None, None)
    if not isinstance(label, str) or isinstance(choice, bool) or not isinstance(choice, int) or choice < 0:
        raise ValueError(f"step {number} should have a 'label' (a text) and a 'choice' (a number from 0)")
    try:
        sight = sight_of(step["observed"]) if "observed" in step else None
    except ValueError as error:
        raise ValueError(f"step {number}: {error}") from error
    wrote = step.get("digest")
    return label, choice, sight, wrote if isinstance(wrote, str) else None
