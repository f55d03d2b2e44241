"""The commands of the language: one table, from which everything that knows commands by name is derived.

Grammar, reserved words, hints, the reference, the checks before a run, the formatter and the printed reactions read it.
Footprints and the live loop read the reactions. `docs/how-to/extending.md` explains how to add one.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from semantics.behaviours.reaction_rules import (
    CONTROL_AUTHORITY,
    LinkVariable,
    Pattern,
    PlaceVariable,
    Reaction,
    Sides,
)
from semantics.state.signature import Name

HOST: Final = "HOST"
"""Stands for the agent's host in an open reaction; the word is reserved, so no entity has this name."""

VIA: Final = "VIA"
WAY: Final = ("gate0", "gate1")
"""The example of a VIA in hints and in the reference."""

MOST_VIA: Final = 20
"""The most places of one VIA; a longer path is several moves."""


@dataclass(frozen=True)
class Command:
    """The syntax of a command, and the reaction that it requests.

    Attributes:
        form: Words of the language in capitals, and operands in small letters: all different, each a node.
        sides: The function from the agent's host and the operands to R and R'; its docstring appears in the reference.
        travels: Whether it may end with places to pass: `VIA gate0, gate1`.
    """

    form: str
    sides: Callable[..., Sides]
    travels: bool = False

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """The words and operands, in written order."""
        return tuple(self.form.split())

    @cached_property
    def name(self) -> str:
        """Its first word."""
        return self.parts[0]

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Its words of the language."""
        return tuple(part for part in self.parts if part.isupper())

    @cached_property
    def operands(self) -> tuple[str, ...]:
        """The names of its operands."""
        return tuple(part for part in self.parts if not part.isupper())

    @cached_property
    def open(self) -> Reaction:
        """The reaction over `HOST` and the operands' own names: its moves are known before any run."""
        return self(HOST, *self.operands)

    def __call__(self, host: Name, *arguments: Name) -> Reaction:
        """Return R ⇒ R'. Further arguments are the VIA: context, nodes with sites on both sides."""
        operands, via = arguments[: len(self.operands)], arguments[len(self.operands) :]
        redex, reactum = self.sides(host, *operands)
        return Reaction(self.write(operands, via), redex.beside(via), reactum.beside(via), via)

    def made_from(self, reaction: Reaction, host: Name) -> tuple[Name, ...] | None:  # noqa: ARG002 - a rule needs it
        """Return the host and the operands of a reaction; None if another command or rule made it."""
        given = tuple(node for node in reaction.redex.nodes if isinstance(node, str))
        if len(given) <= len(self.operands):
            return None
        return given if self(*given) == reaction else None

    def write(self, operands: Iterable[str], via: Iterable[str] = ()) -> str:
        """Return the text of the command with these operands."""
        left = iter(operands)
        text = " ".join(part if part.isupper() else next(left) for part in self.parts)
        way = ", ".join(via)
        return f"{text} {VIA} {way}" if way else text


def move_host_to(host: Name, place: Name) -> Sides:
    """Move the agent's host into a place. If it is there already, this is the identity."""
    anywhere, nodes = PlaceVariable("x"), (host, place)
    return Pattern(nodes, ((host, anywhere),)), Pattern(nodes, ((host, place),))


def move(host: Name, entity: Name, place: Name) -> Sides:
    """Move an entity into a place, from wherever it is. The host has control authority over it: `h[c] || u[c]`."""
    anywhere, authority = PlaceVariable("x"), LinkVariable("c", CONTROL_AUTHORITY)
    nodes, links = (host, entity, place), ((authority, host), (authority, entity))
    return Pattern(nodes, ((entity, anywhere),), links), Pattern(nodes, ((entity, place),), links)


def put(host: Name, entity: Name, place: Name) -> Sides:
    """Put a child of the host, `h.(x | $0)`, where the host is, or into a carrier of the host or aboard it."""
    nodes = (host, entity, place)
    return Pattern(nodes, ((entity, host),)), Pattern(nodes, ((entity, place),))


def hand(host: Name, entity: Name, station: Name) -> Sides:
    """Hand the control authority over an entity to a station: `h[c] || u[c] || g[d] -> h[c] || u[d] || g[d]`."""
    old, new = LinkVariable("c", CONTROL_AUTHORITY), LinkVariable("d", CONTROL_AUTHORITY)
    nodes = (host, entity, station)
    return (
        Pattern(nodes, links=((old, host), (old, entity), (new, station))),
        Pattern(nodes, links=((old, host), (new, entity), (new, station))),
    )


def connect_host_to(host: Name, node: Name) -> Sides:
    """Let the host join a channel of a node, control authorities excepted."""
    channel, nodes = LinkVariable("d", but=CONTROL_AUTHORITY), (host, node)
    return Pattern(nodes, links=((channel, node),)), Pattern(nodes, links=((channel, node), (channel, host)))


def disconnect_host_from(host: Name, node: Name) -> Sides:
    """Let the host leave a channel that it shares with a node, control authorities excepted."""
    apart, joined = connect_host_to(host, node)
    return joined, apart


COMMANDS: Final[Mapping[str, Command]] = {
    command.name: command
    for command in (
        Command("MOVE_HOST_TO place", move_host_to, travels=True),
        Command("MOVE entity TO place", move, travels=True),
        Command("PUT entity IN place", put),
        Command("HAND entity TO station", hand),
        Command("CONNECT_HOST_TO node", connect_host_to),
        Command("DISCONNECT_HOST_FROM node", disconnect_host_from),
    )
}

COMMAND_WORDS: Final = frozenset(word for command in COMMANDS.values() for word in command.words) | {VIA}
"""All words of commands; none of them may be a name."""
