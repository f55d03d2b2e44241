"""`bigactors replay`: replay a trace or a recording through the rules."""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from bigactors.arguments.options import FOREIGN_NAMES, VARIATION
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import is_terminal, paint, say, tell

if TYPE_CHECKING:
    from adapters.recording.recording_reader import Recording
    from checker import Trace

DESCRIPTION: Final = """\
Replay a trace, or the recording of a run, through the rules, step by step. A step that the rules do not allow ends
the replay with exit code 1, and the enabled steps are printed.

For a telemetry log (.tlog) or an AIS recording, print the changes of the bigraph in the places of a mission, the
events that its environment section does not permit, and the bigraph at the end."""

EXAMPLES: Final = (
    "bigactors replay traces/oil_spill/over_the_spill-witness/trace.json",
    "bigactors replay run.json --mission changed.mission",
    "bigactors replay run.mcap --report flight.html",
    "bigactors replay run.json --waypoints uav0=uav0.plan",
    "bigactors replay flight.tlog --mission oil_spill --name mavlink:1=uav0",
)

ARGUMENTS: Final = f"""\
  trace TRACE  a trace in JSON (check --trace and simulate write it), or a recording (run --record writes it)
  --mission FILE  the mission on which the trace is replayed (default: the mission that the trace names)
  --speed X  print a recording at X times its own speed (default: without pauses)
{FOREIGN_NAMES}
  --waypoints VEHICLE=FILE  write the destinations of a vehicle in the trace, with their altitudes, for ground
      stations: as QGC WPL 110 (.waypoints) or as a plan (.plan); may be repeated
  --report FILE  write the report of a recorded flight as a page: mission, verdict, vehicles, findings, and who did
      what
  --step  wait for Enter before each step

{VARIATION}"""


def run(options: Namespace) -> Exit:
    """Replay a trace and print it; stop at a step that the rules do not allow."""
    from bigactors.commands.replay.trace_reader import is_foreign, read_trace
    from bigactors.commands.replay.waypoint_export import write_report, write_route
    from bigactors.mission_lookup import variation_of
    from checker import ReplayError, print_loop
    from physical.wordings import counted
    from semantics.state.printing import print_configuration

    if is_foreign(options.trace):
        return show_foreign(options)
    try:
        found = read_trace(options.trace, options.mission, variation_of(options))
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    trace, recording = found.trace, found.recording
    if recording is not None:
        _introduce(recording)
    for line in paced(trace, found.times, options.speed, stepwise=options.step):
        say(line)
    if recording is not None:
        _tell_breaches(recording)
    say(f"c{len(trace)} = {print_configuration(trace.configurations[-1])}")
    again = f", and {print_loop(trace)}" if trace.loop is not None else ""
    say(f"{options.trace}: {counted(len(trace), 'step')} replayed on {found.mission.name}{again}")
    if options.report is not None:
        write_report(options.trace, options.report)
    for vehicle, path in options.waypoints:
        written = counted(write_route(trace, vehicle, path), "waypoint")
        tell(f"{written} of {vehicle} written to {path}")
    return Exit.HOLDS


def show_foreign(options: Namespace) -> Exit:
    """Print a foreign recording as a trace of the mission's world, and its last bigraph."""
    from textwrap import indent

    from bigactors.commands.replay.trace_reader import account_for, watched_in
    from bigactors.mission_lookup import variation_of
    from bigraphs import draw_text
    from physical.wordings import counted
    from semantics.state.abstraction import all_as_it_is

    if options.report is not None:
        raise Mistake("a recording by other programs has no verdict", "leave out --report", options.trace)
    if options.waypoints:
        raise Mistake(
            "a recording by other programs has no destinations", "leave out --waypoints", options.trace
        )
    _, shown = watched_in(options.trace, options.mission, variation_of(options), dict(options.name))
    for line in paced(shown.trace, shown.times, options.speed, stepwise=options.step):
        say(line)
    for finding in shown.findings:
        tell(finding.message, "assumption broken:")
    say(f"c{len(shown.trace)} shows")
    say(indent(draw_text(all_as_it_is(shown.trace.configurations[-1]).structure.logical.bigraph()), "  "))
    changes = counted(len(shown.trace), "change")
    say(f"{options.trace}: {counted(shown.positions, 'position')}, {changes} of the bigraph")
    account_for(options.trace, shown, say)
    return Exit.HOLDS


def _introduce(recording: Recording) -> None:
    if recording.run.get("verified") is not True:
        tell(paint("nothing was verified of this run", "red", sys.stderr), "!")
    if recording.left_out:
        tell(f"{recording.left_out:,} arrivals were not recorded: more came in a second than are written")
    if recording.torn:
        tell("the recording has no end: the run was killed, or still writes it")


def _tell_breaches(recording: Recording) -> None:
    """Print the broken assumptions and properties of a recorded run, with their times from its first message on."""
    begin = recording.messages[0].time if recording.messages else 0.0
    for message in recording.of("findings"):
        kind, said = message.data.get("kind"), message.data.get("message")
        if kind in ("broken assumption", "broken property") and isinstance(said, str):
            tell(f"{said:.400}", f"{message.time - begin:8.1f} s  {kind}:")


def paced(trace: Trace, times: Sequence[float], speed: float | None, *, stepwise: bool) -> Iterator[str]:
    """Yield the lines of a trace: at once, at a multiple of the recorded speed, or step by step."""
    from checker import print_trace

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
