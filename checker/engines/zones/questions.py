"""Questions about each agent and each vehicle in the configurations reachable in time.

Each is a pure function of a configuration and reads few cells, so its answers are learned like the rules.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from checker.properties.findings import Key
from checker.properties.inspections import Excerpt, Inspection
from checker.properties.visited_statements import moment_of, passages
from checker.recording.value_templates import settled
from semantics.behaviours.computation import Passage
from semantics.behaviours.expressions import Fault
from semantics.races.monitor import CONTROLS
from semantics.state.agents import Code, code_cell
from semantics.state.configuration import Configuration, Transition
from semantics.state.signature import Name
from semantics.successors import Expansion, moves, remembered, served, turn_of
from semantics.timing.actor_clocks import Sort, StepClocks, Test, is_restored, of_moves, of_requests

NO_TURN = math.inf
"""The turn of a step that waits for none."""


class PendingControl(NamedTuple):
    """A pending control.

    Attributes:
        turn: Its position in the queue, `NO_TURN` if it waits for none.
        tests: A disjunction of clock tests before it may be served; empty if it may be served at any time.
    """

    turn: float
    tests: tuple[Test, ...]


def controls_of(a: Name, c: Configuration) -> tuple[PendingControl, ...]:
    """Return an agent's pending controls that a rule can serve."""
    steps = list(served(c, a)) if a in c.alpha else []
    times = dict(zip(map(id, steps), of_requests(c, a, steps).steps, strict=True))
    return tuple(
        PendingControl(_turn(several[0]), _one_of([times[id(each)] for each in several]))
        for several in _controls(steps)
    )


def _controls(steps: Iterable[Transition]) -> list[list[Transition]]:
    """Return the transitions that serve each control; of equal controls only the first is served."""
    found: dict[object, list[Transition]] = {}
    for step in dict.fromkeys(steps):
        if step.label.rule in CONTROLS and step.served is not None:
            found.setdefault((step.served.cell, step.served.position), []).append(step)
    return list(found.values())


def _one_of(several: list[StepClocks]) -> tuple[Test, ...]:
    if not all(each.tests for each in several):
        return ()
    return tuple(
        test._replace(clock=test.clock._replace(of=settled(test.clock.of)))
        for each in several
        for test in each.tests
    )


def _turn(step: Transition) -> float:
    turn = turn_of(step)
    return NO_TURN if turn is None else turn


def first_turn(a: Name, c: Configuration) -> float:
    """Return the first turn that an agent waits for."""
    return min(map(_turn, served(c, a)), default=NO_TURN) if a in c.alpha else NO_TURN


def between(
    inspection: Inspection, one: tuple[Name, int], other: tuple[Name, int], c: Configuration
) -> tuple[Key | None, ...]:
    """Return the findings of an inspection about two controls, given by their agents and ranks."""
    pair = [remembered(c, step) for a, rank in (one, other) for step in _controls(served(c, a))[rank]]
    return _found(inspection, c, (one[0], other[0]), pair)


def about_step(inspection: Inspection, a: Name, rank: int, c: Configuration) -> tuple[Key | None, ...]:
    """Return the findings of an inspection about a step that serves an agent's request, given by its rank."""
    return _found(inspection, c, (a,), [list(served(c, a))[rank]])


def _found(
    inspection: Inspection, c: Configuration, agents: tuple[Name, ...], steps: list[Transition]
) -> tuple[Key | None, ...]:
    excerpt = Excerpt(c, tuple(dict.fromkeys(agents)), Expansion(tuple(dict.fromkeys(steps)), ()))
    return tuple(each.wrong for each in inspection.seen(excerpt))


def unbounded(a: Name, c: Configuration) -> frozenset[tuple[str, float]]:
    """Return the rules of an agent's steps without an upper time bound, each with its turn."""
    return frozenset(_unbounded(a, c)) if a in c.alpha else frozenset()


def _unbounded(a: Name, c: Configuration) -> Iterator[tuple[str, float]]:
    for rules, clocks in ((served, of_requests), (moves, of_moves)):
        steps = [each for each in rules(c, a) if isinstance(each, Transition)]
        running, times = clocks(c, a, steps)
        ending = {each.clock for each in running if each.interval.hi is not None}
        for step, (done, _) in zip(steps, times, strict=True):
            if ending.isdisjoint(done):
                yield step.label.rule, _turn(step)


def longest_flight(a: Name, c: Configuration) -> int | None:
    """Return the longest flight of an agent in ticks, among those that can end; None if none is bounded."""
    running = of_requests(c, a, served(c, a)).running if a in c.alpha else ()
    return max((each.interval.hi or 0 for each in running if each.clock.sort is Sort.AIM), default=None)


def is_aloft(vehicle: Name, c: Configuration) -> bool:
    """Return whether a vehicle exists and is not where it is restored."""
    return vehicle in c.structure.physical and not is_restored(c, vehicle)


def is_failing(a: Name, c: Configuration) -> bool:
    """Return whether a computation of an agent fails or diverges."""
    return a in c.alpha and any(isinstance(each, Fault) for each in moves(c, a))


def left_to_run(a: Name, c: Configuration) -> Code | None:
    """Return the code that is left to an agent, None if the agent doesn't exist."""
    code: Code = c.read(code_cell(a))
    return code if a in c.alpha else None


def passed_over(a: Name, c: Configuration) -> frozenset[Passage]:
    """Return the statements and branches that an agent's computation executes in one step."""
    return frozenset(passages(c.setting, moment_of(c, a)))
