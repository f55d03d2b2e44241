"""The value of each property in one configuration."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any, Final

from checker.check import BY_LOOKING
from checker.properties.findings import Collected, Finding
from checker.properties.inspections import Inspection, Invariant
from checker.properties.races import STALE, ControlRaces, StaleObservationRaces
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import holds
from semantics.state.configuration import Configuration, Transition
from semantics.successors import Expansion

if TYPE_CHECKING:
    from bigactors.commands.simulate.one_run import Choice


STANDARD: Final = frozenset({PropertyKind.RACE_FREEDOM, *BY_LOOKING})
"""The properties without a proposition of the mission's own."""


@dataclass(frozen=True, slots=True)
class Visit:
    """One configuration of a run.

    Attributes:
        c: The configuration.
        expansion: Its transitions.
        choices: The steps that may be taken, with times the intervals in which they may be.
        raced: Whether the last step to it was the last one of a stale-observation race.
    """

    c: Configuration
    expansion: Expansion
    choices: Sequence[Choice]
    raced: bool


def values_here(properties: Sequence[Property], here: Visit) -> list[dict[str, Any]]:
    """Return for each property whether it is true here, in words, and whether that is bad; None if it is about runs."""
    found = []
    for each in properties:
        value, words, bad = _value(each, here)
        said: dict[str, Any] = {"name": each.name, "kind": each.kind.value, "formula": each.written}
        found.append(said | {"value": value, "words": words, "bad": bad})
    return found


def _value(asked: Property, here: Visit) -> tuple[bool | None, str, bool]:
    if asked.is_of_runs or asked.kind is PropertyKind.ENDURANCE:
        return None, "about whole runs", False
    wrong = wrong_here(asked, here)
    if asked.kind in STANDARD:
        return not wrong, wrong[0].message if wrong else "nothing against it here", bool(wrong)
    value = holds(asked.formula, here.c)
    return value, "true here" if value else "not true here", bool(wrong)


def wrong_here(asked: Property, here: Visit) -> list[Finding]:
    """Return what contradicts a property in a configuration; nothing for a property of whole runs."""
    if asked.is_of_runs:
        return []
    if asked.kind is PropertyKind.RACE_FREEDOM:
        last = [Finding(STALE, "the last step was a stale-observation race", 0)] if here.raced else []
        return [*last, *_first(_races(here))]
    if asked.kind in BY_LOOKING:
        inspection: Inspection = BY_LOOKING[asked.kind](1)
    elif asked.kind is PropertyKind.INVARIANT:
        inspection = Invariant(asked.formula, asked.shown, 1)
    else:
        return []
    inspection(0, here.c, here.expansion)
    return _first([inspection.collected])


def _first(found: Sequence[Collected]) -> list[Finding]:
    return [finding for each in found for finding in each.first.values()]


def _races(here: Visit) -> list[Collected]:
    controls, stale = ControlRaces(1), StaleObservationRaces(1)
    for enabled in _together(here):
        controls(0, here.c, Expansion(enabled, ()))
    labels = {each.transition.label for each in here.choices}
    taken = tuple(each for each in here.expansion.by_agents if each.label in labels)
    if here.c.setting.monitored:
        stale(0, here.c, Expansion(taken, ()))
    return [controls.collected, stale.collected]


def _together(here: Visit) -> Iterator[tuple[Transition, ...]]:
    """Yield the steps that may be taken at one moment: with times, the pairs whose intervals overlap."""
    if here.c.setting.timing is None:
        yield here.expansion.enabled
        return
    for one, other in combinations(here.choices, 2):
        begin = max(one.earliest or 0, other.earliest or 0)
        if all(each.latest is None or begin <= each.latest for each in (one, other)):
            yield one.transition, other.transition
