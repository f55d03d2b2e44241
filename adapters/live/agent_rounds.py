"""Let agents take own steps, one each in turn, and serve their requests."""

from __future__ import annotations

from bisect import bisect_right

from adapters.live.request_service import serve
from adapters.live.scheduling import PATIENCE, STEPS_PER_SECOND, own_steps
from adapters.live.step_taking import take
from adapters.live.turn_in_progress import Turning
from semantics.behaviours.expressions import Fault
from semantics.behaviours.process_conversion import next_statement
from semantics.behaviours.statements import React
from semantics.bigactor_rules import timeout
from semantics.state.configuration import Transition
from semantics.state.signature import Name
from semantics.state.station_partition import is_here


def go_on(turning: Turning, most: int) -> None:
    """Let every agent take a step in turn and serve one request, until nothing more can be done now."""
    ended = []
    for agent, until in turning.due.timeouts.items():
        if until > turning.now:
            turning.wake(until)
        else:
            ended.append(agent)
    turning.agents = turning.agents.woken(ended)
    left = most
    while left > 0:
        taken = _own_steps(turning, left)
        taken += serve(turning)
        if not taken:
            return
        left -= taken
    turning.wake(turning.now)


def _own_steps(turning: Turning, most: int) -> int:
    """Let agents take one step each, beginning after the last one that took a step."""
    agents = turning.agents
    able = (a for a in turning.c.alpha.names() if a not in agents.idle and a not in agents.failed)
    going = [a for a in able if is_here(turning.c, a)]
    first = bisect_right(going, agents.last)
    taken, last = 0, agents.last
    for a in going[first:] + going[:first]:
        if taken >= most:
            break
        taken += _own_step(turning, a)
        last = a
    turning.agents = turning.agents.after(last)
    return taken


def _own_step(turning: Turning, a: Name) -> bool:
    """Let an agent take one step of its own, if its pace allows one."""
    pace = turning.agents.pace(a, turning.now)
    if pace.tokens < 1:
        turning.wake(turning.now + max(PATIENCE, (1 - pace.tokens) / STEPS_PER_SECOND))
        return False
    try:
        found = own_steps(turning.c, a) or _timeout(turning, a)
    except Fault as fault:
        turning.agents = turning.agents.failing(a)
        turning.find("failed", a, f"the computation of {a} fails: {fault}")
        return False
    if not found:
        turning.agents = turning.agents.resting(a)
        return False
    turning.agents = turning.agents.paced(a, pace.spent())
    take(turning, found[turning.number % len(found)], found)
    return True


def _timeout(turning: Turning, a: Name) -> tuple[Transition, ...]:
    """Return the timeout of an agent that has waited long enough; schedule it for one that still waits."""
    found = tuple(timeout(turning.c, a))
    if not found:
        turning.due = turning.due.waited(a)
        return ()
    react = next_statement(turning.c, a)
    assert isinstance(react, React)
    assert react.after is not None
    turning.due = turning.due.timing_out(a, turning.now + react.after.seconds)
    until = turning.due.timeouts[a]
    if turning.now < until:
        turning.wake(until)
        return ()
    return found
