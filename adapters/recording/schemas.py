"""JSON schemas of a recording's messages, one for each topic; docs/reference/recording.md prints them."""

from __future__ import annotations

from typing import Any, Final

VERSION: Final = 1

_TEXT: Final = {"type": "string"}
_NUMBER: Final = {"type": "number"}
_TEXTS: Final = {"type": "array", "items": _TEXT}
_RING: Final = {
    "type": "array",
    "description": "Latitude and longitude of each vertex in 1e-7 degree; one vertex for a point.",
    "items": {"type": "array", "items": {"type": "integer"}, "minItems": 2, "maxItems": 2},
}
_OBSERVED: Final = {
    "type": "object",
    "description": "What the world decided: the cells of P that were written, as [cell, value].",
    "required": ["words", "writes"],
    "properties": {
        "words": _TEXT,
        "writes": {"type": "array", "items": {"type": "array", "minItems": 2, "maxItems": 2}},
        "admits": {
            "type": "object",
            "description": "Entities that the mission does not name, with their kinds.",
        },
        "agent": {**_TEXT, "description": "Who left for another station, has entered, or was learned of."},
        "station": {**_TEXT, "description": "Where to, or where from."},
        "number": {"type": "integer", "minimum": 1},
        "parcel": {"type": "object", "description": "What has entered (docs/how-to/stations.md)."},
        "host": {**_TEXT, "description": "Where the agent is hosted."},
        "node": {**_TEXT, "description": "Of what another station has written into L,"},
        "slot": {"enum": ["parent", "links"], "description": "in which slot,"},
        "names": {**_TEXTS, "description": "and what is there now."},
    },
}


def _object(description: str, required: tuple[str, ...], **properties: Any) -> dict[str, Any]:
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "description": description,
        "type": "object",
        "required": list(required),
        "properties": properties,
    }


RUN: Final = _object(
    "The run: its mission, its verdict and its vehicles.",
    ("schema", "mission", "text", "digest", "version", "verified", "vehicles"),
    schema={"const": f"bigactors.run/{VERSION}"},
    mission={**_TEXT, "description": "The mission's file or name, as it was given."},
    text={**_TEXT, "description": "The mission."},
    folder={**_TEXT, "description": "The folder of the files that the mission names."},
    sources={"type": "object", "description": "Files read in place of those that the mission names."},
    digest={**_TEXT, "description": "Of the mission as it runs, under fcfs and timed control."},
    version=_TEXT,
    verified={"type": "boolean", "description": "False for a run that was forced with --unverified."},
    verdict={"type": ["object", "null"], "description": "The verdict file of the run."},
    strict={
        "type": "boolean",
        "description": "Whether other requests waited while vehicles confirmed hand-overs.",
    },
    vehicles={"type": "object", "description": "For each vehicle its plugin."},
    resumes={"type": ["string", "null"], "description": "The recording that the run continues."},
    station={
        "type": ["object", "null"],
        "description": "The station's part of the mission, if there are several stations.",
    },
)

ARRIVAL: Final = _object(
    "Something that a plugin published: a physical property, or that an entity is gone.",
    ("plugin", "entity"),
    plugin=_TEXT,
    entity=_TEXT,
    kind=_TEXT,
    ring=_RING,
    altitude={
        "type": "array",
        "items": _NUMBER,
        "description": "Lowest and highest, metres above sea level.",
    },
    channels=_TEXTS,
    carried_by=_TEXT,
    time={**_NUMBER, "description": "When it was observed, in seconds since 1970 UTC."},
    velocity={"type": "array", "items": _NUMBER, "description": "Metres a second, degrees from true north."},
    time_to_live=_NUMBER,
    gone={"const": True},
)

LEFT_OUT: Final = _object(
    "How many arrivals were not recorded, of an entity or of all that the mission does not name: more came in a second "
    "than are written.",
    ("plugin", "entity", "arrivals"),
    plugin=_TEXT,
    entity={**_TEXT, "description": "Empty for all that the mission does not name."},
    arrivals={"type": "integer", "minimum": 1},
)

STEP: Final = _object(
    "A transition, as the step of a trace (docs/reference/trace.schema.json) has it.",
    ("number", "label", "choice", "digest"),
    number={"type": "integer", "minimum": 1},
    label={**_TEXT, "description": "The transition, such as ⟨sense : OBS(a, ALL)⟩."},
    choice={"type": "integer", "minimum": 0},
    observed=_OBSERVED,
    shown={**_TEXTS, "description": "What `display` showed."},
    digest={**_TEXT, "description": "Of the cells that it wrote, with their values."},
)

COMMAND: Final = _object(
    "A command to a vehicle: written before it is sent.",
    ("command", "request", "entity"),
    command={"enum": ["GoTo", "Follow", "HandOver", "Hold", "Return", "GiveBack", "Rebind"]},
    request=_TEXT,
    entity=_TEXT,
    ring=_RING,
    altitude={"type": "array", "items": _NUMBER},
    name=_TEXT,
    leave=_TEXT,
    join=_TEXT,
    source={**_TEXT, "description": "The address from which the vehicle is heard from now on."},
)

REPORTS: Final = (
    *(
        "Accepted",
        "Arrived",
        "Rejected",
        "Doubted",
        "TakenOver",
        "LinkLost",
        "LinkRestored",
        "Trouble",
        "Failed",
    ),
    *("Delivered", "Underway", "Hosts", "Believes", "Broken"),
)
"""Those of a vehicle or a feed, then those of other stations."""

REPORT: Final = _object(
    "A plugin's report on a request, a link or its input.",
    ("report",),
    report={"enum": [*REPORTS]},
    request=_TEXT,
    entity=_TEXT,
    reason=_TEXT,
    what=_TEXT,
    detail=_TEXT,
    source=_TEXT,
    station=_TEXT,
    number={"type": "integer", "minimum": 1},
    to={**_TEXT, "description": "Where another station has sent a vehicle; empty when it has arrived."},
    agent=_TEXT,
    host=_TEXT,
    assumption=_TEXT,
    node=_TEXT,
    slot=_TEXT,
    names=_TEXTS,
    parcel={"type": "object", "description": "A parcel from another station (docs/how-to/stations.md)."},
)

SAYING: Final = _object(
    "A message from outside to an agent; if it was refused, the reason.",
    ("agent", "message", "refusal"),
    agent=_TEXT,
    message=_TEXT,
    refusal=_TEXT,
)

GIVEN_BACK: Final = _object(
    "An operator gave a vehicle back that had been taken over, or gave its new address; if this was refused, the "
    "reason.",
    ("vehicle", "refusal"),
    vehicle=_TEXT,
    at={**_TEXT, "description": "Where it is heard from now on; it is not given back by that."},
    refusal=_TEXT,
)

FINDING: Final = _object(
    "A message to the operator: a broken assumption, a refusal, a lost link, a request that takes too long.",
    ("kind", "about", "message"),
    kind=_TEXT,
    about=_TEXT,
    message=_TEXT,
    fallback=_TEXT,
    verdicts={**_TEXTS, "description": "The properties whose verdicts depend on the broken assumption."},
)

END: Final = _object("How the run ended.", ("reason",), reason=_TEXT)

SCHEMAS: Final[dict[str, tuple[str, dict[str, Any]]]] = {
    "run": (f"bigactors.run/{VERSION}", RUN),
    "arrivals": (f"bigactors.arrival/{VERSION}", ARRIVAL),
    "left_out": (f"bigactors.left_out/{VERSION}", LEFT_OUT),
    "steps": (f"bigactors.step/{VERSION}", STEP),
    "commands": (f"bigactors.command/{VERSION}", COMMAND),
    "reports": (f"bigactors.plugin_report/{VERSION}", REPORT),
    "sayings": (f"bigactors.saying/{VERSION}", SAYING),
    "given_back": (f"bigactors.given_back/{VERSION}", GIVEN_BACK),
    "findings": (f"bigactors.finding/{VERSION}", FINDING),
    "end": (f"bigactors.end/{VERSION}", END),
}
"""The name and the schema of each topic's messages."""
