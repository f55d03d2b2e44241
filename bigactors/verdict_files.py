"""Verdict files: the decision of `check` on exactly one mission, which `run` requires before take-off."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bigactors import __version__
from bigactors.checking import Checked, short_limits
from bigactors.code_digest import build_digest
from bigactors.files import read_json
from bigactors.mission_lookup import digest_of
from bigactors.mistakes import Mistake
from bigactors.signatures import check_signature, signature_json
from semantics.state.canonical import digest
from semantics.state.physical_model import placement_cell
from semantics.state.setting import Control, Scheduler
from semantics.state.signature import Name
from specs.elaboration import ElaboratedMission

if TYPE_CHECKING:
    from bigactors.signatures import SigningKey, TrustedKey

SCHEMA = "bigactors.verdict/1"
"""The version of the schema of verdict files (docs/reference/verdict.schema.json)."""

SUFFIX = ".verdict.json"

PARTS = {
    "text": "the mission's text",
    "places": "the places that never move",
    "entities": "the entities that are declared",
    "environment": "the environment section",
}
"""The parts of a mission to which a verdict is bound, with their descriptions."""


def verdict_json(checked: Checked, engine: str, key: SigningKey | None = None) -> dict[str, Any]:
    """Return the verdict on a mission as plain data, sealed, and signed if a key is given."""
    report, mission = checked.report, checked.mission
    data = {
        "schema": SCHEMA,
        "mission": checked.name,
        "version": __version__,
        "build": build_digest(),
        "engine": engine,
        "scheduler": mission.setting.scheduler.value,
        "control": mission.setting.control.value,
        "digest": checked.digest,
        "parts": parts_of(mission),
        "holds": report.exit_code == 0,
        "complete": report.complete,
        "configurations": report.configurations,
        "transitions": report.transitions,
        "flights": dict(report.flights),
        "properties": [
            {
                "name": verdict.property.name,
                "kind": verdict.property.kind,
                "verdict": verdict.outcome.value,
                "note": verdict.note,
                "rests_on": "text" if verdict.note.startswith("by ownership") else "environment",
            }
            for verdict in report.verdicts
        ],
    }
    signed = {} if key is None else {"signature": signature_json(key, said_by(data))}
    return {**data, "seal": _seal(data), **signed}


def said_by(data: dict[str, Any]) -> bytes:
    """Return a verdict's content as one text, the input of its seal and signature."""
    said = {name: value for name, value in data.items() if name not in ("seal", "signature")}
    return json.dumps(said, sort_keys=True, ensure_ascii=True).encode("ascii")


def _seal(data: dict[str, Any]) -> str:
    """Return a digest of a verdict's content: it detects accidents, not forgery."""
    return "sha256:" + hashlib.sha256(said_by(data)).hexdigest()


def parts_of(mission: ElaboratedMission) -> dict[str, str]:
    """Return a digest of each part of a mission to which a verdict is bound."""
    setting, first = mission.setting, mission.initial
    places = {name: first.read(placement_cell(name)) for name in mission.fixed}
    entities = {name: (kind, first.read(("channels", name))) for name, kind in setting.kinds.items()}
    moving = {name: first.read(placement_cell(name)) for name in setting.kinds if name not in mission.fixed}
    return {
        "text": digest(mission.source.text),
        "places": digest(places),
        "entities": digest((entities, moving, setting.signature.kinds)),
        "environment": digest((setting.environment, setting.arriving, setting.missable)),
    }


@dataclass(frozen=True, slots=True)
class Licence:
    """The verdict that permits a run.

    Attributes:
        path: The file.
        data: Its content.
        resting: The properties whose verdicts depend on the environment section.
        scheduler: The scheduler under which it was reached.
    """

    path: str
    data: dict[str, Any]
    resting: tuple[str, ...]
    scheduler: Scheduler


def find_verdict(mission: str, given: str | None) -> str | None:
    """Return the path of a mission's verdict file: the given one, else one beside the mission, else one here."""
    if given is not None:
        return given
    path = Path(mission)
    for candidate in (path.with_suffix(SUFFIX), Path(path.stem + SUFFIX)):
        if candidate.is_file():
            return str(candidate)
    return None


def licence_for(
    name: str, path: str, mission: ElaboratedMission, trusted: TrustedKey | None = None
) -> Licence:
    """Return a file's verdict if it permits to run the mission; raises Mistake with the reason if not.

    The mission is the one that flies, as it was read: replacing its file changes nothing. With a trusted key, the
    verdict must bear its signature.
    """
    data = read_json(path)
    if trusted is not None and isinstance(data, dict):
        check_signature(data.get("signature"), said_by(data), trusted, path)
    scheduler = _scheduler_of(data, path)
    differing = _differing(data, mission.under(scheduler, Control.TIMED))
    if differing:
        raise Mistake(f"the verdict belongs to another mission: {differing}", _hint(name, path), path)
    if data.get("holds") is not True or data.get("complete") is not True:
        raise Mistake(
            "the verdict does not confirm every property", f"bigactors check {name} prints the failures", path
        )
    if data.get("seal") != _seal(data):
        raise Mistake("the verdict was changed after it was reached", _hint(name, path), path)
    for short in short_limits(mission, _flights_of(data)):
        raise Mistake(f"{short}: a normal flight would be given up", "lengthen the limit", name)
    properties = data.get("properties")
    listed = [each for each in properties if isinstance(each, dict)] if isinstance(properties, list) else []
    resting = tuple(str(each.get("name")) for each in listed if each.get("rests_on") == "environment")
    return Licence(path, data, resting, scheduler)


def _scheduler_of(data: Any, path: str) -> Scheduler:
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise Mistake(f"this is no verdict: it should be an object with 'schema': '{SCHEMA}'", place=path)
    if data.get("control") != Control.TIMED.value:
        hint = "vehicles take time: check the mission with --control timed"
        raise Mistake("the verdict was reached under 'control atomic'", hint, path)
    try:
        return Scheduler(data.get("scheduler"))
    except ValueError:
        raise Mistake("the verdict names no scheduler", place=path) from None


def _flights_of(data: dict[str, Any]) -> dict[Name, float]:
    flights = data.get("flights")
    known = flights if isinstance(flights, dict) else {}
    return {agent: seconds for agent, seconds in known.items() if isinstance(seconds, int | float)}


def _differing(data: dict[str, Any], mission: ElaboratedMission) -> str:
    """Return the differences between a mission and that of the verdict, in words."""
    if data.get("version") != __version__:
        return f"it was reached by version {data.get('version')!s:.40}, this is {__version__}"
    if data.get("build") != build_digest():
        return f"it was reached by another build of version {__version__}"
    known = data.get("parts")
    parts = known if isinstance(known, dict) else {}
    others = [called for part, called in PARTS.items() if parts.get(part) != parts_of(mission)[part]]
    if others:
        return f"changed since: {', '.join(others)}"
    return "" if data.get("digest") == digest_of(mission) else "its digest differs"


def _hint(name: str, path: str) -> str:
    return f"check it again: bigactors check --control timed --verdict {path} {name}"
