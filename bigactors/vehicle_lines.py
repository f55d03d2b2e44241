"""Vehicles in words: a line for each vehicle, and the situation of a run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from adapters.live.live_state import LiveState
from adapters.live.operator_commands import typed
from adapters.live.plan import Plan
from adapters.live.scheduling import in_turn
from adapters.live.timing_monitor import flying
from adapters.plugin import Follow, GoTo, Status
from physical import distance
from physical.wordings import counted
from semantics.environment import Says
from semantics.state.requests import READY, Request
from semantics.state.signature import REGION, Name
from semantics.timing.dates import lapse_text

OLD = 5.0
"""Seconds of silence after which a line reports the silence."""

MOST = 4
"""The most vehicles in one line."""


def vehicles_line(vehicles: Iterable[Name], state: LiveState, said: Mapping[Name, Status], now: float) -> str:
    """Return one line about all vehicles: the first few in words, those that need attention first."""
    lost, taken = state.sightings.lost, state.overrides.taken
    names = sorted(vehicles, key=lambda name: (name not in lost, name not in taken, name))
    lines = [vehicle_line(name, state, said.get(name), now) for name in names[:MOST]]
    more = [f"and {len(names) - MOST} more"] if len(names) > MOST else []
    return " | ".join([*lines, *more])


def vehicle_line(name: Name, state: LiveState, said: Status | None, now: float) -> str:
    """Return a vehicle's position or destination, its own status, and its silence, in one line."""
    return f"{name} {', '.join((*_does(name, state, said, now), *_tells(said), *_heard(name, state, said, now)))}"


def standing(state: LiveState) -> str:
    """Return the vehicles outside the mission's command, or still to be stopped, as a suffix to the end of a run."""
    found = state.overrides
    words = {name: f"was taken over: {how}" for name, how in found.taken.items() if found.is_foreign(name)}
    words |= {name: each.reason for name, each in (*found.owing.items(), *found.orders.items())}
    return "".join(f"; {name} {each}" for name, each in sorted(words.items()))


def situation(plan: Plan, state: LiveState, said: Mapping[Name, Status], now: float) -> str:
    """Return the situation of a run: its vehicles, its pending requests, and the messages that may still come."""
    c = state.configuration
    vehicles = [vehicle_line(name, state, said.get(name), now) for name in sorted(plan.vehicles)]
    pending = (each.request for each in in_turn(c))
    requests = [_request(each, state, now) for each in pending if not isinstance(each, READY)]
    clauses = [clause for clause in c.setting.environment if isinstance(clause, Says)]
    left = [(clause, c.read(clause.counter)) for clause in clauses]
    may = [
        f"{each.agent} {typed(each, clauses)} ({counted(times, 'time')} more)"
        for each, times in left
        if times
    ]
    served = ["no more controls are served: an assumption broke"] if state.overrides.suspended else []
    parts = {"vehicles": vehicles, "requests": requests, "permitted messages": may, "suspended": served}
    return "\n".join(
        line for title, lines in parts.items() if lines for line in (title, *(f"  {each}" for each in lines))
    )


def _request(request: Request, state: LiveState, now: float) -> str:
    """Return a pending request, and its waiting time if there is a limit on it."""
    waiting = state.due.heads.get(request.agent)
    known = waiting is not None and waiting.request == request
    return f"{request}, for {now - waiting.since:.0f} s" if waiting is not None and known else str(request)


def _does(name: Name, state: LiveState, said: Status | None, now: float) -> Iterator[str]:
    overrides = state.overrides
    if name in overrides.taken:
        yield overrides.taken[name]
    elif name in overrides.owing:
        yield overrides.owing[name].reason
    order, seen = state.commanded.flights.get(name), state.sightings.newest.get(name)
    if order is None or not isinstance(order.command, GoTo | Follow):
        yield f"is in {_place(name, state)}"
        return
    if name in overrides.taken:
        yield f"has not arrived in {order.command.name}"
    elif overrides.stops(order.agent):
        yield f"has given up its flight to {order.command.name}"
    else:
        to = order.command.path[-1] if isinstance(order.command, Follow) else order.command.place
        far = "" if seen is None else f", {_metres(distance(seen.property.geometry, to))} away"
        waits = not order.obeyed and said is not None and said.armed is False
        goes = "has not set out" if waits else "is on its way"
        yield f"{'has refused to go' if order.refused else goes} to {order.command.name}{far}"
        yield from _lasts(name, state, now)


def _place(name: Name, state: LiveState) -> str:
    """Return the observed place of a vehicle that is not under way, whatever agents believe."""
    physical = state.configuration.structure.physical
    parent = physical.abstract_parent(name) if name in physical else REGION
    return "none of the places" if parent == REGION else parent


def _lasts(name: Name, state: LiveState, now: float) -> Iterator[str]:
    """Yield the elapsed and the remaining time of a flight, if the mission has times."""
    flights = () if state.due.timers is None else flying(state.due.timers)
    for flight in (each for each in flights if each.vehicle == name):
        elapsed = now - flight.since
        least = _lapse(flight.least - elapsed)
        left = f"{least} or more" if flight.most is None else f"{least} to {_lapse(flight.most - elapsed)}"
        yield f"for {_lapse(elapsed)}, {left} to go"


def _lapse(seconds: float) -> str:
    return lapse_text(round(max(0.0, seconds)) * 1000)


def _tells(said: Status | None) -> Iterator[str]:
    if said is None:
        return
    if said.mode is not None:
        yield f"{said.mode}{'' if said.armed else ', disarmed'}"
    if said.lacks:
        yield said.lacks.removeprefix("it ")
    battery = said.battery
    if battery is not None and battery.percent is not None:
        yield f"battery {battery.percent} %"
    elif battery is not None and battery.volts is not None:
        yield f"battery {battery.volts:.1f} V"


def _heard(name: Name, state: LiveState, said: Status | None, now: float) -> Iterator[str]:
    if (
        said is not None
        and said.heard is not None
        and (name in state.sightings.lost or now - said.heard > OLD)
    ):
        yield f"not heard for {now - said.heard:.0f} s"
    elif name in state.sightings.lost:
        yield "not heard"


def _metres(metres: float) -> str:
    """Return a distance with its unit.

    >>> _metres(12.4), _metres(3249.0)
    ('12 m', '3.2 km')
    """
    return f"{metres:.0f} m" if metres < 1000 else f"{metres / 1000:.1f} km"
