"""The three steps of a stale-observation race in a run: the sensing, the change of the answer, and the control.

Agents may ask the same question one after the other, and send each other their observations. So the run is replayed
with dated dependencies: each has the numbers of the step that sensed it and of the steps that changed it. The
dependencies of the last control give the three steps.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from checker.properties.race_steps import RaceSteps
from checker.properties.races import is_stale, used_slots
from checker.steps import Step, alike
from semantics.races.provenance import OTHERS, Dependency, Key, Mark
from semantics.state.agents import AgentProvenance
from semantics.state.cell_values import MONITOR
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class _Dated(Dependency):
    """A dependency with the steps that sensed and changed it.

    Attributes:
        sensed: The number of the step that sensed its observation.
        dates: For each mark the number of the step that changed it.
    """

    sensed: int = 0
    dates: tuple[tuple[Mark, int], ...] = ()


def stale_steps(initial: Configuration, steps: Sequence[Step]) -> RaceSteps | None:
    """Return the three steps of the race that ends a monitored run; None if it does not end in a race."""
    if not steps or not initial.setting.monitored or not isinstance(steps[-1].label.about, CTR | FLY):
        return None
    run = (initial, *(step.target for step in steps[:-1]))
    before, request = _dated_end(run, steps), steps[-1].label.about
    if before is None:
        return None
    for pending in before.eta.in_line(request.agent):
        stale = is_stale(before, pending) if pending.request == request else ()
        if stale:
            used = used_slots(before, pending)
            found = [(each.sensed, _changed(each, used)) for each in _the_same(stale)]
            return RaceSteps(*max(found), len(steps))
    return None


def _the_same(stale: Sequence[Dependency]) -> Iterator[_Dated]:
    """Yield the first dependency, the one in reports, once for each time that it was sensed."""
    for each in stale:
        if isinstance(each, _Dated) and _plain(each) == _plain(stale[0]):
            yield each


def _changed(stale: _Dated, used: frozenset[Key]) -> int:
    """Return the first step that made a dependency stale."""
    return min(
        date
        for (key, author), date in stale.dates
        if key in used or (key == stale.asked and author == OTHERS)
    )


# --- the replayed run -----------------------------------------------------------------------------------------


def _dated_end(run: Sequence[Configuration], steps: Sequence[Step]) -> Configuration | None:
    """Return the end of a run in which each dependency has its dates."""
    at, actor = run[0], steps[-1].label.agent
    for number, (step, (_, target)) in enumerate(zip(steps, pairwise(run), strict=False), 1):
        taken = alike(at, str(step.label), step.sight)
        after = next((each.target for each in taken if _is_plainly(each.target, target)), None)
        if after is None:
            return None
        at = _dated(at, after, number, actor)
    return at


def _is_plainly(dated: Configuration, plain: Configuration) -> bool:
    """Return whether two configurations are equal apart from dates."""
    cells = dated.state.changed(plain.state)
    return all(
        cell[0] == MONITOR and _mapped(dated.state.read(cell), _plain) == plain.state.read(cell)
        for cell in cells
    )


def _dated(before: Configuration, after: Configuration, number: int, actor: Name | None) -> Configuration:
    """Return the configuration after a step, with this step's date on the dependencies that it sensed or changed."""
    cells = [cell for cell in after.state.changed(before.state) if cell[0] == MONITOR]
    return after.with_(
        {cell: _mapped(after.state.read(cell), lambda each: _dating(each, number, actor)) for cell in cells}
    )


def _dating(each: Dependency, number: int, actor: Name | None) -> Dependency:
    if not isinstance(each, _Dated):
        return _Dated(each.query, each.steps, each.changed, each.asked, each.computed, number)
    known = dict(each.dates)
    gone = {mark: date for mark, date in known.items() if mark not in each.changed and mark[1] != actor}
    return replace(each, dates=tuple((mark, _date(mark, known, gone, number)) for mark in each.changed))


def _date(mark: Mark, known: dict[Mark, int], gone: dict[Mark, int], number: int) -> int:
    """Return the date of a mark; a mark that replaces other agents' marks takes over their oldest date.

    Marks of the actor itself do not count: its own changes make none of its controls stale.
    """
    if mark in known:
        return known[mark]
    return min((date for (key, _), date in gone.items() if key == mark[0]), default=number)


def _plain(each: Dependency) -> Dependency:
    return Dependency(each.query, each.steps, each.changed, each.asked, each.computed)


def _mapped(remembered: Any, change: Callable[[Dependency], Dependency]) -> Any:
    """Return a monitor cell's value with each dependency in it changed."""
    if isinstance(remembered, Dependency):
        return change(remembered)
    if isinstance(remembered, AgentProvenance):
        parts = ("code", "store", "mailbox", "host")
        return replace(remembered, **{part: _mapped(getattr(remembered, part), change) for part in parts})
    if isinstance(remembered, tuple | frozenset):
        return type(remembered)(_mapped(each, change) for each in remembered)
    return remembered
