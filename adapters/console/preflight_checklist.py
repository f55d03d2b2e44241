"""The preflight checklist of a run that waits for an operator's start."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.mutable_facts import Draft
from adapters.console.parsing import text, texts

STATES: Final = ("waits", "ready", "begun")
MOST: Final = 1_000


def take_preflight(draft: Draft, _time: float, data: Any) -> None:
    """Take in the checklist, and whether the run waits, is ready to start, or has begun."""
    match data:
        case {"state": str(state), "items": list(items)} if state in STATES:
            draft.preflight["state"] = state
            draft.preflight["by"] = text(data.get("by"))
            draft.preflight["items"] = [_item(each) for each in items[:MOST] if isinstance(each, dict)]


def _item(said: dict[Any, Any]) -> Json:
    vehicle = text(said.get("vehicle"))
    ready = {"fence": text(said.get("fence")) or None, "refuses": texts(said.get("refuses"))}
    return {
        "what": text(said.get("what")),
        "done": said.get("done") is True,
        "detail": text(said.get("detail")),
        **({"vehicle": vehicle, **ready} if vehicle else {}),
    }
