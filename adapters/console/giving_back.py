"""Vehicles that an operator gives back to the mission, or accepts from a new address."""

from __future__ import annotations

from typing import Any

from adapters.console.fates import end
from adapters.console.mutable_facts import MOST_VEHICLES, Draft
from adapters.console.operator_actions import act, settle
from adapters.console.parsing import text


def take_giving_back(draft: Draft, time: float, data: Any) -> None:
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


def rebind(draft: Draft, name: str, request: str) -> None:
    """Note the command to accept a vehicle from a new address; the operator's order follows in the recording."""
    draft.rebinds[name] = (request, "")
    draft.rebinds.bounded(MOST_VEHICLES)


def rebound(draft: Draft, time: float, name: str) -> None:
    """Note that a vehicle is heard again; this confirms a pending change of its address."""
    _, number = draft.rebinds.pop(name, ("", ""))
    settle(draft, time, number, "confirmed")


def not_rebound(draft: Draft, time: float, name: str, request: str, why: str) -> None:
    """Note that the change of a vehicle's address is refused, and why."""
    known, number = draft.rebinds.get(name, ("", ""))
    if number and known == request:
        draft.rebinds.pop(name)
        settle(draft, time, number, "refused", why)
