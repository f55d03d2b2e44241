"""Arrivals, steps, commands and reports as plain data for recordings."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from adapters.live.batch import Acknowledging, GivingBack, Heard, Noting, Ordering, Saying
from adapters.live.flown_ways import FlownWay
from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.live.seen_regions import way_of
from adapters.live.timing_monitor import Timers, flying
from adapters.live.turn_result import Answer, LiveStep
from adapters.live.watched import WatchedInvariant
from adapters.plugin import Aged, Battery, Command, Gone, Presence, Report, Seen, Status, StatusText
from physical import Band, Geometry, PhysicalProperty
from semantics.state.canonical import digest_of_step
from semantics.state.observation_serialization import sight_json
from semantics.state.signature import Name


def arrival_json(heard: Heard) -> dict[str, Any]:
    """Return a plugin's publication as plain data."""
    published = heard.published
    if isinstance(published, Gone):
        said = {"entity": published.entity, "time": published.time, "gone": True, "source": published.source}
        return {"plugin": heard.plugin, **said}
    if isinstance(published, Aged):
        return {**_property(heard.plugin, published.property), "time_to_live": published.time_to_live}
    return _property(heard.plugin, published)


def _property(plugin: str, said: PhysicalProperty) -> dict[str, Any]:
    data: dict[str, Any] = {
        "plugin": plugin,
        "entity": said.entity,
        "kind": said.kind,
        "ring": said.geometry.ring,
    }
    if said.altitude is not None:
        data["altitude"] = [said.altitude.low, said.altitude.high]
    if said.channels:
        data["channels"] = said.channels
    if said.carried_by is not None:
        data["carried_by"] = said.carried_by
    if said.time is not None:
        data["time"] = said.time
    if said.velocity is not None:
        data["velocity"] = [said.velocity.speed, said.velocity.course]
    return data


def step_json(step: LiveStep) -> dict[str, Any]:
    """Return a step as plain data: like a step of a trace, with its number and the digest of its writes."""
    transition = step.transition
    data: dict[str, Any] = {"number": step.number, "label": str(transition.label), "choice": step.choice}
    if step.sight is not None:
        data["observed"] = sight_json(step.sight)
    if transition.shown:
        data["shown"] = transition.shown
    dated = {} if step.date == step.time else {"date": step.date}
    return {**data, **dated, "digest": digest_of_step(step.source, transition.target)}


def command_json(command: Command) -> dict[str, Any]:
    """Return a command to a vehicle as plain data."""
    return {"command": type(command).__name__, **_fields(command, "around", "shape")}


def report_json(report: Report) -> dict[str, Any]:
    """Return a plugin's report as plain data."""
    return {"report": type(report).__name__, **_fields(report, "place")}


def seen_json(seen: Seen) -> tuple[str, dict[str, Any]]:
    """Return the topic of a report for people alone, and the report as plain data."""
    data = {each.name: _plain(getattr(seen, each.name)) for each in fields(seen)}
    match seen:
        case Status():
            more = {name: data.pop(name) for name in ("lacks", "follows", "surface")}
            return "status", data | {name: each for name, each in more.items() if each}
        case StatusText():
            return "said", data
        case Presence():
            return "stations", data


def answer_json(answer: Answer) -> tuple[str, dict[str, Any]] | None:
    """Return the topic and the data of an operator's message, None for a refused acknowledgement or note."""
    said, refusal = answer.saying, {"refusal": answer.refusal}
    match said:
        case Saying(agent, message, by):
            return "sayings", {"agent": agent, "message": message, "by": by, **refusal}
        case GivingBack(vehicle, at, by):
            more = {name: each for name, each in {"at": at, "notes": answer.notes}.items() if each}
            return "given_back", {"vehicle": vehicle, "by": by, **more, **refusal}
        case Ordering(order, vehicle, by):
            others = {"left_out": dict(answer.left_out), "notes": answer.notes}
            told = {
                "requests": dict(answer.requests),
                **{name: each for name, each in others.items() if each},
            }
            return "orders", {"order": order.value, "vehicle": vehicle, "by": by, **told, **refusal}
        case Acknowledging(finding, by):
            return None if answer.refusal else ("acknowledged", {"finding": finding, "by": by})
        case Noting(text, by):
            return None if answer.refusal else ("notes", {"text": text, "by": by})


def clocks_json(timers: Timers | None) -> dict[str, float]:
    """Return the start and the standstill of the mission's clocks as plain data; empty without timing."""
    return {} if timers is None else {"began": timers.began, "rested": timers.rested}


def flights_json(timers: Timers | None) -> dict[Name, dict[str, Any]]:
    """Return the destination, start and durations of each flight under way as plain data."""
    under_way = () if timers is None else flying(timers)
    return {
        each.vehicle: {"to": each.destination, "since": each.since, "least": each.least, "most": each.most}
        for each in under_way
    }


def ways_json(state: LiveState) -> dict[Name, dict[str, Any]]:
    """Return the way of each vehicle that the mission commands as plain data."""
    commanded, overrides = state.commanded, state.overrides
    names = commanded.flights.keys() | commanded.rests.keys()
    ways = {name: way_of(name, commanded, overrides) for name in sorted(names)}
    begins = {name: FlownWay((at,)) for name, at in commanded.begins.items()}
    return {
        name: {"to": way.to, "points": [each.ring[0] for each in way.points], "passed": way.passed}
        for name, way in (begins | ways).items()
        if way is not None
    }


def invariant_json(watched: WatchedInvariant) -> dict[str, Any]:
    """Return an invariant about ways, compared with what is seen, as plain data."""
    return {each.name: getattr(watched, each.name) for each in fields(watched)}


def finding_json(finding: Finding, verdicts: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return a finding as plain data."""
    return {**_fields(finding), **({"verdicts": verdicts} if verdicts else {})}


def _fields(value: Any, *left_out: str) -> dict[str, Any]:
    named = ((each.name, getattr(value, each.name)) for each in fields(value) if each.name not in left_out)
    return {"ring" if name == "place" else name: _plain(part) for name, part in named if part is not None}


def _plain(value: Any) -> Any:
    match value:
        case Geometry():
            return value.ring
        case Band():
            return [value.low, value.high]
        case Battery(percent, volts):
            return {"percent": percent, "volts": volts}
        case tuple():
            return [_plain(each) for each in value]
        case _:
            return value
