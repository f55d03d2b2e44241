"""The sections of a view, each made from the facts."""

from __future__ import annotations

from functools import lru_cache

from adapters.console.agent_states import agents, sayings
from adapters.console.alerts import alarms, fallen_back
from adapters.console.cards import vehicles
from adapters.console.closest_approach import approaches
from adapters.console.console_view import Json, Section, View, keeping
from adapters.console.entity_tracks import tracks
from adapters.console.facts import Facts
from adapters.console.station_list import stations
from adapters.console.watched_ways import ways
from adapters.console.whereabouts import entities, places
from bigraphs import draw_text
from semantics.state.configuration import Configuration


def view_of(facts: Facts, now: float, head: Facts, picture: Section, before: View) -> View:
    """Return the view of facts at a time; values equal to those of the view before are the same objects.

    `head` are the newest facts of the recording, and `picture` is the newest picture of L. While a run goes on, the
    view of an earlier moment has the current alarms.
    """
    if facts.run is None:
        return before
    ends = head.broken_off and facts.time >= head.time
    cards, shown = vehicles(facts, now, (head.ended or "") if ends else ""), places(facts)
    sections: dict[str, Section] = {
        "mission": {**facts.run.mission, "fallen_back": fallen_back(facts) or None},
        "clock": _clock(facts, head),
        "places": shown,
        "fences": facts.run.fences,
        "entities": entities(facts, now, shown),
        "vehicles": cards,
        "approaches": approaches(facts, now),
        "tracks": tracks(facts),
        "ways": ways(facts),
        "invariants": facts.invariants,
        "agents": agents(facts),
        "steps": facts.steps,
        "ticks": head.ticks,
        "bigraph": _bigraph(facts, picture),
        "alerts": facts.alerts,
        "alarms": alarms(facts if head.ended is not None else head),
        "sayings": sayings(facts),
        "actions": facts.actions,
        "stations": stations(facts, cards),
        "preflight": facts.preflight,
    }
    return View({name: keeping(before.sections.get(name, {}), each) for name, each in sections.items()})


def _clock(facts: Facts, head: Facts) -> dict[str, Json]:
    """Return the recording's part of the section `clock`; each browser adds its play head."""
    begin = head.time if head.begin is None else head.begin
    rate = None if facts.run is None else facts.run.rate
    ended = {"ended": head.ended, "broken_off": head.broken_off}
    return {"begin": begin, "head": head.time, **ended, "step": facts.step, "rate": rate}


def _bigraph(facts: Facts, picture: Section) -> dict[str, Json]:
    if facts.standing is None:
        return {}
    change = facts.standing.change
    return {**picture, "text": _drawn_in_text(change.after), "step": change.number}


@lru_cache(maxsize=64)
def _drawn_in_text(c: Configuration) -> str:
    return draw_text(c.structure.logical.bigraph())
