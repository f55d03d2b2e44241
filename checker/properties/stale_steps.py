"""Find the three steps of a stale-observation race in a run: who sensed, who changed the answer, who acted on it.

Agents may ask the same of the world one after the other, and tell each other what they have seen. So the run is taken
once more with an observation that knows its own step, and what the last control rests on says where it was sensed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from checker.properties.race_steps import RaceSteps
from checker.properties.races import is_stale, used_slots
from checker.steps import Step, alike
from semantics.behaviours.queries import resolve
from semantics.races.monitor import CONTROLS, asked_again
from semantics.races.provenance import Dependency, Key
from semantics.state.agents import Watch
from semantics.state.cells import MONITOR
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY


@dataclass(frozen=True, slots=True)
class _Sensed(Dependency):
    """What rests on an observation, with the number of the step that sensed it."""

    step: int = 0


def stale_steps(initial: Configuration, steps: Sequence[Step]) -> RaceSteps | None:
    """Return the three steps of the race that a monitored run ends in; None where it ends in none."""
    if not steps or not initial.setting.monitored or not isinstance(steps[-1].label.about, CTR | FLY):
        return None
    run = (initial, *(step.target for step in steps))
    before, request = _traced(run[:-1], steps), steps[-1].label.about
    for pending in () if before is None else before.eta.in_line(request.agent):
        stale = is_stale(before, pending) if before is not None and pending.request == request else ()
        if stale:
            keys = used_slots(before, pending) | {each for each in [stale[0].asked] if each is not None}
            sensed = max(each.step for each in stale if isinstance(each, _Sensed) and _is_one(each, stale[0]))
            changed = _changed(run, steps, sensed, keys)
            return None if changed is None else RaceSteps(sensed, changed, len(steps))
    return None


def _is_one(one: Dependency, other: Dependency) -> bool:
    return _plain(one) == _plain(other)


def _changed(
    run: Sequence[Configuration], steps: Sequence[Step], sensed: int, keys: frozenset[Key]
) -> int | None:
    """Return the first step after the look by which another agent's control has changed its answer."""
    about, before = steps[sensed - 1].label.about, run[sensed - 1]
    looked = resolve(about.query, before.structure.physical, before.alpha)
    for number in range(sensed + 1, len(steps)):
        label = steps[number - 1].label
        again = asked_again(run[number - 1], run[number], looked, keys)
        if label.rule in CONTROLS and label.agent != steps[-1].label.agent:
            if again.changed & keys:
                return number
            looked = again.steps
    return None


# --- the run, taken again -------------------------------------------------------------------------------------


def _traced(run: Sequence[Configuration], steps: Sequence[Step]) -> Configuration | None:
    """Return the end of a run in which everything that rests on an observation knows the step that sensed it."""
    at = run[0]
    for number, (step, (_, target)) in enumerate(zip(steps, pairwise(run), strict=False), 1):
        taken = alike(at, str(step.label), step.sight)
        after = next((each.target for each in taken if _is_plainly(each.target, target)), None)
        if after is None:
            return None
        at = _sensing(at, after, number) if step.label.rule == "sense" else after
    return at


def _is_plainly(traced: Configuration, plain: Configuration) -> bool:
    """Tell whether a configuration is another one, apart from what observations know of their steps."""
    cells = traced.state.changed(plain.state)
    return all(
        cell[0] == MONITOR and _mapped(traced.state.read(cell), _plain) == plain.state.read(cell)
        for cell in cells
    )


def _sensing(before: Configuration, after: Configuration, number: int) -> Configuration:
    """Return the configuration after a look, whose observation knows the number of its step."""

    def numbered(each: Dependency) -> Dependency:
        fresh = not isinstance(each, _Sensed)
        return (
            _Sensed(each.query, each.steps, each.changed, each.asked, each.computed, number)
            if fresh
            else each
        )

    cells = [cell for cell in after.state.changed(before.state) if cell[0] == MONITOR]
    return after.with_({cell: _mapped(after.state.read(cell), numbered) for cell in cells})


def _plain(each: Dependency) -> Dependency:
    return Dependency(each.query, each.steps, each.changed, each.asked, each.computed)


def _mapped(remembered: Any, change: Callable[[Dependency], Dependency]) -> Any:
    """Return a monitor cell's value with each dependency in it changed."""
    if isinstance(remembered, Dependency):
        return change(remembered)
    if isinstance(remembered, Watch):
        parts = ("code", "store", "mailbox", "host")
        return replace(remembered, **{part: _mapped(getattr(remembered, part), change) for part in parts})
    if isinstance(remembered, tuple | frozenset):
        return type(remembered)(_mapped(each, change) for each in remembered)
    return remembered
