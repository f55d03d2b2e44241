"""The progress of orders to hold or to return: asked, sent, confirmed or refused.

An operator gives such an order, or the mission falls back. The vehicle owes it until its state shows it. A refused
order is repeated: the reason may pass, such as the authority of another station.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from adapters.live.overrides import Fate, StandingOrder
from adapters.live.turn_in_progress import Turning
from semantics.state.signature import Name

RETRY: Final = 5.0
"""Seconds after a refusal until the order is repeated."""


def sent(turning: Turning, entity: Name, request: str) -> None:
    """Record that a plugin has sent an order to a vehicle."""
    for order in _ordered(turning, entity, request):
        if order.fate is Fate.ASKED:
            _becomes(turning, entity, replace(order, fate=Fate.SENT))


def confirm(turning: Turning, entity: Name, request: str) -> None:
    """Report, once, that a vehicle carries out an order."""
    for order in _ordered(turning, entity, request):
        if order.owed:
            _becomes(turning, entity, replace(order, fate=Fate.CONFIRMED, refusal=""))
            does = "holds" if order.action == "hold" else "returns"
            turning.find("confirmed", entity, f"{entity} {does}, as {order.orderer} ordered")


def refused(turning: Turning, entity: Name, request: str, reason: str) -> bool:
    """Record a vehicle's refusal, and report each reason once; return whether the request was such an order."""
    found = False
    for order in _ordered(turning, entity, request):
        found = True
        again = turning.now + RETRY
        _becomes(turning, entity, replace(order, fate=Fate.REFUSED, refusal=reason, again=again))
        turning.wake(again)
        if reason != order.refusal:
            what = f"{entity} refuses to {order.action}, as {order.orderer} ordered: {reason}"
            turning.find("refused", entity, f"{what}; the order is repeated until it obeys")
    return found


def repeat_refused(turning: Turning) -> None:
    """Repeat refused orders to their vehicles."""
    for entity, order in turning.overrides.all_orders():
        if order.fate is not Fate.REFUSED:
            continue
        if turning.now < order.again:
            turning.wake(order.again)
            continue
        _becomes(turning, entity, replace(order, fate=Fate.ASKED))
        turning.command(order.command)


def _ordered(turning: Turning, entity: Name, request: str) -> Iterator[StandingOrder]:
    """Yield the standing order of a vehicle with this request."""
    return (each for each in turning.overrides.of(entity) if each.command.request == request)


def _becomes(turning: Turning, entity: Name, order: StandingOrder) -> None:
    turning.overrides = turning.overrides.with_progress(entity, order)
