"""Simulate a system: one run, chosen by a seed."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from bigraphs.bigraph import Bigraph
from bigraphs.engine.decoding import to_bigraph
from bigraphs.engine.machine import Machine, Step
from bigraphs.engine.node_identity import identities
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state import State
from bigraphs.system import System, SystemKind


class Stage(NamedTuple):
    """One state of a run.

    `rule` is the label of the rule that made it and `action` its action, if it has one; both are None at the start.
    `time` is the number of steps so far, or in an SBRS the time that has passed. `kept` gives the number of a node
    before the step and its number now, for every node that is the same one.
    """

    bigraph: Bigraph
    labels: tuple[str, ...]
    rule: str | None
    action: str | None
    time: float
    kept: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Bounds:
    """How far a run goes: at most so many steps, and in an SBRS at most until a time."""

    steps: int
    time: float | None = None


def simulate(system: System, seed: int, bounds: Bounds) -> Iterator[Stage]:
    """Yield the states of one run, the same for the same seed, however terms are written.

    In a BRS each occurrence is as likely as any other; in a PBRS by its weight; in an SBRS by its rate, after a
    delay that is exponentially distributed (Gillespie's direct method); in an NBRS first an action is drawn, then
    an occurrence by its weight. The run ends where nothing can happen, or at its bounds.
    """
    machine, chance = Machine(system), random.Random(seed)
    spot, _ = machine.start()
    yield _stage(machine, spot, None, 0.0, ())
    time = 0.0
    for _ in range(bounds.steps):
        steps = list(machine.steps(spot))
        if not steps:
            return
        step = _draw(system.kind, steps, chance)
        time += chance.expovariate(sum(map(_weight, steps))) if system.kind is SystemKind.SBRS else 1.0
        if bounds.time is not None and time > bounds.time:
            return
        kept = tuple(sorted(identities(spot, step)))
        spot = step.target
        yield _stage(machine, spot, step, time, kept)


def _draw(kind: SystemKind, steps: list[Step], chance: random.Random) -> Step:
    if kind is SystemKind.NBRS:
        actions = sorted({step.reaction.rule.action or "" for step in steps})
        chosen = chance.choice(actions)
        steps = [step for step in steps if (step.reaction.rule.action or "") == chosen]
    return chance.choices(steps, [_weight(step) for step in steps])[0]


def _weight(step: Step) -> float:
    return 1.0 if step.reaction.rule.weight is None else step.reaction.rule.weight


def _stage(
    machine: Machine, spot: Spot, step: Step | None, time: float, kept: tuple[tuple[int, int], ...]
) -> Stage:
    rule = None if step is None else step.reaction.rule
    return Stage(
        to_bigraph(spot.state),
        _labels(machine, spot.state),
        None if rule is None else rule.label,
        None if rule is None else rule.action,
        time,
        kept,
    )


def _labels(machine: Machine, state: State) -> tuple[str, ...]:
    holding, predicates = machine.holding(state), enumerate(machine.system.predicates)
    return tuple(predicate.label for number, predicate in predicates if number in holding)
