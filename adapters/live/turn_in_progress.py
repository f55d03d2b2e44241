"""The working copy of a turn: make steps, let agents compute, serve their requests, give orders."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import replace

from adapters.live.orders import hand_overs, is_authority, is_done, journey, stopping, unshown
from adapters.live.plan import Plan
from adapters.live.reported import Finding
from adapters.live.scheduling import PATIENCE, STEPS_PER_SECOND, own_steps, refilled, served, to_serve
from adapters.live.sightings import Fences, placement_seen
from adapters.live.state import Bidden, LiveState, Order, Pace
from adapters.live.timing import next_end, stepped, too_late, too_soon
from adapters.live.turn import Answer, LiveStep, Outgoing, Turn
from adapters.plugin import Command, HandOver
from semantics.behaviours.expressions import Fault
from semantics.behaviours.statements import React
from semantics.behaviours.stepping import next_statement
from semantics.control import Realisation, obstacle, realisations
from semantics.extension import timeout
from semantics.live_policy import Fallback
from semantics.observed_steps import Sight
from semantics.state.configuration import Transition
from semantics.state.eta import Pending
from semantics.state.partition import (
    HERE,
    Elsewhere,
    Passage,
    is_here,
    is_parted,
    leave,
    parcel_of,
    sent_cell,
    station_of,
)
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.requests import CTR, SND
from semantics.state.signature import Name

MOST_REPORTED = 1_000
"""The number of remembered reports; beyond it no more troubles are reported, since any sender can cause any number."""


class Turning:
    """A turn in progress; its changes become the next state."""

    def __init__(self, plan: Plan, state: LiveState, now: float) -> None:
        self.plan = plan
        self.now = now
        self.before = state
        self.c = state.configuration
        self.seen = dict(state.seen)
        self.expires = state.expires
        self.orders = dict(state.orders)
        self.handing = dict(state.handing)
        self.lost = set(state.lost)
        self.taken = dict(state.taken)
        self.bidden = dict(state.bidden)
        self.owed = dict(state.owed)
        self.idle = set(state.idle)
        self.due = dict(state.due)
        self.heads = dict(state.heads)
        self.paces = dict(state.paces)
        self.suspended = state.suspended
        self.grounded = set(state.grounded)
        self.missing = dict(state.missing)
        self.failed = set(state.failed)
        self.reported = state.reported
        self.told = state.told
        self.shares = dict(state.shares)
        self.timers = state.timers
        self.stopped = state.stopped
        self.done: float | None = None
        self.coming: set[Name] = set()  # strangers that are about to be admitted
        self.quiet = state.quiet
        self.last = state.last
        self.fences = Fences(self.c)
        self.steps: list[LiveStep] = []
        self.commands: list[Command] = []
        self.findings: list[Finding] = []
        self.answers: list[Answer] = []
        self.parcels: list[Outgoing] = []
        self.again = math.inf

    # --- the result

    def turn(self) -> Turn:
        """Return the result of the turn."""
        state = LiveState(
            self.c,
            self.seen,
            self.expires,
            self.orders,
            self.handing,
            frozenset(self.lost),
            self.taken,
            self.bidden,
            self.owed,
            frozenset(self.idle),
            self.due,
            self.quiet,
            self.heads,
            self.paces,
            self.suspended,
            frozenset(self.grounded),
            self.missing,
            frozenset(self.failed),
            self.reported,
            self.last,
            self.before.number + len(self.steps),
            self.told,
            self.before.findings + len(self.findings),
            self.shares,
            self.timers,
            self.stopped,
        )
        gathered = (tuple(self.steps), tuple(self.commands), tuple(self.findings), tuple(self.answers))
        again = None if self.again == math.inf else self.again
        return Turn(state, *gathered, tuple(self.parcels), again)

    def find(self, kind: str, about: Name, message: str, fallback: str = "", *, once: bool = False) -> bool:
        """Report a finding, with `once` not twice, and at most so many troubles; return whether it was reported."""
        if once:
            full = kind == "trouble" and len(self.reported) >= MOST_REPORTED
            if full or message in self.reported:
                return False
            self.reported |= {message}
        self.findings.append(Finding(kind, about, message, self.now, fallback))
        return True

    def wake(self, at: float) -> None:
        """Schedule a turn at a time, even without input."""
        self.again = min(self.again, at)

    # --- steps

    def take(
        self,
        transition: Transition,
        alike: tuple[Transition, ...],
        sight: Sight | Elsewhere | None = None,
    ) -> None:
        """Take a step; `alike` are all possible steps by that rule here.

        Additions to an agent at another station leave at once.
        """
        word = str(transition.label)
        choice = [each for each in alike if str(each.label) == word].index(transition)
        number = self.before.number + len(self.steps) + 1
        date = self.now if self.done is None else min(self.done, self.now)
        self.steps.append(LiveStep(number, self.c, transition, choice, sight, self.now, date))
        agent, request = transition.label.agent, transition.label.about
        if agent is not None:
            self.idle.discard(agent)
        if agent is not None and transition.served is None:
            self.due.pop(agent, None)
        if agent is not None and transition.served is not None and not isinstance(request, SND):
            self.heads.pop(agent, None)
        if isinstance(request, SND):
            self.idle.discard(request.to)
        if transition.label.rule == "spawn":
            self.idle.discard(str(request))
        self.c = transition.target
        self._time(transition, date)
        if is_parted(self.c):
            self._forward(request.to if isinstance(request, SND) else agent)
            if transition.label.rule == "spawn":
                self._forward(str(request))

    def _time(self, transition: Transition, date: float) -> None:
        """Advance the mission's clocks over a step; a step that is too soon breaks an assumption."""
        if self.timers is None:
            return
        before, self.timers = self.timers, stepped(self.timers, transition, date)
        for about, message in too_soon(before, transition, self.timers, date):
            self._untimely(about, message)

    def check_times(self) -> None:
        """Report exceeded time bounds, and schedule the next check."""
        if self.timers is None:
            return
        for about, message in too_late(self.timers, self.now):
            self._untimely(about, message)
        self.wake(next_end(self.timers, self.now))

    def _untimely(self, about: Name, message: str) -> None:
        """Report a broken time assumption, except of vehicles that were taken over: they need not keep it."""
        if about not in self.taken:
            self.breaks(message, about)

    def _forward(self, a: Name | None) -> None:
        """Send the local parts of an agent that runs at another station."""
        if a is None or a not in self.c.alpha:
            return
        if station_of(self.c, a) is None:
            host = self.c.alpha.host(a)
            message = f"no station runs what is hosted at {host}, and so {a} does not go on"
            self.find(
                "blocked", a, f"{message}: add {host} to the hosts of a station in the peers file", once=True
            )
        for left in leave(self.c, a):
            station, parcel = str(left.label.about), parcel_of(self.c, a)
            assert parcel is not None
            number: int = left.target.read(sent_cell(station))
            self.parcels.append(Outgoing(station, number, parcel))
            self.take(left, (left,), Passage(a, station, number))

    def observe(self, sight: Sight, found: Iterator[Transition]) -> bool:
        """Take the step that an observation causes, if any; return whether there was one."""
        alike = tuple(found)
        if alike:
            self.take(alike[0], alike, sight)
        return bool(alike)

    # --- agents and requests

    def go_on(self, most: int) -> None:
        """Let every agent take a step in turn and serve one request, until nothing more can be done now."""
        for a, due in self.due.items():
            if due > self.now:
                self.wake(due)
            else:
                self.idle.discard(a)
        left = most
        while left > 0:
            taken = self._own_steps(left)
            taken += self.serve()
            if not taken:
                return
            left -= taken
        self.wake(self.now)

    def _own_steps(self, most: int) -> int:
        """Let agents take one step each, beginning after the last one that took a step."""
        able = (a for a in self.c.alpha.names() if a not in self.idle and a not in self.failed)
        going = [a for a in able if is_here(self.c, a)]
        first = bisect_right(going, self.last)
        taken = 0
        for a in going[first:] + going[:first]:
            if taken >= most:
                break
            taken += self.own_step(a)
            self.last = a
        return taken

    def own_step(self, a: Name) -> bool:
        """Let an agent take one step of its own, if its pace allows one."""
        pace = refilled(self.paces.get(a), self.now)
        if pace.tokens < 1:
            self.wake(self.now + max(PATIENCE, (1 - pace.tokens) / STEPS_PER_SECOND))
            return False
        try:
            found = own_steps(self.c, a) or self._timeout(a)
        except Fault as fault:
            self.failed.add(a)
            self.find("failed", a, f"the computation of {a} fails: {fault}")
            return False
        if not found:
            self.idle.add(a)
            return False
        self.paces[a] = Pace(pace.tokens - 1, self.now)
        self.take(found[(self.before.number + len(self.steps)) % len(found)], found)
        return True

    def _timeout(self, a: Name) -> tuple[Transition, ...]:
        """Return the timeout of an agent that has waited long enough; schedule it for one that still waits."""
        found = tuple(timeout(self.c, a))
        if not found:
            self.due.pop(a, None)
            return ()
        react = next_statement(self.c, a)
        assert isinstance(react, React)
        assert react.after is not None
        due = self.due.setdefault(a, self.now + react.after.seconds)
        if self.now < due:
            self.wake(due)
            return ()
        return found

    def serve(self) -> bool:
        """Serve the first request that can be served, oldest first."""
        if self.quiet is self.c:
            return False
        for pending in to_serve(self.c):
            found, held = self.allowed(pending)
            if found:
                self.take(found[0], found)
                return True
            if held and self.plan.strict:
                return False
        self.quiet = self.c
        return False

    def allowed(self, pending: Pending) -> tuple[tuple[Transition, ...], bool]:
        """Return the transitions that serve a request now, and whether it only waits for a vehicle's confirmation."""
        request = pending.request
        found = served(self.c, pending)
        if not isinstance(request, CTR):
            return found, False
        if self.stops(request.agent):
            return (), False
        if not found:
            self._blocked(request)
            return (), False
        way = next(way for way in realisations(self.c, request) if not (way.flying and way.waits(self.c)))
        return self._controlled(request, way, found)

    def _blocked(self, request: CTR) -> None:
        reason = obstacle(self.c, request)
        if reason is not None:
            self.find("blocked", request.agent, f"{request} is {reason.value}; it stays pending", once=True)

    def _controlled(
        self, request: CTR, way: Realisation, found: tuple[Transition, ...]
    ) -> tuple[tuple[Transition, ...], bool]:
        """Give the orders of a control, and return its transition once it may be taken."""
        vehicles = frozenset(self.plan.vehicles)
        unseen = unshown(self.c, request, way, vehicles)
        if unseen:
            self.find("blocked", request.agent, f"{request}: {unseen}; it stays pending", once=True)
            return (), True
        for node, _ in way.flying:
            if not self._hears(node):
                return (), False
        if way.flying:
            for node, place in way.flying:
                going = journey(self.c, way, node, place, self.request_of(request.agent), self.plan.first)
                if going is None:
                    return (), False
                self.orders[node] = Order(going, request.agent, self.now)
                self.commands.append(going)
            return found, False
        waiting = [told for told in hand_overs(self.c, request, way, vehicles) if not self._confirmed(told)]
        for told in waiting:
            self._hand_over(told, request.agent)
        if waiting:
            return (), True
        for told in hand_overs(self.c, request, way, vehicles):
            self.handing.pop(told.entity, None)
        return found, False

    def _hears(self, node: Name) -> bool:
        owner = self.plan.vehicles.get(node)
        if owner is None or owner == self.plan.peers:
            here = "" if owner is None else " at this station"
            message = f"no vehicle takes commands as {node}{here}: say --vehicle {node}=..."
            self.find("blocked", node, message, once=True)
            return False
        return node in self.seen and node not in self.lost and node not in self.taken

    def _confirmed(self, told: HandOver) -> bool:
        sighting = self.seen.get(told.entity)
        return sighting is not None and is_done(told, sighting.property.channels)

    def _hand_over(self, told: HandOver, agent: Name) -> None:
        known = self.handing.get(told.entity)
        if known is None and self._hears(told.entity):
            command = replace(told, request=self.request_of(agent))
            self.handing[told.entity] = Order(command, agent, self.now)
            self.commands.append(command)

    def request_of(self, agent: Name) -> str:
        """Return an identifier for a new order of an agent."""
        self.told += 1
        return f"{agent}-{self.told}"

    # --- flights

    def stops(self, agent: Name) -> bool:
        """Return whether an agent's controls are no longer served."""
        return self.suspended or agent in self.grounded

    def flies(self, entity: Name) -> bool:
        """Return whether the order of a vehicle in flight is still valid."""
        order = self.orders.get(entity)
        if order is None or self.stops(order.agent):
            return False
        return not order.refused and entity not in self.taken

    def shape(self, entity: Name) -> Placed | None:
        """Return the mission's shape of an entity."""
        placement = self.plan.first.structure.physical.placement(entity)
        if isinstance(placement, Carried):
            return placement.shape
        return placement if isinstance(placement, Placed) else None

    def around(self, entity: Name, kind: str, placement: Placement | None) -> frozenset[Name]:
        """Return the containers and carriers of an entity at a placement, in the current world."""
        if self.fences.c is not self.c:
            self.fences = Fences(self.c)
        return self.fences.holders(entity, kind, placement)

    def where_seen(self, entity: Name) -> Placement | None:
        """Return the last seen placement of an entity."""
        sighting = self.seen.get(entity)
        return None if sighting is None else placement_seen(self.c, self.shape(entity), sighting)

    # --- falling back

    def fall_back(self, fallback: Fallback, entities: tuple[Name, ...]) -> None:
        """Command the mission's fallback to vehicles; a vehicle on its way home does not stop."""
        if fallback is Fallback.CONTINUE:
            return
        for entity in filter(self.answers_for, entities):
            if fallback is Fallback.HOLD and self.flies_home(entity):
                what = f"{entity} is not told to hold: it was told to return before"
                self.find("trouble", entity, what, once=True)
                continue
            if entity in self.taken:
                bidden = self.bidden.get(entity)
                why = (
                    "it was taken over" if bidden is None else f"{bidden.orderer} ordered it to {bidden.what}"
                )
                what = f"{entity} is not told to {fallback.value}: {why}"
                self.find("taken over", entity, what, once=True)
                continue
            command = stopping(fallback, self.request_of("fallback"), entity)
            self.owed[entity] = Bidden(command, by=None)
            self.commands.append(command)
            if self.handing.pop(entity, None) is not None:  # ends the hand-over; its agent may order it again
                self.quiet = None

    def due_fallback(self, entity: Name) -> Fallback:
        """Return the mission's standing fallback for a vehicle; `CONTINUE` if the mission commands its flight."""
        due = {self.plan.precautions.on_broken} if self.suspended else set()
        agents = [agent for agent in self.grounded if entity in self.vehicles_of(agent)]
        if agents:
            limits = self.plan.precautions.limits
            due |= {limit.fallback for limit in limits if limit.agent in (None, *agents)}
        return next((each for each in (Fallback.RETURN, Fallback.HOLD) if each in due), Fallback.CONTINUE)

    def flies_home(self, entity: Name) -> bool:
        """Return whether the mission's fallback sends a vehicle home."""
        return entity in self.plan.vehicles and self.due_fallback(entity) is Fallback.RETURN

    def vehicles_of(self, agent: Name) -> tuple[Name, ...]:
        """Return the vehicles of an agent's request: those that it has sent, else its host."""
        sent = {entity for entity, order in self.orders.items() if order.agent == agent}
        sent |= {entity for entity, order in self.handing.items() if order.agent == agent}
        host = {self.c.alpha.host(agent)} if agent in self.c.alpha else set()
        return tuple(sorted(sent or host & self.plan.vehicles.keys()))

    def answers_for(self, entity: Name) -> bool:
        """Return whether this station alone commands a vehicle and reports on it."""
        if not is_parted(self.c) or entity not in self.plan.vehicles:
            return True
        if self.plan.vehicles[entity] == self.plan.peers:
            return False
        physical = self.before.configuration.structure.physical
        authority = set(filter(is_authority, physical.channels(entity)))
        return not authority or not authority.isdisjoint(physical.channels(self.c.read(HERE)))

    def breaks(self, assumption: str, about: Name, kind: str = "broken assumption") -> None:
        """Report a broken assumption, or another end of a flight, and respond with the mission's fallback."""
        if not self.answers_for(about):
            return
        fallback = self.plan.precautions.on_broken
        found = self.find(kind, about, assumption, fallback.value, once=True)
        if found and not self.suspended:
            self.fall_back(fallback, tuple(sorted(self.plan.vehicles)))
            self.suspended = fallback is not Fallback.CONTINUE
