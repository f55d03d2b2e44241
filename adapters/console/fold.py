"""The fold: it applies the next messages of a recording to the facts: its `run`, its steps, and all others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, Final

from adapters.console.agent_states import take_deadline
from adapters.console.alerts import take_finding, tell
from adapters.console.console_view import Json
from adapters.console.entity_tracks import take_arrival
from adapters.console.facts import Change, Facts, Opening, Run, Standing, Unreplayable
from adapters.console.fates import take_giving_back, take_order
from adapters.console.flights import arrive, take_command, take_flight, take_report, take_status, take_words
from adapters.console.operator_actions import act, take_acknowledgement, take_note, take_saying
from adapters.console.parsing import count, number, ring, text, texts
from adapters.console.station_list import take_presence
from adapters.console.watched_ways import take_invariant, take_way
from adapters.live.due_times import HeadRequest
from adapters.live.fallbacks import heads_of
from adapters.live.run_watchers import SHOWN_RULES
from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import Message
from adapters.recording.recording_reader import checked_run
from semantics.live_policy import Fallback, TimeLimit
from semantics.state.brief import cut
from semantics.state.canonical import written
from semantics.state.configuration import Configuration, Label
from semantics.state.differences import differences
from semantics.state.requests import REQUESTS, SND

MOST_STEPS: Final = 200
"""The number of newest steps that are kept."""

MOST_CHANGES: Final = 40

SORTS: Final = {"env": "world", "commit": "world", "say": "say"}
"""The sort of a tick, by its rule; `control` for the other rules of `SHOWN_RULES`."""

STRUCTURE: Final = frozenset({"parent", "links", "placement", "channels", "down", "names"})
"""The cells of L and P."""


def take_step(draft: Facts, time: float, data: Any) -> None:
    """Take in a step: the configuration after it, and the changes."""
    label, number = data.get("label"), count(data.get("number"))
    if not isinstance(label, str) or number is None:
        return
    before = draft.standing
    found = None if before is None else _followed(draft, before, number, time, data)
    rule = label.removeprefix("⟨").partition(" ")[0] if found is None else found.rule
    shown = texts(data.get("shown"))
    told = rule in SHOWN_RULES or bool(shown)
    changed: tuple[str, ...] = ()
    if before is not None and draft.standing is not None:
        changed = changes(before.configuration, draft.standing.configuration)
    draft.step = number
    draft.steps[str(number)] = {
        "time": time,
        "label": text(label),
        "rule": text(rule),
        "agent": None if found is None else found.agent,
        "about": text(label.partition(" : ")[2].removesuffix("⟩") if found is None else found.details),
        "changes": changed,
        "shown": shown,
        "told": told,
    }
    draft.steps.bounded(MOST_STEPS)
    if rule in SHOWN_RULES:
        draft.tick(time, SORTS.get(rule, "control"))


def _followed(draft: Facts, standing: Standing, number: int, time: float, data: Any) -> Label | None:
    """Replay a step and return its label; if the rules do not allow it, give up the replay for good."""
    before = standing.configuration
    try:
        label, after = standing.rules.follow(before, data)
    except Unreplayable as error:
        tell(draft, f"the logical model is not known any more: {error}")
        draft.standing = None
        return None
    change = Change(number, before, after) if is_structural(before, after) else standing.change
    draft.standing = Standing(standing.rules, after, change, _heads(standing, label, after, time))
    arrive(draft, label, before)
    return label


def _heads(standing: Standing, label: Label, after: Configuration, time: float) -> Mapping[str, HeadRequest]:
    """Return the heads of lines after a step; the wait of a next request starts now, even if it is an equal one."""
    served = isinstance(label.about, REQUESTS) and not isinstance(label.about, SND)
    known = {key: each for key, each in standing.heads.items() if not (served and key == label.agent)}
    return heads_of(after, known, time)


@lru_cache(maxsize=1 << 12)
def changes(before: Configuration, after: Configuration) -> tuple[str, ...]:
    """Return descriptions of the changes of a step; cached, since observing loops repeat the same steps."""
    return tuple(cut(each, 200) for each in differences(before, after)[:MOST_CHANGES])


@lru_cache(maxsize=1 << 12)
def is_structural(before: Configuration, after: Configuration) -> bool:
    """Return whether a step has changed L or P."""
    return any(cell[0] in STRUCTURE for cell in written(before, after))


MOST: Final = 1_000

RESTS_ON: Final = {
    "text": ["the mission's text"],
    "environment": ["the environment section"],
}
"""The words for the premises of a verdict."""


def run_of(data: dict[str, Any], begun: float) -> Run:
    """Return the content of a checked `run`."""
    station = data.get("station")
    here = text(station.get("here")) if isinstance(station, dict) else ""
    hosts = station.get("hosts") if isinstance(station, dict) else None
    named = hosts.values() if isinstance(hosts, dict) else ()
    stations = dict.fromkeys([here, *(text(each) for each in list(named)[:MOST])]) if here else {}
    return Run(
        _mission(data, begun, here),
        _vehicles(data.get("vehicles")),
        _fences(data.get("fences")),
        _limits(data.get("limits")),
        here,
        tuple(sorted(stations)),
        _rate(data.get("rate", 1.0)),
    )


def _rate(said: Any) -> float | None:
    rate = number(said)
    return rate if rate is not None and rate > 0 else None


def _mission(data: dict[str, Any], begun: float, here: str) -> dict[str, Json]:
    verdict = data.get("verdict") if isinstance(data.get("verdict"), dict) else {}
    assert isinstance(verdict, dict)
    properties = verdict.get("properties")
    return {
        "name": text(data["mission"]).rpartition("/")[2],  # it may be given as a path
        "digest": text(data["digest"]),
        "verified": data.get("verified") is True,
        "verdicts": [_verdict(each) for each in properties[:MOST]] if isinstance(properties, list) else [],
        "scheduler": text(verdict.get("scheduler")) or None,
        "begun": begun,
        "station": here or None,
    }


def _verdict(data: Any) -> Json:
    said = data if isinstance(data, dict) else {}
    resting = said.get("rests_on")
    return {
        "property": text(said.get("name")),
        "verdict": text(said.get("verdict")),
        "rests_on": RESTS_ON.get(resting, [text(resting)]) if isinstance(resting, str) else texts(resting),
    }


def _vehicles(data: Any) -> dict[str, str]:
    named = list(data.items())[:MOST] if isinstance(data, dict) else []
    return {name: plugin for name, plugin in named if isinstance(plugin, str)}


def _fences(data: Any) -> dict[str, Json]:
    named = list(data.items())[:MOST] if isinstance(data, dict) else []
    rings = ((name, ring(each)) for name, each in named)
    return {name: {"ring": found} for name, found in rings if found}


def _limits(data: Any) -> tuple[TimeLimit, ...] | None:
    if not isinstance(data, list):
        return None
    found = (_limit(each) for each in data[:MOST])
    return tuple(each for each in found if each is not None)


def _limit(data: Any) -> TimeLimit | None:
    match data:
        case {
            "request": str() | None as request,
            "agent": str() | None as agent,
            "seconds": said,
            "fallback": "hold" | "return" | "continue" as fallback,
        } if (seconds := number(said)) is not None:
            return TimeLimit(request, agent, seconds, Fallback(fallback))
    return None


STATES: Final = ("waits", "ready", "begun")


def take_preflight(draft: Facts, time: float, data: Any) -> None:
    """Take in the checklist, and whether the run waits, is ready to start, or was started by an operator."""
    match data:
        case {"state": str(state), "items": list(items)} if state in STATES:
            if state == "begun" != draft.preflight.get("state") and text(data.get("by")):
                act(draft, time, {"by": data["by"]}, "start", "")
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


TOPICS: Final[dict[str, Callable[[Facts, float, Any], None]]] = {
    "arrivals": take_arrival,
    "steps": take_step,
    "deadlines": take_deadline,
    "flights": take_flight,
    "ways": take_way,
    "invariants": take_invariant,
    "commands": take_command,
    "reports": take_report,
    "sayings": take_saying,
    "given_back": take_giving_back,
    "orders": take_order,
    "findings": take_finding,
    "acknowledged": take_acknowledgement,
    "notes": take_note,
    "status": take_status,
    "said": take_words,
    "stations": take_presence,
    "preflight": take_preflight,
}
"""The handler of each topic's messages; the console shows nothing of other topics."""


def take(draft: Facts, message: Message, opening: Opening) -> None:
    """Take in a message; raises RecordingError if the recording is not of a run."""
    draft.changed = True
    if draft.run is None:
        if message.topic == "run":
            _begin(draft, message, opening)
        return
    draft.time = time_of(draft, message)
    if isinstance(message.data, dict):
        if message.topic == "end":
            draft.end(text(message.data.get("reason")) or "the run has ended", broken_off=False)
        elif message.topic in TOPICS:
            draft.begin = draft.time if draft.begin is None else draft.begin
            TOPICS[message.topic](draft, draft.time, message.data)


def time_of(facts: Facts, message: Message) -> float:
    """Return the time at which a message counts: time never goes back, even after the old messages of a resumed run.

    The topic `end` and those for other programs may use another clock; their messages count at the current time.
    """
    if facts.run is None or (facts.begin is None and message.topic != "end"):
        return message.time
    timeless = message.topic == "end" or message.topic.startswith(OTHERS)
    return facts.time if timeless else max(facts.time, message.time)


def _begin(draft: Facts, message: Message, opening: Opening) -> None:
    run = checked_run(message.data if isinstance(message.data, dict) else None)
    draft.run, draft.time = run_of(run, message.time), message.time
    try:
        rules = opening(run)
    except Unreplayable as error:
        tell(draft, f"the logical model is not known: {error}")
        return
    first = rules.initial
    draft.standing = Standing(rules, first, Change(0, first, first), heads_of(first, {}, message.time))
