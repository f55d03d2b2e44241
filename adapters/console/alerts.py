"""Findings: what the operator was told, and what stands until it is acknowledged."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.draft import Draft
from adapters.console.parsing import text, texts
from adapters.console.ticks import tick
from adapters.console.view import Json

MOST: Final = 1_000

WRONG: Final = frozenset(
    {"broken assumption", "refused", "taken over", "lost link", "late", "blocked", "failed"}
)
"""The kinds of findings that stand until somebody has seen them."""

STOPPING: Final = frozenset({"hold", "return"})
"""The fallbacks after which controls are served no more: of the agent that is late, else of all."""

OF_ACTIONS: Final = frozenset({"ordered", "confirmed"})
"""The kinds that tell what became of an action, which has a tick of its own."""

ALL: Final = ""
"""Stands for all agents among those whose controls are served no more."""

CONSOLES_OWN: Final = "0"
"""The key of what the console itself has to say; findings are counted from 1."""


def take_finding(draft: Draft, time: float, data: Any) -> None:
    """Take in a finding; its number counts the messages of its topic."""
    draft.found += 1
    alert = _alert(time, data)
    draft.alerts[str(draft.found)] = alert
    draft.alerts.bounded(MOST)
    if alert["kind"] == "failed" and len(draft.failed) < MOST:
        draft.failed |= {alert["about"]}
    if alert["fallback"] in STOPPING and not _is_copied(draft, time):
        draft.stopped[alert["about"] if alert["kind"] == "late" else ALL] = alert["fallback"]
        draft.stopped.bounded(MOST)
    if alert["kind"] not in OF_ACTIONS:
        tick(draft, time, "finding")


def _is_copied(draft: Draft, time: float) -> bool:
    """Tell whether something was found in the run that this one resumes: it begins once the world is right again."""
    return draft.run is not None and time < draft.run.mission["begun"]


def tell(draft: Draft, message: str) -> None:
    """Alert of what the console itself has found; it stands in no red line."""
    draft.alerts[CONSOLES_OWN] = _alert(draft.time, {"kind": "console", "message": message})


def _alert(time: float, data: Any) -> dict[str, Json]:
    kind, about, message, fallback = (text(data.get(key)) for key in ("kind", "about", "message", "fallback"))
    return {
        "time": time,
        "kind": kind,
        "about": about,
        "message": message,
        "fallback": fallback,
        "verdicts": texts(data.get("verdicts")),
        "wrong": kind in WRONG or bool(fallback),
        "acknowledged": None,
    }
