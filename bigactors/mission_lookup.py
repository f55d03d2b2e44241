"""Missions by path or name, with a digest of their content."""

import hashlib
from argparse import Namespace
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from bigactors import __version__
from bigactors.diagnostic_output import as_mistake
from bigactors.mistakes import Mistake
from physical import PhysicalProperty
from semantics.state.canonical import canonical
from semantics.state.physical_model import Placed
from semantics.state.setting import Control, Scheduler
from specs import MissionError
from specs.elaboration import (
    ElaboratedMission,
    Variation,
    find_mission,
    load_mission,
    read_mission,
    require_bigactor,
)


def locate(word: str) -> Path:
    """Return the path of a mission, given as a file or as a shipped mission's name; raises Mistake."""
    if word.endswith(".big"):
        raise Mistake("this is a system of bigraphs, not a mission", f"bigactors big check {word:.100}", word)
    try:
        return find_mission(word)
    except MissionError as error:
        (found,) = error.diagnostics
        raise Mistake(found.message, found.hint, word) from error


def variation_of(options: Namespace) -> Variation:
    """Return the variation of a mission that the options describe; raises Mistake for a missing file."""
    sources = {name: Path(file) for name, file in options.source}
    for name, path in sources.items():
        if not path.exists():
            raise Mistake("there is no such file", f"it was to be read in the place of {name}", str(path))
    return Variation(
        Scheduler(options.scheduler) if options.scheduler else None,
        Control(options.control) if options.control else None,
        sources,
    )


def open_mission(word: str, variation: Variation) -> ElaboratedMission:
    """Return an elaborated mission; raises Mistake with all its diagnostics."""
    try:
        return load_mission(locate(word), variation)
    except MissionError as error:
        raise as_mistake(error) from error


def checkable(mission: ElaboratedMission) -> ElaboratedMission:
    """Return the mission if it can be checked; raises Mistake if it has no bigActor."""
    try:
        require_bigactor(mission)
    except MissionError as error:
        raise as_mistake(error) from error
    return mission


def text_json(mission: ElaboratedMission, file: str, sources: Mapping[str, Path]) -> dict[str, Any]:
    """Return the text of a mission, and where its files are, as plain data that `from_text` reads in any folder."""
    return {
        "text": mission.source.text,
        "folder": str(locate(file).absolute().parent),
        "sources": {name: str(path.absolute()) for name, path in sources.items()},
    }


def from_text(data: Mapping[str, Any], variation: Variation) -> ElaboratedMission:
    """Return the mission whose text is in the data; the files that it names are read again. Raises Mistake."""
    sources = data.get("sources")
    found = {name: Path(str(file)) for name, file in sources.items()} if isinstance(sources, dict) else {}
    asked = replace(variation, sources={**found, **variation.sources})
    folder, name = str(data.get("folder", ".")), str(data["mission"])
    try:
        return read_mission(str(data["text"]), folder, name=name, variation=asked)
    except MissionError as error:
        raise as_mistake(error) from error


def fixed_places(mission: ElaboratedMission) -> tuple[PhysicalProperty, ...]:
    """Return the positions of all entities that never move."""
    physical, kinds = mission.initial.structure.physical, mission.setting.kinds
    placed = ((name, physical.placement(name)) for name in sorted(mission.fixed))
    return tuple(
        PhysicalProperty(name, kinds[name], at.geometry, at.altitude)
        for name, at in placed
        if isinstance(at, Placed)
    )


def digest_of(mission: ElaboratedMission) -> str:
    """Return a digest of the mission's text, its scheduler, control and first world, and the version of bigactors.

    Missions with equal digests have equal configurations: the contents of their files are in their worlds.
    """
    initial = mission.initial
    world = dict(initial.state.items())  # type: ignore[attr-defined]  # a stored configuration
    setting = (mission.setting.scheduler.value, mission.setting.control.value)
    said = "\0".join((__version__, mission.source.text, *setting, canonical(world)))
    return "sha256:" + hashlib.sha256(said.encode("utf-8", "surrogatepass")).hexdigest()
