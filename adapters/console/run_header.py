"""The parsing of a recording's `run`: the mission, its verdict, its vehicles, and the recording station."""

from __future__ import annotations

from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import Run
from adapters.console.parsing import number, ring, text, texts
from semantics.live_policy import Fallback, TimeLimit

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
        "name": text(data["mission"]),
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
