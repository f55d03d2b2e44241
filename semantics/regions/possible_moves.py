"""Possible moves: the entities that the text of a mission may move, where to, and by which places."""

from collections.abc import Iterator
from functools import lru_cache
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


def may_move(setting: Setting, agent: Name, entity: Name) -> bool:
    """Whether a control of an agent's text may move an entity; true for an agent without a text."""
    moved = _moved(setting).get(agent)
    return moved is None or entity in moved


@lru_cache(maxsize=8)
def _moved(setting: Setting) -> dict[Name, frozenset[Name]]:
    """Return for each agent with a text the entities that it may move."""
    flow = ValueFlow(setting)
    return {
        agent: frozenset(
            move.entity
            for reaction in dict.fromkeys(_controls(setting, flow, agent))
            for move in _moves(setting, agent, reaction)
        )
        for agent, role in flow.roles.items()
        if role.starts
    }


def possible_ways(setting: Setting, entity: Name, to: Name) -> frozenset[tuple[Name, ...]] | None:
    """Return the VIAs of all controls of a text that may send an entity to a place; None for any."""
    every = tuple(sorted(setting.kinds))
    found = _vias(setting).get((entity, to), frozenset())
    return None if every in found else found


@lru_cache(maxsize=8)
def _vias(setting: Setting) -> dict[tuple[Name, Name], frozenset[tuple[Name, ...]]]:
    """Return for each entity and place the VIAs of all moves of a text."""
    flow = ValueFlow(setting)
    found: dict[tuple[Name, Name], set[tuple[Name, ...]]] = {}
    for agent in flow.agents:
        for reaction in dict.fromkeys(_controls(setting, flow, agent)):
            for move in _moves(setting, agent, reaction):
                found.setdefault((move.entity, move.place), set()).add(move.via)
    return {key: frozenset(vias) for key, vias in found.items()}


def _requested(c: Configuration, flow: ValueFlow, agent: Name) -> Iterator[Reaction | None]:
    """Yield the reactions that an agent may request; None for any."""
    if agent in c.alpha:
        for pending in c.eta.of(agent):
            if isinstance(pending.request, CTR | FLY):
                yield pending.request.reaction
    yield from _controls(c.setting, flow, agent)


def _controls(setting: Setting, flow: ValueFlow, agent: Name) -> Iterator[Reaction | None]:
    """Yield the reactions of an agent's controls; None for any."""
    for number in flow[agent].statements:
        statement = setting.program.statements[number]
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
