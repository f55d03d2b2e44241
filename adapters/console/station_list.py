"""The stations: their connection, the times of their last messages, and the vehicles that each controls."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import ControllingStations, Facts
from adapters.console.parsing import number, text
from semantics.state.signature import Name

MOST: Final = 1_000


def take_presence(draft: Facts, _time: float, data: Any) -> None:
    """Take in whether another station of the run is reached."""
    station = text(data.get("station"))
    if draft.run is not None and station in draft.run.stations:
        truths = {key: data.get(key) for key in ("reached", "agrees", "begun")}
        known = {key: each if isinstance(each, bool) else None for key, each in truths.items()}
        draft.stations[station] = {**known, "heard": number(data.get("heard"))}


def obeys(draft: Facts, time: float, name: Name, stations: tuple[str, ...]) -> None:
    """Note the controlling stations of a vehicle; an empty tuple means unknown and changes nothing."""
    known = draft.authority.get(name)
    if not stations or (known is not None and known.stations == stations):
        return
    handed = None if known is None else {"time": time, "from": [*known.stations], "to": [*stations]}
    draft.authority[name] = ControllingStations(stations, handed)
    draft.authority.bounded(MOST)


def stations(facts: Facts, cards: Mapping[str, Json]) -> dict[str, Json]:
    """Return the section `stations`; empty if one station flies alone."""
    if facts.run is None:
        return {}
    unknown = {"reached": None, "heard": None, "agrees": None, "begun": None}
    return {
        name: {
            "here": name == facts.run.station,
            **facts.stations.get(name, unknown),
            "vehicles": [vehicle for vehicle, card in cards.items() if name in card["authority"]],
        }
        for name in facts.run.stations
    }
