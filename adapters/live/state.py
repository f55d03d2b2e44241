"""The state of a live run and the changes to it: frozen values, no clock, no input or output."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from adapters.live.timing import Timers
from adapters.plugin import Command, Follow, GoTo, HandOver, Hold, Published, Report, Return
from physical import Geometry, PhysicalProperty
from semantics.contingencies import Fallback, Precautions
from semantics.observed_steps import Sight
from semantics.state.cells import Cell
from semantics.state.configuration import Configuration, Transition
from semantics.state.parcels import Parcel
from semantics.state.partition import Elsewhere
from semantics.state.requests import Request
from semantics.state.signature import Name


@dataclass(frozen=True, eq=False)
class Plan:
    """The constants of a live run.

    Attributes:
        first: The mission's first configuration, under `control timed` and `fcfs`.
        vehicles: For each entity that takes commands, the plugin that owns it.
        precautions: The mission's responses to broken assumptions and exceeded time limits.
        strict: Whether other requests wait while a vehicle confirms a hand-over, since the verdict is for `fcfs` only.
        peers: The plugin of the other stations, which also speaks for vehicles; empty if there are none.
    """

    first: Configuration
    vehicles: Mapping[Name, str] = field(default_factory=dict)
    precautions: Precautions = field(default_factory=Precautions)
    strict: bool = False
    peers: str = ""


@dataclass(frozen=True, slots=True)
class Sighting:
    """The newest observation of an entity, and until when it may stay in P."""

    property: PhysicalProperty
    time: float
    until: float


@dataclass(frozen=True, slots=True)
class Order:
    """A command to a vehicle that is not confirmed yet.

    Attributes:
        command: The last command.
        agent: The agent whose request it serves.
        since: When it was first sent.
        obeyed: Whether the vehicle has shown that it follows the command, and has shown nothing else since.
        through: Whether the vehicle has reported the end of its path.
        refused: Whether it was refused.
        waypoint: Around which point the vehicle will stay, as far as it has told.
    """

    command: GoTo | Follow | HandOver
    agent: Name
    since: float
    obeyed: bool = False
    through: bool = False
    refused: bool = False
    waypoint: Geometry | None = None

    @property
    def goal(self) -> Geometry | None:
        """The last place of the command, as it was when it was told."""
        match self.command:
            case GoTo(place=place):
                return place
            case Follow(path=path):
                return path[-1]
        return None


class Fate(StrEnum):
    """What has become of an order to hold or to return."""

    ASKED = "asked"
    SENT = "sent"
    CONFIRMED = "confirmed"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class Bidden:
    """An order to hold or to return, which a vehicle owes until it has shown that it does it.

    It stands until the vehicle is given back or taken over.

    Attributes:
        command: What it was told.
        by: The operator who said so, empty if unknown; None for the mission, which falls back.
        fate: What has become of it.
        refusal: Why it was refused last; empty if it was not.
        again: When it is told again what it has refused.
    """

    command: Hold | Return
    by: str | None = ""
    fate: Fate = Fate.ASKED
    refusal: str = ""
    again: float = math.inf

    @property
    def owed(self) -> bool:
        """Whether the vehicle has not shown yet that it does it."""
        return self.fate is not Fate.CONFIRMED

    @property
    def told(self) -> Fate:
        """Its fate, as people are told: what was refused stays refused while the vehicle is told again."""
        return Fate.REFUSED if self.owed and self.refusal else self.fate

    @property
    def orderer(self) -> str:
        """Who ordered it, for people."""
        return "the mission" if self.by is None else operator(self.by)

    @property
    def what(self) -> str:
        """What was ordered."""
        return "hold" if isinstance(self.command, Hold) else "return"

    @property
    def reason(self) -> str:
        """What stands between the vehicle and the mission's commands, as far as it is known to be so."""
        if not self.owed:
            return f"{'held' if self.what == 'hold' else 'sent home'} by {self.orderer}"
        if self.refusal:  # also while it is told again
            return f"refuses to {self.what}, as {self.orderer} ordered: {self.refusal}"
        return f"told to {self.what} by {self.orderer}, not confirmed yet"


def operator(by: str) -> str:
    """Name an operator for people.

    >>> operator("Ana"), operator("")
    ('the operator (Ana)', 'the operator')
    """
    return f"the operator ({by})" if by else "the operator"


@dataclass(frozen=True, slots=True)
class Waiting:
    """The request at the head of an agent's line: since when, and which limits it has exceeded."""

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
    """The state of a live run.

    Attributes:
        configuration: ⟨α | S | η⟩.
        seen: The newest sighting of each entity that the mission names or has admitted.
        expires: When the first sighting becomes too old.
        orders: The order of each vehicle in flight.
        handing: The unconfirmed hand-over of each vehicle.
        lost: Vehicles whose link is lost.
        taken: Vehicles that were taken over, also by an operator's order, and how: they get no commands until an
            operator gives them back.
        bidden: The operator's order that stands for each vehicle; all of them are taken.
        owed: The fall-back that the mission has ordered of each vehicle.
        idle: Agents without own steps: they wait for an observation, a message, or for ever.
        due: When each agent at a `react` with an `after` branch stops waiting.
        quiet: The configuration in which nothing more could be served, None if that is not known.
        heads: The head of each agent's line.
        paces: The pace of each agent.
        suspended: Whether no more controls are served, since an assumption broke.
        grounded: Agents whose controls are no longer served, since a request of theirs took too long.
        missing: Cells of P whose removal broke an assumption, with their values: their return breaks no other.
        failed: Agents whose computation failed.
        reported: What was reported already, and is not reported again.
        last: The agent that took the last step: the next turn begins with the one after it.
        number: How many steps were taken.
        told: How many orders were given.
        findings: How many findings were reported: the number of the last one.
        shares: How many strangers were admitted from each plugin, and how many of them are places.
        timers: Since when everything runs that the mission times; None before the start, and where it times nothing.
        stopped: Since when a run stands still that goes on after it was killed; None where it does not.
    """

    configuration: Configuration
    seen: Mapping[Name, Sighting] = field(default_factory=dict)
    expires: float = math.inf
    orders: Mapping[Name, Order] = field(default_factory=dict)
    handing: Mapping[Name, Order] = field(default_factory=dict)
    lost: frozenset[Name] = frozenset()
    taken: Mapping[Name, str] = field(default_factory=dict)
    bidden: Mapping[Name, Bidden] = field(default_factory=dict)
    owed: Mapping[Name, Bidden] = field(default_factory=dict)
    idle: frozenset[Name] = frozenset()
    due: Mapping[Name, float] = field(default_factory=dict)
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
    findings: int = 0
    shares: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    timers: Timers | None = None
    stopped: float | None = None

    def with_(self, **changes: object) -> LiveState:
        """Return the state with some of its attributes changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # names are checked by replace itself

    @property
    def owing(self) -> Mapping[Name, Bidden]:
        """The orders to hold or to return that vehicles have not confirmed."""
        return {name: each for name, each in (*self.owed.items(), *self.bidden.items()) if each.owed}

    @property
    def fates(self) -> Mapping[Name, tuple[str, str]]:
        """What has become of each operator's order, and in words."""
        return {name: (each.told.value, each.reason) for name, each in self.bidden.items()}

    def later(self, seconds: float) -> LiveState:
        """Return the state with all ages and waiting times shifted by a time without listening."""
        seen = {name: replace(each, until=each.until + seconds) for name, each in self.seen.items()}
        heads = {name: replace(each, since=each.since + seconds) for name, each in self.heads.items()}
        due = {agent: at + seconds for agent, at in self.due.items()}
        timers = None if self.timers is None else self.timers.later(seconds)
        return self.with_(seen=seen, expires=self.expires + seconds, heads=heads, due=due, timers=timers)


# --- what comes in ------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Heard:
    """Something that a plugin published."""

    plugin: str
    published: Published


@dataclass(frozen=True, slots=True)
class Saying:
    """A message from outside to an agent, and who says it; `number` identifies it in the answer."""

    agent: Name
    message: str
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return self.agent, self.message, self.by


@dataclass(frozen=True, slots=True)
class GivingBack:
    """An operator's word of a vehicle: that it may be commanded again, or where it is believed from now on.

    Attributes:
        vehicle: Which.
        at: HOST:PORT where it is heard now; empty where it may be commanded again.
        by: Who says so.
        number: Names the word in the answer.
    """

    vehicle: Name
    at: str = ""
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return self.vehicle, self.at, self.by


@dataclass(frozen=True, slots=True)
class Ordering:
    """An operator's order: to hold, or to return.

    Attributes:
        fallback: Which of the two.
        vehicle: Which vehicle; None for all that this station commands.
        by: Who says so.
        number: Names the order in the answer.
    """

    fallback: Fallback
    vehicle: Name | None = None
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return self.vehicle or "", self.by


@dataclass(frozen=True, slots=True)
class Acknowledging:
    """An operator has seen a finding: the number that it has in the recording, from 1, and who."""

    finding: int
    by: str = ""
    number: int = 0

    @property
    def texts(self) -> tuple[str, ...]:
        """What in it came from outside."""
        return (self.by,)


Said = Saying | GivingBack | Ordering | Acknowledging
"""What is said to a run from outside."""


@dataclass(frozen=True, slots=True)
class Batch:
    """All input since the last turn, in order; `missed` are the seconds without listening."""

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
        choice: The index of the transition among those with its label.
        sight: What the world decided: an observation, or what passes between stations.
        time: When.
        date: When another station did what it is, by the clock here; else the same.
    """

    number: int
    source: Configuration
    transition: Transition
    choice: int
    sight: Sight | Elsewhere | None
    time: float
    date: float


@dataclass(frozen=True, slots=True)
class Finding:
    """A message to the operator.

    Attributes:
        kind: `broken assumption`, `refused`, `taken over`, `given back`, `ordered`, `confirmed` (an order),
            `lost link`, `link restored`, `late`, `blocked`, `failed` (a computation, the recording, a plugin),
            `trouble`.
        about: The entity or agent.
        message: One line.
        time: When.
        fallback: The response: `hold`, `return`, or nothing.
        elsewhere: Whether another station found it.
    """

    kind: str
    about: str
    message: str
    time: float
    fallback: str = ""
    elsewhere: bool = False


def is_breach(finding: Finding) -> bool:
    """Tell whether it is a breach of what the mission assumes, or what it falls back for."""
    return finding.kind == "broken assumption" or bool(finding.fallback)


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to a message.

    Attributes:
        saying: The message.
        refusal: Empty if it was accepted, else the reason for refusing it.
        requests: Of an order, the request of each vehicle that was told.
        left_out: Of an order to all, why the others were not told.
        notes: What else the operator should know, of an order or of a vehicle that is given back.
    """

    saying: Said
    refusal: str = ""
    requests: Mapping[Name, str] = field(default_factory=dict)
    left_out: Mapping[Name, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Outgoing:
    """The `number`-th parcel for another station."""

    station: str
    number: int
    parcel: Parcel


@dataclass(frozen=True, slots=True)
class Turn:
    """The result of one turn of the loop.

    Attributes:
        state: The state after it.
        steps: The transitions, in their order.
        commands: Commands to be sent now.
        findings: Messages to the operator.
        answers: Answers to messages from outside.
        parcels: Parcels to other stations.
        again: When to turn again without input; None if nothing waits for time to pass.
    """

    state: LiveState
    steps: tuple[LiveStep, ...] = ()
    commands: tuple[Command, ...] = ()
    findings: tuple[Finding, ...] = ()
    answers: tuple[Answer, ...] = ()
    parcels: tuple[Outgoing, ...] = ()
    again: float | None = None
