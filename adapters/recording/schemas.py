"""JSON schemas of a recording's messages, one for each topic; docs/reference/recording.md prints them.

The members of a message that is one value of a type are generated from the type.
"""

from __future__ import annotations

from typing import Any, Final, get_args

from adapters.live.operator_findings import Finding
from adapters.plugin import Command, Presence, Report, Seen, Status, StatusText
from adapters.recording.recording_reader import VERSION
from adapters.recording.type_schemas import BAND, RING, members_of

COMMANDS: Final = get_args(Command)
REPORTS: Final = tuple(kind for kind in get_args(Report) if kind not in get_args(Seen))

_TEXT: Final = {"type": "string"}
_NUMBER: Final = {"type": "number"}
_OPTIONAL: Final = {"type": ["string", "null"]}
_BY: Final = {**_TEXT, "description": "The operator's name; empty if unknown."}
_TIME: Final = _NUMBER
_TEXTS: Final = {"type": "array", "items": _TEXT}
_OBSERVED: Final = {
    "type": "object",
    "description": "The choice of the world: the cells of P that it wrote, as [cell, value].",
    "required": ["words", "writes"],
    "properties": {
        "words": _TEXT,
        "writes": {"type": "array", "items": {"type": "array", "minItems": 2, "maxItems": 2}},
        "admits": {
            "type": "object",
            "description": "Entities that the mission does not name, with their kinds.",
        },
        "agent": {
            **_TEXT,
            "description": "The agent that left for another station, entered, or was heard of.",
        },
        "station": {**_TEXT, "description": "Its destination, or its origin."},
        "number": {"type": "integer", "minimum": 1},
        "parcel": {"type": "object", "description": "The parcel that entered (docs/how-to/stations.md)."},
        "host": {**_TEXT, "description": "Where the agent is hosted."},
        "node": {**_TEXT, "description": "The node of L that another station has written,"},
        "slot": {"enum": ["parent", "links"], "description": "in which slot,"},
        "names": {**_TEXTS, "description": "and the new names in it."},
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


def _name_of(*kinds: type) -> dict[str, Any]:
    return {**_TEXT, "enum": [kind.__name__ for kind in kinds]}


RUN: Final = _object(
    "The run: its mission, its verdict and its vehicles.",
    ("schema", "mission", "text", "digest", "version", "verified", "vehicles"),
    schema={"type": "string", "const": f"bigactors.run/{VERSION}"},
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
        "description": "Whether other requests waited while a vehicle or an operator kept one waiting.",
    },
    vehicles={"type": "object", "description": "For each vehicle its plugin."},
    fences={"type": "object", "description": "For each vehicle that has a fence its ring."},
    limits={
        "type": "array",
        "description": "Time limits of requests at the head of a line, with their fallbacks.",
        "items": {
            "type": "object",
            "required": ["request", "agent", "seconds", "fallback"],
            "properties": {
                "request": {**_OPTIONAL, "description": "OBS, CTR, FLY, SND or MGR; null for any."},
                "agent": {**_OPTIONAL, "description": "Null for anyone's."},
                "seconds": _NUMBER,
                "fallback": {"enum": ["hold", "return", "continue"]},
            },
        },
    },
    resumes={"type": ["string", "null"], "description": "The recording that the run continues."},
    rate={
        "type": ["number", "null"],
        "exclusiveMinimum": 0,
        "description": "Seconds of the run in one of the clock on the wall: 1 unless time is simulated, null for "
        "as many as possible.",
    },
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
    ring=RING,
    altitude=BAND,
    channels=_TEXTS,
    carried_by=_TEXT,
    time={**_NUMBER, "description": "When it was observed."},
    velocity={"type": "array", "items": _NUMBER, "description": "Metres a second, degrees from true north."},
    time_to_live=_NUMBER,
    gone={"type": "boolean", "const": True},
)

LEFT_OUT: Final = _object(
    "How many arrivals were not recorded, of an entity or of all that the mission does not name.",
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
    shown={**_TEXTS, "description": "The output of `display`."},
    date={
        "type": "number",
        "description": "The time of another station's step, by the clock here.",
    },
    digest={**_TEXT, "description": "Of the cells that it wrote, with their values."},
)

DEADLINE: Final = _object(
    "The deadline of an agent at a `react` with an `after` branch: written when it changes.",
    ("agent", "until"),
    agent=_TEXT,
    until={
        "type": ["number", "null"],
        "description": "Null once it waits no longer.",
    },
)

CLOCKS: Final = _object(
    "The reference of all clocks of a mission with `timing`: written before the next step, when it changes.",
    ("began", "rested"),
    began={
        "type": "number",
        "description": "The start of the mission, plus the time without listening.",
    },
    rested={
        "type": "number",
        "description": "For how many seconds the run itself stood still: it was killed, and went on.",
    },
)

FLIGHT: Final = _object(
    "The duration of a flight by the mission's times: written when it changes.",
    ("vehicle", "takes"),
    vehicle=_TEXT,
    takes={
        "type": ["object", "null"],
        "description": "Null once it is over.",
        "required": ["to", "since", "least", "most"],
        "properties": {
            "number": {"type": "integer", "minimum": 1},
            "to": {**_TEXT, "description": "Where it ends."},
            "since": _TIME,
            "least": {**_NUMBER, "description": "Seconds from `since`,"},
            "most": {"type": ["number", "null"], "description": "and those at the most; null for any."},
        },
    },
)

WAY: Final = _object(
    "The points to which a vehicle is sent: written when they change.",
    ("vehicle", "way"),
    vehicle=_TEXT,
    way={
        "type": ["object", "null"],
        "description": "Null while the mission does not command it.",
        "required": ["to", "points", "passed"],
        "properties": {
            "to": {**_TEXT, "description": "Where it ends; empty where the vehicle was never sent."},
            "points": {
                **RING,
                "description": "Latitude and longitude of each point in 1e-7 degree, the first behind.",
            },
            "passed": {"type": "integer", "minimum": 1, "description": "How many are certainly behind it."},
        },
    },
)

INVARIANT: Final = _object(
    "An invariant about ways, compared with what is seen: at once when it becomes true or false, else once a second.",
    ("property", "holds", "figure", "entities", "points"),
    property=_TEXT,
    holds={"type": "boolean"},
    figure={**_TEXT, "description": "Such as: uav0 may come within 42 m of uav1; at least 50 m."},
    entities={**_TEXTS, "description": "The entities of the figure."},
    points={
        "type": "array",
        "description": "The points that show it, in degrees.",
        "items": {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2},
    },
)

COMMAND: Final = _object(
    "A command to a vehicle: written before it is sent.",
    ("command", "request", "entity"),
    command=_name_of(*COMMANDS),
    **members_of(*COMMANDS, without=("around", "shape")),
)

REPORT: Final = _object(
    "A plugin's report on a request, a link or its input.",
    ("report",),
    report=_name_of(*REPORTS),
    **members_of(*REPORTS, without=("place",))
    | {
        "time": _TIME,
        "number": {"type": "integer", "minimum": 1},
        "to": {
            **_TEXT,
            "description": "Where another station has sent a vehicle; empty when it has arrived.",
        },
        "parcel": {
            "type": "object",
            "description": "A parcel from another station (docs/how-to/stations.md).",
        },
    },
)

SAYING: Final = _object(
    "A message from outside to an agent; if it was refused, the reason.",
    ("agent", "message", "refusal"),
    agent=_TEXT,
    message=_TEXT,
    by=_BY,
    refusal=_TEXT,
)

GIVEN_BACK: Final = _object(
    "An operator gave a vehicle back that had been taken over, or gave its new address; if this was refused, the "
    "reason.",
    ("vehicle", "refusal"),
    vehicle=_TEXT,
    at={**_TEXT, "description": "Where it is heard from now on; it is not given back by that."},
    by=_BY,
    notes={
        **_TEXTS,
        "description": "Notes for the operator, such as a flight that was given up.",
    },
    refusal=_TEXT,
)

ORDER: Final = _object(
    "An operator ordered vehicles to hold or to return. The commands have the same requests, and a report `Accepted` "
    "or `Arrived` of such a request confirms it.",
    ("order", "vehicle", "by", "requests", "refusal"),
    order={"type": "string", "enum": ["hold", "return"]},
    vehicle={
        "type": ["string", "array", "null"],
        "items": _TEXT,
        "description": "A list for several, null for all.",
    },
    by=_BY,
    requests={"type": "object", "description": "The request of each vehicle that got the order."},
    left_out={"type": "object", "description": "The reason for each vehicle that an order to all left out."},
    notes={**_TEXTS, "description": "Notes for the operator, such as a take-over that was overruled."},
    refusal=_TEXT,
)

ACKNOWLEDGED: Final = _object(
    "An operator has seen a finding.",
    ("finding", "by"),
    finding={"type": "integer", "minimum": 1, "description": "Its number among the messages of `findings`."},
    by=_BY,
)

NOTE: Final = _object("An operator's note.", ("text", "by"), text=_TEXT, by=_BY)

STATUS: Final = _object(
    "A vehicle's report on itself, at most once a second; null is not reported.",
    ("plugin", "entity", "time", "mode", "armed", "battery", "heading", "authority", "heard"),
    **members_of(Status, nulls=True) | {"time": _TIME},
)

STATUS_TEXT: Final = _object(
    "A text that a vehicle has sent.",
    ("entity", "time", "text", "severity"),
    **members_of(StatusText, nulls=True)
    | {
        "time": _TIME,
        "severity": {
            "type": "integer",
            "minimum": 0,
            "maximum": 7,
            "description": "From 0 (emergency) to 7 (debug).",
        },
    },
)

PRESENCE: Final = _object(
    "Whether another station is reached, when that changes, and at most every 2 seconds.",
    ("station", "time", "reached", "heard"),
    **members_of(Presence, nulls=True) | {"time": _TIME},
)

PREFLIGHT: Final = _object(
    "The checks before the start of a run that waits for an operator, when they change.",
    ("state", "items", "by"),
    state={"enum": ["waits", "ready", "begun"], "description": "`ready`: it begins when Start is pressed."},
    items={
        "type": "array",
        "description": "In the order in which they are done.",
        "items": {
            "type": "object",
            "required": ["what", "done", "detail"],
            "properties": {
                "what": _TEXT,
                "done": {"type": "boolean"},
                "detail": _TEXT,
                "vehicle": {**_TEXT, "description": "The vehicle that is checked."},
                "fence": {**_TEXT, "description": "The fence that was read back from it, in words."},
                "refuses": {**_TEXTS, "description": "Its recent reasons why it cannot be armed."},
            },
        },
    },
    by={**_TEXT, "description": "Who has pressed Start."},
)

FINDING: Final = _object(
    "A message to the operator: a broken assumption, a refusal, a lost link, a request that takes too long.",
    ("kind", "about", "message"),
    **members_of(Finding) | {"time": _TIME},
    verdicts={**_TEXTS, "description": "The properties with verdicts that depend on the broken assumption."},
)

END: Final = _object("How the run ended.", ("reason",), reason=_TEXT)

SCHEMAS: Final[dict[str, tuple[str, dict[str, Any]]]] = {
    "run": (f"bigactors.run/{VERSION}", RUN),
    "arrivals": (f"bigactors.arrival/{VERSION}", ARRIVAL),
    "left_out": (f"bigactors.left_out/{VERSION}", LEFT_OUT),
    "steps": (f"bigactors.step/{VERSION}", STEP),
    "deadlines": (f"bigactors.deadline/{VERSION}", DEADLINE),
    "clocks": (f"bigactors.clocks/{VERSION}", CLOCKS),
    "flights": (f"bigactors.flight/{VERSION}", FLIGHT),
    "ways": (f"bigactors.way/{VERSION}", WAY),
    "invariants": (f"bigactors.invariant/{VERSION}", INVARIANT),
    "commands": (f"bigactors.command/{VERSION}", COMMAND),
    "reports": (f"bigactors.plugin_report/{VERSION}", REPORT),
    "sayings": (f"bigactors.saying/{VERSION}", SAYING),
    "given_back": (f"bigactors.given_back/{VERSION}", GIVEN_BACK),
    "orders": (f"bigactors.order/{VERSION}", ORDER),
    "findings": (f"bigactors.finding/{VERSION}", FINDING),
    "notes": (f"bigactors.note/{VERSION}", NOTE),
    "acknowledged": (f"bigactors.acknowledged/{VERSION}", ACKNOWLEDGED),
    "status": (f"bigactors.status/{VERSION}", STATUS),
    "said": (f"bigactors.status_text/{VERSION}", STATUS_TEXT),
    "stations": (f"bigactors.presence/{VERSION}", PRESENCE),
    "preflight": (f"bigactors.preflight/{VERSION}", PREFLIGHT),
    "end": (f"bigactors.end/{VERSION}", END),
}
"""The name and the schema of each topic's messages."""
