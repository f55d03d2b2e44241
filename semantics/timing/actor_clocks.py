"""The clocks of actors: which of them run in a configuration, and which clocks guard each step.

An actor is a vehicle with an endurance, an agent's requests, an agent itself, or a clause of the environment. The
clocks of an actor are a pure function of the cells that it reads, so they can be learned as the rules are.
"""

import math
import re
from collections.abc import Collection, Hashable, Iterable, Iterator
from enum import IntEnum, auto
from typing import NamedTuple

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault
from semantics.behaviours.process_conversion import next_statement
from semantics.behaviours.statements import React
from semantics.bigactor_rules import channels_between
from semantics.environment import Drops, Leaves
from semantics.state.configuration import Configuration, Transition
from semantics.state.physical_model import InTransit
from semantics.state.requests import CTR, FLY, MGR, OBS, SND, Request
from semantics.state.signature import Name
from semantics.timing.flight_times import aim, interval_of_flight
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import ONE_HOST, Every, Sayable, Timing, Window


class Sort(IntEnum):
    """The measure of a clock."""

    MISSION = auto()
    """The time since the start."""
    EVERY = auto()
    """Since the last step of a clause with a least time between steps."""
    WINDOW = auto()
    """Not a time, but a flag of a clause with a window: enabled within it (`BOUND`), or no longer bound by it (`FREE`).
    """
    ALOFT = auto()
    """Since a vehicle left a place that restores it."""
    RESTORED = auto()
    """Since a vehicle came to a place that restores it."""
    REQUEST = auto()
    AGENT = auto()
    AFTER = auto()
    """Since an agent waits at a `react` with an `after`, and no case takes anything that has come."""
    FLIGHT = auto()
    """Since the `command` of a flight."""
    AIM = auto()
    """Since a flight can end, and its aim has not changed."""
    RETURNS = auto()
    """Since a dropped channel, or one that was left, may return."""


class ActorClock(NamedTuple):
    """A clock: its measure, and its owner."""

    sort: Sort
    of: Hashable = ""
    channel: Name = ""


BOUND, FREE = 1, 2
"""The values of a window's clock: the window binds the clause, or binds it no longer."""


class RunningClock(NamedTuple):
    """A clock that runs.

    Attributes:
        clock: The clock.
        interval: The bounds of the step that it times.
        aim: The targets of a flight; when they change, its clock restarts.
    """

    clock: ActorClock
    interval: Interval
    aim: Hashable = None


class Test(NamedTuple):
    """A bound on a clock: its age must lie in [least, most]."""

    clock: ActorClock
    least: int
    most: int | None = None


class StepClocks(NamedTuple):
    """The clocks of a step.

    Attributes:
        done: The clocks that the step resets.
        tests: The guards, of which one must hold; empty if the step is possible at any time.
    """

    done: tuple[ActorClock, ...]
    tests: tuple[Test, ...] = ()


class ActorClocks(NamedTuple):
    """The clocks of an actor.

    Attributes:
        running: The clocks that run; of equal ones the oldest is the first.
        steps: The clocks of each of its steps.
    """

    running: tuple[RunningClock, ...]
    steps: tuple[StepClocks, ...] = ()


def timing_of(c: Configuration) -> Timing:
    """Return a mission's timing; the mission must have a `timing` section."""
    timing = c.setting.timing
    assert timing is not None
    return timing


def lasting(timing: Timing) -> Iterator[RunningClock]:
    """Yield the clocks that run in every configuration: the mission's, and those of clauses."""
    steps = [each.step for each in timing.clauses]
    latest = [bound for step in steps if isinstance(step, Window | Sayable) for bound in _bounds_of(step)]
    if latest:
        yield RunningClock(ActorClock(Sort.MISSION), Interval(max(latest)))
    for number, step in enumerate(steps):
        if isinstance(step, Every):
            yield RunningClock(ActorClock(Sort.EVERY, number), Interval(step.least))
        elif isinstance(step, Window):
            yield RunningClock(ActorClock(Sort.WINDOW, number), Interval(FREE))


# --- vehicles -------------------------------------------------------------------------------------


def of_vehicle(c: Configuration, vehicle: Name) -> ActorClocks:
    """Return the clocks of a vehicle's endurance; RESTORED runs only at a place that restores it."""
    endurance = dict(timing_of(c).endurances)[vehicle]
    aloft = RunningClock(ActorClock(Sort.ALOFT, vehicle), Interval(endurance.lasts))
    restored = RunningClock(ActorClock(Sort.RESTORED, vehicle), Interval(endurance.after))
    return ActorClocks((aloft, restored) if is_restored(c, vehicle) else (aloft,))


def is_restored(c: Configuration, vehicle: Name) -> bool:
    """Whether a vehicle is at a place that restores it, or aboard a carrier that does, also on its way."""
    places = dict(timing_of(c).endurances)[vehicle].places
    return any(place in places for place in _around(c, vehicle))


def _around(c: Configuration, entity: Name) -> Iterator[Name]:
    """Yield the carriers and places around an entity in A(P), the innermost first; nothing is around a flight."""
    physical, seen = c.structure.physical, set[Name]()
    while entity in physical and not isinstance(physical.placement(entity), InTransit):
        entity = physical.abstract_parent(entity)
        if entity in seen or entity not in physical:
            return
        yield entity
        seen.add(entity)


# --- requests -------------------------------------------------------------------------------------


def of_requests(c: Configuration, a: Name, served: Iterable[Transition | Fault]) -> ActorClocks:
    """Return the clocks of an agent's requests that a rule can serve, regardless of turns, and of its flights."""
    steps = [each for each in served if isinstance(each, Transition)]
    enabled = _serving_rules(steps)
    pending = [each.request for each in c.eta.in_line(a) if each.request in enabled]
    running = [
        RunningClock(
            ActorClock(Sort.REQUEST, request, channel), _service(c, request, channel, enabled[request])
        )
        for request in pending
        if not isinstance(request, FLY)
        for channel in _channels(c, request)
    ]
    bounded = sorted((each for each in running if each.interval != ANY_TIME), key=running.index)
    found = (*bounded, *_flights(c, a, enabled))  # equal clocks are adjacent
    return ActorClocks(found, tuple(_of_request(c, each, found) for each in steps))


def _serving_rules(steps: Iterable[Transition]) -> dict[Request, frozenset[str]]:
    """Return the rules that would serve each request."""
    found: dict[Request, frozenset[str]] = {}
    for each in steps:
        if each.served is not None:
            found[each.served.request] = found.get(each.served.request, frozenset()) | {each.label.rule}
    return found


def _flights(c: Configuration, a: Name, enabled: Collection[Request]) -> Iterator[RunningClock]:
    for fly in dict.fromkeys(each.request for each in c.eta.own(a)):
        if isinstance(fly, FLY):
            interval = interval_of_flight(c, fly)
            if interval != ANY_TIME or timing_of(c).motions:
                yield RunningClock(ActorClock(Sort.FLIGHT, fly), Interval(interval.lo))
            if fly in enabled and interval.hi is not None:
                yield RunningClock(ActorClock(Sort.AIM, fly), Interval(0, interval.hi), aim(c, fly))


def _of_request(c: Configuration, step: Transition, running: Iterable[RunningClock]) -> StepClocks:
    assert step.served is not None
    request = step.served.request
    if isinstance(request, FLY):
        flight = ActorClock(Sort.FLIGHT, request)
        return StepClocks((flight, ActorClock(Sort.AIM, request)), _tests(running, [flight]))
    clocks = [ActorClock(Sort.REQUEST, request, channel) for channel in _channels(c, request)]
    return StepClocks(tuple(clocks), _tests(running, clocks))


def _tests(running: Iterable[RunningClock], clocks: list[ActorClock]) -> tuple[Test, ...]:
    """Return the lower bounds, of which one must hold; empty if some clock has no lower bound."""
    bounds = {each.clock: each.interval for each in running}
    tests = tuple(Test(clock, bounds.get(clock, ANY_TIME).lo) for clock in clocks)
    return tests if all(each.least for each in tests) else ()


def _channels(c: Configuration, request: Request) -> tuple[Name, ...]:
    if not isinstance(request, SND):
        return ("",)
    here, there = c.alpha.host(request.agent), c.alpha.host(request.to)
    return (ONE_HOST,) if here == there else tuple(channels_between(c, here, there))


def _service(c: Configuration, request: Request, channel: Name, rules: frozenset[str]) -> Interval:
    """Return the time until some rules serve a request; without a line in `timing` it is unbounded."""
    timing = timing_of(c)
    match request:
        case OBS():
            return timing.sense
        case SND():
            return timing.message(channel)
        case MGR():
            return timing.command("migrate") or ANY_TIME
        case CTR():
            taken_up = all(is_taken_up(request, rule) for rule in rules)
            return timing.command(word_of(request)) or (timing.react if taken_up else ANY_TIME)
        case _:
            return ANY_TIME


def is_taken_up(request: CTR, rule: str) -> bool:
    """Whether serving a control only takes it up, which takes the time of the agent's own steps (`react`).

    It does when a vehicle is sent on its way, or is already at its destination. Every other control takes effect when
    served, and `timing` has to give its duration.
    """
    command = COMMANDS.get(word_of(request))
    return rule == "command" or (command is not None and command.travels)


def word_of(request: CTR) -> str:
    """Return the word of a command, or the name of a rule.

    >>> import re
    >>> re.match(r"[A-Za-z_]+", "HAND uav0 TO gcs1").group()
    'HAND'
    """
    found = re.match(r"\w+", request.reaction.text)
    return found.group() if found else ""


# --- agents by themselves -------------------------------------------------------------------------


def of_moves(c: Configuration, a: Name, moves: Iterable[Transition | Fault]) -> ActorClocks:
    """Return the clock of an agent that can take a step of its own."""
    steps = [each for each in moves if isinstance(each, Transition)]
    running = tuple(_of_agent(c, a, steps[-1].label.rule)) if steps else ()
    done = ActorClock(Sort.AGENT, a), ActorClock(Sort.AFTER, a)
    clocks = [[done[1] if each.label.rule == "timeout" else done[0]] for each in steps]
    return ActorClocks(running, tuple(StepClocks(done, _tests(running, each)) for each in clocks))


def _of_agent(c: Configuration, a: Name, rule: str) -> Iterator[RunningClock]:
    timing = timing_of(c)
    clock = ActorClock(Sort.AFTER if rule == "timeout" else Sort.AGENT, a)
    interval = timing.react
    if rule == "timeout":
        interval = _after(c, a)
    elif rule == "spawn":
        interval = timing.command(rule) or ANY_TIME
    if interval != ANY_TIME:
        yield RunningClock(clock, interval)


def _after(c: Configuration, a: Name) -> Interval:
    timing, statement = timing_of(c), next_statement(c, a)
    assert isinstance(statement, React)
    assert statement.after is not None
    ticks, react = statement.after.seconds * 1000 / timing.tick, timing.react
    return Interval(math.floor(ticks) + react.lo, None if react.hi is None else math.ceil(ticks) + react.hi)


# --- clauses --------------------------------------------------------------------------------------


def of_clause(c: Configuration, number: int, steps: Iterable[Transition]) -> ActorClocks:
    """Return the clock of a clause's return, and the clocks of its steps."""
    several, most = list(steps), timing_of(c).clause(number).returns
    returns = RunningClock(ActorClock(Sort.RETURNS, number), Interval(0, most))
    is_running = most is not None and any(_returns(c, number, each) for each in several)
    return ActorClocks(
        (returns,) if is_running else (), tuple(_of_clause_step(c, number, each) for each in several)
    )


def _of_clause_step(c: Configuration, number: int, step: Transition) -> StepClocks:
    if _returns(c, number, step):
        return StepClocks((ActorClock(Sort.RETURNS, number),))
    mission, every, window = (
        ActorClock(Sort.MISSION),
        ActorClock(Sort.EVERY, number),
        ActorClock(Sort.WINDOW, number),
    )
    match timing_of(c).clause(number).step:
        case Every(least):
            tests: tuple[Test, ...] = (Test(every, least),)
        case Window(after):
            tests = (Test(mission, after), Test(window, FREE))
        case Sayable(after, until):
            tests = (Test(mission, after, until),)
        case None:
            tests = ()
    return StepClocks((every, window), tests)


def _returns(c: Configuration, number: int, step: Transition) -> bool:
    clause = c.setting.environment[number]
    return isinstance(clause, Drops | Leaves) and step.label.about == clause.words[-1] and clause.returns


def _bounds_of(step: Window | Sayable) -> Iterator[int]:
    yield step.after
    yield from filter(None, [step.within if isinstance(step, Window) else step.until])
