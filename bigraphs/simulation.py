"""Simulation of a system: one random run, determined by a seed."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

from bigraphs.bigraph import Bigraph
from bigraphs.engine.decoding import to_bigraph
from bigraphs.engine.machine import Machine, RewritingStep
from bigraphs.engine.node_identity import identities
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import GroundState
from bigraphs.system import Rule, System, SystemKind


class Stage(NamedTuple):
    """One state of a run.

    `rule` is the label of the last rule and `action` its action, if it has one; both are None at the start. `time` is
    the number of steps so far, in an SBRS the elapsed time. `kept` pairs the number of each surviving node before the
    step with its number after it.
    """

    bigraph: Bigraph
    labels: tuple[str, ...]
    rule: str | None
    action: str | None
    time: float
    kept: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Bounds:
    """The bounds of a run: a maximum number of steps and, in an SBRS, an optional end time."""

    steps: int
    time: float | None = None


def chances(seed: int, run: int | None = None) -> random.Random:
    """Return the random numbers of a seed, or of one of its numbered runs.

    The streams of the runs of one seed are independent (numpy's SeedSequence). Those of neighbouring seeds may not be.
    """
    if run is None:
        return random.Random(seed)
    from numpy.random import SeedSequence  # noqa: PLC0415 - a single run needs no numpy

    return random.Random(SeedSequence(seed, spawn_key=(run,)).generate_state(8).tobytes())


def simulate(system: System, seed: int, bounds: Bounds, *, run: int | None = None) -> Iterator[Stage]:
    """Yield the states of one run; equal seeds give equal runs, whatever the order of terms in the source.

    With `run`, it is the run of that number in `bigactors big sim --runs`.

    In a BRS each occurrence is equally likely; in a PBRS the weights decide. In an SBRS the rates decide, after an
    exponentially distributed delay (Gillespie's direct method). In an NBRS an action is drawn first, then an occurrence
    by its weight. The run ends in a deadlock or at its bounds.
    """
    machine, chance = Machine(system), chances(seed, run)
    spot, _ = machine.start()
    yield _stage(machine, spot, None, 0.0, ())
    time = 0.0
    for _ in range(bounds.steps):
        steps = ordered_steps(machine, spot)
        if not steps:
            return
        draw = Draw(system.kind, [step.reaction.rule for step in steps])
        step = steps[draw.one(chance)]
        time += draw.delay(chance)
        if bounds.time is not None and time > bounds.time:
            return
        kept = tuple(sorted(identities(spot, step)))
        spot = step.target
        yield _stage(machine, spot, step, time, kept)


def ordered_steps(machine: Machine, spot: Spot) -> list[RewritingStep]:
    """Return the possible steps, in an order that depends only on the state, not on the path to it."""
    return sorted(machine.steps(spot), key=lambda step: (step.reaction.number, step.target.state.key()))


class Draw:
    """A random choice among the applicable rules of a state, with the delay of the chosen one."""

    def __init__(self, kind: SystemKind, rules: Sequence[Rule]) -> None:
        self.timed = kind is SystemKind.SBRS
        groups: dict[str, list[int]] = {}
        for number, rule in enumerate(rules):
            groups.setdefault(rule.action or "" if kind is SystemKind.NBRS else "", []).append(number)
        weights = [1.0 if rule.weight is None else rule.weight for rule in rules]
        self.groups = [
            (numbers, list(accumulate(weights[number] for number in numbers)))
            for _, numbers in sorted(groups.items())
        ]
        self.total = sum(weights)

    def one(self, chance: random.Random) -> int:
        """Return the number of a rule: in an NBRS of a uniformly drawn action, then by the weights."""
        numbers, weights = self.groups[0] if len(self.groups) == 1 else chance.choice(self.groups)
        return chance.choices(numbers, cum_weights=weights)[0]

    def delay(self, chance: random.Random) -> float:
        """Return the delay of the step: 1, or in an SBRS exponential in the sum of the rates."""
        return chance.expovariate(self.total) if self.timed else 1.0


def _stage(
    machine: Machine, spot: Spot, step: RewritingStep | None, time: float, kept: tuple[tuple[int, int], ...]
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


def _labels(machine: Machine, state: GroundState) -> tuple[str, ...]:
    holding, predicates = machine.holding(state), enumerate(machine.system.predicates)
    return tuple(predicate.label for number, predicate in predicates if number in holding)
