"""The client of a run's socket, which passes on operators' actions."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from pathlib import Path

from adapters.console.browser_requests import Acknowledge, GiveBackRequest, Note, Order, RequestedAction, Say
from adapters.live.operator_socket import (
    NobodyListens,
    Outcome,
    acknowledge,
    give_back,
    note,
    order,
    say,
    start,
)

Performing = Callable[[RequestedAction, str], Awaitable[Outcome]]
"""Performs an action for a named operator, and returns its outcome."""


def performing(socket: Path) -> Performing:
    """Return a function that has the run at a socket perform actions."""

    async def perform(action: RequestedAction, by: str) -> Outcome:
        try:
            return await _perform(socket, action, by)
        except NobodyListens as nobody:
            return Outcome(str(nobody))

    return perform


async def _perform(socket: Path, action: RequestedAction, by: str) -> Outcome:
    match action:
        case RequestedAction(say=Say(agent, message)):
            return Outcome(await say(socket, agent, message, by))
        case RequestedAction(order=Order(what, vehicle)):
            return await order(socket, what, vehicle, by)
        case RequestedAction(give_back=GiveBackRequest(vehicle)):
            return await give_back(socket, vehicle, by=by)
        case RequestedAction(acknowledge=Acknowledge(alert)):
            return Outcome(await acknowledge(socket, int(alert), by))
        case RequestedAction(note=Note(text)):
            return Outcome(await note(socket, text, by))
    return Outcome(await start(socket, by))
