"""`bigactors simulate`: one run of a mission, chosen by a seed or step by step."""

import random
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from bigactors.choosing import Walk
from bigactors.exits import Exit
from bigactors.files import json_text, write_json
from bigactors.missions import digest_of, open_mission, variation_of
from bigactors.mistakes import Mistake
from bigactors.one_run import OneRun, nothing_more, print_step
from bigactors.terminal import say, say_text, tell
from checker import to_json
from physical.wordings import counted
from semantics.state.configuration import Configuration
from semantics.state.printing import print_configuration
from specs.elaboration import ElaboratedMission

PROMPT = "> "
LONGEST_ANSWER = 1_000


def run(options: Namespace) -> Exit:
    """Print one run; write it as a trace on request."""
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
        data = to_json(run.trace, options.file, digest_of(mission))
        say_text(json_text(data)) if options.json == "-" else write_json(options.json, data)
    if options.json not in (None, "-"):
        tell(f"trace written to {options.json}")
    return Exit.HOLDS


def chosen(mission: ElaboratedMission, seed: int) -> OneRun:
    """Let the user choose each step; answers from a pipe are echoed after the prompt."""
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


@dataclass(frozen=True, slots=True)
class Simulation:
    """One run, and the reason why it ended."""

    run: OneRun
    end: str


def simulate(initial: Configuration, seed: int, steps: int) -> Simulation:
    """Take one run of at most `steps` steps; all steps are equally likely, and with times all dates."""
    chance = random.Random(seed)  # a simulation, not a secret
    run = OneRun(initial)
    while run.choices():
        if len(run.taken) == steps:
            return Simulation(run, f"stopped after {counted(steps, 'step')}")
        run.take_by_chance(chance)
    return Simulation(run, nothing_more(run))


def print_simulation(simulation: Simulation) -> Iterator[str]:
    """Print a run in the paper's notation: its first configuration, its steps, its last configuration."""
    run = simulation.run
    yield f"c0 = {print_configuration(run.initial)}"
    for number in range(len(run.taken)):
        yield from print_step(run, number)
    if run.taken:
        yield f"c{len(run.taken)} = {print_configuration(run.at)}"
    yield simulation.end
