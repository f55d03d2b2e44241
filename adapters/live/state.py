"""The state of a live run and the changes to it: frozen values, no clock, no input or output."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from adapters.plugin import Command, Follow, GoTo, HandOver, Published, Report
from physical import PhysicalProperty
from semantics.contingencies import Precautions
from semantics.observed import Sight
from semantics.state.cells import Cell
from semantics.state.configuration import Configuration, Transition
from semantics.state.partition import Elsewhere, Parcel
from semantics.state.requests import Request
from semantics.state.signature import Name


@dataclass(frozen=True, eq=False)
class Plan:
    """What stays the same in a live run.

    Attributes:
        first: The mission's first configuration, under `control timed` and `fcfs`.
        vehicles: For each entity that takes commands, the plugin that owns it.
        precautions: What the mission says of broken assumptions and time limits.
        strict: Whether turns are kept while a vehicle confirms a hand-over: the verdict is one under `fcfs` only.
        peers: The plugin by which other stations speak, of vehicles too; empty where there are none.
    """

    first: Configuration
    vehicles: Mapping[Name, str] = field(default_factory=dict)
    precautions: Precautions = field(default_factory=Precautions)
    strict: bool = False
    peers: str = ""


@dataclass(frozen=True, slots=True)
class Sighting:
    """The newest that is known of an entity, and until when it may stand in P."""

    property: PhysicalProperty
    time: float
    until: float


@dataclass(frozen=True, slots=True)
class Order:
    """What a vehicle was told, and not confirmed as yet.

    Attributes:
        command: What it was told last.
        agent: Whose request it serves.
        since: When it was first told.
        obeyed: Whether the vehicle has shown that it does it, and nothing since that it does not.
        through: Whether the vehicle has said that the path that it was told is behind it.
        refused: Whether it turned out not to be possible.
    """

    command: GoTo | Follow | HandOver
    agent: Name
    since: float
    obeyed: bool = False
    through: bool = False
    refused: bool = False


@dataclass(frozen=True, slots=True)
class Waiting:
    """The request at the head of an agent's line: since when it is there, and which limits it has passed."""

    request: Request
    since: float
    late: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Pace:
    """How many steps of its own an agent may take at once, as of a time."""

    tokens: float
    at: float


@dataclass(frozen=True, slots=True)
class LiveState:
    """Where a live run is.

    Attributes:
        configuration: ⟨α | S | η⟩.
        seen: The newest of each entity that the mission names or has admitted.
        expires: No sighting is too old before.
        orders: Where each vehicle in flight was told to go.
        handing: Which hand-over each vehicle was told, and has not confirmed.
        lost: Vehicles whose link is lost.
        taken: Vehicles that were taken over, and how: nobody here commands them until an operator gives them back.
        idle: Agents that cannot go on by themselves: they wait for an observation, a message, or for ever.
        quiet: The configuration in which nothing more could be served, None if that is not known.
        heads: What stands at the head of each agent's line.
        paces: How fast each agent may go on.
        suspended: Whether controls are served no more: an assumption broke.
        grounded: Agents of which no control is served any more: a request of theirs took too long.
        missing: What P had in cells where its going broke an assumption: that it comes back breaks no other.
        failed: Agents whose computation failed.
        reported: What was reported already, and is not again.
        last: The agent that went on last: the next turn begins with the one after it.
        number: How many steps were taken.
        told: How many orders were given.
        shares: How many entities that nobody announced were taken in of each plugin, and how many of them are places.
    """

    configuration: Configuration
    seen: Mapping[Name, Sighting] = field(default_factory=dict)
    expires: float = math.inf
    orders: Mapping[Name, Order] = field(default_factory=dict)
    handing: Mapping[Name, Order] = field(default_factory=dict)
    lost: frozenset[Name] = frozenset()
    taken: Mapping[Name, str] = field(default_factory=dict)
    idle: frozenset[Name] = frozenset()
    quiet: Configuration | None = None
    heads: Mapping[Name, Waiting] = field(default_factory=dict)
    paces: Mapping[Name, Pace] = field(default_factory=dict)
    suspended: bool = False
    grounded: frozenset[Name] = frozenset()
    missing: Mapping[Cell, object] = field(default_factory=dict)
    failed: frozenset[Name] = frozenset()
    reported: frozenset[str] = frozenset()
    last: Name = ""
    number: int = 0
    told: int = 0
    shares: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    def with_(self, **changes: object) -> LiveState:
        """Return the state with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself

    def later(self, seconds: float) -> LiveState:
        """Return the state in which all that grows old, or waits, has as much longer: nobody has listened meanwhile."""
        seen = {name: replace(each, until=each.until + seconds) for name, each in self.seen.items()}
        heads = {name: replace(each, since=each.since + seconds) for name, each in self.heads.items()}
        return self.with_(seen=seen, expires=self.expires + seconds, heads=heads)


# --- what comes in ------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Heard:
    """Something that a plugin published."""

    plugin: str
    published: Published


@dataclass(frozen=True, slots=True)
class Saying:
    """A message from someone outside to an agent; `number` names it in the answer."""

    agent: Name
    message: str
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return self.agent, self.message


@dataclass(frozen=True, slots=True)
class GivingBack:
    """An operator's word that a vehicle that was taken over may be commanded again."""

    vehicle: Name
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return (self.vehicle,)


Said = Saying | GivingBack
"""What is said to a run from outside."""


@dataclass(frozen=True, slots=True)
class Batch:
    """All that came in since the last turn, in its order; `missed` are the seconds for which nobody listened."""

    heard: tuple[Heard, ...] = ()
    reports: tuple[Report, ...] = ()
    sayings: tuple[Said, ...] = ()
    missed: float = 0.0


# --- what comes out -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class LiveStep:
    """One committed transition.

    Attributes:
        number: From 1.
        source: The configuration before it.
        transition: The transition.
        choice: Which of the transitions of that label it is, from 0.
        sight: What was observed, where the world decided; what passes between stations.
        time: When.
    """

    number: int
    source: Configuration
    transition: Transition
    choice: int
    sight: Sight | Elsewhere | None
    time: float


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that the operator has to know.

    Attributes:
        kind: `broken assumption`, `refused`, `taken over`, `given back`, `lost link`, `link restored`, `late`,
            `blocked`, `failed` (a computation, the recording, a plugin), `trouble`.
        about: The entity or agent.
        message: One line.
        time: When.
        fallback: What is done about it: `hold`, `return`, or nothing.
        elsewhere: Whether it was another station that found it.
    """

    kind: str
    about: str
    message: str
    time: float
    fallback: str = ""
    elsewhere: bool = False


@dataclass(frozen=True, slots=True)
class Answer:
    """What came of what was said: an empty text if it was taken, else why it was not."""

    saying: Said
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class Outgoing:
    """The `number`-th parcel for another station."""

    station: str
    number: int
    parcel: Parcel


@dataclass(frozen=True, slots=True)
class Turn:
    """What one turn of the loop came to.

    Attributes:
        state: The state after it.
        steps: The transitions, in their order.
        commands: What vehicles are to be told now.
        findings: What the operator has to know.
        answers: What came of what was said.
        parcels: What leaves for other stations.
        again: When to turn again though nothing comes in; None if nothing waits for time to pass.
    """

    state: LiveState
    steps: tuple[LiveStep, ...] = ()
    commands: tuple[Command, ...] = ()
    findings: tuple[Finding, ...] = ()
    answers: tuple[Answer, ...] = ()
    parcels: tuple[Outgoing, ...] = ()
    again: float | None = None
