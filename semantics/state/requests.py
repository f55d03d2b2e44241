"""Pending requests: the members of η."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from semantics.behaviours.values import Value, order_key, show
from semantics.state.signature import Name

if TYPE_CHECKING:
    from semantics.behaviours.observations import Observation, Query
    from semantics.behaviours.reaction_rules import Match, Reaction


@dataclass(frozen=True, slots=True)
class OBS:
    """`OBS(a, q)`: a asked to observe q, with HOST resolved at the request."""

    agent: Name
    query: "Query"

    def __str__(self) -> str:
        return f"OBS({self.agent}, {self.query})"


@dataclass(frozen=True, slots=True)
class READY:
    """`READY(a, q, L_q)`: the observation that a asked for is ready to be received."""

    agent: Name
    query: "Query"
    observation: "Observation"

    def __str__(self) -> str:
        return f"READY({self.agent}, {self.query}, {self.observation})"


@dataclass(frozen=True, slots=True)
class CTR:
    """`CTR(a, R ⇒ R')`: a asked for a reaction to be made true."""

    agent: Name
    reaction: "Reaction"

    def __str__(self) -> str:
        return f"CTR({self.agent}, {self.reaction})"


@dataclass(frozen=True, slots=True)
class FLY:
    """`FLY(a, m, R')`: the reaction was commanded with match m, and is not true yet (`control timed`)."""

    agent: Name
    reaction: "Reaction"
    match: "Match"

    def __str__(self) -> str:
        return f"FLY({self.agent}, {self.reaction})"


@dataclass(frozen=True, slots=True)
class SND:
    """`SND(a, b, m)`: a message in transit."""

    agent: Name
    to: Name
    message: Value

    def __str__(self) -> str:
        return f"SND({self.agent}, {self.to}, {show(self.message)})"


@dataclass(frozen=True, slots=True)
class MGR:
    """`MGR(a, h)`: a asked to be hosted at h."""

    agent: Name
    host: Name

    def __str__(self) -> str:
        return f"MGR({self.agent}, {self.host})"


@dataclass(frozen=True, slots=True)
class Received:
    """The subject of a `rcv_obs` label: an observation, printed only on demand."""

    observation: "Observation"

    def __str__(self) -> str:
        return f"react({self.observation})"


Request = OBS | READY | CTR | FLY | SND | MGR
REQUESTS: tuple[type, ...] = (OBS, READY, CTR, FLY, SND, MGR)


def request_key(request: Request) -> tuple[str, str]:
    """Return a canonical sort key, the same in every process: a message may hold sets, whose `repr` has no order."""
    if isinstance(request, SND):
        return ("SND", repr((request.agent, request.to, order_key(request.message))))
    return (type(request).__name__, repr(request))
