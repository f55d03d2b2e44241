"""The run's findings as alerts; an alert of something wrong stands until an operator acknowledges it."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.console_view import Json, Section
from adapters.console.facts import Facts
from adapters.console.parsing import text, texts

MOST: Final = 1_000

WRONG: Final = frozenset(
    {
        "broken assumption",
        "broken property",
        "refused",
        "taken over",
        "lost link",
        "late",
        "blocked",
        "failed",
    }
)
"""The kinds of findings that stand until an operator acknowledges them."""

STOPPING: Final = {"hold": "hold", "return": "return home"}
"""The fallbacks that end the serving of controls, with their words.

After a late request they end it for that agent, after another finding for all agents.
"""

OF_ACTIONS: Final = frozenset({"ordered", "confirmed"})
"""The kinds of findings about an action; they get no tick, since the action has its own."""

ALL: Final = ""
"""The key of `stopped` for all agents."""

CONSOLES_OWN: Final = "0"
"""The key of the console's own alert; findings are counted from 1."""


def take_finding(draft: Facts, time: float, data: Any) -> None:
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
        draft.tick(time, "finding")


def _is_copied(draft: Facts, time: float) -> bool:
    """Return whether a finding is from the run that this one resumes.

    Its fallback does not count here: a run resumes only when its assumptions hold again.
    """
    return draft.run is not None and time < draft.run.mission["begun"]


def tell(draft: Facts, message: str) -> None:
    """Set the console's own alert, which never stands in the red line."""
    draft.alerts[CONSOLES_OWN] = _alert(draft.time, {"kind": "console", "message": message})


# --- alarms and consequences --------------------------------------------------------------------------


def alarms(facts: Facts) -> Section:
    """Return the section `alarms`: the unacknowledged alerts of something wrong, with their consequences."""
    return {
        number: {**alert, "consequence": _consequence(facts, alert)}
        for number, alert in facts.alerts.items()
        if alert["wrong"] and alert["acknowledged"] is None
    }


def fallen_back(facts: Facts) -> str:
    """Return the consequence of the mission's fallback; empty if it has not fallen back as a whole."""
    if ALL not in facts.stopped:
        return ""
    told = STOPPING[facts.stopped[ALL]]
    return f"all vehicles were commanded to {told}; the mission sends no more commands"


def grounded(agent: str) -> str:
    """Return the consequence of an agent's fallback."""
    return f"no command of {agent} is carried out any more"


def vanity(facts: Facts, agent: str) -> str | None:
    """Return why a message to an agent has no effect; None while the mission still commands vehicles for it."""
    if ALL in facts.stopped:
        return "the mission has fallen back and sends no more commands: messages move no vehicle"
    return f"the mission has fallen back: {grounded(agent)}" if agent in facts.stopped else None


def _consequence(facts: Facts, alert: Json) -> str:
    """Return the consequence of a finding; once the whole mission has fallen back, that consequence counts for all."""
    fallback = alert["fallback"]
    if whole := fallen_back(facts):
        return whole
    if fallback in STOPPING:
        return f"its vehicles were commanded to {STOPPING[fallback]}; {grounded(alert['about'])}"
    return "the mission goes on" if fallback else _of_vehicle(facts, alert["kind"], alert["about"])


def _of_vehicle(facts: Facts, kind: str, name: str) -> str:
    """Return the consequence of a lost link or a take-over, as it is now; empty after the run."""
    if facts.ended is not None:
        return ""
    if kind == "lost link":
        lost = name in facts.links and facts.links[name].lost
        return "its autopilot decides, and orders reach it once it is heard" if lost else "it is heard again"
    if kind == "taken over":
        away = name in facts.taken or name in facts.standing_orders
        return "the mission does not command it until it is given back" if away else "it was given back"
    return ""


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
