"""The working copy of a turn: the parts of the state so far, and the results."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from adapters.live.fresh_placements import Fences, placement_seen
from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.live.plan import Plan
from adapters.live.turn_result import Answer, LiveStep, Outgoing, Turn
from adapters.plugin import Command
from semantics.state.physical_model import Carried, Placed, Placement
from semantics.state.signature import Name


@dataclass(slots=True)
class Results:
    """The results of a turn so far."""

    steps: list[LiveStep] = field(default_factory=list)
    commands: list[Command] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    answers: list[Answer] = field(default_factory=list)
    parcels: list[Outgoing] = field(default_factory=list)
    again: float = math.inf


class Turning:
    """A turn in progress, the only mutable value of a turn.

    One step changes the configuration, several parts of the state, and the results; a finding may suspend the mission
    at any depth. Functions that return all of these would hide their own result. A part is replaced as a whole, by the
    methods of its module; an unchanged part stays the same object.

    Attributes:
        plan: The constants of the run.
        now: The time.
        before: The state before the turn.
        c: The configuration.
        done: Time of another station's original action, while its report is taken in.
        results: The results so far.
    """

    def __init__(self, plan: Plan, state: LiveState, now: float) -> None:
        self.plan = plan
        self.now = now
        self.before = state
        self.c = state.configuration
        self.sightings = state.sightings
        self.commanded = state.commanded
        self.overrides = state.overrides
        self.agents = state.agents
        self.due = state.due
        self.reported = state.reported
        self.watched = state.watched
        self.done: float | None = None
        self.results = Results()
        self._fences = Fences(self.c)

    @property
    def number(self) -> int:
        """The number of steps taken."""
        return self.before.number + len(self.results.steps)

    def turn(self) -> Turn:
        """Return the result of the turn."""
        found = self.results
        state = LiveState(
            self.c,
            self.number,
            self.sightings,
            self.commanded,
            self.overrides,
            self.agents,
            self.due,
            self.reported.counted(len(found.findings)),
            self.watched,
        )
        return Turn(
            state,
            tuple(found.steps),
            tuple(found.commands),
            tuple(found.findings),
            tuple(found.answers),
            tuple(found.parcels),
            None if found.again == math.inf else found.again,
        )

    # --- results

    def find(self, kind: str, about: Name, message: str, fallback: str = "", *, once: bool = False) -> bool:
        """Report a finding, with `once` not twice, and at most so many troubles; return whether it was reported."""
        if once:
            if not self.reported.admits(kind, message):
                return False
            self.reported = self.reported.remembering(message)
        self.results.findings.append(Finding(kind, about, message, self.now, fallback))
        return True

    def wake(self, at: float) -> None:
        """Schedule a turn at a time, even without input."""
        self.results.again = min(self.results.again, at)

    def command(self, command: Command) -> None:
        """Send a command to a vehicle after the turn."""
        self.results.commands.append(command)

    def answer(self, answer: Answer) -> None:
        """Answer an operator's message."""
        self.results.answers.append(answer)

    def request_of(self, agent: Name) -> str:
        """Return an identifier for a new command of an agent."""
        self.commanded = self.commanded.counted()
        return f"{agent}-{self.commanded.count}"

    # --- the world

    def shape(self, entity: Name) -> Placed | None:
        """Return the mission's shape of an entity."""
        placement = self.plan.first.structure.physical.placement(entity)
        if isinstance(placement, Carried):
            return placement.shape
        return placement if isinstance(placement, Placed) else None

    def around(self, entity: Name, kind: str, placement: Placement | None) -> frozenset[Name]:
        """Return the containers and carriers of an entity at a placement, in the current world."""
        if self._fences.c is not self.c:
            self._fences = Fences(self.c)
        return self._fences.holders(entity, kind, placement)

    def where_seen(self, entity: Name) -> Placement | None:
        """Return the last seen placement of an entity."""
        sighting = self.sightings.newest.get(entity)
        return None if sighting is None else placement_seen(self.c, self.shape(entity), sighting)
