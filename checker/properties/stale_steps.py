"""Find the three steps of a stale-observation race in a run: who sensed, who changed the answer, who acted on it.

Agents may ask the same of the world one after the other, and tell each other what they have seen. So the run is taken
once more, with dependencies that know which step sensed them and which steps changed them; those that the last control
rests on tell.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from checker.properties.race_steps import RaceSteps
from checker.properties.races import is_stale, used_slots
from checker.steps import Step, alike
from semantics.races.provenance import OTHERS, Dependency, Key, Mark
from semantics.state.agents import Watch
from semantics.state.cells import MONITOR
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class _Dated(Dependency):
    """A dependency with the steps that made it what it is.

    Attributes:
        sensed: The number of the step that sensed its observation.
        dates: For each mark the number of the step that changed it.
    """

    sensed: int = 0
    dates: tuple[tuple[Mark, int], ...] = ()


def stale_steps(initial: Configuration, steps: Sequence[Step]) -> RaceSteps | None:
    """Return the three steps of the race that a monitored run ends in; None where it ends in none."""
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
    """Yield the first dependency, which a report names, as often as it was sensed."""
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


# --- the run, taken again -------------------------------------------------------------------------------------


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
    """Tell whether a configuration is another one, apart from dates."""
    cells = dated.state.changed(plain.state)
    return all(
        cell[0] == MONITOR and _mapped(dated.state.read(cell), _plain) == plain.state.read(cell)
        for cell in cells
    )


def _dated(before: Configuration, after: Configuration, number: int, actor: Name | None) -> Configuration:
    """Return the configuration after a step, with the dates of what the step sensed and changed."""
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
    """Return when something was changed; a mark in the place of those of others is as old as they are.

    What the actor itself has changed makes nothing stale that it does.
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
    if isinstance(remembered, Watch):
        parts = ("code", "store", "mailbox", "host")
        return replace(remembered, **{part: _mapped(getattr(remembered, part), change) for part in parts})
    if isinstance(remembered, tuple | frozenset):
        return type(remembered)(_mapped(each, change) for each in remembered)
    return remembered
