"""Parcels: the parts of a bigActor that pass from one station to another, in terms of the mission's text.

A parcel holds no reaction. A requested control travels as its command or rule with host and arguments. The receiver
rebuilds the reaction from the text of its own mission.
"""

from dataclasses import dataclass

from semantics.behaviours.program import Program
from semantics.behaviours.values import Value
from semantics.state.agents import Code, Store
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND, Request
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Controls:
    """A pending `control(R ⇒ R')`, by the command or rule that made it.

    Attributes:
        agent: The agent that requested it.
        name: The command or rule.
        host: The agent's host at the request.
        arguments: Its arguments.
    """

    agent: Name
    name: str
    host: Name
    arguments: tuple[Name, ...]


Asked = OBS | READY | SND | MGR | Controls
"""The pending requests of a travelling bigActor; a flight ends where it began, so it has no FLY."""


@dataclass(frozen=True, slots=True)
class Running:
    """A travelling bigActor.

    Attributes:
        host: Its new host.
        code: Its code left to run.
        store: Its variables.
        requests: Its pending requests.
        says: The remaining number of each message from outside, in the order of the environment's clauses.
    """

    host: Name
    code: Code = ()
    store: Store = ()
    requests: tuple[Asked, ...] = ()
    says: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Parcel:
    """The contents of a passage between stations: messages for an agent, or the agent itself with its messages."""

    agent: Name
    mail: tuple[Value, ...] = ()
    running: Running | None = None


def parcel_request(program: Program, request: Request, host: Name) -> Asked:
    """Return a pending request in the form of a parcel; raises ValueError if the text cannot have made it."""
    if not isinstance(request, CTR | FLY):
        return request
    for name, make in sorted(program.reactions.items()) if isinstance(request, CTR) else ():
        found = make.made_from(request.reaction, host)
        if found is not None:
            return Controls(request.agent, name, found[0], found[1:])
    raise ValueError(f"{request} stays where it is")


def requested(program: Program, given: Asked) -> Request:
    """Return the pending request of a parcel's request; a control's reaction is rebuilt from this program.

    Raises:
        Fault: The command or rule does not take its arguments.
    """
    if not isinstance(given, Controls):
        return given
    return CTR(given.agent, program.reactions[given.name](given.host, *given.arguments))
