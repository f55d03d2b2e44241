"""Findings: what the operator was told, and what stands until it is acknowledged."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.facts import Facts
from adapters.console.mutable_facts import Draft
from adapters.console.parsing import text, texts
from adapters.console.ticks import tick
from adapters.console.view import Json, Section

MOST: Final = 1_000

WRONG: Final = frozenset(
    {"broken assumption", "refused", "taken over", "lost link", "late", "blocked", "failed"}
)
"""The kinds of findings that stand until somebody has seen them."""

STOPPING: Final = {"hold": "hold", "return": "return home"}
"""The fallbacks after which controls are served no more, of the agent that is late, else of all; in words."""

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


# --- what stands --------------------------------------------------------------------------------------


def alarms(facts: Facts) -> Section:
    """Return the section `alarms`: what is wrong and not acknowledged, each with its consequence."""
    return {
        number: {**alert, "consequence": _consequence(facts, alert)}
        for number, alert in facts.alerts.items()
        if alert["wrong"] and alert["acknowledged"] is None
    }


def fallen_back(facts: Facts) -> str:
    """Return what it means that the mission has fallen back; empty where it has not."""
    if ALL not in facts.stopped:
        return ""
    told = STOPPING[facts.stopped[ALL]]
    return f"all vehicles were told to {told}; the mission commands nothing any more"


def grounded(agent: str) -> str:
    """Return what it means that an agent's controls are served no more."""
    return f"nothing that {agent} orders is carried out any more"


def vanity(facts: Facts | Draft, agent: str) -> str | None:
    """Return why nothing comes of what is said to an agent, None if something may: the mission commands vehicles."""
    if ALL in facts.stopped:
        return "the mission has fallen back and commands nothing any more: what is said moves no vehicle"
    return f"the mission has fallen back: {grounded(agent)}" if agent in facts.stopped else None


def _consequence(facts: Facts, alert: Json) -> str:
    """Return what follows from a finding, or from all that was found: the latter counts for every vehicle."""
    fallback = alert["fallback"]
    if whole := fallen_back(facts):
        return whole
    if fallback in STOPPING:
        return f"its vehicles were told to {STOPPING[fallback]}; {grounded(alert['about'])}"
    return "the mission goes on" if fallback else ""


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
