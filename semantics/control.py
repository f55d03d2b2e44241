"""Control requests in a configuration: their realisations, or the reason why there is none."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from semantics.behaviours.reactions import (
    Match,
    Reaction,
    is_active,
    is_full,
    matches,
    moved,
    relinked,
    stays_forest,
)
from semantics.drive import Reach, drive, unloaded
from semantics.state.cells import Changes
from semantics.state.configuration import Configuration
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import Carried, InTransit
from semantics.state.relations import Parent, Relation
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Realisation:
    """One way in which a control can be made true.

    Attributes:
        match: What the redex's variables stand for.
        logical: The writes of L[m(R) ↦ m(R′)].
        physical: The writes of P′.
        flying: What has to travel for it, and where to.
        via: The places that it passes on its way.
    """

    match: Match
    logical: Changes
    physical: Changes
    flying: tuple[tuple[Name, Name], ...]
    via: tuple[Name, ...] = ()

    def waits(self, c: Configuration) -> bool:
        """Tell whether what moves, or what carries it, is in transit: then a command waits."""
        return any(c.structure.physical.transit(node) is not None for node, _ in self.flying)

    def departing(self, c: Configuration) -> Changes:
        """Write P with what travels in transit."""
        physical = c.structure.physical
        changes: Changes = {}
        for node, place in self.flying:
            origin, placement = physical.position(node), physical.placement(node)
            assert origin is not None
            if isinstance(placement, Carried):
                origin = unloaded(placement, origin)
            changes |= physical.placing(node, InTransit(origin, place))
        return changes


class Obstacle(Enum):
    """Why a control next in line has no realisation."""

    UNMATCHED = "unmatched"
    INCONSISTENT = "inconsistent"
    UNREALISABLE = "unrealisable"


def applicable(c: Configuration, agent: Name, reaction: Reaction) -> Iterator[Match]:
    """Yield the matches of R in L that leave L a forest and involve the agent's host."""
    host = c.alpha.host(agent)
    for match in matches(reaction.redex, c.structure.logical):
        if host in match.nodes(reaction.redex) and stays_forest(reaction, match, c.structure.logical):
            yield match


def is_consistent(c: Configuration, reaction: Reaction, match: Match) -> bool:
    """Tell whether S is locally consistent with respect to m(R), missing sites included."""
    structure = c.structure
    full = is_full(match, reaction.redex, structure.physical)
    return full and structure.locally_consistent(match.relations(reaction.redex), match.nodes(reaction.redex))


def realisations(c: Configuration, request: CTR) -> Iterator[Realisation]:
    """Yield the ways in which a requested control can be made true, in the order of the matches."""
    for match in applicable(c, request.agent, request.reaction):
        if is_consistent(c, request.reaction, match):
            driven = drive(c, c.setting, request.reaction, match)
            if driven is not None:
                logical = reacting(c.structure.logical, request.reaction, match)
                yield Realisation(match, logical, driven.changes, driven.flying, request.reaction.via)


def reacting(logical: LogicalModel, reaction: Reaction, match: Match) -> Changes:
    """Write L[m(R) ↦ m(R′)]: only the relations that R′ changes."""
    changes: Changes = {}
    for node, place in moved(reaction, match):
        changes |= logical.nesting(node, place)
    for node, lost, gained in relinked(reaction, match, logical):
        changes |= logical.linking(node, (frozenset(logical.links(node)) - lost) | gained)
    return changes


def commits(c: Configuration, fly: FLY, reach: Reach | None = None) -> Realisation | None:
    """Return what a flight comes to when it ends now, None where it can't; `reach` as `drive` has it."""
    obstacle = flight_obstacle(c, fly)
    driven = None if obstacle else drive(c, c.setting, fly.reaction, fly.match, reach)
    if driven is None:
        return None
    logical = reacting(c.structure.logical, fly.reaction, fly.match)
    return Realisation(fly.match, logical, driven.changes, driven.flying, fly.reaction.via)


def flight_obstacle(c: Configuration, fly: FLY) -> Obstacle | None:
    """Return why a flight can't be committed, apart from P′: R is gone, or L and P disagree on its unmoved part."""
    structure, reaction, match = c.structure, fly.reaction, fly.match
    travelling = [node for node, _ in moved(reaction, match)]
    nodes = match.nodes(reaction.redex)
    unmoved = [pair for pair in match.relations(reaction.redex) if not _moves(pair, travelling)]
    flying = all(
        structure.physical.transit(node) for node in travelling if structure.physical.carrier(node) is None
    )
    if not structure.consistent((), nodes) or not flying:
        return Obstacle.INCONSISTENT
    believed = all(map(structure.believes, unmoved)) and all(node in structure.logical for node in nodes)
    if not believed or not is_full(match, reaction.redex, structure.logical):
        return Obstacle.UNMATCHED
    if not is_active(nodes, structure.logical) or not stays_forest(reaction, match, structure.logical):
        return Obstacle.UNMATCHED
    consistent = structure.consistent(unmoved) and is_full(match, reaction.redex, structure.physical)
    return None if consistent else Obstacle.INCONSISTENT


def _moves(pair: Relation, travelling: list[Name]) -> bool:
    return isinstance(pair, Parent) and pair.node in travelling


def obstacle(c: Configuration, request: CTR | FLY) -> Obstacle | None:
    """Return why a control next in its agent's line can't be served, None where it can, or merely waits.

    It waits for an entity in transit (`control timed`): that is not an inconsistency.
    """
    if isinstance(request, FLY):
        return flight_obstacle(c, request) or (None if commits(c, request) else Obstacle.UNREALISABLE)
    found = list(applicable(c, request.agent, request.reaction))
    if not found:
        return Obstacle.UNMATCHED
    consistent = [match for match in found if is_consistent(c, request.reaction, match)]
    if not consistent:
        waiting = any(_waits(c, request.reaction, match) for match in found)
        return None if waiting else Obstacle.INCONSISTENT
    served = (drive(c, c.setting, request.reaction, m) or _waits(c, request.reaction, m) for m in consistent)
    return None if any(served) else Obstacle.UNREALISABLE


def _waits(c: Configuration, reaction: Reaction, match: Match) -> bool:
    physical = c.structure.physical
    placed = [pair.node for pair in match.relations(reaction.redex) if isinstance(pair, Parent)]
    return any(physical.transit(node) is not None for node in placed)
