"""`bigactors show`: a configuration printed, and drawn as a bigraph beside a map; a trace in lanes, or as a page."""

import shutil
from argparse import Namespace
from pathlib import Path

from bigactors.commands.replay import read_trace
from bigactors.drawings import draw, draw_lanes, write_page
from bigactors.exits import Exit
from bigactors.files import file_stem
from bigactors.missions import open_mission, opening, variation_of
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell
from checker import ReplayError, Trace, print_loop
from checker.reports.comparison import comparison_text
from checker.reports.lanes import lanes_of_trace, lanes_text
from semantics.state.printing import print_configuration

PAGES = (".html", ".htm")
NARROW, WIDE = 40, 200
"""The least and the most columns of a terminal that lanes are laid out for."""


def run(options: Namespace) -> Exit:
    """Print and draw the initial configuration of a mission, or what is asked for of a trace."""
    try:
        if options.against is not None:
            return _compare(options)
        name, trace, step = _chosen(options)
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    if options.lanes:
        _show_lanes(trace)
    else:
        _show_configuration(trace, step)
    _write(options, name, trace, step)
    return Exit.HOLDS


def _compare(options: Namespace) -> Exit:
    """Print where two traces part, and what differs after that."""
    if options.trace is None:
        raise Mistake("--against is for two traces", "give the other one with --trace")
    opened, names = opening(variation_of(options)), dict(options.name)
    both = (options.trace, options.against)
    one, other = (read_trace(path, options.file, opened, names).trace for path in both)
    for line in comparison_text(one, other, (options.trace, options.against)):
        say(line)
    return Exit.HOLDS


def _show_lanes(trace: Trace) -> None:
    columns = min(max(shutil.get_terminal_size((100, 24)).columns, NARROW), WIDE)
    for line in lanes_text(lanes_of_trace(trace), columns):
        say(line)


def _show_configuration(trace: Trace, step: int) -> None:
    if step:
        say(f"c{step - 1} --{trace.steps[step - 1].label}--> c{step}")
    say(f"c{step} = {print_configuration(trace.configurations[step])}")
    if trace.loop is not None and step in (trace.loop, len(trace)):
        say(print_loop(trace))


def _write(options: Namespace, name: str, trace: Trace, step: int) -> None:
    """Write what the name of the output says: a page, the lanes as a picture, or the picture of a configuration."""
    output = options.output
    if output is not None and Path(output).suffix.lower() in PAGES:
        write_page(trace, output, name, step if options.step is not None else 0)
        tell(f"page written to {output}")
        return
    if options.lanes:
        if output is not None:
            draw_lanes(trace, output, name)
            tell(f"picture written to {output}")
        return
    output = output or f"{file_stem(name)}{f'-c{step}' if step else ''}.svg"
    draw(
        trace.configurations[step],
        output,
        f"{name}, c{step}",
        trace.configurations[step - 1] if step else None,
    )
    tell(f"picture written to {output}")


def _chosen(options: Namespace) -> tuple[str, Trace, int]:
    """Return the mission's name, a trace of it, and which configuration of it to show."""
    if options.trace is None:
        if options.file is None:
            raise Mistake("there is nothing to show", "give a mission, or a trace with --trace")
        if options.step is not None or options.lanes:
            word = "--lanes shows" if options.lanes else "--step is a step of"
            raise Mistake(f"{word} a trace", "give the trace with --trace")
        mission = open_mission(options.file, variation_of(options))
        return mission.name, Trace(mission.initial), 0
    found = read_trace(options.trace, options.file, opening(variation_of(options)), dict(options.name))
    trace = found.trace
    step = len(trace) if options.step is None else options.step
    if step > len(trace):
        raise Mistake(
            f"there is no c{step}: the trace ends with c{len(trace)}",
            f"give --step 0 to {len(trace)}",
            options.trace,
        )
    return found.mission.name, trace, step
