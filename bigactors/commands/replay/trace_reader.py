"""Traces in files: of the checker, recordings of runs, and recordings by other programs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from adapters.recording.recording_reader import Recording, is_recording
from bigactors.commands.replay.foreign_recordings import TELEMETRY, ForeignRecording, watched
from bigactors.files import read_bytes, read_json
from bigactors.mission_lookup import digest_of, from_text, open_mission
from bigactors.mistakes import Mistake
from bigactors.recordings import mission_of, open_recording, trace_of
from bigactors.terminal import tell
from checker import Trace, replay
from checker.reports.trace_subject import TraceSubject, subject_of
from physical.nmea_lines import has_frame
from semantics.races.monitor import monitored
from semantics.state.setting import Control, Scheduler
from specs.elaboration import ElaboratedMission, Variation
from specs.missions import shipped_missions

AIS = (".nmea", ".ais")


@dataclass(frozen=True, slots=True)
class Replayed:
    """A replayed trace, with its mission, and the recording that it was read from, if any.

    `times` are the times of its steps in seconds; empty for an undated trace. `subject` is the reason why it was
    written, for a trace of this very mission that `check` wrote.
    """

    mission: ElaboratedMission
    trace: Trace
    recording: Recording | None = None
    times: tuple[float, ...] = ()
    subject: TraceSubject | None = None


def is_foreign(path: str) -> bool:
    """Return whether a file is a telemetry log or AIS, not a trace or a recording of ours."""
    if path.endswith((TELEMETRY, *AIS)):
        return True
    begins = read_bytes(path, 4_096).lstrip()
    return begins[:1] in (b"!", b"$", b"\\", b"#") or (
        begins[:1] not in (b"", b"{", b"[") and has_frame(begins)
    )


def account_for(path: str, shown: ForeignRecording, write: Callable[[str], None]) -> None:
    """Print the counts of a foreign recording: the data used, and the data left out."""
    for tally in shown.tallies:
        for row in tally.summary():
            write(f"{path}: {row}")


def watched_in(
    path: str, mission_file: str | None, variation: Variation, names: dict[str, str]
) -> tuple[ElaboratedMission, ForeignRecording]:
    """Return a foreign recording in the places of a mission; raises Mistake without a mission."""
    if mission_file is None:
        hint = "give a mission for its places: replay --mission FILE, show FILE"
        raise Mistake("this is no trace of ours", hint, path)
    mission = open_mission(mission_file, variation)
    return mission, watched(path, mission, names)


OF_TRACES: Final = "give a trace.json that check --trace wrote, or a recording that run --record wrote"


def read_trace(
    path: str, mission_file: str | None, variation: Variation, names: dict[str, str] | None = None
) -> Replayed:
    """Return the trace in a file, replayed on its mission; warn of a trace of another mission.

    Without a mission's file, the mission is the one whose text is in the trace. A foreign recording gives a trace of
    the mission's world; `names` maps its sources to names in the mission.

    Raises:
        Mistake: The file holds no trace, or its mission cannot be read.
        ReplayError: The mission does not allow the trace.
    """
    if is_recording(path):
        return _read_recording(path, mission_file, variation)
    if is_foreign(path):
        mission, shown = watched_in(path, mission_file, variation, names or {})
        account_for(path, shown, tell)
        return Replayed(mission, shown.trace, times=shown.times)
    try:
        data = read_json(path)
    except Mistake as mistake:
        raise Mistake(mistake.message, mistake.hint or OF_TRACES, path) from mistake
    named = data.get("mission") if isinstance(data, dict) else None
    if mission_file is None and not isinstance(named, str):
        raise Mistake("the file names no mission: it is no trace", "give the mission with --mission", path)
    mission = _mission_of(path, data, mission_file, variation)
    try:
        start = monitored(mission.initial) if data.get("monitored") is True else mission.initial
        trace = replay(start, data)
        if not trace.in_turn and start.setting.scheduler is Scheduler.FCFS:
            tell(
                f"{path}: warning: requests were served out of turn, as in a live run; it is no run of 'scheduler fcfs'"
            )
        if not _is_of(data, mission):
            _warn_of_another(path, data, mission, mission_file or str(named))
            return Replayed(mission, trace)
        return Replayed(mission, trace, subject=subject_of(data, trace, mission.properties))
    except ValueError as error:
        raise Mistake(str(error), place=path) from error


def _mission_of(path: str, data: dict[str, Any], file: str | None, variation: Variation) -> ElaboratedMission:
    """Return the mission of a trace: the file's, the one whose text is in it, or the one that it names."""
    if file is None and isinstance(data.get("text"), str):
        return from_text(data, _as_written(path, data, variation))
    return open_mission(file or _beside(path, str(data["mission"])), variation)


def _as_written(path: str, data: dict[str, Any], variation: Variation) -> Variation:
    """Return the variation under which a trace was written, with what the options replace."""
    written = data.get("scheduler"), data.get("control")
    try:
        scheduler = variation.scheduler or (written[0] and Scheduler(written[0]))
        control = variation.control or (written[1] and Control(written[1]))
    except ValueError as error:
        hint = "check --trace and simulate write the scheduler and the control of the mission"
        raise Mistake(str(error), hint, path) from error
    return replace(variation, scheduler=scheduler or None, control=control or None)


def _read_recording(path: str, mission_file: str | None, variation: Variation) -> Replayed:
    recording = open_recording(path)
    mission = mission_of(recording) if mission_file is None else open_mission(mission_file, variation)
    trace = trace_of(recording, mission)
    if not _is_of(recording.run, mission):
        _warn_of_another(path, recording.run, mission, mission_file or str(recording.run["mission"]))
    times = tuple(message.time for message in recording.of("steps"))
    return Replayed(mission, trace, recording, times)


def _beside(trace: str, mission: str) -> str:
    """Return the path of the mission that a trace names, relative to this folder or to the trace's."""
    beside = Path(trace).parent / mission
    known = Path(mission).is_file() or mission in shipped_missions() or not beside.is_file()
    return mission if known else str(beside)


def _is_of(data: Mapping[str, Any], mission: ElaboratedMission) -> bool:
    return data.get("digest") == digest_of(mission)


def _warn_of_another(path: str, data: Mapping[str, Any], mission: ElaboratedMission, given: str) -> None:
    tell(f"{path}: warning: it was written of another mission, or by another version of bigactors")
    tell(f"  written of: {data.get('mission')!s:.200}, digest {data.get('digest')!s:.80}")
    tell(f"  replayed on: {given}, digest {digest_of(mission)}")
    if "violation" in data:
        tell("  its violation is not shown: it was found there")
