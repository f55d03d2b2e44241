"""`bigactors replay`: replay a trace or a recording through the rules."""

import sys
import time
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import indent
from typing import Any

from adapters.recording.reading import Recording, is_recording
from bigactors.exits import Exit
from bigactors.files import read_bytes, read_json
from bigactors.foreign_recordings import TELEMETRY, Shown, watched
from bigactors.missions import digest_of, opening, variation_of
from bigactors.mistakes import Mistake
from bigactors.recordings import mission_of, open_recording, trace_of
from bigactors.terminal import is_terminal, paint, say, tell
from bigactors.waypoint_export import write_route
from bigraphs import draw_text
from checker import ReplayError, Trace, print_loop, print_trace, replay
from physical.nmea_lines import has_frame
from physical.wordings import counted
from semantics.races.monitor import monitored
from semantics.state.abstraction import all_as_it_is
from semantics.state.printing import print_configuration
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


def run(options: Namespace) -> Exit:
    """Replay a trace and print it; stop at a step that the rules do not allow."""
    if is_foreign(options.trace):
        return show_foreign(options)
    try:
        found = read_trace(options.trace, options.mission, opening(variation_of(options)))
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    trace, recording = found.trace, found.recording
    if recording is not None:
        _introduce(recording)
    for line in paced(trace, found.times, options.speed, stepwise=options.step):
        say(line)
    say(f"c{len(trace)} = {print_configuration(trace.configurations[-1])}")
    again = f", and {print_loop(trace)}" if trace.loop is not None else ""
    say(f"{options.trace}: {len(trace)} steps replayed on {found.mission.name}{again}")
    for vehicle, path in options.waypoints:
        tell(f"{write_route(trace, vehicle, path)} waypoints of {vehicle} written to {path}")
    return Exit.HOLDS


def is_foreign(path: str) -> bool:
    """Return whether a file is a telemetry log or AIS, not a trace or a recording of ours."""
    if path.endswith((TELEMETRY, *AIS)):
        return True
    begins = read_bytes(path, 4_096).lstrip()
    return begins[:1] in (b"!", b"$", b"\\", b"#") or (
        begins[:1] not in (b"", b"{", b"[") and has_frame(begins)
    )


def show_foreign(options: Namespace) -> Exit:
    """Print a foreign recording as a trace of the mission's world, and its last bigraph."""
    if options.waypoints:
        raise Mistake(
            "nothing is sent anywhere in a recording of others", "leave out --waypoints", options.trace
        )
    _, shown = _watched(options.trace, options.mission, opening(variation_of(options)), dict(options.name))
    for line in paced(shown.trace, shown.times, options.speed, stepwise=options.step):
        say(line)
    for finding in shown.findings:
        tell(finding.message, "not as the mission says:")
    say(f"c{len(shown.trace)} shows")
    say(indent(draw_text(all_as_it_is(shown.trace.configurations[-1]).structure.logical.bigraph()), "  "))
    changes = counted(len(shown.trace), "change")
    say(f"{options.trace}: {counted(shown.positions, 'position')}, {changes} of the bigraph")
    _account_for(options.trace, shown, say)
    return Exit.HOLDS


def _account_for(path: str, shown: Shown, write: Callable[[str], None]) -> None:
    """Print the counts of a foreign recording: the data used, and the data left out."""
    for tally in shown.tallies:
        for row in tally.summary():
            write(f"{path}: {row}")


def _watched(
    path: str, mission_file: str | None, open_mission: Open, names: dict[str, str]
) -> tuple[ElaboratedMission, Shown]:
    if mission_file is None:
        hint = "say in which mission's places it is to be seen: replay --mission FILE, show FILE"
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
        mission, shown = _watched(path, mission_file, open_mission, names or {})
        _account_for(path, shown, tell)
        return Replayed(mission, shown.trace, times=shown.times)
    data = read_json(path)
    named = data.get("mission") if isinstance(data, dict) else None
    if mission_file is None and not isinstance(named, str):
        raise Mistake("the file says no mission: it is no trace", "give the mission with --mission", path)
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


def _introduce(recording: Recording) -> None:
    if recording.run.get("verified") is not True:
        tell(paint("nothing was verified of this run", "red", sys.stderr), "!")
    if recording.left_out:
        tell(f"{recording.left_out:,} arrivals were not recorded: more came in a second than are written")
    if recording.torn:
        tell("the recording has no end: the run was killed")


def paced(trace: Trace, times: Sequence[float], speed: float | None, *, stepwise: bool) -> Iterator[str]:
    """Yield the lines of a trace: at once, at a multiple of the recorded speed, or step by step."""
    step, began = -1, time.monotonic()
    for line in print_trace(trace):
        if line.startswith("c"):
            step += 1
            if stepwise and is_terminal(sys.stdin):
                sys.stdin.readline()
            elif speed is not None and 0 < step < len(times):
                due = began + (times[step] - times[0]) / speed
                time.sleep(max(0.0, due - time.monotonic()))
        yield line


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
