"""The result of a turn: steps, commands, findings, answers and parcels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from adapters.live.batch import Said
from adapters.live.live_state import LiveState
from adapters.live.operator_findings import Finding
from adapters.plugin import Command
from semantics.observed_steps import Sight
from semantics.state.configuration import Configuration, Transition
from semantics.state.parcels import Parcel
from semantics.state.signature import Name
from semantics.state.station_partition import Elsewhere


@dataclass(frozen=True, slots=True)
class LiveStep:
    """One committed transition.

    Attributes:
        number: From 1.
        source: The configuration before it.
        transition: The transition.
        choice: The index of the transition among those with its label.
        sight: The world's part: an observation, or a passage between stations.
        time: Its time here.
        date: Time of another station's original action, by the clock here; else `time`.
    """

    number: int
    source: Configuration
    transition: Transition
    choice: int
    sight: Sight | Elsewhere | None
    time: float
    date: float


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to a message.

    Attributes:
        saying: The message.
        refusal: Empty if it was accepted, else the reason for refusing it.
        requests: For an order, the request of each ordered vehicle.
        left_out: For an order to all, the vehicles that were left out, with the reasons.
        notes: Other remarks to the operator, on an order or on a vehicle that is given back.
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
        again: Time of the next turn without input; None if nothing waits for time to pass.
    """

    state: LiveState
    steps: tuple[LiveStep, ...] = ()
    commands: tuple[Command, ...] = ()
    findings: tuple[Finding, ...] = ()
    answers: tuple[Answer, ...] = ()
    parcels: tuple[Outgoing, ...] = ()
    again: float | None = None
