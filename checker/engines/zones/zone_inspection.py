"""The findings of inspections over the configurations reachable in time, by surveys and by the clocks of zones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache, partial
from itertools import chain, combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from checker.engines.contract import Inspect
from checker.engines.fast.model.learner import TransitionGroup
from checker.engines.fast.survey.row_inspection import (
    ALL,
    are_independent,
    collect,
    inspect_fast,
    of_pairs,
    of_rows,
    together,
)
from checker.engines.timed.answers import shown_to, without_sayings
from checker.engines.timed.zone_answers import ZoneTimes
from checker.engines.zones.questions import (
    about_step,
    between,
    controls_of,
    is_failing,
    left_to_run,
    passed_over,
)
from checker.properties.findings import Key
from checker.properties.inspections import DeadlockFreedom, InTime
from checker.properties.races import ControlRaces, StaleObservationRaces
from checker.properties.visited_statements import COMPUTING, Visited
from semantics.races.monitor import CONTROLS
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.successors import served

Tally = tuple[Key | None, int, int]


def inspect_zones(times: ZoneTimes, inspections: Iterable[Inspect]) -> None:
    """Give each inspection its findings over all configurations that are reachable in time."""
    for each in inspections:
        match each:
            case Visited():
                _look_at_visited(times, each)
            case ControlRaces():
                _look_at_races(times, each)
            case StaleObservationRaces():
                _look_at_served(times, each)
            case DeadlockFreedom():
                _look_at_deadlocks(times, each)
            case _:
                inspect_fast(times.survey(shown_to(each)), [each])


def _look_at_deadlocks(times: ZoneTimes, inspection: DeadlockFreedom) -> None:
    """Collect deadlocks; a message that may have expired doesn't prevent one."""
    tallies = [
        tally
        for late, places in times.late_sayings
        for tally in together(times.survey().among(places), inspection, partial(without_sayings, late))
    ]
    collect(times.survey(), inspection, tallies, lambda: DeadlockFreedom(ALL))


# --- races ----------------------------------------------------------------------------------------------------


def _look_at_races(times: ZoneTimes, inspection: ControlRaces) -> None:
    """Collect races of controls that may be served at the same moment."""
    survey = times.survey(InTime.TOGETHER)
    unordered = survey.learner.setting.scheduler is Scheduler.UNORDERED
    independent = cache(partial(are_independent, survey))
    agents = survey.agents()
    trees = {a: survey.of_actor(TransitionGroup(served, a)) for a in agents}
    due = {a: list(_due(times, a)) for a in agents}
    tallies: list[Tally] = []
    for a, b in combinations_with_replacement(agents, 2):
        if a == b and not unordered:
            continue  # its controls are served in order
        for one, first in enumerate(due[a]):
            for other, second in enumerate(due[b]):
                if a == b and other <= one:
                    continue
                places = np.unique(times.places[first & second])
                if not len(places):
                    continue
                asked = survey.learner.question(partial(between, inspection, (a, one), (b, other)))
                leaves = survey.classify(trees[a], places), survey.classify(trees[b], places)
                tallies += of_pairs(
                    survey, asked, places, leaves, lambda *both: not unordered and independent(*both)
                )
    collect(survey, inspection, tallies, lambda: ControlRaces(ALL))


def _due(times: ZoneTimes, a: Name) -> Iterator[NDArray[np.bool_]]:
    """Yield, rank by rank, the zones in which an agent's control may be served, regardless of turns."""
    answers, several = times.survey().answered(partial(controls_of, a))
    answers_of_zones = answers[times.places]
    for rank in range(max(map(len, several), default=0)):
        due = np.zeros(len(times.places), np.bool_)
        for number, controls in enumerate(several):
            if rank < len(controls):
                zones = np.flatnonzero(answers_of_zones == number)
                due[zones] = times.is_due(zones, *controls[rank])
        yield due


def _look_at_served(times: ZoneTimes, inspection: StaleObservationRaces) -> None:
    """Collect stale observations behind the controls that are served at some time."""
    survey, learner = times.survey(InTime.TAKEN), times.network.learner
    found: dict[tuple[Name, int], list[NDArray[np.int64]]] = {}
    for step, places in times.taken_steps():
        label = learner.steps[step]
        if label.rule in CONTROLS and label.agent is not None:
            found.setdefault((label.agent, learner.leaves.rank_of(step)), []).append(places)
    tallies = [
        tally
        for (a, rank), several in sorted(found.items())
        for asked in [learner.question(partial(about_step, inspection, a, rank))]
        for tally in of_rows(survey, asked, np.sort(np.concatenate(several)))
    ]
    collect(survey, inspection, tallies, lambda: StaleObservationRaces(ALL))


# --- coverage -------------------------------------------------------------------------------------------------


def _look_at_visited(times: ZoneTimes, inspection: Visited) -> None:
    """Collect the remaining code of agents, the executed statements and branches, and the events, all in time."""
    survey, learner = times.survey(), times.network.learner
    computing: dict[Name, list[NDArray[np.int64]]] = {}
    for step, places in times.taken_steps():
        label = learner.steps[step]
        if label.agent is None:
            inspection.happened.add(str(label.about))
        elif label.rule in COMPUTING:
            computing.setdefault(label.agent, []).append(places)
    for a in survey.agents():
        codes = (each.value for each in survey.answers(partial(left_to_run, a)))
        inspection.codes |= {a: met} if (met := {code for code in codes if code is not None}) else {}
        failing = np.flatnonzero(survey.where(partial(is_failing, a)))
        moments = np.unique(np.concatenate((*computing.get(a, ()), failing)))
        passed = (each.value for each in survey.among(moments).answers(partial(passed_over, a)))
        inspection.passed |= set(chain.from_iterable(passed))
