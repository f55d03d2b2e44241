"""`bigactors simulate`: one run of a mission, chosen by a seed or step by step."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from bigactors.arguments.options import MISSION, VARIATION
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, say_text, tell

if TYPE_CHECKING:
    from bigactors.commands.simulate.one_run import OneRun
    from specs.elaboration import ElaboratedMission

DESCRIPTION: Final = """\
Simulate one run of a mission, chosen by a seed or by you, step by step, and print it in the paper's notation."""

EXAMPLES: Final = (
    "bigactors simulate oil_spill.mission --seed 7",
    "bigactors simulate oil_spill.mission --steps 20 --json run.json",
    "bigactors simulate oil_spill.mission --choose",
)

ARGUMENTS: Final = f"""\
  file FILE  {MISSION}
  --seed N as at_least_zero = 0  the number that chooses the run; the same seed gives the same run
  --steps N as at_least_zero = 100  take at most N steps
  --choose  choose each step: the enabled steps are listed, and your answers are read from standard input (? lists
      the possible answers)
  --json FILE  write the run as a trace in JSON; - for standard output, alone

{VARIATION}"""


PROMPT = "> "
LONGEST_ANSWER = 1_000


def run(options: Namespace) -> Exit:
    """Print one run; write it as a trace on request."""
    from bigactors.commands.simulate.one_run import print_simulation, simulate
    from bigactors.files import json_text, write_json
    from bigactors.mission_lookup import open_mission, variation_of
    from bigactors.trace_files import trace_json

    if options.choose and options.json == "-":
        raise Mistake("--choose talks on standard output", "write the trace to a file: --json FILE")
    mission = open_mission(options.file, variation_of(options))
    if options.choose:
        run = chosen(mission, options.seed)
    else:
        simulation = simulate(mission.initial, options.seed, options.steps)
        run = simulation.run
        for line in print_simulation(simulation) if options.json != "-" else ():
            say(line)
    if options.json:
        data = trace_json(run.trace, options.file, mission, variation_of(options).sources)
        say_text(json_text(data)) if options.json == "-" else write_json(options.json, data)
    if options.json not in (None, "-"):
        tell(f"trace written to {options.json}")
    return Exit.HOLDS


def chosen(mission: ElaboratedMission, seed: int) -> OneRun:
    """Let the user choose each step; answers from a pipe are echoed after the prompt."""
    import random

    from bigactors.commands.simulate.choosing import Walk
    from bigactors.commands.simulate.one_run import OneRun

    walk = Walk(OneRun(mission.initial), mission.properties, random.Random(seed))
    for line in walk.lines(_answers()):
        say(line)
    return walk.run


def _answers() -> Iterator[str]:
    """Yield the lines of standard input; a terminal gets a prompt."""
    if not sys.stdin.isatty():
        while answer := sys.stdin.readline(LONGEST_ANSWER):
            say(f"{PROMPT}{answer.rstrip()}")
            yield answer
        return
    with suppress(EOFError):
        while True:
            yield input(PROMPT)
    say("")
