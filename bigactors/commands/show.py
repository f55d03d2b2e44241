"""`bigactors show`: a configuration printed, and drawn as a bigraph beside a map."""

from argparse import Namespace

from bigactors.commands.replay import read_trace
from bigactors.drawings import draw
from bigactors.exits import Exit
from bigactors.files import file_stem
from bigactors.missions import open_mission, variation_of
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell
from checker import ReplayError, Trace, print_loop
from semantics.printing import print_configuration


def run(options: Namespace) -> Exit:
    """Print and draw the initial configuration of a mission, or one of a trace."""
    try:
        name, trace, step = _chosen(options)
    except ReplayError as error:
        tell(f"{options.trace}: {error}")
        return Exit.VIOLATED
    configuration = trace.configurations[step]
    if step:
        say(f"c{step - 1} --{trace.steps[step - 1].label}--> c{step}")
    say(f"c{step} = {print_configuration(configuration)}")
    if trace.loop is not None and step in (trace.loop, len(trace)):
        say(print_loop(trace))
    output = options.output or f"{file_stem(name)}{f'-c{step}' if step else ''}.svg"
    before = trace.configurations[step - 1] if step else None
    draw(configuration, output, f"{name}, c{step}", before)
    tell(f"picture written to {output}")
    return Exit.HOLDS


def _chosen(options: Namespace) -> tuple[str, Trace, int]:
    """Return the mission's name, a trace of it, and which configuration of it to show."""
    if options.trace is None:
        if options.file is None:
            raise Mistake("there is nothing to show", "give a mission, or a trace with --trace")
        if options.step is not None:
            raise Mistake("--step is a step of a trace", "give the trace with --trace")
        mission = open_mission(options.file, variation_of(options))
        return mission.name, Trace(mission.initial), 0
    mission, trace = read_trace(options.trace, options.file, variation_of(options))
    step = len(trace) if options.step is None else options.step
    if step > len(trace):
        raise Mistake(
            f"there is no c{step}: the trace ends with c{len(trace)}",
            f"give --step 0 to {len(trace)}",
            options.trace,
        )
    return mission.name, trace, step
