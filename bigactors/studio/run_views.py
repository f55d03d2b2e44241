"""A run, and a configuration of it, as plain data for pages: lanes, the map's sections, and the bigraph."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, lru_cache
from typing import Any, Final

from adapters.console.facts import SeenEntity
from adapters.console.whereabouts import degrees, entity_of, places_of, positions_of, whereabouts
from bigactors.pictures import logical_picture, look_of
from bigraphs import draw_text
from checker import Trace
from checker.reports.causes import Cause
from checker.reports.lanes import LaneStep, Repetition, folded, lanes_of_trace
from checker.reports.plain_steps import agent_words, step_words
from physical import centroid
from semantics.state.configuration import Configuration
from semantics.state.differences import where_words
from semantics.state.physical_model import InTransit
from semantics.state.printing import print_agent
from semantics.state.signature import REGION, Name

MOST_PICTURES: Final = 64


def run_json(trace: Trace, causes: Sequence[Cause] = ()) -> dict[str, Any]:
    """Return a run in lanes: their names, its steps in words, and the steps that only repeat others."""
    lanes = lanes_of_trace(trace)
    rows = folded(lanes.steps)
    guilty = {cause.number for cause in causes if cause.is_step}
    pairs = zip(lanes.steps, trace.configurations, trace.configurations[1:], strict=False)
    words = cache(step_words)  # a loop repeats its steps
    return {
        "lanes": lanes.names,
        "hosts": [agent_words(trace.initial, name) for name in lanes.names],
        "steps": [
            _step_json(step, words(before, step.label, after), is_cause=step.number in guilty)
            for step, before, after in pairs
        ],
        "folds": [[row.number, row.last, row.about] for row in rows if isinstance(row, Repetition)],
        "causes": [
            {"step": cause.number, "text": cause.text, "after": not cause.is_step} for cause in causes
        ],
        "loop": trace.loop,
        "end": lanes.end,
    }


def _step_json(step: LaneStep, words: str, *, is_cause: bool) -> dict[str, Any]:
    told: dict[str, Any] = {
        "lane": step.lane,
        "rule": step.label.rule,
        "words": words,
        "label": str(step.label),
        "changes": [[change.part, change.text] for change in step.changes],
        "sort": "serves" if step.serves else "environment" if step.label.agent is None else "agent",
    }
    more = {"date": step.date, "at": step.at, "role": step.role, "cause": is_cause or None}
    return told | {key: value for key, value in more.items() if value not in ("", None)}


def parts_json(c: Configuration, before: Configuration | None) -> dict[str, Any]:
    """Return the agents and the pending requests of a configuration, each with whether it is new."""
    agents = [print_agent(c, a) for a in c.alpha.names()]
    requests = [str(each.request) for each in c.eta.all()]
    known = set(agents) if before is None else {print_agent(before, a) for a in before.alpha.names()}
    asked = set(requests) if before is None else {str(each.request) for each in before.eta.all()}
    return {
        "agents": [[each, each not in known] for each in agents],
        "requests": [[each, each not in asked] for each in requests],
    }


def sections_of(
    c: Configuration, before: Configuration | None, fixed: frozenset[Name], step: int
) -> dict[str, Any]:
    """Return a configuration as the sections that the shared map and bigraph draw (docs/reference/console.md)."""
    driven = frozenset(c.setting.driven())
    where, shown = whereabouts(c), places_of(c, fixed, driven)
    found = {
        name: entity_of(SeenEntity(kind, at, None, None, 0.0, 0.0, "", ()), where[name], True, name in driven)
        for name, (kind, at) in positions_of(c).items()
        if name not in shown
    }
    return {
        "places": shown,
        "entities": found,
        "vehicles": {name: _vehicle(c, name) for name in sorted(driven & found.keys())},
        "clock": {"now": 0},
        "bigraph": {"svg": picture_of(c, before), "text": text_of(c), "step": step, "drawn": step},
    }


@lru_cache(maxsize=MOST_PICTURES)
def picture_of(c: Configuration, before: Configuration | None) -> str:
    """Return the picture of L; the changes since the configuration before glow."""
    return logical_picture(c.structure.logical.bigraph(), look_of(c, before), "L").svg


@lru_cache(maxsize=MOST_PICTURES)
def text_of(c: Configuration) -> str:
    """Return L as text."""
    return draw_text(c.structure.logical.bigraph())


def _vehicle(c: Configuration, name: Name) -> dict[str, Any]:
    """Return a vehicle's part of the map: the way that it is on."""
    physical = c.structure.physical
    placement = physical.placement(name)
    if not isinstance(placement, InTransit):
        return {}
    target = None if placement.to == REGION else physical.position(placement.to)
    way = [] if target is None else [degrees(centroid(target.geometry))[0]]
    return {"order": {"command": "GoTo", "to": placement.to, "state": "accepted", "way": way}}


@lru_cache(maxsize=MOST_PICTURES)
def places_text(c: Configuration) -> str:
    """Return P as text: the place of each entity."""
    physical = c.structure.physical
    return "\n".join(f"{name}: {where_words(physical, name)}" for name in physical.entities())
