"""Vehicles that are given back, or believed from another address."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.actions import act, settle
from adapters.console.fates import end
from adapters.console.mutable_facts import Draft
from adapters.console.parsing import text

MOST_VEHICLES: Final = 1_000


def take_giving_back(draft: Draft, time: float, data: Any) -> None:
    """Take in that a vehicle was given back, or is heard elsewhere from now on."""
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
    """Note that a vehicle is to be believed elsewhere, before the operator's order that says so."""
    draft.rebinds[name] = (request, "")
    draft.rebinds.bounded(MOST_VEHICLES)


def rebound(draft: Draft, time: float, name: str) -> None:
    """Note that a vehicle is heard, where it was or elsewhere."""
    _, number = draft.rebinds.pop(name, ("", ""))
    settle(draft, time, number, "confirmed")


def not_rebound(draft: Draft, time: float, name: str, request: str, why: str) -> None:
    """Note that a vehicle is not believed elsewhere, and why."""
    known, number = draft.rebinds.get(name, ("", ""))
    if number and known == request:
        draft.rebinds.pop(name)
        settle(draft, time, number, "refused", why)
