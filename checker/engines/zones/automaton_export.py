"""A mission's timed automaton for other model checkers: one process, or one for each process of local time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from checker.engines.timed.zone_answers import ZoneTimes
from checker.engines.zones.exported_process import ExportedProcess, ProcessWriter
from checker.engines.zones.local_automata import Division, LocalAutomaton, Wrong
from checker.engines.zones.local_states import LocalStates
from checker.engines.zones.observers import Observer
from checker.engines.zones.timed_automaton import TimedAutomaton
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property


class ExportedAutomaton(NamedTuple):
    """A network of timed automata.

    Attributes:
        name: The mission's name.
        asked: The property of `WRONG`.
        processes: Its processes.
        shared: The events of several processes, each with the numbers of its participants.
    """

    name: str
    asked: Property | None
    processes: tuple[ExportedProcess, ...]
    shared: tuple[tuple[str, tuple[int, ...]], ...] = ()


class AskedAutomaton(NamedTuple):
    """An automaton with the question of a property.

    Attributes:
        automaton: The mission's automaton, or that with a deadline's observer.
        first, ages: Its first location, and the clock values there.
        wrong: The clock constraints that violate the property in each location.
        observer: The observer; None without one.
    """

    automaton: TimedAutomaton
    first: int
    ages: tuple[int, ...]
    wrong: Wrong
    observer: Observer | None = None

    def behind(self, location: int) -> int:
        """Return the mission's location behind a location."""
        return location if self.observer is None else self.observer.spot(location).location


def model_of(
    times: ZoneTimes, asked: Property | None, name: str, *, divided: bool = False
) -> ExportedAutomaton:
    """Return a mission's automaton; with a deadline or an endurance, `WRONG` is reachable exactly if it is violated.

    If `divided`, it has a process for each one of local time, where that is possible.

    Raises:
        ValueError: The property is of another kind.
    """
    question = question_of(times, asked)
    subjects = (*times.network.clocks_of, None)  # the last one is an observer's
    division = division_of(times, question) if divided else None
    if division is not None:
        found = division.divided(question.first, question.ages, question.wrong)
        processes = (
            ProcessWriter(each, subjects, f"x{number}_", "e").process()
            for number, each in enumerate(found.processes)
        )
        shared = ((f"e{number}", takes) for number, takes in enumerate(found.events) if len(takes) > 1)
        return ExportedAutomaton(name, asked, tuple(processes), tuple(shared))

    def words(location: int, step: int) -> str:
        place = times.network.place(question.behind(location))
        return str(times.network.situation(place.number).steps[step].transition.label)

    whole = LocalAutomaton("mission", *question[:4])
    return ExportedAutomaton(name, asked, (ProcessWriter(whole, subjects, "x", "s", words).process(),))


def question_of(times: ZoneTimes, asked: Property | None) -> AskedAutomaton:
    """Return a mission's automaton with the question of a property.

    Raises:
        ValueError: The property is of another kind than deadlines and endurance.
    """
    network = times.network
    match None if asked is None else asked.kind:
        case None | PropertyKind.ENDURANCE:
            locations = times.reached.tolist() if asked else []
            wrong = {at: tuple(times.exhaustion(at).values()) for at in locations}
            return AskedAutomaton(network.automaton, network.first, network.first_ages, wrong)
        case PropertyKind.WITHIN:
            assert asked is not None
            observer = times.observer(asked)
            goals = ((at, observer.automaton.location(at).goal) for at in range(len(observer.automaton)))
            late = {at: [goal] for at, goal in goals if goal is not None}
            return AskedAutomaton(observer.automaton, 0, observer.first_ages(), late, observer)
        case _:
            raise ValueError("only deadlines and endurance are exported")


def division_of(times: ZoneTimes, question: AskedAutomaton) -> Division | None:
    """Return the division of an automaton among the processes of local time; None if it was not searched so."""
    network, observer = times.network, question.observer
    participants = network.participants if observer is None else observer.participants
    if participants is None or not times.search.is_local:
        return None
    if observer is None:
        states = LocalStates(network, participants, np.arange(len(network.automaton)))
        return Division(network.automaton, states, times.reached)
    states = LocalStates(
        network, participants, observer.locations.astype(np.int64), observer.watches.astype(np.int64)
    )
    return Division(observer.automaton, states, np.arange(len(observer.locations)))
