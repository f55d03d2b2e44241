"""Possible moves: the entities that the text of a mission may move, where to, and by which places."""

from collections.abc import Iterator
from typing import NamedTuple

from semantics.analysis.overapproximation import Overapproximation
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.reaction_rules import NodeTerm, PlaceTerm, Reaction
from semantics.behaviours.statements import ControlBy
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY
from semantics.state.setting import Setting
from semantics.state.signature import Name


class PossibleMove(NamedTuple):
    """A move that a control may request: the agent, the moved entity, the places of its VIA, and its new parent."""

    agent: Name
    entity: Name
    via: tuple[Name, ...]
    place: Name


def possible_moves(c: Configuration) -> tuple[PossibleMove, ...]:
    """Return all moves that agents may request from an initial configuration on, sorted."""
    flow = ValueFlow(c.setting, Overapproximation(c))
    found: set[PossibleMove] = set()
    for agent in flow.agents:
        reactions = dict.fromkeys(_requested(c, flow, agent))
        found.update(move for reaction in reactions for move in _moves(c.setting, agent, reaction))
    return tuple(sorted(found))


def _requested(c: Configuration, flow: ValueFlow, agent: Name) -> Iterator[Reaction | None]:
    """Yield the reactions that an agent may request; None for any."""
    if agent in c.alpha:
        for pending in c.eta.of(agent):
            if isinstance(pending.request, CTR | FLY):
                yield pending.request.reaction
    for number in flow[agent].statements:
        statement = c.setting.program.statements[number]
        if isinstance(statement, ControlBy):
            found = flow.reactions(agent, statement)
            yield from (None,) if found is None else found


def _moves(setting: Setting, agent: Name, reaction: Reaction | None) -> Iterator[PossibleMove]:
    """Yield the moves of a reaction, for all nodes and places that its variables may denote."""
    if reaction is None:
        yield from (PossibleMove(agent, *pair) for pair in _any(setting))
        return
    for node, place in reaction.moves:
        for entity in _denoted(setting, node):
            for to in _denoted(setting, place):
                if _fits(setting, entity, to):
                    yield PossibleMove(agent, entity, reaction.via, to)


def _any(setting: Setting) -> Iterator[tuple[Name, tuple[Name, ...], Name]]:
    """Yield every move, with every entity as a VIA of each."""
    every = tuple(sorted(setting.kinds))
    yield from ((entity, every, to) for entity in every for to in every if _fits(setting, entity, to))


def _denoted(setting: Setting, term: NodeTerm | PlaceTerm) -> tuple[Name, ...]:
    """Return the entities that a term of a reaction may denote."""
    if isinstance(term, str):
        return (term,) if term in setting.kinds else ()
    kind = getattr(term, "kind", None)
    return tuple(name for name, of in sorted(setting.kinds.items()) if kind in (None, of))


def _fits(setting: Setting, entity: Name, place: Name) -> bool:
    """Whether a place may be the parent of an entity."""
    inside = setting.kind(entity)
    return entity != place and setting.signature[setting.kind(place)].may_contain(inside)
