"""The vehicles' cards: their requests and orders, their status, and how urgently they need an operator."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from math import floor
from operator import attrgetter
from typing import Final, NamedTuple

from adapters.console.agent_states import agents
from adapters.console.alerts import ALL, fallen_back, grounded
from adapters.console.console_view import Json
from adapters.console.facts import (
    ControllingStations,
    Facts,
    Link,
    OrderState,
    Position,
    SeenEntity,
    VehicleCommand,
)
from adapters.console.flights import concerned
from adapters.console.parsing import text
from adapters.console.return_preview import of_return
from adapters.console.whereabouts import UNKNOWN, Whereabouts, destination, known_whereabouts
from adapters.live.command_planning import unshown
from adapters.live.due_times import HeadRequest
from semantics.behaviours.durations import duration_text
from semantics.control import obstacle, realisations
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY, Request
from semantics.state.signature import REGION, Name
from semantics.state.station_partition import is_here

WELL, WATCHED, WRONG, LOST = range(4)
"""The levels: how urgently a vehicle needs an operator."""

WORDS: Final = ("well", "watch", "wrong", "lost")
"""The word for each level, unless the reason has its own."""

UNKNOWN_NOW: Final = "unknown"
"""The word for a vehicle without any current information."""

ENDED: Final = "ended"
"""The word for a vehicle without a reason when the run has ended: its last known state is no present one."""

OLD: Final = 5.0
"""Seconds of silence after which a vehicle is to be watched."""

SETS_OUT: Final = 15.0
"""Seconds within which a vehicle is armed for its flight."""

LOW: Final = 25
"""Percent of charge below which a battery is low."""

UNTOLD: Final = ControllingStations(())


class Asked(NamedTuple):
    """A request that concerns a vehicle, its time limit, and whether it is given up (never served any more)."""

    waiting: HeadRequest
    limit: TimeLimit | None
    given_up: bool


class Reason(NamedTuple):
    """A reason why a vehicle needs an operator: the level, the explanation, and a word; if empty, the level's word."""

    level: int
    why: str
    word: str = ""


def vehicles(facts: Facts, now: float, broken_off: str = "") -> dict[str, Json]:
    """Return the section `vehicles`; `broken_off` is the reason why the recording ends here, if it was cut off."""
    if facts.run is None:
        return {}
    asked, where = _asked(facts), known_whereabouts(facts)
    silent = (
        [Reason(LOST, f"nothing is known of it any more: {broken_off}", UNKNOWN_NOW)] if broken_off else []
    )
    found = {}
    for name in sorted(facts.run.vehicles):
        there = where.get(name, UNKNOWN)
        reasons = [*silent, *_reasons(facts, name, now, asked.get(name), there)]
        found[name] = _card(facts, name, asked.get(name), there, reasons)
    return found


def _card(facts: Facts, name: Name, asked: Asked | None, where: Whereabouts, said: list[Reason]) -> Json:
    """Return a vehicle's card.

    It omits the position and rounds the times, so that it does not change ten times a second with each position.
    """
    seen, status = facts.seen.get(name), facts.status.get(name, {})
    order, link = _order(facts, name), facts.links.get(name, Link())
    reasons = sorted(said, key=lambda reason: -reason.level)
    worst = reasons[0] if reasons else Reason(WELL, "", "" if facts.ended is None else ENDED)
    heading, authority = status.get("heading"), facts.authority.get(name, UNTOLD)
    return {
        "kind": _kind(facts, name),
        "believed": where.believed,
        "actual": where.actual,
        "differs": where.differs,
        "going": destination(facts, name),
        "request": None if asked is None else _request_json(asked),
        "flight": facts.flights.get(name),
        "order": None if order is None else _order_json(order, _way(facts, name)),
        "link": _link_json(link, over=facts.ended is not None),
        "mode": status.get("mode"),
        "armed": status.get("armed"),
        "battery": status.get("battery"),
        "heading": heading if heading is not None or seen is None else seen.course,
        "altitude": _altitude(seen, status),
        "height": status.get("height"),
        "home": status.get("home"),
        "returning": status.get("returning", False),
        "authority": [*authority.stations],
        "handed": authority.handed,
        "said": facts.words.get(name),
        "taken": _away(facts, name),
        "ordered": _ordered_json(facts.standing_orders.get(name)),
        "on_return": of_return(facts, name),
        "level": worst.level,
        "word": worst.word or WORDS[worst.level],
        "why": "; ".join(each.why for each in reasons),
    }


def _link_json(link: Link, *, over: bool) -> Json:
    heard = None if link.heard is None else floor(link.heard)
    return {"heard": heard, "lost": link.lost} | ({"over": True} if over else {})


def _altitude(seen: SeenEntity | None, status: Mapping[str, Json]) -> int | None:
    """Return a vehicle's altitude in metres above the sea, None of a vehicle on water or on the ground."""
    if seen is None or seen.altitude is None or status.get("surface", False):
        return None
    return round(seen.altitude)


def _kind(facts: Facts, name: Name) -> str | None:
    if facts.standing is not None:
        return facts.standing.configuration.setting.kinds.get(name)
    return facts.seen[name].kind if name in facts.seen else None


def _request_json(asked: Asked) -> Json:
    request, limit = asked.waiting.request, asked.limit
    return {
        "text": text(str(request)),
        "agent": request.agent,
        "since": asked.waiting.since,
        "limit": None if limit is None else limit.seconds,
        "fallback": None if limit is None else limit.fallback.value,
        "given_up": asked.given_up,
    }


# --- orders -------------------------------------------------------------------------------------------


def _order(facts: Facts, name: Name) -> VehicleCommand | None:
    """Return a vehicle's last order: a hand-over until it is done, else the last order of movement."""
    hand_over = facts.hand_overs.get(name)
    return hand_over if hand_over is not None and hand_over.state != "arrived" else facts.orders.get(name)


def _is_standing(facts: Facts, name: Name, order: VehicleCommand) -> bool:
    """Return whether an order is an operator's; the card describes those separately."""
    return (
        name in facts.standing_orders and facts.standing_orders[name].order.command.request == order.request
    )


def _away(facts: Facts, name: Name) -> str | None:
    """Return why the mission does not command a vehicle, None while it does."""
    if name in facts.taken:
        return facts.taken[name]
    return facts.standing_orders[name].order.reason if name in facts.standing_orders else None


def _ordered_json(standing: OrderState | None) -> Json:
    """Return an operator's order to a vehicle, and its state."""
    if standing is None:
        return None
    order = standing.order
    return {
        "order": order.action,
        "by": order.by,
        "since": standing.since,
        "state": order.fate.value,
        "why": order.refusal,
    }


def _way(facts: Facts, name: Name) -> tuple[Position, ...]:
    going = facts.orders.get(name)
    return () if going is None else going.way


def _order_json(order: VehicleCommand, way: tuple[Position, ...]) -> Json:
    return {
        "command": order.command,
        "to": order.to,
        "way": way,
        "since": order.since,
        "state": order.state,
        "why": order.why,
    }


# --- requests -----------------------------------------------------------------------------------------


def _asked(facts: Facts) -> Mapping[Name, Asked]:
    """Return one request for each vehicle: one that moves it, else one of an agent aboard."""
    if facts.standing is None or facts.run is None:
        return {}
    limits = facts.standing.rules.limits if facts.run.limits is None else facts.run.limits
    found: dict[Name, Asked] = {}
    for waiting in facts.standing.heads.values():
        moving = isinstance(waiting.request, CTR | FLY)
        for name in concerned(facts.standing.configuration, waiting.request):
            if name in facts.run.vehicles and (moving or name not in found):
                limit = limit_of(waiting.request, limits)
                found[name] = Asked(waiting, limit, _is_given_up(facts, waiting.request))
    return found


def _is_given_up(facts: Facts, request: Request) -> bool:
    stopped = not facts.stopped.keys().isdisjoint((ALL, request.agent))
    return stopped and isinstance(request, CTR | FLY)


def limit_of(request: Request, limits: tuple[TimeLimit, ...]) -> TimeLimit | None:
    """Return the shortest time limit of a request, None if it has none."""
    kind = type(request).__name__
    covering = (limit for limit in limits if limit.covers(kind, request.agent))
    return min(covering, key=attrgetter("seconds"), default=None)


# --- levels -------------------------------------------------------------------------------------------


def _reasons(
    facts: Facts, name: Name, now: float, asked: Asked | None, where: Whereabouts
) -> Iterator[Reason]:
    """Yield the reasons why a vehicle needs an operator."""
    runs = facts.ended is None
    yield from _of_link(facts.links.get(name, Link()), now, runs=runs)
    if name in facts.taken:
        yield Reason(LOST, f"taken over: {facts.taken[name]}", "taken over")
    elif name in facts.standing_orders:
        standing = facts.standing_orders[name].order
        yield Reason(WRONG if standing.refusal else WATCHED, standing.reason)
    yield from _of_assumptions(facts, name)
    for station in facts.authority.get(name, UNTOLD).stations:
        known = facts.stations.get(station, {})
        if known.get("reached") is False:
            yield Reason(WRONG, f"its station {station} is not reached")
        elif known.get("begun") is False:
            yield Reason(WRONG, f"its station {station} has not started: nobody commands it")
    away = name in facts.taken or name in facts.standing_orders
    if runs:
        yield from _of_request(asked, now, idle=away)
    yield from _of_blocking(facts, name, asked, where)
    yield from _of_falling_back(facts, asked)
    yield from _of_preflight(facts, name)
    if runs and not away:
        yield from _of_setting_out(facts, name, now)
    if runs and asked is None and not away and facts.status.get(name, {}).get("armed"):
        yield from _of_idleness(facts, name)
    for order in (facts.orders.get(name), facts.hand_overs.get(name)):
        told = order is not None and (_is_standing(facts, name, order) or order.why == facts.taken.get(name))
        if order is not None and order.state == "refused" and not told:
            yield Reason(WRONG, f"it refuses {order.command}{f': {order.why}' if order.why else ''}")
    battery = facts.status.get(name, {}).get("battery")
    if battery is not None and battery["percent"] is not None and battery["percent"] < LOW:
        yield Reason(WRONG, f"its battery has less than {LOW} %")
    if where.differs and destination(facts, name) is None:
        yield Reason(WATCHED, "its believed and its actual position differ")


def _of_link(link: Link, now: float, *, runs: bool) -> Iterator[Reason]:
    if link.lost:
        yield Reason(LOST, "the link is lost" if runs else "the link was lost")
    elif link.heard is None:
        yield Reason(WATCHED, f"nothing was heard of it{' yet' if runs else ''}", UNKNOWN_NOW)
    elif runs and now - link.heard > OLD:
        yield Reason(WATCHED, f"nothing was heard of it for more than {OLD:g} s")


def _of_assumptions(facts: Facts, name: Name) -> Iterator[Reason]:
    """Yield the newest unacknowledged breaches about a vehicle, and the number of the others."""
    for kind in ("broken assumption", "broken property"):
        broken = [
            alert["message"]
            for alert in facts.alerts.values()
            if alert["kind"] == kind and alert["about"] == name and alert["acknowledged"] is None
        ]
        if broken:
            more = f" (and {len(broken) - 1} more)" if len(broken) > 1 else ""
            yield Reason(LOST, f"{kind}: {broken[-1]}{more}", "broken")


def _of_request(asked: Asked | None, now: float, *, idle: bool) -> Iterator[Reason]:
    """Yield the reasons due to the request's time limit; `idle`: the mission does not command the vehicle."""
    if asked is None or asked.limit is None:
        return
    stood, limit = now - asked.waiting.since, asked.limit.seconds
    if stood >= limit:
        yield Reason(WRONG, f"its request is pending for longer than {duration_text(limit)}")
    elif stood > limit / 2:
        yield Reason(WATCHED, f"its request is pending for more than half of {duration_text(limit)}")
    if idle and stood < limit and not asked.given_up:
        then = (
            ""
            if asked.limit.fallback is Fallback.CONTINUE
            else f"; then {grounded(asked.waiting.request.agent)}"
        )
        yield Reason(WATCHED, f"the time limit of its request, {duration_text(limit)}, still runs{then}")


def _of_blocking(facts: Facts, name: Name, asked: Asked | None, where: Whereabouts) -> Iterator[Reason]:
    """Yield that the request cannot be served as L and P are now, whatever the run has found before."""
    if asked is None or asked.given_up or facts.standing is None or facts.run is None:
        return
    c, request = facts.standing.configuration, asked.waiting.request
    if isinstance(request, CTR) and is_here(c, request.agent):
        why = _hindrance(c, request, frozenset(facts.run.vehicles))
        if why:
            astray = f": {name} is believed in {_place(where.believed)} and is in {_place(where.actual)}"
            yield Reason(WRONG, f"its request {why}{astray if where.differs else ''}; it stays pending")


@lru_cache(maxsize=1 << 10)
def _hindrance(c: Configuration, request: CTR, vehicles: frozenset[Name]) -> str:
    """Return why a control cannot be served in a configuration, empty if it can, or only waits."""
    reason = obstacle(c, request)
    if reason is not None:
        return f"is {reason.value}"
    way = next((each for each in realisations(c, request) if not (each.flying and each.waits(c))), None)
    unseen = "" if way is None else unshown(c, request, way, vehicles)
    return unseen and f"is blocked: {unseen}"


def _place(name: Name | None) -> str:
    return "none of the places" if name in (None, REGION) else str(name)


def _of_preflight(facts: Facts, name: Name) -> Iterator[Reason]:
    """Yield, before the start, that a vehicle refuses to arm."""
    if facts.preflight.get("state") == "begun":
        return
    for item in facts.preflight.get("items", ()):
        if item.get("vehicle") == name and item.get("refuses"):
            yield Reason(WATCHED, f"it refuses to arm: {'; '.join(item['refuses'])}")


def _of_setting_out(facts: Facts, name: Name, now: float) -> Iterator[Reason]:
    """Yield that a vehicle is still not armed for its flight, with its newest text, which may say why."""
    order, said = facts.orders.get(name), facts.words.get(name)
    if order is None or not order.to or order.state != "sent" or now - order.since < SETS_OUT:
        return
    if facts.status.get(name, {}).get("armed") is False:
        why = f": {said['text']}" if said else ""
        yield Reason(WATCHED, f"it has not set out to {order.to}{why}")


def _of_falling_back(facts: Facts, asked: Asked | None) -> Iterator[Reason]:
    """Yield that the mission will not command a vehicle again, even after a give-back."""
    if whole := fallen_back(facts):
        yield Reason(WRONG, whole)
    elif asked is not None and asked.given_up:
        yield Reason(WRONG, grounded(asked.waiting.request.agent))


def _of_idleness(facts: Facts, name: Name) -> Iterator[Reason]:
    """Yield why no request concerns a vehicle: an agent waits, its own first, or all agents have ended."""
    if ALL in facts.stopped or _is_elsewhere(facts, name):
        return
    states = agents(facts)
    if any(each["state"] == "goes on" or each["request"] is not None for each in states.values()):
        return
    own_first = sorted(states.items(), key=lambda each: each[1]["host"] != name)
    waiting = [f"{agent} {each['state']}" for agent, each in own_first if each["state"].startswith("waits")]
    if waiting:
        yield Reason(WELL, f"it has no request: {waiting[0]}")
    elif states:
        yield Reason(WATCHED, "it will get no more requests: every bigActor of the mission has ended")


def _is_elsewhere(facts: Facts, name: Name) -> bool:
    """Return whether a vehicle obeys another station, whose agents this one does not know."""
    stations = facts.authority.get(name, UNTOLD).stations
    return (
        facts.run is not None and bool(stations and facts.run.station) and facts.run.station not in stations
    )
