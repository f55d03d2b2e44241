"""Exchanges in missions with times: equal constants, and the clocks that go along with their owners."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from checker.reduction.alpha_equivalence import Unlike
from checker.reduction.configuration_renaming import Renaming
from semantics.environment import Appears, Clause, Says, Vanishes
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.timing.actor_clocks import ActorClock, Sort
from semantics.timing.timing import Endurance, Timing

OF_CLAUSES = frozenset({Sort.EVERY, Sort.WINDOW, Sort.RETURNS})
"""The clocks whose owner is a clause of the environment, by its number."""


def check_times(c: Configuration, renaming: Renaming) -> None:
    """Look whether a renaming preserves all times of a mission.

    Raises:
        Unlike: It changes one of them, or the order of names may decide about a time.
    """
    timing = c.setting.timing
    if timing is None:
        return
    for one, other in renaming.names.items():
        if timing.motion(one) != timing.motion(other):
            raise Unlike("their speeds differ")
        if one in dict(timing.commands):
            raise Unlike(f"a duration is given for '{one}'")
    _check_endurances(timing, renaming)
    for number, image in enumerate(images_of_clauses(c.setting.environment, renaming)):
        if timing.clause(number) != timing.clause(image):
            raise Unlike("the times of their events differ")
    again = sorted(_reappearing(c.setting))
    if again and any(name in c.alpha for name in renaming.names):
        raise Unlike(
            f"'{again[0]}' may vanish in flight and appear: of two flights of it one is taken by name"
        )


def _check_endurances(timing: Timing, renaming: Renaming) -> None:
    lasting = dict(timing.endurances)
    for vehicle in (*lasting, *(before for before, after in renaming.names.items() if after in lasting)):
        endurance = lasting.get(vehicle)
        image = None if endurance is None else _renamed_endurance(endurance, renaming)
        if image != lasting.get(renaming.name(vehicle)):
            raise Unlike("their endurances differ")


def _renamed_endurance(endurance: Endurance, renaming: Renaming) -> Endurance:
    return replace(endurance, places=tuple(sorted(map(renaming.name, endurance.places))))


def _reappearing(setting: Setting) -> set[Name]:
    """Return the vehicles that may vanish and appear again, so that an old flight of theirs is still pending."""
    vanishing = {each.entity for each in setting.environment if isinstance(each, Vanishes)}
    return {
        each.entity for each in setting.environment if isinstance(each, Appears) and each.entity in vanishing
    }


def images_of_clauses(clauses: Sequence[Clause], renaming: Renaming) -> tuple[int, ...]:
    """Return the number of each clause's image; the first of equal clauses becomes the first of equal images."""
    places: dict[Any, deque[int]] = {}
    for number, clause in enumerate(clauses):
        known = clause.counter if isinstance(clause, Says) else clause
        places.setdefault(known, deque()).append(number)
    return tuple(places[_image(each, renaming)].popleft() for each in clauses)


def _image(clause: Clause, renaming: Renaming) -> Any:
    return renaming.cell(clause.counter) if isinstance(clause, Says) else renaming.value(clause)


def renamed_clock(clock: ActorClock, renaming: Renaming, clauses: Sequence[Clause]) -> ActorClock:
    """Return the image of a clock: it belongs to the image of its owner."""
    if clock.sort in OF_CLAUSES:
        assert isinstance(clock.of, int)
        return clock._replace(of=images_of_clauses(clauses, renaming)[clock.of])
    return clock._replace(of=renaming.value(clock.of))
