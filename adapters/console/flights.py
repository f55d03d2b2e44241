"""Commands to vehicles and their progress, the durations of flights, and the vehicles' status and texts."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import MOST_VEHICLES, Facts, Link, Position, Table, VehicleCommand
from adapters.console.fates import confirm, end, not_rebound, rebind, rebound, refuse, sent
from adapters.console.parsing import count, number, text, texts
from adapters.console.station_list import obeys
from physical import PhysicalError, waypoint
from physical.frame import E7
from semantics.behaviours.reaction_rules import moved
from semantics.state.configuration import Configuration, Label
from semantics.state.observation_serialization import geometry_of
from semantics.state.requests import CTR, FLY, Request
from semantics.state.signature import Name

STATES: Final = {"Accepted": "accepted", "Arrived": "arrived", "Rejected": "refused"}
"""The state of an order after each report."""

MOST_WAY: Final = 100


def take_command(draft: Facts, time: float, data: Any) -> None:
    """Take in a command to a vehicle; a known request with a new path keeps its start and its state."""
    match data:
        case {
            "command": "GoTo" | "Follow" | "Hold" | "Return" as command,
            "request": str(),
            "entity": str(name),
        }:
            order = _order(command, time, data)
            known = draft.orders.get(name)
            if known is not None and known.request == order.request:
                order = replace(order, since=known.since, state=known.state, why=known.why)
            draft.orders[name] = order
            if command in ("Hold", "Return"):
                draft.hand_overs.pop(name, None)
            draft.orders.bounded(MOST_VEHICLES)
        case {"command": "HandOver", "request": str(), "entity": str(name)}:
            draft.hand_overs[name] = _order("HandOver", time, data)
            draft.hand_overs.bounded(MOST_VEHICLES)
        case {"command": "Rebind", "request": str(request), "entity": str(name)}:
            rebind(draft, name, request)


def _order(command: str, time: float, data: Any) -> VehicleCommand:
    places = data.get("path", [data["ring"]] if "ring" in data else [])
    points = [_waypoint(each) for each in places[:MOST_WAY]] if isinstance(places, list) else []
    way = tuple(each for each in points if each is not None)
    to = text(data.get("join") if command == "HandOver" else data.get("name"))
    state = "asked" if command in ("Hold", "Return") else "sent"
    return VehicleCommand(text(data["request"]), command, to, way, time, state)


def _waypoint(place: Any) -> Position | None:
    try:
        north, east = waypoint(geometry_of({"ring": place})).ring[0]
    except (ValueError, PhysicalError):
        return None
    return north / E7, east / E7


def take_report(draft: Facts, time: float, data: Any) -> None:
    """Take in a plugin's report about a request or a link."""
    match data:
        case {
            "report": "Sent" | "Accepted" | "Arrived" | "Rejected" as report,
            "request": str(request),
            "entity": str(name),
        }:
            _answer(draft, time, name, request, report, text(data.get("reason")))
        case {"report": "TakenOver", "entity": str(name)}:
            draft.taken[name] = text(data.get("reason"))
            end(draft, time, name, f"then it was taken over: {draft.taken[name]}")
            draft.taken.bounded(MOST_VEHICLES)
        case {"report": "LinkLost", "entity": str(name)}:
            heard = draft.links.get(name, Link()).heard
            draft.links[name] = Link(number(data.get("since")) if heard is None else heard, lost=True)
            draft.links.bounded(MOST_VEHICLES)
        case {"report": "LinkRestored", "entity": str(name)}:
            draft.links[name] = Link(draft.links.get(name, Link()).heard)
            rebound(draft, time, name)


def _answer(draft: Facts, time: float, name: str, request: str, report: str, why: str) -> None:
    """Take in a report about a command to a vehicle."""
    if report == "Sent":
        order: VehicleCommand | None = draft.orders.get(name)
        if order is not None and order.state == "asked":  # else it repeats a refused order
            _becomes(draft.orders, name, request, "sent", "")
        sent(draft, time, name, request)
        return
    _becomes(draft.orders, name, request, STATES[report], why)
    _becomes(draft.hand_overs, name, request, STATES[report], why)
    if report == "Rejected":
        refuse(draft, time, name, request, why)
        not_rebound(draft, time, name, request, why)
    else:
        confirm(draft, time, name, request)


def take_flight(draft: Facts, _time: float, data: Any) -> None:
    """Take in the duration of a flight, or its end."""
    match data:
        case {"vehicle": str(name), "takes": takes}:
            draft.flights.pop(name, None)
            if (flight := _flight(takes)) is not None:
                draft.flights[name] = flight
                draft.flights.bounded(MOST_VEHICLES)


def _flight(takes: Any) -> Json:
    match takes:
        case {"to": str(to), "since": began, "least": shortest, "most": longest}:
            since, least = number(began), number(shortest)
            if since is not None and least is not None:
                return {"to": text(to), "since": since, "least": least, "most": number(longest)}
    return None


def _becomes(orders: Table[VehicleCommand], name: str, request: str, state: str, why: str) -> None:
    order: VehicleCommand | None = orders.get(name)
    if order is not None and order.request == request:
        orders[name] = replace(order, state=state, why=why)


def arrive(draft: Facts, label: Label, c: Configuration) -> None:
    """Mark orders as done by the step that completes them: `commit`, or `actuate` for a hand-over."""
    table = {"commit": draft.orders, "actuate": draft.hand_overs}.get(label.rule)
    if table is not None and isinstance(label.about, CTR | FLY):
        for name in concerned(c, label.about):
            if name in table:
                _becomes(table, name, table[name].request, "arrived", "")


@lru_cache(maxsize=1 << 10)
def concerned(c: Configuration, request: Request) -> tuple[Name, ...]:
    """Return the nodes that a request moves or relinks, else the host of its agent."""
    host = (c.alpha.host(request.agent),) if request.agent in c.alpha else ()
    match request:
        case FLY(_, reaction, match):
            return tuple(node for node, _ in moved(reaction, match)) or host
        case CTR(_, reaction):
            changed = [node for node, _ in reaction.moves]
            changed += [node for _, node in {*reaction.redex.links} ^ {*reaction.reactum.links}]
            return tuple(sorted({node for node in changed if isinstance(node, str)})) or host
    return host


# --- the vehicles' status and texts -------------------------------------------------------------------


def take_status(draft: Facts, time: float, data: Any) -> None:
    """Take in a vehicle's status."""
    match data:
        case {"entity": str(name)}:
            draft.status[name] = {
                "mode": text(data.get("mode")) or None,
                "armed": data.get("armed") if isinstance(data.get("armed"), bool) else None,
                "battery": _battery(data.get("battery")),
                "heading": number(data.get("heading")),
                "authority": texts(data.get("authority")),
                "height": number(data.get("height")),
                "home": _position(data.get("home")),
                "returning": data.get("returning") is True,
                "surface": data.get("surface") is True,
            }
            draft.status.bounded(MOST_VEHICLES)
            obeys(draft, time, name, tuple(texts(data.get("authority"))))
            heard, link = number(data.get("heard")), draft.links.get(name, Link())
            if heard is not None and (link.heard is None or heard > link.heard):
                draft.links[name] = replace(link, heard=heard)


def _position(value: Any) -> Position | None:
    match value:
        case [float() | int() as north, float() | int() as east] if abs(north) <= 90 and abs(east) <= 180:
            return north, east
    return None


def _battery(value: Any) -> dict[str, float | None] | None:
    match value:
        case {"percent": percent, "volts": volts}:
            return {"percent": number(percent), "volts": number(volts)}
    return None


def take_words(draft: Facts, time: float, data: Any) -> None:
    """Take in a text message of a vehicle."""
    match data:
        case {"entity": str(name), "text": str(said)}:
            stamp = number(data.get("time"))
            severity = count(data.get("severity"))
            draft.words[name] = {
                "text": text(said),
                "time": time if stamp is None else stamp,
                "severity": severity,
            }
            draft.words.bounded(MOST_VEHICLES)
