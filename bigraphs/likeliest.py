"""The most probable run to a set of states, with a strategy for the nondeterministic choices."""

from __future__ import annotations

import heapq
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from math import log

from bigraphs.exports.markov import choices_of
from bigraphs.system import SystemKind
from bigraphs.transitions import Transition, TransitionSystem


@dataclass(frozen=True, slots=True)
class Likeliest:
    """A run: its transitions, their probabilities under the strategy, and the product of these."""

    transitions: tuple[Transition, ...]
    chances: tuple[float, ...]
    chance: float


def likeliest_run(
    system: TransitionSystem,
    goals: Container[int],
    within: Container[int] | None = None,
    strategy: Sequence[int] | None = None,
) -> Likeliest | None:
    """Return the most probable run from the initial state to the first goal state, None if there is none.

    Uses Dijkstra's algorithm on the negative logarithms of probabilities; ties go to the shortest run.

    Args:
        system: The transition system. For an SBRS the embedded chain is used.
        goals: The goal states.
        within: The states that the run may pass; all by default.
        strategy: The number of the choice in each state, as in exported files; needed for a BRS and an NBRS.
    """
    best = {0: (0.0, 0)}
    came: dict[int, tuple[Transition, float]] = {}
    waiting, done = [(0.0, 0, 0)], set[int]()
    while waiting:
        cost, length, state = heapq.heappop(waiting)
        if state in goals:
            return _run(state, came)
        if state in done or (within is not None and state not in within):
            continue
        done.add(state)
        for transition, chance in _chosen(system, state, strategy):
            target = transition.target
            reached = (cost - log(chance), length + 1)
            if target not in best or reached < best[target]:
                best[target] = reached
                came[target] = transition, chance
                heapq.heappush(waiting, (*reached, target))
    return None


def decisions(
    system: TransitionSystem, strategy: Sequence[int], goals: Container[int] = ()
) -> dict[int, str]:
    """Return the strategy's choice in each reachable state with several choices, up to the goals.

    A choice is named by its action; in a BRS by its rules.
    """
    told: dict[int, str] = {}
    waiting, met = [0], {0}
    while waiting:
        state = waiting.pop()
        if state in goals:
            continue
        chosen = [each for each, _ in _chosen(system, state, strategy)]
        if len(chosen) < len(system.leaving(state)):
            told[state] = chosen[0].action or ", ".join(chosen[0].rules)
        new = {each.target for each in chosen} - met
        met |= new
        waiting += new
    return dict(sorted(told.items()))


def _chosen(
    system: TransitionSystem, state: int, strategy: Sequence[int] | None
) -> Iterator[tuple[Transition, float]]:
    """Yield the transitions that the strategy permits, each with its probability."""
    leaving = list(system.transitions_from(state))
    if strategy is not None:
        numbered = zip(choices_of(system.kind, leaving), leaving, strict=True)
        leaving = [each for number, each in numbered if number == strategy[state]]
    total = sum(each.weight for each in leaving) if system.kind is SystemKind.SBRS else 1.0
    return ((each, each.weight / total) for each in leaving)


def _run(state: int, came: dict[int, tuple[Transition, float]]) -> Likeliest:
    steps: list[tuple[Transition, float]] = []
    while state:
        steps.append(came[state])
        state = steps[-1][0].source
    steps.reverse()
    chance = 1.0
    for _, each in steps:
        chance *= each
    return Likeliest(tuple(each for each, _ in steps), tuple(each for _, each in steps), chance)
