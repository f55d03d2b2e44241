"""`bigactors simulate`: one run of a mission, chosen by a seed."""

import random
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import dataclass

from bigactors.exits import Exit
from bigactors.files import json_text, write_json
from bigactors.missions import digest_of, open_mission, variation_of
from bigactors.terminal import say, say_text, tell
from checker import Step, Trace, to_json
from physical.messages import counted
from semantics.state.configuration import Configuration
from semantics.state.printing import print_changes, print_configuration
from semantics.successors import Expansion, expand


def run(options: Namespace) -> Exit:
    """Print one run; write it as a trace if asked."""
    mission = open_mission(options.file, variation_of(options))
    simulation = simulate(mission.initial, options.seed, options.steps)
    if options.json != "-":
        for line in print_simulation(simulation):
            say(line)
    if options.json:
        data = to_json(simulation.trace, options.file, digest_of(mission))
        say_text(json_text(data)) if options.json == "-" else write_json(options.json, data)
    if options.json not in (None, "-"):
        tell(f"trace written to {options.json}")
    return Exit.HOLDS


@dataclass(frozen=True, slots=True)
class Simulation:
    """One run.

    Attributes:
        trace: Its steps.
        shown: What `display` showed in each.
        end: Why it ended there.
    """

    trace: Trace
    shown: tuple[tuple[str, ...], ...]
    end: str


def simulate(initial: Configuration, seed: int, steps: int) -> Simulation:
    """Take one run of at most so many steps, each transition as likely as any other."""
    chance = random.Random(seed)  # a simulation, no secret
    taken: list[Step] = []
    shown: list[tuple[str, ...]] = []
    at = initial
    while True:
        expansion = expand(at)
        if not expansion.transitions or len(taken) == steps:
            return Simulation(Trace(initial, tuple(taken)), tuple(shown), _end(expansion, steps))
        chosen = chance.choice(expansion.transitions)
        alike = [each.target for each in expansion.transitions if each.label == chosen.label]
        taken.append(Step(chosen.label, alike.index(chosen.target), chosen.target))
        shown.append(chosen.shown)
        at = chosen.target


def _end(expansion: Expansion, steps: int) -> str:
    if expansion.transitions:
        return f"stopped after {counted(steps, 'step')}"
    reasons = "".join(f"; {fault.agent}: {fault}" for fault in expansion.faults)
    return f"nothing more is enabled{reasons}"


def print_simulation(simulation: Simulation) -> Iterator[str]:
    """Print a run in the paper's notation: its first configuration, its steps, its last configuration."""
    trace = simulation.trace
    yield f"c0 = {print_configuration(trace.initial)}"
    for number, (step, source) in enumerate(zip(trace.steps, trace.configurations, strict=False)):
        yield f"c{number} --{step.label}--> c{number + 1}"
        yield from (f"      {line}" for line in print_changes(source, step.target))
        yield from (f"      displayed: {text}" for text in simulation.shown[number])
    if trace.steps:
        yield f"c{len(trace)} = {print_configuration(trace.configurations[-1])}"
    yield simulation.end
