"""Statistics of many runs of a system: the times at which its predicates become true, with confidence intervals.

Run `number` of a seed is the run that `simulate` yields for both numbers. The sampler caches the possible steps of each
state for later runs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from math import cos, inf, pi, sin, sqrt, tan
from statistics import NormalDist, fmean, stdev
from typing import Final, NamedTuple

from bigraphs.engine.machine import Machine
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import Key
from bigraphs.simulation import Bounds, Draw, chances, ordered_steps
from bigraphs.system import System

MOST_REMEMBERED: Final = 50_000
"""The largest number of cached states."""

CONFIDENCE: Final = 0.95
NORMAL: Final = NormalDist()

MANY: Final = 200
"""The greatest number of degrees of freedom for which Student's distribution is summed."""


class End(Enum):
    """The reason for the end of a run."""

    STUCK = "no rule applies"
    STEPS = "steps"
    TIME = "time"


class Sample(NamedTuple):
    """A run; `number` is its number among the runs of its seed.

    `first` holds for each predicate the time at which it was first true, or None. `time` is the number of steps; in an
    SBRS it is the elapsed time at the end.
    """

    number: int
    first: tuple[float | None, ...]
    steps: int
    time: float
    end: End


class _Place:
    """A state that runs visit; its possible steps are computed when a run first continues from it."""

    __slots__ = ("draw", "holding", "spot", "targets")

    def __init__(self, spot: Spot) -> None:
        self.spot: Spot | None = spot
        self.holding: frozenset[int] | None = None
        self.draw: Draw | None = None
        self.targets: list[_Place] = []


class Sampler:
    """A sampler of one system: all its runs have the same seed and bounds."""

    def __init__(self, system: System, bounds: Bounds, seed: int = 0) -> None:
        self.machine, self.bounds, self.seed = Machine(system), bounds, seed
        self.start, _ = self.machine.start()
        self.places: dict[Key, _Place] = {}

    def run(self, number: int) -> Sample:
        """Return run `number` of the seed."""
        chance, time, steps = chances(self.seed, number), 0.0, 0
        first: list[float | None] = [None] * len(self.machine.system.predicates)
        place = self.place(self.start)
        while True:
            for predicate in self.holding(place):
                if first[predicate] is None:
                    first[predicate] = time
            if steps == self.bounds.steps:
                return Sample(number, tuple(first), steps, time, End.STEPS)
            draw = self.draw(place)
            if not place.targets:
                return Sample(number, tuple(first), steps, time, End.STUCK)
            chosen = draw.one(chance)
            time += draw.delay(chance)
            if self.bounds.time is not None and time > self.bounds.time:
                return Sample(number, tuple(first), steps, self.bounds.time, End.TIME)
            place, steps = place.targets[chosen], steps + 1

    def place(self, spot: Spot) -> _Place:
        """Return the cached place of a state; the cache is emptied when it is full."""
        key = spot.state.key()
        found = self.places.get(key)
        if found is None:
            if len(self.places) >= MOST_REMEMBERED:
                self.places.clear()
            found = self.places[key] = _Place(spot)
        return found

    def holding(self, place: _Place) -> frozenset[int]:
        """Return the numbers of the predicates that are true at a place."""
        if place.holding is None:
            assert place.spot is not None  # the first visit reads the state before any step
            place.holding = frozenset(self.machine.holding(place.spot.state))
        return place.holding

    def draw(self, place: _Place) -> Draw:
        """Return the random choice among the targets of a place; the first call computes the targets."""
        if place.draw is None:
            assert place.spot is not None  # the spot is released below
            steps = ordered_steps(self.machine, place.spot)
            place.draw = Draw(self.machine.system.kind, [step.reaction.rule for step in steps])
            place.targets = [self.place(step.target) for step in steps]
            place.spot = None
        return place.draw


# --- statistics ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class SampleEstimate:
    """An estimated number, with its 95 % confidence interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class FirstTimes:
    """The statistics of one predicate.

    Attributes:
        label: The predicate.
        runs: The number of runs in which it was ever true.
        share: The probability of that, within the bounds of a run.
        time: The mean time at which it was first true, over these runs; None without any.
        least: The earliest of these times.
        most: The latest of these times.
        first_run: The number of the run with the earliest time.
    """

    label: str
    runs: int
    share: SampleEstimate
    time: SampleEstimate | None = None
    least: float = 0.0
    most: float = 0.0
    first_run: int | None = None


def first_times(system: System, samples: Sequence[Sample]) -> list[FirstTimes]:
    """Return the statistics of each predicate over these runs."""
    found = []
    for number, predicate in enumerate(system.predicates):
        times = [(time, each.number) for each in samples if (time := each.first[number]) is not None]
        chance = share(len(times), len(samples))
        if not times:
            found.append(FirstTimes(predicate.label, 0, chance))
            continue
        (least, first), (most, _) = min(times), max(times)
        estimate = mean([time for time, _ in times])
        found.append(FirstTimes(predicate.label, len(times), chance, estimate, least, most, first))
    return found


def share(times: int, runs: int) -> SampleEstimate:
    """Return the estimate of a probability, with Wilson's interval, which also holds for rare events.

    >>> round(share(0, 100).high, 4)
    0.037
    """
    z, rate = NORMAL.inv_cdf((1 + CONFIDENCE) / 2), times / runs
    shrink = 1 + z * z / runs
    centre = (rate + z * z / (2 * runs)) / shrink
    half = z * sqrt(rate * (1 - rate) / runs + (z / (2 * runs)) ** 2) / shrink
    low, high = 0.0 if times == 0 else centre - half, 1.0 if times == runs else centre + half
    return SampleEstimate(rate, low, high)


def mean(values: Sequence[float]) -> SampleEstimate:
    """Return the estimate of an expectation, with Student's interval; it is unbounded for one value.

    >>> round(mean([1.0, 2.0, 3.0]).high, 4)
    4.4841
    """
    centre = fmean(values)
    if len(values) == 1:
        return SampleEstimate(centre, -inf, inf)
    half = student_quantile(CONFIDENCE, len(values) - 1) * stdev(values, centre) / sqrt(len(values))
    return SampleEstimate(centre, centre - half, centre + half)


def student_quantile(confidence: float, freedom: int) -> float:
    """Return the bound within which a variable of Student's distribution lies with this confidence, on both sides of 0.

    The formulas are 26.7.3 to 26.7.5 of Abramowitz and Stegun (1964): sums for the distribution of few degrees of
    freedom, which bisection inverts, and an expansion about the normal distribution for many.

    >>> round(student_quantile(0.95, 2), 4)
    4.3027
    """
    if freedom > MANY:
        z = NORMAL.inv_cdf((1 + confidence) / 2)
        first, second = (z**3 + z) / 4, (5 * z**5 + 16 * z**3 + 3 * z) / 96
        third = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
        return z + first / freedom + second / freedom**2 + third / freedom**3
    low, high = 0.0, pi / 2
    while low < (angle := (low + high) / 2) < high:
        low, high = (angle, high) if _within(angle, freedom) < confidence else (low, angle)
    return sqrt(freedom) * tan(angle)


def _within(angle: float, freedom: int) -> float:
    """Return the probability that a variable of Student's distribution is within `sqrt(freedom) * tan(angle)` of 0."""
    odd = freedom % 2
    term, total = (cos(angle), 0.0) if odd else (1.0, 0.0)
    for number in range(
        1 + odd, freedom, 2
    ):  # the powers of the cosine, each with the product of its fractions
        total += term
        term *= cos(angle) ** 2 * number / (number + 1)
    return 2 / pi * (angle + sin(angle) * total) if odd else sin(angle) * total


def shares_until(samples: Sequence[Sample], predicate: int) -> Iterable[tuple[float, int]]:
    """Yield the times at which a predicate was first true, sorted, each with the number of runs up to it."""
    times = sorted(time for each in samples if (time := each.first[predicate]) is not None)
    for number, time in enumerate(times, 1):
        if number == len(times) or times[number] != time:
            yield time, number
