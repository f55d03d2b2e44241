"""One turn of a live run: take in the arrivals, then make every step that follows, by the checked rules.

`advance` is a function of a state, a batch and a time. It knows no clock, no device and no file: tests, replays and the
loop all call it.
"""

from __future__ import annotations

from dataclasses import replace

from adapters.live.agent_rounds import go_on
from adapters.live.batch import Batch
from adapters.live.commanded import Commanded
from adapters.live.fallbacks import answers_for, check_limits
from adapters.live.flying import remember
from adapters.live.ingest import take_in
from adapters.live.live_state import LiveState
from adapters.live.operator_commands import answer
from adapters.live.order_progress import repeat_refused
from adapters.live.plan import Plan
from adapters.live.property_watch import watch_properties
from adapters.live.scheduling import in_turn
from adapters.live.step_taking import check_times
from adapters.live.turn_in_progress import Turning
from adapters.live.turn_result import Turn
from adapters.live.way_watch import watch_ways
from physical import centroid
from semantics.environment import Says
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed
from semantics.state.requests import READY
from semantics.state.signature import Name
from semantics.state.station_partition import is_parted

MOST_STEPS = 400
"""The most steps of one turn."""

LONG = 5.0
"""Seconds without listening that are reported."""


def advance(plan: Plan, state: LiveState, batch: Batch, now: float, most: int = MOST_STEPS) -> Turn:
    """Make one turn: take the world in, then let agents continue until nothing more can be done now."""
    if plan.first.setting.timing is not None:
        state = replace(state, due=state.due.running(state.configuration, now))
    turning = _taken_in(plan, state, batch, now)
    for said in batch.sayings:
        answer(turning, said)
    repeat_refused(turning)
    go_on(turning, most)
    check_limits(turning)
    check_times(turning)
    watch_properties(turning)
    return turning.turn()


def watch(plan: Plan, state: LiveState, batch: Batch, now: float) -> Turn:
    """Make a turn that only takes the world in, before a run begins."""
    return _taken_in(plan, state, batch, now).turn()


def _taken_in(plan: Plan, state: LiveState, batch: Batch, now: float) -> Turning:
    turning = Turning(plan, state.later(batch.missed) if batch.missed else state, now)
    if batch.missed >= LONG:
        missed = f"this process did not listen for {batch.missed:.0f} s; that time does not count as silence"
        turning.find("trouble", "", missed)
    take_in(turning, batch)
    watch_ways(turning)
    return turning


def obeying(plan: Plan, state: LiveState) -> frozenset[Name]:
    """Return the vehicles that this station commands: those of other stations never answer it."""
    turning = Turning(plan, state, 0.0)
    return frozenset(vehicle for vehicle in plan.vehicles if answers_for(turning, vehicle))


def is_over(state: LiveState) -> bool:
    """Return whether all agents have ended, none of their requests is pending, and no vehicle owes a stop.

    With several stations this is never known: the others may still send something.
    """
    c = state.configuration
    if is_parted(c) or state.overrides.owing:
        return False
    if any(map(c.alpha.code, c.alpha.names())):
        return False
    return all(isinstance(each.request, READY) for each in c.eta.all())


def is_refused(state: LiveState) -> bool:
    """Return whether all remaining requests were refused, with no change possible by operators or stations.

    An operator may give a vehicle back, or send a message that the mission allows.
    """
    c = state.configuration
    refusing = {given.agent for given in state.commanded if given.refused}
    overrides = state.overrides
    if not refusing or is_parted(c) or _may_be_said(c):
        return False
    if overrides.taken or overrides.suspended or overrides.grounded:
        return False
    pending = [each.request for each in c.eta.all() if not isinstance(each.request, READY)]
    rest = state.agents.idle | state.agents.failed
    at_rest = all(a in rest or not c.alpha.code(a) for a in c.alpha.names())
    return at_rest and bool(pending) and all(request.agent in refusing for request in pending)


def _may_be_said(c: Configuration) -> bool:
    says = (clause for clause in c.setting.environment if isinstance(clause, Says))
    return any(c.read(clause.counter) for clause in says)


def resumed(plan: Plan, state: LiveState, now: float) -> LiveState:
    """Return the state that resumes a killed run: its commands to vehicles are outstanding."""
    turning = Turning(plan, state, now)
    for pending in in_turn(state.configuration):
        remember(turning, pending.request)
    return turning.turn().state


def started(plan: Plan) -> LiveState:
    """Return the state in which a run of a mission begins."""
    physical = plan.first.structure.physical
    ours = [name for name, owner in plan.vehicles.items() if owner != plan.peers]
    placed = {name: physical.placement(name) for name in sorted(ours)}
    begins = {name: centroid(at.geometry) for name, at in placed.items() if isinstance(at, Placed)}
    return LiveState(plan.first, commanded=Commanded(begins=begins))
