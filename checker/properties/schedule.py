"""The schedule of a mission: the durations and dates of its flights, and the first moments of its `time` properties."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from checker.engines.timed.answers import NO_SPAN, TakenStep, Times, VehicleFlight
from semantics.behaviours.reaction_rules import moved
from semantics.state.configuration import Configuration
from semantics.state.requests import FLY, SND
from semantics.state.signature import REGION, Name
from semantics.timing.bounds import WrittenBound, bound_of_flight, timed_by
from semantics.timing.clocks import TimedStep, TimedView
from semantics.timing.dates import clock_text
from semantics.timing.flight_history import travelling
from semantics.timing.intervals import ANY_TIME, Interval


@dataclass(frozen=True, slots=True)
class EventDates:
    """The dates of an event, in ticks from the start.

    Attributes:
        earliest: The earliest; infinite if it never happens.
        latest: The latest; infinite if nothing bounds it.
        may_never: Whether there is a run in which it never happens.
    """

    earliest: float
    latest: float
    may_never: bool = False

    @property
    def is_never(self) -> bool:
        """Whether it happens in no run."""
        return math.isinf(self.earliest)


@dataclass(frozen=True, slots=True)
class PossibleFlight:
    """A possible flight of a mission: of one vehicle, by one request, from one place to another.

    Attributes:
        vehicle: The vehicle.
        agent: The requesting agent.
        origin: The place in which L has the vehicle at the start.
        destination: The place in which it ends.
        takes: Its duration, in ticks.
        begins: The dates of its start.
        ends: The dates of its end; never if its arrival isn't known.
        bound: The origin of its duration in the mission.
    """

    vehicle: Name
    agent: Name
    origin: Name
    destination: Name
    takes: Interval
    begins: EventDates
    ends: EventDates
    bound: WrittenBound


@dataclass(frozen=True, slots=True)
class MessageDates:
    """The dates of a message from one agent to another: its duration, its sending and its arrival."""

    agent: Name
    to: Name
    takes: Interval
    begins: EventDates
    ends: EventDates


@dataclass(frozen=True, slots=True)
class Milestone:
    """The first moments of a `time` property's proposition."""

    name: str
    moments: EventDates


@dataclass(frozen=True, slots=True)
class Schedule:
    """The times of a mission over all of its runs.

    Attributes:
        tick: Milliseconds of a tick.
        flights: The possible flights, in the order of their first starts.
        milestones: The first moments of the propositions of its `time` properties.
        complete: Whether everything was explored; else the latest moments are unknown.
        messages: The messages between agents, in the order of their first sendings.
    """

    tick: int
    flights: tuple[PossibleFlight, ...] = ()
    milestones: tuple[Milestone, ...] = ()
    complete: bool = True
    messages: tuple[MessageDates, ...] = ()

    def seconds(self, ticks: float | None) -> float | None:
        """Return ticks in seconds, None where nothing bounds them."""
        return None if ticks is None or math.isinf(ticks) else ticks * self.tick / 1000

    def clock(self, ticks: float) -> str:
        """Return a moment as text; empty if it is unbounded."""
        return "" if math.isinf(ticks) else clock_text(int(ticks) * self.tick)


_Key = tuple[Name, Name, Name, Name]
"""Vehicle, agent, origin, destination."""


def flights_of(times: Times) -> tuple[PossibleFlight, ...]:
    """Return the flights that are made in time, in the order of their first starts."""
    begun: dict[_Key, set[TakenStep]] = {}
    ended: dict[_Key, set[TakenStep]] = {}
    set_out: dict[tuple[FLY, Name], dict[_Key, None]] = {}
    said: dict[_Key, tuple[Interval, WrittenBound]] = {}
    for at, situation, fly in _steps_of_flights(times, "command"):
        for flight in _each(times, situation.c, fly):
            key = _key(flight)
            begun.setdefault(key, set()).add(at)
            set_out.setdefault((flight.request, flight.vehicle), {})[key] = None
    for at, situation, fly in _steps_of_flights(times, "commit"):
        interval = timed_by(situation, situation.steps[at.step]).interval
        for flight in _each(times, situation.c, fly):
            bound = bound_of_flight(situation.c.setting, flight.travelling)
            for key in _begun_as(_key(flight), set_out.get((flight.request, flight.vehicle), ())):
                ended.setdefault(key, set()).add(at)
                said[key] = _both(said.get(key, (interval, bound))[0], interval), bound
    spans = times.spans([*begun.values(), *ended.values()])
    begins = dict(zip(begun, spans, strict=False))
    ends = dict(zip(ended, spans[len(begun) :], strict=True))
    found = [
        PossibleFlight(
            *key,
            said.get(key, (ANY_TIME,))[0],
            EventDates(*begins.get(key, NO_SPAN)),
            EventDates(*ends.get(key, NO_SPAN)),
            said.get(key, (ANY_TIME, WrittenBound()))[1],
        )
        for key in dict.fromkeys((*begun, *ended))
    ]
    return tuple(sorted(found, key=lambda each: (each.begins.earliest, each.ends.earliest, *_key(each))))


def messages_of(times: Times) -> tuple[MessageDates, ...]:
    """Return the messages that are sent in time, in the order of their first sendings."""
    sent: dict[tuple[Name, Name], set[TakenStep]] = {}
    heard: dict[tuple[Name, Name], set[TakenStep]] = {}
    takes: dict[tuple[Name, Name], Interval] = {}
    for place, situation in enumerate(times.situations):
        for at in sorted(times.taken(place)):
            step = situation.steps[at]
            label, known = step.transition.label, situation.c.eta.all()
            if label.rule == "req_snd":
                new = (each.request for each in step.transition.target.eta.all() if each not in known)
                for request in (each for each in new if isinstance(each, SND)):
                    for key in times.alike((request.agent, request.to)):
                        sent.setdefault(key, set()).add(TakenStep(place, at))
            elif isinstance(label.about, SND):
                interval = timed_by(situation, step).interval
                for key in times.alike((label.about.agent, label.about.to)):
                    heard.setdefault(key, set()).add(TakenStep(place, at))
                    takes[key] = _both(takes.get(key, interval), interval)
    keys = [key for key in sent if key in heard]
    spans = times.spans([*(sent[key] for key in keys), *(heard[key] for key in keys)])
    dates = zip(keys, spans, spans[len(keys) :], strict=False)
    found = [
        MessageDates(*key, takes[key], EventDates(*begin), EventDates(*end)) for key, begin, end in dates
    ]
    return tuple(
        sorted(found, key=lambda each: (each.begins.earliest, each.ends.earliest, each.agent, each.to))
    )


def _key(flight: PossibleFlight | VehicleFlight) -> _Key:
    return flight.vehicle, flight.agent, flight.origin, flight.destination


def _steps_of_flights(times: Times, rule: str) -> Iterator[tuple[TakenStep, TimedView, FLY]]:
    """Yield the steps by a rule that are taken at some time, with the flights that they begin or end."""
    for place, situation in enumerate(times.situations):
        for at in sorted(times.taken(place)):
            step = situation.steps[at]
            fly = _flight_of(step)
            if fly is not None and step.transition.label.rule == rule:
                yield TakenStep(place, at), situation, fly


def _begun_as(arriving: _Key, set_out: Iterable[_Key]) -> list[_Key]:
    """Return the flights that may have this end; all begun ones if L has lost the origin meanwhile."""
    known = list(set_out)
    return [arriving] if arriving in known or not known else known


def _flight_of(step: TimedStep) -> FLY | None:
    """Return the flight that a step begins or ends."""
    label, target = step.transition.label, step.transition.target
    if label.rule == "command" and label.agent is not None:
        line = (pending.request for pending in target.eta.in_line(label.agent))
        return next((each for each in line if isinstance(each, FLY)), None)
    return label.about if label.rule == "commit" and isinstance(label.about, FLY) else None


def _each(times: Times, c: Configuration, fly: FLY) -> Iterator[VehicleFlight]:
    """Yield the flight of each vehicle, with the flights alike.

    L keeps a vehicle at its origin until an observation corrects it.
    """
    together = tuple(vehicle for vehicle, _ in travelling(c, fly))
    for vehicle, place in moved(fly.reaction, fly.match):
        origin = c.structure.logical.parent(vehicle) or REGION
        yield from times.alike(VehicleFlight(fly, together, vehicle, fly.agent, origin, place))


def _both(one: Interval, other: Interval) -> Interval:
    hi = None if one.hi is None or other.hi is None else max(one.hi, other.hi)
    return Interval(min(one.lo, other.lo), hi)
