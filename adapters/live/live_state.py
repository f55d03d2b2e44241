"""The state of a live run, in parts: each part is a frozen value, changed by the methods of its own module."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from adapters.live.commanded import Commanded
from adapters.live.due_times import DueTimes
from adapters.live.fresh_placements import Sightings
from adapters.live.operator_findings import Reported
from adapters.live.overrides import Overrides
from adapters.live.scheduling import AgentProgress
from adapters.live.watched import Watched
from semantics.state.configuration import Configuration


@dataclass(frozen=True, slots=True)
class LiveState:
    """The state of a live run.

    Attributes:
        configuration: ⟨α | S | η⟩.
        number: The number of steps taken.
        sightings: Who is seen.
        commanded: The mission's commands to vehicles.
        overrides: Who is taken over, ordered to stop, or no longer served.
        agents: How far agents have come.
        due: What is due.
        reported: What was reported to the operator.
        watched: What the run watches of ways.
    """

    configuration: Configuration
    number: int = 0
    sightings: Sightings = field(default_factory=Sightings)
    commanded: Commanded = field(default_factory=Commanded)
    overrides: Overrides = field(default_factory=Overrides)
    agents: AgentProgress = field(default_factory=AgentProgress)
    due: DueTimes = field(default_factory=DueTimes)
    reported: Reported = field(default_factory=Reported)
    watched: Watched = field(default_factory=Watched)

    def later(self, seconds: float) -> LiveState:
        """Return the state with all ages and waiting times shifted by a time without listening."""
        return replace(self, sightings=self.sightings.later(seconds), due=self.due.later(seconds))
