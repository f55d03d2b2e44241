"""The operators' actions and their states: asked of the run, sent to vehicles, confirmed by them, or refused."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.alerts import vanity
from adapters.console.console_view import Json
from adapters.console.facts import Facts
from adapters.console.parsing import text, texts

MOST: Final = 500
MOST_NAMED: Final = 1_000

SETTLED: Final = ("confirmed", "refused")
"""The final states of an action."""


def take_saying(draft: Facts, time: float, data: Any) -> None:
    """Take in an operator's message to an agent: it is in the mailbox, or was refused."""
    match data:
        case {"agent": str(agent), "message": str(message)}:
            number = act(draft, time, data, f'say "{text(message)}"', text(agent))
            if draft.actions[number]["state"] != "refused":
                said = {**draft.actions[number], "vain": vanity(draft, text(agent))}
                draft.actions[number] = said


def act(draft: Facts, time: float, data: Any, what: str, about: str, state: str = "confirmed") -> str:
    """Add an action in a state, or as refused if the run refused it; return its number."""
    draft.acted += 1
    why = text(data.get("refusal"))
    state = "refused" if why else state
    draft.actions[str(draft.acted)] = {
        "time": time,
        "by": text(data.get("by")),
        "what": what,
        "about": about,
        "state": state,
        "why": why,
        "fates": {},
        "left_out": _left_out(data.get("left_out")),
        "notes": texts(data.get("notes")),
        "vain": None,
        "answered": time if state in SETTLED else None,
    }
    draft.actions.bounded(MOST)
    if sort := "note" if what == "note" else "action" if state != "confirmed" or what == "give back" else "":
        draft.tick(time, sort)
    return str(draft.acted)


def _left_out(said: Any) -> dict[str, str]:
    named = list(said.items())[:MOST_NAMED] if isinstance(said, dict) else []
    return {text(name): text(why) for name, why in named}


def settle(draft: Facts, time: float, number: str, state: str, why: str = "") -> None:
    """Set the final state of an action."""
    action: Json = draft.actions.get(number)
    if action is not None:
        draft.actions[number] = {**action, "state": state, "why": why, "answered": time}


# --- acknowledgements ---------------------------------------------------------------------------------


def take_acknowledgement(draft: Facts, time: float, data: Any) -> None:
    """Take in that an operator has acknowledged a finding."""
    match data:
        case {"finding": int(number)} if str(number) in draft.alerts:
            seen = {"by": text(data.get("by")), "time": time}
            alert = draft.alerts[str(number)]
            draft.alerts[str(number)] = {**alert, "acknowledged": seen}
            act(draft, time, data, "acknowledge", alert["about"])


# --- notes --------------------------------------------------------------------------------------------


def take_note(draft: Facts, time: float, data: Any) -> None:
    """Take in an operator's note."""
    match data:
        case {"text": str(said)}:
            act(draft, time, data, "note", text(said))
