"""`bigactors show`: a configuration as text and as a bigraph beside a map; a trace in lanes, or as a page."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from bigactors.arguments.options import FOREIGN_NAMES, MISSION, VARIATION
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

if TYPE_CHECKING:
    from bigactors.commands.replay.trace_reader import Replayed
    from bigactors.pages import Story
    from checker import Trace

DESCRIPTION: Final = """\
Print the initial configuration of a mission, or any configuration of a trace, and draw its bigraph beside the map.
Show a whole trace in lanes or as a page that steps through it, and compare it with another one. Show a timeline of
all flights."""

EXAMPLES: Final = (
    "bigactors show oil_spill.mission --output oil_spill.png",
    "bigactors show oil_spill.mission --trace run.json --step 3",
    "bigactors show endurance.mission --timeline --output endurance.png",
    "bigactors show --trace run.json --output run.html",
    "bigactors show --trace run.mcap --output tracks.geojson",
    "bigactors show oil_spill --trace flight.tlog --name mavlink:1=uav0 --output flight.html",
)

ARGUMENTS: Final = f"""\
  file [FILE]  {MISSION}; optional with --trace
  --output, --out FILE  write a picture (.svg or .png), a page that steps through the whole trace (.html), or the
      tracks of a trace or recording (.geojson, .gpx or .csv); default: MISSION.svg in this folder
  --trace TRACE  a trace in JSON (check --trace and simulate write it), a recording (run --record writes it), or a
      telemetry log (.tlog) or AIS recording, shown in the mission's places
  --step K  show configuration K of the trace (default: its last)
  --lanes  print the trace with a lane for each agent, and only the changes of each step; draw only with --output
  --timeline  explore a mission with timing, print the table of check --times, and draw the earliest and latest
      times of each flight over all runs (default: MISSION-timeline.svg in this folder)
  --all  give each step a row (default: repeated steps, such as those of an agent that observes again and again,
      share one)
  --against TRACE  print the differences between the trace and this one, and draw nothing
{FOREIGN_NAMES}

{VARIATION}"""


PAGES = (".html", ".htm")
MOST_CONFIGURATIONS = 2_000_000
"""The most configurations visited for a timeline."""

NARROW, WIDE = 40, 200
"""The least and the most columns for lanes."""


def run(options: Namespace) -> Exit:
    """Print and draw the initial configuration of a mission, or the requested view of a trace."""
    from adapters.recording.recorded_tracks import WRITERS
    from checker import ReplayError

    if options.timeline:
        return _show_timeline(options)
    try:
        if options.against is not None:
            return _compare(options)
        if options.output and Path(options.output).suffix.lower() in WRITERS:
            return _write_tracks(options)
        found, step = _chosen(options)
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    if options.lanes:
        _show_lanes(found.trace, unfolded=options.all)
    else:
        _show_configuration(found.trace, step)
    _write(options, found, step)
    return Exit.HOLDS


def _show_timeline(options: Namespace) -> Exit:
    """Explore a mission, print its times and draw them. The exit code reports the picture, not the verdicts."""
    from bigactors.files import file_stem
    from bigactors.mission_lookup import open_mission, variation_of
    from bigactors.picture_files import draw_schedule
    from checker import Limits
    from checker.reports.times import times_text

    if options.file is None:
        raise Mistake("a timeline is of all runs of a mission", "give the mission")
    if options.trace is not None or options.step is not None or options.lanes or options.against is not None:
        hint = "leave out --trace, --step, --lanes and --against; --lanes shows the dates of one run"
        raise Mistake("a timeline is of all runs of a mission", hint)
    from bigactors.checking import FailedMission, How, check_mission  # only a timeline explores

    if open_mission(options.file, variation_of(options)).setting.timing is None:
        hint = "write a section timing { ... }: docs/explanation/time.md"
        raise Mistake("it has no times: no duration is given", hint, options.file)
    limits = Limits(MOST_CONFIGURATIONS)
    checked = check_mission(options.file, limits, variation_of(options), How(times=True))
    if isinstance(checked, FailedMission):
        return checked.exit
    schedule, name = checked.report.schedule, checked.mission.name
    if schedule is None:
        return Exit.MISTAKE
    for bound in checked.report.bounds:
        say(f"  {bound.effect}")
    for line in times_text(schedule):
        say(line)
    output = options.output or f"{file_stem(name)}-timeline.svg"
    draw_schedule(schedule, output, f"{name}: what happens when")
    tell(f"picture written to {output}")
    return Exit.HOLDS


def _write_tracks(options: Namespace) -> Exit:
    """Write the dated positions in a recording or a trace; those of a recording completely."""
    from adapters.recording.recording_reader import is_recording
    from bigactors.commands.show.tracks import write_recorded, write_traced
    from physical.wordings import counted

    if options.trace is None:
        raise Mistake("tracks are those of a trace", "give the trace with --trace", options.output)
    if options.step is not None or options.lanes or options.against is not None:
        raise Mistake(
            "tracks are those of a whole trace", "leave out --step, --lanes and --against", options.output
        )
    if is_recording(options.trace):
        count = write_recorded(options.trace, options.output)
    else:
        found, _ = _chosen(options)
        count = write_traced(found.trace, found.times, options.output)
    tell(f"{counted(count, 'track')} written to {options.output}")
    return Exit.HOLDS


def _compare(options: Namespace) -> Exit:
    """Print the point at which two traces part, and the differences from there."""
    from bigactors.commands.replay.trace_reader import read_trace
    from bigactors.mission_lookup import variation_of
    from checker.reports.trace_comparison import comparison_text

    if options.trace is None:
        raise Mistake("--against is for two traces", "give the other one with --trace")
    variation, names = variation_of(options), dict(options.name)
    both = (options.trace, options.against)
    one, other = (read_trace(path, options.file, variation, names).trace for path in both)
    for line in comparison_text(one, other, (options.trace, options.against)):
        say(line)
    return Exit.HOLDS


def _show_lanes(trace: Trace, *, unfolded: bool) -> None:
    import shutil

    from checker.reports.lanes import lanes_of_trace, lanes_text

    columns = min(max(shutil.get_terminal_size((100, 24)).columns, NARROW), WIDE)
    for line in lanes_text(lanes_of_trace(trace), columns, unfolded=unfolded):
        say(line)


def _show_configuration(trace: Trace, step: int) -> None:
    from checker import print_loop
    from checker.traces import print_step
    from semantics.state.printing import print_configuration

    if step:
        say(print_step(trace, step))
    say(f"c{step} = {print_configuration(trace.configurations[step])}")
    if trace.loop is not None and step in (trace.loop, len(trace)):
        say(print_loop(trace))


def _write(options: Namespace, found: Replayed, step: int) -> None:
    """Write the output by its suffix: a page, the lanes as a picture, or the picture of a configuration."""
    from bigactors.files import file_stem
    from bigactors.picture_files import draw, draw_lanes, write_page
    from bigactors.pictures import marks_of

    name, trace, output = found.mission.name, found.trace, options.output
    if output is not None and Path(output).suffix.lower() in PAGES:
        left_out = write_page(_story(options, found, step), output)
        tell(f"page written to {output}")
        for line in left_out:
            tell(line)
        return
    if options.lanes:
        if output is not None:
            draw_lanes(trace, output, name, unfolded=options.all)
            tell(f"picture written to {output}")
        return
    output = output or f"{file_stem(name)}{f'-c{step}' if step else ''}.svg"
    draw(
        trace.configurations[step],
        output,
        f"{name}, c{step}",
        trace.configurations[step - 1] if step else None,
        marks_of(trace.initial, trace.configurations[step], found.mission.properties),
    )
    tell(f"picture written to {output}")


def _story(options: Namespace, found: Replayed, step: int) -> Story:
    """Return the page of a trace: with the headline of the page that `check` wrote, if the trace is its own."""
    from bigactors.mission_lookup import digest_of
    from bigactors.pages import Story
    from bigactors.pictures import marks_of
    from checker.reports.causes import causes_of

    trace, subject = found.trace, found.subject
    violated = subject is not None and subject.violation is not None
    opened = options.step is not None or trace.race is not None or violated
    asked = found.mission.properties if subject is None else (subject.asked,)
    notes = () if subject is None else (subject.about, *subject.details, digest_of(found.mission))
    return Story(
        found.mission.name,
        "" if subject is None else subject.headline,
        violated,
        trace,
        step if opened else 0,
        causes_of(trace) if subject is None else subject.causes(trace),
        notes=notes,
        times=found.times,
        unfolded=options.all,
        marks=marks_of(
            trace.initial, trace.configurations[step], asked, violated=None if subject is None else violated
        ),
        properties=found.mission.properties,
    )


def _chosen(options: Namespace) -> tuple[Replayed, int]:
    """Return a trace with its mission, and the number of the configuration to show."""
    from bigactors.commands.replay.trace_reader import Replayed, read_trace
    from bigactors.mission_lookup import open_mission, variation_of
    from checker import Trace

    if options.trace is None:
        if options.file is None:
            raise Mistake("there is nothing to show", "give a mission, or a trace with --trace")
        if options.step is not None or options.lanes or options.all:
            word = (
                "--lanes shows"
                if options.lanes
                else "--step is a step of"
                if options.step is not None
                else "--all is all of"
            )
            raise Mistake(f"{word} a trace", "give the trace with --trace")
        mission = open_mission(options.file, variation_of(options))
        return Replayed(mission, Trace(mission.initial)), 0
    found = read_trace(options.trace, options.file, variation_of(options), dict(options.name))
    trace = found.trace
    step = len(trace) if options.step is None else options.step
    if step > len(trace):
        raise Mistake(
            f"there is no c{step}: the trace ends with c{len(trace)}",
            f"give --step 0 to {len(trace)}",
            options.trace,
        )
    return found, step
