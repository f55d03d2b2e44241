"""What operators do: asked of the run, sent to vehicles, confirmed by their reports, or refused."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.alerts import vanity
from adapters.console.draft import Draft
from adapters.console.parsing import text, texts
from adapters.console.ticks import tick
from adapters.console.view import Json

MOST: Final = 500
MOST_AWAITED: Final = 1_000


def take_saying(draft: Draft, time: float, data: Any) -> None:
    """Take in a message that someone said to an agent: it is in the mailbox, or was refused."""
    match data:
        case {"agent": str(agent), "message": str(message)}:
            _act(draft, time, data, f'say "{text(message)}"', text(agent), vain=vanity(draft, text(agent)))


def take_giving_back(draft: Draft, time: float, data: Any) -> None:
    """Take in that a vehicle was given back, or is heard elsewhere from now on."""
    match data:
        case {"vehicle": str(name), "at": str(at), **rest}:
            _act(draft, time, rest, f"is at {text(at)}", text(name), f"link {name}")
        case {"vehicle": str(name)}:
            refused = bool(data.get("refusal"))
            _act(draft, time, data, "give back", text(name))
            if not refused:
                draft.taken.pop(name, None)
                draft.bidden.pop(name, None)


def take_order(draft: Draft, time: float, data: Any) -> None:
    """Take in that vehicles were ordered to hold or to return: what is done is confirmed by each of them."""
    match data:
        case {"order": "hold" | "return" as order, "requests": dict(requests)}:
            told = {name: request for name, request in requests.items() if isinstance(request, str)}
            name = data.get("vehicle")
            about = text(name) if isinstance(name, str) else "all"
            _act(draft, time, data, order, about, *told.values())
            by = f"the operator ({text(data.get('by'))})" if data.get("by") else "the operator"
            for vehicle in told:
                draft.taken.pop(vehicle, None)  # who had taken it over is overruled
                draft.bidden[vehicle] = f"{'held' if order == 'hold' else 'sent home'} by {by}"


def _act(
    draft: Draft, time: float, data: Any, what: str, about: str, *awaits: str, vain: str | None = None
) -> None:
    """Note an action: the requests that are to be confirmed, and why nothing comes of what was said."""
    draft.acted += 1
    why = text(data.get("refusal"))
    state = "refused" if why else "sent" if awaits else "confirmed"
    draft.actions[str(draft.acted)] = {
        "time": time,
        "by": text(data.get("by")),
        "what": what,
        "about": about,
        "state": state,
        "why": why,
        "left_out": _left_out(data.get("left_out")),
        "notes": texts(data.get("notes")),
        "vain": None if why else vain,
        "answered": None if state == "sent" else time,
    }
    draft.actions.bounded(MOST)
    if state == "sent":
        draft.awaited.update(dict.fromkeys(awaits, draft.acted))
        draft.awaited.bounded(MOST_AWAITED)
    if why or awaits or what == "give back":
        tick(draft, time, "action")


def _left_out(said: Any) -> dict[str, str]:
    named = list(said.items())[:MOST_AWAITED] if isinstance(said, dict) else []
    return {text(name): text(why) for name, why in named}


def confirm(draft: Draft, time: float, request: str, refusal: str | None) -> None:
    """Note that a request is confirmed, or why it was refused; an action is done when all that it awaits is."""
    number = draft.awaited.pop(request, None) if request in draft.awaited else None
    action: Json = draft.actions.get(str(number))
    if action is None:
        return
    if refusal is not None:
        answer = {"state": "refused", "why": refusal}
    elif action["state"] == "sent" and number not in draft.awaited.values():
        answer = {"state": "confirmed"}
    else:
        return
    draft.actions[str(number)] = {**action, **answer, "answered": time}


# --- what an operator has seen ------------------------------------------------------------------------


def take_acknowledgement(draft: Draft, time: float, data: Any) -> None:
    """Take in that an operator has seen a finding."""
    match data:
        case {"finding": int(number)} if str(number) in draft.alerts:
            seen = {"by": text(data.get("by")), "time": time}
            alert = draft.alerts[str(number)]
            draft.alerts[str(number)] = {**alert, "acknowledged": seen}
            _act(draft, time, data, "acknowledge", alert["about"])
