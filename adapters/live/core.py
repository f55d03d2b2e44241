"""One turn of a live run: what came in, and every step that follows, by the rules that were checked.

`advance` is a function of a state, a batch and a time. It knows no clock, no device and no file: tests, replays and
the loop call the same.
"""

from __future__ import annotations

from adapters.live.flying import remember
from adapters.live.limits import check_limits
from adapters.live.serving import in_turn
from adapters.live.state import Batch, LiveState, Plan, Turn
from adapters.live.turning import Turning
from adapters.live.watching import hear, note, say_to
from semantics.configuration import Configuration
from semantics.parting import is_parted
from semantics.requests import READY

MOST_STEPS = 400
"""How many steps one turn takes at the most."""

LONG = 5.0
"""Seconds without listening that are said."""


def advance(plan: Plan, state: LiveState, batch: Batch, now: float, most: int = MOST_STEPS) -> Turn:
    """Return what one turn comes to: the world is taken in, then agents go on until nothing more can be done now."""
    turning = _taken_in(plan, state, batch, now)
    for saying in batch.sayings:
        say_to(turning, saying)
    turning.go_on(most)
    check_limits(turning)
    return turning.turn()


def watch(plan: Plan, state: LiveState, batch: Batch, now: float) -> Turn:
    """Return what a turn comes to in which the world is taken in, and nobody goes on: before a run begins."""
    return _taken_in(plan, state, batch, now).turn()


def _taken_in(plan: Plan, state: LiveState, batch: Batch, now: float) -> Turning:
    turning = Turning(plan, state.later(batch.missed) if batch.missed else state, now)
    if batch.missed >= LONG:
        missed = (
            f"nothing was listened to for {batch.missed:.0f} s: nobody is taken to have been silent meanwhile"
        )
        turning.find("trouble", "", missed)
    hear(turning, batch.heard)
    for report in batch.reports:
        note(turning, report)
    return turning


def is_over(state: LiveState) -> bool:
    """Tell whether nothing will happen any more: all agents have ended, and nothing they asked for is pending.

    Of one station among several nobody can tell: what comes from the others is not known.
    """
    c = state.configuration
    if is_parted(c):
        return False
    pending = (each.request for each in c.eta.all())
    return not any(map(c.alpha.code, c.alpha.names())) and all(isinstance(each, READY) for each in pending)


def resumed(plan: Plan, c: Configuration, steps: int, orders: int, now: float) -> LiveState:
    """Return the state of a run that goes on where another was killed: what it had asked of vehicles is outstanding."""
    state = LiveState(c, number=steps, told=orders)
    turning = Turning(plan, state, now)
    for pending in in_turn(c):
        remember(turning, pending.request)
    return turning.turn().state


def started(plan: Plan) -> LiveState:
    """Return the state in which a run of a mission begins."""
    return LiveState(plan.first)
