"""Foreign recordings as feeds: telemetry logs and AIS recordings, and the trace of the world that they show."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from adapters.live.batch import Batch, Heard
from adapters.live.core import started, watch
from adapters.live.operator_findings import Finding
from adapters.live.plan import Plan
from adapters.mavlink.tlog import THINGS, positions_of, read_tlog
from adapters.mavlink.vehicle_identities import Craft
from adapters.naming import NamingService
from bigactors.mistakes import Mistake
from checker import Step, Trace
from physical import PhysicalError, PhysicalProperty
from physical.ais_recording import read_recording
from physical.ais_world import COARSE, Finest, dated, physical_property
from physical.file_account import Counting, FileAccount
from physical.mmsi import digits
from semantics.live_policy import Fallback, LivePolicy
from specs.elaboration import ElaboratedMission

TELEMETRY = ".tlog"


@dataclass(frozen=True, slots=True)
class ForeignRecording:
    """A recording's view of a mission's world.

    Attributes:
        trace: The steps, all of them `env`.
        times: The time of each step.
        findings: Events that the mission's environment section does not allow.
        positions: The number of positions.
        tallies: The counts of the recording's contents.
    """

    trace: Trace
    times: tuple[float, ...]
    findings: tuple[Finding, ...]
    positions: int
    tallies: tuple[FileAccount, ...] = ()


def watched(path: str, mission: ElaboratedMission, names: dict[str, str]) -> ForeignRecording:
    """Return a recording's view of a mission's world; raises Mistake if it can't be read or has no position."""
    plan = Plan(mission.initial, precautions=LivePolicy(Fallback.CONTINUE))
    state, steps, times, findings, count = started(plan), list[Step](), list[float](), list[Finding](), 0
    accounts: list[FileAccount] = []
    try:
        for time, heard in feed(path, mission, names, accounts):
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
    if not count:
        raise _nothing_shown(path, accounts)
    return ForeignRecording(
        Trace(mission.initial, tuple(steps)), tuple(times), tuple(findings), count, tuple(accounts)
    )


def _nothing_shown(path: str, accounts: Iterable[FileAccount]) -> Mistake:
    """Return the mistake for a recording without a usable position, with the recording's contents."""
    rows = [row for tally in accounts for row in tally.summary()]
    message = "; ".join(["it shows no position", *rows])
    return Mistake(message, "give a recording with positions, and name its vehicles with --name", path)


def feed(
    path: str, mission: ElaboratedMission, names: dict[str, str], accounts: list[FileAccount] | None = None
) -> Iterator[tuple[float, Heard]]:
    """Yield the dated positions of a recording; at its end, append its tallies to `accounts`."""
    told = [] if accounts is None else accounts
    found = _telemetry(path, mission, names, told) if path.endswith(TELEMETRY) else _ais(path, names, told)
    for time, said in found:
        yield time, Heard("recording", said)


def _telemetry(
    path: str, mission: ElaboratedMission, names: dict[str, str], accounts: list[FileAccount]
) -> Iterator[tuple[float, PhysicalProperty]]:
    """Yield the positions of the vehicles that `names` maps by system id; without any, of all systems as UAVs."""
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
    counting = Counting()
    for time, said in positions_of(read_tlog(path, counting), crafts, counting):
        yield time, replace(said, time=time)
    accounts.append(counting.tally(counting.total, *THINGS))


def _ais(
    path: str, names: dict[str, str], accounts: list[FileAccount]
) -> Iterator[tuple[float, PhysicalProperty]]:
    naming, finest, counting = NamingService(names), Finest(), Counting()
    recording = read_recording(Path(path))
    positions = dated(recording.positions)
    for number, report in enumerate(positions):
        time = float(number) if report.time is None else report.time
        if finest.supersedes(report, time):
            counting.leave(COARSE)
            continue
        counting.take("position shown")
        said = physical_property(report)
        yield time, replace(said, entity=naming.name(f"mmsi:{digits(report.mmsi)}"), time=time)
    accounts += (recording.tally, counting.tally(len(positions), "position"))
