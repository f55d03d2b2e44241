"""Foreign recordings as feeds: telemetry logs and AIS recordings, and the bigraph of the world that they show."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from adapters.live.core import started, watch
from adapters.live.state import Batch, Finding, Heard, Plan
from adapters.mavlink.fleet import Craft
from adapters.mavlink.tlog import positions_of, read_tlog
from adapters.naming import NamingService
from bigactors.mistakes import Mistake
from checker import Step, Trace
from physical import PhysicalError, PhysicalProperty
from physical.ais_recording import read_recording
from physical.ais_world import physical_property
from physical.mmsi import digits
from semantics.contingencies import Fallback, Precautions
from specs.elaboration import ElaboratedMission

TELEMETRY = ".tlog"


@dataclass(frozen=True, slots=True)
class Shown:
    """What a recording shows of a mission's world.

    Attributes:
        trace: Its steps, all of `env`.
        times: The time of each step.
        findings: Events that the mission's environment section does not allow.
        positions: The number of positions.
    """

    trace: Trace
    times: tuple[float, ...]
    findings: tuple[Finding, ...]
    positions: int


def watched(path: str, mission: ElaboratedMission, names: dict[str, str]) -> Shown:
    """Return what a recording shows of a mission's world; raises Mistake for one that cannot be read."""
    plan = Plan(mission.initial, precautions=Precautions(Fallback.CONTINUE))
    state, steps, times, findings, count = started(plan), list[Step](), list[float](), list[Finding](), 0
    try:
        for time, heard in feed(path, mission, names):
            turn = watch(plan, state, Batch((heard,)), time)
            state, count = turn.state, count + 1
            for each in turn.steps:
                steps.append(Step(each.transition.label, each.choice, each.transition.target, each.sight))
                times.append(each.time)
            findings += turn.findings
    except PhysicalError as error:
        raise Mistake(error.message, error.hint, path) from error
    except OSError as error:
        raise Mistake(error.strerror or str(error), place=path) from error
    return Shown(Trace(mission.initial, tuple(steps)), tuple(times), tuple(findings), count)


def feed(path: str, mission: ElaboratedMission, names: dict[str, str]) -> Iterator[tuple[float, Heard]]:
    """Yield the positions of a recording with their times."""
    found = _telemetry(path, mission, names) if path.endswith(TELEMETRY) else _ais(path, names)
    for time, said in found:
        yield time, Heard("recording", said)


def _telemetry(
    path: str, mission: ElaboratedMission, names: dict[str, str]
) -> Iterator[tuple[float, PhysicalProperty]]:
    """Yield the positions of the vehicles that the table names by system id; of all as UAVs if it names none."""
    kinds = mission.setting.kinds
    systems = ((identity.partition(":"), name) for identity, name in names.items())
    table = {
        int(number): name
        for (scheme, _, number), name in systems
        if scheme == "mavlink" and re.fullmatch(r"[0-9]{1,3}", number)
    }
    crafts = {system: Craft(name, kinds.get(name, "UAV"), system) for system, name in table.items()}
    if not crafts:
        crafts = {system: Craft(f"mavlink{system}", "UAV", system) for system in range(1, 256)}
    for time, said in positions_of(read_tlog(path), crafts):
        yield time, replace(said, time=time)


def _ais(path: str, names: dict[str, str]) -> Iterator[tuple[float, PhysicalProperty]]:
    naming = NamingService(names)
    for number, report in enumerate(read_recording(Path(path)).positions):
        said = physical_property(report)
        time = float(number) if said.time is None else said.time
        yield time, replace(said, entity=naming.name(f"mmsi:{digits(report.mmsi)}"), time=time)
