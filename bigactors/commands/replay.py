"""`bigactors replay`: a trace run again through the rules."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from bigactors.exits import Exit
from bigactors.files import read_json
from bigactors.missions import digest_of, open_mission, shipped_missions, variation_of
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell
from checker import ReplayError, Trace, print_loop, print_trace, replay
from semantics.monitor import monitored
from semantics.printing import print_configuration
from specs.elaboration import ElaboratedMission, Variation


def run(options: Namespace) -> Exit:
    """Replay a trace and print it; a step that the rules do not allow ends it."""
    try:
        mission, trace = read_trace(options.trace, options.mission, variation_of(options))
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    for line in print_trace(trace):
        say(line)
    say(f"c{len(trace)} = {print_configuration(trace.configurations[-1])}")
    again = f", and {print_loop(trace)}" if trace.loop is not None else ""
    say(f"{options.trace}: {len(trace)} steps replayed on {mission.name}{again}")
    return Exit.HOLDS


def read_trace(path: str, mission_file: str | None, variation: Variation) -> tuple[ElaboratedMission, Trace]:
    """Return the mission of a trace and the trace, replayed; warn where it was written of another mission.

    Raises:
        Mistake: The file holds no trace, or its mission cannot be read.
        ReplayError: The mission does not allow it.
    """
    data = read_json(path)
    named = data.get("mission") if isinstance(data, dict) else None
    if mission_file is None and not isinstance(named, str):
        raise Mistake("the file says no mission: it is no trace", "give the mission with --mission", path)
    mission = open_mission(mission_file or _beside(path, str(named)), variation)
    _warn_of_another(path, data, mission, mission_file or str(named))
    try:
        start = monitored(mission.initial) if data.get("monitored") is True else mission.initial
        return mission, replay(start, data)
    except ValueError as error:
        raise Mistake(str(error), place=path) from error


def _beside(trace: str, mission: str) -> str:
    """Return the path of the mission that a trace names: from here, or from where the trace is."""
    beside = Path(trace).parent / mission
    known = Path(mission).is_file() or mission in shipped_missions() or not beside.is_file()
    return mission if known else str(beside)


def _warn_of_another(path: str, data: Any, mission: ElaboratedMission, given: str) -> None:
    if not isinstance(data, dict) or data.get("digest") == digest_of(mission):
        return
    tell(f"{path}: warning: it was written of another mission, or by another version of bigactors")
    tell(f"  written of: {data.get('mission')!s:.200}, digest {data.get('digest')!s:.80}")
    tell(f"  replayed on: {given}, digest {digest_of(mission)}")
