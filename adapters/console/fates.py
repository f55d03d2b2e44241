"""The fates of operators' orders, by the run's words: asked, sent, confirmed or refused; vehicles given back.

The run repeats an order that a vehicle has refused. The order stays refused until the vehicle shows that it obeys.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import MOST_VEHICLES, Facts, OrderState
from adapters.console.operator_actions import MOST_NAMED, act, settle
from adapters.console.parsing import text, texts
from adapters.live.command_planning import stopping
from adapters.live.overrides import Fate, StandingOrder
from semantics.live_policy import Fallback


def take_giving_back(draft: Facts, time: float, data: Any) -> None:
    """Take in an operator's give-back of a vehicle, or its new address."""
    match data:
        case {"vehicle": str(name), "at": str(at), **rest}:
            number = act(draft, time, rest, f"is at {text(at)}", text(name), "sent")
            if not rest.get("refusal"):
                draft.rebinds[name] = (draft.rebinds.get(name, ("", ""))[0], number)
        case {"vehicle": str(name)}:
            act(draft, time, data, "give back", text(name))
            if not data.get("refusal"):
                draft.taken.pop(name, None)
                end(draft, time, name, "then it was given back")


def rebind(draft: Facts, name: str, request: str) -> None:
    """Note the command to accept a vehicle from a new address; the operator's order follows in the recording."""
    draft.rebinds[name] = (request, "")
    draft.rebinds.bounded(MOST_VEHICLES)


def rebound(draft: Facts, time: float, name: str) -> None:
    """Note that a vehicle is heard again; this confirms a pending change of its address."""
    _, number = draft.rebinds.pop(name, ("", ""))
    settle(draft, time, number, "confirmed")


def not_rebound(draft: Facts, time: float, name: str, request: str, why: str) -> None:
    """Note that the change of a vehicle's address is refused, and why."""
    known, number = draft.rebinds.get(name, ("", ""))
    if number and known == request:
        draft.rebinds.pop(name)
        settle(draft, time, number, "refused", why)


MOST_LISTED: Final = 4
"""The most vehicles whose names stand for the addressees of an order."""

WORST_FIRST: Final = (Fate.REFUSED, Fate.ASKED, Fate.SENT, Fate.CONFIRMED)


def take_order(draft: Facts, time: float, data: Any) -> None:
    """Take in an operator's order to vehicles to hold or to return, or the run's refusal of it."""
    match data:
        case {"order": "hold" | "return" as order, "requests": dict(requests)}:
            named = [each for each in requests.items() if isinstance(each[1], str)][:MOST_NAMED]
            name, by = data.get("vehicle"), text(data.get("by"))
            for vehicle, _ in named:
                end(draft, time, vehicle, f"then it was ordered to {order}")
            number = act(draft, time, data, order, _told(name), "asked")
            for vehicle, request in named:
                draft.taken.pop(vehicle, None)  # the order overrules the take-over
                draft.standing_orders[vehicle] = OrderState(
                    number, time, StandingOrder(stopping(Fallback(order), request, vehicle), by)
                )
                _note(draft, time, vehicle, draft.standing_orders[vehicle])
            draft.standing_orders.bounded(MOST_VEHICLES)


def _told(vehicle: Any) -> str:
    """Return the addressees of an order: a vehicle, a few, the number of several, or all."""
    several = texts(vehicle, MOST_NAMED)
    if len(several) > MOST_LISTED:
        return f"{len(several)} vehicles"
    return ", ".join(several) if several else text(vehicle) or "all"


def sent(draft: Facts, time: float, vehicle: str, request: str) -> None:
    """Note that an order is sent to a vehicle; a refused order stays refused when it is repeated."""
    for standing in _ordered(draft, vehicle, request):
        if standing.order.fate is Fate.ASKED:
            _becomes(draft, time, vehicle, standing, Fate.SENT)


def confirm(draft: Facts, time: float, vehicle: str, request: str) -> None:
    """Note that a vehicle shows that it obeys an order."""
    for standing in _ordered(draft, vehicle, request):
        if standing.order.owed:
            _becomes(draft, time, vehicle, standing, Fate.CONFIRMED)


def refuse(draft: Facts, time: float, vehicle: str, request: str, why: str) -> None:
    """Note that a vehicle refuses an order, and why."""
    for standing in _ordered(draft, vehicle, request):
        _becomes(draft, time, vehicle, standing, Fate.REFUSED, why)


def end(draft: Facts, time: float, vehicle: str, why: str) -> None:
    """Note that an order has ended; if it is not confirmed yet, it never will be."""
    standing: OrderState | None = draft.standing_orders.pop(vehicle, None)
    if standing is not None and standing.order.owed:
        _note(draft, time, vehicle, standing, why)


def _ordered(draft: Facts, vehicle: str, request: str) -> Iterator[OrderState]:
    """Yield the vehicle's standing order if it has this request; else nothing."""
    standing: OrderState | None = draft.standing_orders.get(vehicle)
    if standing is not None and standing.order.command.request == request:
        yield standing


def _becomes(
    draft: Facts, time: float, vehicle: str, standing: OrderState, fate: Fate, why: str = ""
) -> None:
    draft.standing_orders[vehicle] = replace(standing, order=replace(standing.order, fate=fate, refusal=why))
    _note(draft, time, vehicle, draft.standing_orders[vehicle])


def _note(draft: Facts, time: float, vehicle: str, standing: OrderState, then: str = "") -> None:
    """Update an order's action with the fate for a vehicle; `then` is the event that ended the order."""
    action: Json = draft.actions.get(standing.action)
    if action is None:
        return
    why = "; ".join(filter(None, [standing.order.refusal, then]))
    fates = {**action["fates"], vehicle: {"state": standing.order.fate.value, "why": why}}
    owed = any(_is_owed(draft, name, standing.action) for name in fates)
    draft.actions[standing.action] = {
        **action,
        "state": _state([each["state"] for each in fates.values()]),
        "why": _why(fates),
        "fates": fates,
        "answered": None if owed else time,
    }


def _is_owed(draft: Facts, vehicle: str, action: str) -> bool:
    standing: OrderState | None = draft.standing_orders.get(vehicle)
    return standing is not None and standing.action == action and standing.order.owed


def _state(fates: Collection[str]) -> str:
    """Return the fate of an order to several vehicles: the worst of all."""
    return next(fate.value for fate in WORST_FIRST if fate.value in fates)


def _why(fates: Mapping[str, Mapping[str, str]]) -> str:
    named = {name: each["why"] for name, each in fates.items() if each["why"]}
    return "; ".join(named.values() if len(fates) == 1 else (f"{name}: {why}" for name, why in named.items()))
