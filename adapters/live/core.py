"""One turn of a live run: what came in, and every step that follows, by the rules that were checked.

`advance` is a function of a state, a batch and a time. It knows no clock, no device and no file: tests, replays and
the loop call the same.
"""

from __future__ import annotations

from adapters.live.limits import check_limits
from adapters.live.state import Batch, LiveState, Plan, Turn
from adapters.live.turning import Turning
from adapters.live.watching import hear, note, say_to

MOST_STEPS = 400
"""How many steps one turn takes before the loop looks at what has come in meanwhile."""


def advance(plan: Plan, state: LiveState, batch: Batch, now: float) -> Turn:
    """Return what one turn comes to: the world is taken in, then agents go on until nothing more can be done now."""
    turning = Turning(plan, state, now)
    hear(turning, batch.heard)
    for report in batch.reports:
        note(turning, report)
    for saying in batch.sayings:
        say_to(turning, saying)
    turning.go_on(MOST_STEPS)
    check_limits(turning)
    return turning.turn()


def started(plan: Plan) -> LiveState:
    """Return the state in which a run of a mission begins."""
    return LiveState(plan.first)
