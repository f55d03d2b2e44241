"""Parcels: what goes from one station to another of a bigActor, in the words of the mission's text.

A parcel holds no reaction. A control that is asked for goes as the command or rule that made it, with its host and its
arguments; who takes it in makes the reaction anew from the text of its own mission.
"""

from dataclasses import dataclass

from semantics.behaviours.program import Program
from semantics.behaviours.values import Value
from semantics.state.agents import Code, Store
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND, Request
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Controls:
    """`control(R ⇒ R')`, asked for and not served: what made it.

    Attributes:
        agent: Who asked.
        name: The command or rule.
        host: The host that it was asked for.
        arguments: Its arguments.
    """

    agent: Name
    name: str
    host: Name
    arguments: tuple[Name, ...]


Asked = OBS | READY | SND | MGR | Controls
"""What a bigActor on its way may have asked for; a flight ends where it began."""


@dataclass(frozen=True, slots=True)
class Running:
    """A bigActor on its way.

    Attributes:
        host: Where it goes.
        code: What is left of it to run.
        store: Its variables.
        requests: What it has asked for.
        says: How often each thing may still be said to it, in the order of the environment's clauses.
    """

    host: Name
    code: Code = ()
    store: Store = ()
    requests: tuple[Asked, ...] = ()
    says: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Parcel:
    """What goes from one station to another: messages for an agent, or the agent itself with its messages."""

    agent: Name
    mail: tuple[Value, ...] = ()
    running: Running | None = None


def asked(program: Program, request: Request, host: Name) -> Asked:
    """Return a pending request as it goes to another station; raises ValueError where the text cannot have made it."""
    if not isinstance(request, CTR | FLY):
        return request
    for name, make in sorted(program.reactions.items()) if isinstance(request, CTR) else ():
        found = make.made_from(request.reaction, host)
        if found is not None:
            return Controls(request.agent, name, found[0], found[1:])
    raise ValueError(f"{request} stays where it is")


def requested(program: Program, given: Asked) -> Request:
    """Return what was asked for as it is served here: the reaction of a control is made of this program.

    Raises:
        Fault: The command or rule does not take its arguments.
    """
    if not isinstance(given, Controls):
        return given
    return CTR(given.agent, program.reactions[given.name](given.host, *given.arguments))
