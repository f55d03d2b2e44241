"""Traces in files: of the checker, recordings of runs, and recordings by other programs."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adapters.recording.recording_reader import Recording, is_recording
from bigactors.commands.replay.foreign_recordings import TELEMETRY, ForeignRecording, watched
from bigactors.files import read_bytes, read_json
from bigactors.mission_lookup import digest_of
from bigactors.mistakes import Mistake
from bigactors.recordings import mission_of, open_recording, trace_of
from bigactors.terminal import tell
from checker import Trace, replay
from physical.nmea_lines import has_frame
from semantics.races.monitor import monitored
from specs.elaboration import ElaboratedMission
from specs.missions import shipped_missions

AIS = (".nmea", ".ais")

Open = Callable[[str], ElaboratedMission]
"""Returns a mission by its path or name."""


@dataclass(frozen=True, slots=True)
class Replayed:
    """A replayed trace, with its mission, and the recording that it was read from, if any.

    `times` are the times of its steps in seconds; empty for an undated trace.
    """

    mission: ElaboratedMission
    trace: Trace
    recording: Recording | None = None
    times: tuple[float, ...] = ()


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
    path: str, mission_file: str | None, open_mission: Open, names: dict[str, str]
) -> tuple[ElaboratedMission, ForeignRecording]:
    """Return a foreign recording in the places of a mission; raises Mistake without a mission."""
    if mission_file is None:
        hint = "give a mission for its places: replay --mission FILE, show FILE"
        raise Mistake("this is no trace of ours", hint, path)
    mission = open_mission(mission_file)
    return mission, watched(path, mission, names)


def read_trace(
    path: str, mission_file: str | None, open_mission: Open, names: dict[str, str] | None = None
) -> Replayed:
    """Return the trace in a file, replayed on its mission; warn of a trace of another mission.

    A foreign recording gives a trace of the mission's world; `names` maps its sources to names in the mission.

    Raises:
        Mistake: The file holds no trace, or its mission cannot be read.
        ReplayError: The mission does not allow the trace.
    """
    if is_recording(path):
        return _read_recording(path, mission_file, open_mission)
    if is_foreign(path):
        mission, shown = watched_in(path, mission_file, open_mission, names or {})
        account_for(path, shown, tell)
        return Replayed(mission, shown.trace, times=shown.times)
    data = read_json(path)
    named = data.get("mission") if isinstance(data, dict) else None
    if mission_file is None and not isinstance(named, str):
        raise Mistake("the file names no mission: it is no trace", "give the mission with --mission", path)
    mission = open_mission(mission_file or _beside(path, str(named)))
    _warn_of_another(path, data, mission, mission_file or str(named))
    try:
        start = monitored(mission.initial) if data.get("monitored") is True else mission.initial
        return Replayed(mission, replay(start, data))
    except ValueError as error:
        raise Mistake(str(error), place=path) from error


def _read_recording(path: str, mission_file: str | None, open_mission: Open) -> Replayed:
    recording = open_recording(path)
    mission = mission_of(recording) if mission_file is None else open_mission(mission_file)
    _warn_of_another(path, recording.run, mission, mission_file or str(recording.run["mission"]))
    times = tuple(message.time for message in recording.of("steps"))
    return Replayed(mission, trace_of(recording, mission), recording, times)


def _beside(trace: str, mission: str) -> str:
    """Return the path of the mission that a trace names, relative to this folder or to the trace's."""
    beside = Path(trace).parent / mission
    known = Path(mission).is_file() or mission in shipped_missions() or not beside.is_file()
    return mission if known else str(beside)


def _warn_of_another(path: str, data: Any, mission: ElaboratedMission, given: str) -> None:
    if not isinstance(data, dict) or data.get("digest") == digest_of(mission):
        return
    tell(f"{path}: warning: it was written of another mission, or by another version of bigactors")
    tell(f"  written of: {data.get('mission')!s:.200}, digest {data.get('digest')!s:.80}")
    tell(f"  replayed on: {given}, digest {digest_of(mission)}")
