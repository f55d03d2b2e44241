"""The fate of orders to hold or to return: asked, sent, confirmed or refused.

An operator gives such an order, or the mission falls back. The vehicle owes it until its state shows it. A refused
order is repeated: the reason may pass, such as the authority of another station.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from adapters.live.state import Bidden, Fate
from adapters.live.turn_in_progress import Turning
from semantics.state.signature import Name

RETRY: Final = 5.0
"""Seconds after a refusal until the order is repeated."""


def sent(turning: Turning, entity: Name, request: str) -> None:
    """Record that a plugin has sent an order to a vehicle."""
    for bidden in _ordered(turning, entity, request):
        if bidden.fate is Fate.ASKED:
            _becomes(turning, entity, replace(bidden, fate=Fate.SENT))


def confirm(turning: Turning, entity: Name, request: str) -> None:
    """Report, once, that a vehicle carries out an order."""
    for bidden in _ordered(turning, entity, request):
        if bidden.owed:
            _becomes(turning, entity, replace(bidden, fate=Fate.CONFIRMED, refusal=""))
            does = "holds" if bidden.what == "hold" else "returns"
            turning.find("confirmed", entity, f"{entity} {does}, as {bidden.orderer} ordered")


def refused(turning: Turning, entity: Name, request: str, reason: str) -> bool:
    """Record a vehicle's refusal, and report each reason once; return whether the request was such an order."""
    found = False
    for bidden in _ordered(turning, entity, request):
        found = True
        again = turning.now + RETRY
        _becomes(turning, entity, replace(bidden, fate=Fate.REFUSED, refusal=reason, again=again))
        turning.wake(again)
        if reason != bidden.refusal:
            what = f"{entity} refuses to {bidden.what}, as {bidden.orderer} ordered: {reason}"
            turning.find("refused", entity, f"{what}; it is told again until it does")
    return found


def tell_again(turning: Turning) -> None:
    """Repeat refused orders to their vehicles."""
    for entity, bidden in (*sorted(turning.owed.items()), *sorted(turning.bidden.items())):
        if bidden.fate is not Fate.REFUSED:
            continue
        if turning.now < bidden.again:
            turning.wake(bidden.again)
            continue
        _becomes(turning, entity, replace(bidden, fate=Fate.ASKED))
        turning.commands.append(bidden.command)


def _ordered(turning: Turning, entity: Name, request: str) -> Iterator[Bidden]:
    """Yield the standing order of a vehicle with this request."""
    both = (turning.owed.get(entity), turning.bidden.get(entity))
    return (each for each in both if each is not None and each.command.request == request)


def _becomes(turning: Turning, entity: Name, bidden: Bidden) -> None:
    if bidden.by is None:
        turning.owed[entity] = bidden
        return
    turning.bidden[entity] = bidden
    turning.taken[entity] = bidden.reason
