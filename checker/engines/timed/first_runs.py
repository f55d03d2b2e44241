"""Runs in whole ticks, and the choice of the run that a report shows.

The first run to a goal has the fewest steps. Among such runs, its sequence of step numbers is the first in
lexicographic order. Each step is as early as the steps before it allow. So every engine shows the same run.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, TypeVar

from checker.limits import look

DELAY = -1
"""The step number of a delay: one tick passes."""


class RunEdge(NamedTuple):
    """An edge between two states: the number of a step in its configuration, or `DELAY`."""

    step: int
    target: int


@dataclass(frozen=True, slots=True)
class TimedRun:
    """A run.

    Attributes:
        steps: The numbers of its steps, each in its own configuration.
        dates: The date of each step, in ticks from the start.
        end: The duration of the run in ticks.
    """

    steps: tuple[int, ...] = ()
    dates: tuple[int, ...] = ()
    end: int = 0

    def then(self, step: int) -> TimedRun:
        """Return the run with one more step at its end."""
        return replace(self, steps=(*self.steps, step), dates=(*self.dates, self.end))


Node = TypeVar("Node", bound=Hashable)
Follow = Callable[[Node], Iterable[tuple[int, Node]]]


@dataclass(frozen=True, slots=True, eq=False)
class StateGroup(Generic[Node]):
    """The states that a sequence of steps reaches first, at any dates."""

    states: tuple[Node, ...]
    step: int = DELAY
    before: StateGroup[Node] | None = None

    @property
    def steps(self) -> tuple[int, ...]:
        """The steps of the sequence."""
        found, group = [], self
        while group.before is not None:
            found.append(group.step)
            group = group.before
        return tuple(reversed(found))


def groups(start: Node, follow: Follow[Node]) -> Iterator[StateGroup[Node]]:
    """Yield the states in groups, one for each first sequence of steps: the shortest first, then by step numbers."""
    met = {start}
    layer = [StateGroup(tuple(_waiting([start], follow, met)))]
    while layer:
        following: list[StateGroup[Node]] = []
        for group in layer:
            look()
            yield group
            by_step: dict[int, list[Node]] = {}
            for step, target in (edge for state in group.states for edge in follow(state)):
                if step != DELAY and target not in met:
                    by_step.setdefault(step, []).append(target)
            for step, targets in sorted(by_step.items()):
                fresh = [each for each in dict.fromkeys(targets) if each not in met]
                met.update(fresh)
                if fresh:
                    following.append(StateGroup(tuple(_waiting(fresh, follow, met)), step, group))
        layer = following


def layers(start: Node, follow: Follow[Node]) -> Iterator[list[Node]]:
    """Yield all states, layer by layer: those that a number of steps reaches and fewer don't."""
    met = {start}
    layer = _waiting([start], follow, met)
    while layer:
        look()
        yield layer
        targets = (to for state in layer for step, to in follow(state) if step != DELAY and to not in met)
        fresh = list(dict.fromkeys(targets))
        met.update(fresh)
        layer = _waiting(fresh, follow, met)


def _waiting(states: list[Node], follow: Follow[Node], met: set[Node]) -> list[Node]:
    """Add the unvisited states that delays alone reach, and return the list."""
    for state in states:  # grows during the loop
        later = [target for step, target in follow(state) if step == DELAY and target not in met]
        met.update(later)
        states += later
    return states


def first_run(start: Node, follow: Follow[Node], is_end: Callable[[Node], bool]) -> TimedRun | None:
    """Return the first run from a state to an end, None if there is none."""
    for group in groups(start, follow):
        if any(map(is_end, group.states)):
            run, _ = dated(start, follow, group.steps, is_end)
            return run
    return None


def dated(
    start: Node, follow: Follow[Node], steps: tuple[int, ...], is_end: Callable[[Node], bool]
) -> tuple[TimedRun, tuple[Node, ...]]:
    """Return a sequence of steps with its earliest dates to an end, and the ends it reaches on them."""
    leading = _leading(start, follow, steps, is_end)
    now, dates, states = 0, list[int](), [start]
    for done, step in enumerate((*steps, None)):
        while True:
            if step is None:
                ends = tuple(state for state in states if is_end(state))
            else:
                ends = tuple(
                    dict.fromkeys(
                        to
                        for state in states
                        for at, to in follow(state)
                        if at == step and (done + 1, to) in leading
                    )
                )
            if ends:
                break
            states = [
                to for state in states for at, to in follow(state) if at == DELAY and (done, to) in leading
            ]
            assert states, "the steps lead to no end"
            now += 1
        states = list(ends)
        dates += [] if step is None else [now]
    return TimedRun(steps, tuple(dates), now), tuple(states)


def _leading(
    start: Node, follow: Follow[Node], steps: tuple[int, ...], is_end: Callable[[Node], bool]
) -> set[tuple[int, Node]]:
    """Return the pairs of a number of done steps and a state from which the other steps reach an end."""
    sources: dict[tuple[int, Node], list[tuple[int, Node]]] = {(0, start): []}
    waiting = [(0, start)]
    for done, state in waiting:  # grows during the loop
        for step, target in follow(state):
            if step == DELAY or (done < len(steps) and step == steps[done]):
                node = (done + (step != DELAY), target)
                if node not in sources:
                    waiting.append(node)
                sources.setdefault(node, []).append((done, state))
    ends = [(done, state) for done, state in sources if done == len(steps) and is_end(state)]
    found = set(ends)
    while ends:
        for source in sources[ends.pop()]:
            if source not in found:
                found.add(source)
                ends.append(source)
    return found
