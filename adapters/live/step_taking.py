"""Take a step of the calculus: the next configuration, the clocks, and parcels to other stations."""

from __future__ import annotations

from collections.abc import Iterator

from adapters.live.fallbacks import breaks
from adapters.live.timing_monitor import next_end, stepped, too_late, too_soon
from adapters.live.turn_in_progress import Turning
from adapters.live.turn_result import LiveStep, Outgoing
from semantics.observed_steps import Sight
from semantics.state.configuration import Transition
from semantics.state.requests import SND
from semantics.state.signature import Name
from semantics.state.station_partition import (
    Elsewhere,
    Passage,
    is_parted,
    leave,
    parcel_of,
    sent_cell,
    station_of,
)


def take(
    turning: Turning,
    transition: Transition,
    alike: tuple[Transition, ...],
    sight: Sight | Elsewhere | None = None,
) -> None:
    """Take a step; `alike` are all possible steps by that rule here.

    Additions to an agent at another station leave at once.
    """
    word = str(transition.label)
    choice = [each for each in alike if str(each.label) == word].index(transition)
    date = turning.now if turning.done is None else min(turning.done, turning.now)
    step = LiveStep(turning.number + 1, turning.c, transition, choice, sight, turning.now, date)
    turning.results.steps.append(step)
    _go_on(turning, transition)
    turning.c = transition.target
    _time(turning, transition, date)
    if is_parted(turning.c):
        for agent in _concerned(transition):
            _forward(turning, agent)


def observe(turning: Turning, sight: Sight, found: Iterator[Transition]) -> bool:
    """Take the step that an observation causes, if any; return whether there was one."""
    alike = tuple(found)
    if alike:
        take(turning, alike[0], alike, sight)
    return bool(alike)


def _go_on(turning: Turning, transition: Transition) -> None:
    """Wake the agents that a step concerns, and end the waits that it ends."""
    agent, request = transition.label.agent, transition.label.about
    woken = [] if agent is None else [agent]
    if isinstance(request, SND):
        woken.append(request.to)
    if transition.label.rule == "spawn":
        woken.append(str(request))
    turning.agents = turning.agents.woken(woken)
    if agent is None:
        return
    if transition.served is None:
        turning.due = turning.due.waited(agent)
    elif not isinstance(request, SND):
        turning.due = turning.due.served(agent)


def _concerned(transition: Transition) -> Iterator[Name | None]:
    """Yield the agents to which a step has added something."""
    request = transition.label.about
    yield request.to if isinstance(request, SND) else transition.label.agent
    if transition.label.rule == "spawn":
        yield str(request)


# --- times


def _time(turning: Turning, transition: Transition, date: float) -> None:
    """Advance the mission's clocks over a step; a step that is too soon breaks an assumption."""
    before = turning.due.timers
    if before is None:
        return
    after = stepped(before, transition, date)
    turning.due = turning.due.with_timers(after)
    for about, message in too_soon(before, transition, after, date):
        _untimely(turning, about, message)


def check_times(turning: Turning) -> None:
    """Report exceeded time bounds, and schedule the next check."""
    timers = turning.due.timers
    if timers is None:
        return
    for about, message in too_late(timers, turning.now):
        _untimely(turning, about, message)
    turning.wake(next_end(timers, turning.now))


def _untimely(turning: Turning, about: Name, message: str) -> None:
    """Report a broken time assumption, except of vehicles that were taken over: they need not keep it."""
    if about not in turning.overrides.taken:
        breaks(turning, message, about)


# --- other stations


def _forward(turning: Turning, agent: Name | None) -> None:
    """Send the local parts of an agent that runs at another station."""
    if agent is None or agent not in turning.c.alpha:
        return
    if station_of(turning.c, agent) is None:
        host = turning.c.alpha.host(agent)
        message = f"no station runs the bigActors of {host}, so {agent} does not go on"
        remedy = f"add {host} to the hosts of a station in the peers file"
        turning.find("blocked", agent, f"{message}: {remedy}", once=True)
    for left in leave(turning.c, agent):
        station, parcel = str(left.label.about), parcel_of(turning.c, agent)
        assert parcel is not None
        number: int = left.target.read(sent_cell(station))
        turning.results.parcels.append(Outgoing(station, number, parcel))
        take(turning, left, (left,), Passage(agent, station, number))
