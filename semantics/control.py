"""Control requests in a configuration: their realisations, or the obstacle where there is none.

Each premise is defined once, as the guard of a rule together with the obstacle where it fails.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final

from semantics.behaviours.reaction_rules import (
    Match,
    Reaction,
    is_active,
    is_full,
    matches,
    moved,
    relinked,
    stays_forest,
)
from semantics.drive import Driven, Reach, drive, unloaded
from semantics.state.cell_values import Changes
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit
from semantics.state.relations import Parent, Relation
from semantics.state.requests import CTR, FLY
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Realisation:
    """One way to make a control true.

    Attributes:
        match: The values of the redex's variables.
        logical: The writes of L[m(R) ↦ m(R′)].
        physical: The writes of P′.
        flying: The nodes that have to travel, each with its destination.
        via: The places that they pass on the way.
    """

    match: Match
    logical: Changes
    physical: Changes
    flying: tuple[tuple[Name, Name], ...]
    via: tuple[Name, ...] = ()

    def waits(self, c: Configuration) -> bool:
        """Whether a moving node, or its carrier, is in transit: then a command waits."""
        return any(c.structure.physical.transit(node) is not None for node, _ in self.flying)

    def departing(self, c: Configuration) -> Changes:
        """Return the writes of P that put the travelling nodes in transit."""
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
    """Why the control next in line can't be made true; for one match, the first obstacle in this order counts."""

    UNMATCHED = "unmatched"
    INCONSISTENT = "inconsistent"
    UNREALISABLE = "unrealisable"


@dataclass(frozen=True, slots=True)
class Premise:
    """A premise of a rule on a match m of R: its guard, and the obstacle where no match fulfils it.

    Attributes:
        text: Its text above the bar of the rule.
        holds: Whether it holds for a match.
        otherwise: The obstacle where it does not.
    """

    text: str
    holds: Callable[[Configuration, CTR | FLY, Match], bool]
    otherwise: Obstacle


# --- premises ---------------------------------------------------------------------------------------------------


def involves_host(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether the agent's host is a node of m(R)."""
    return c.alpha.host(request.agent) in match.nodes(request.reaction.redex)


def leaves_forest(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether L with m(R′) for m(R) is a forest."""
    return stays_forest(request.reaction, match, c.structure.logical)


def is_consistent(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether S is locally consistent with respect to m(R), missing sites included."""
    structure, redex = c.structure, request.reaction.redex
    full = is_full(match, redex, structure.physical)
    return full and structure.locally_consistent(match.relations(redex), match.nodes(redex))


def is_under_way(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether P has all nodes of m(R), and each travelling node flies to its parent in m(R′), or is carried.

    An entity that vanished and appeared again during the flight is in no transit, or in that of another flight.
    """
    physical, nodes = c.structure.physical, match.nodes(request.reaction.redex)
    travelling = ((node, to) for node, to in moved(request.reaction, match) if physical.carrier(node) is None)
    return c.structure.consistent((), nodes) and all(physical.going_to(node) == to for node, to in travelling)


def still_matches(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether R still matches, apart from the current parents of the travelling nodes."""
    structure, redex = c.structure, request.reaction.redex
    nodes = match.nodes(redex)
    believed = all(map(structure.believes, _unmoved(request, match)))
    known = believed and all(node in structure.logical for node in nodes)
    return known and is_full(match, redex, structure.logical) and is_active(nodes, structure.logical)


def is_unmoved_consistent(c: Configuration, request: CTR | FLY, match: Match) -> bool:
    """Whether S is consistent with respect to the part of m(R) that does not travel, missing sites included."""
    consistent = c.structure.consistent(_unmoved(request, match))
    return consistent and is_full(match, request.reaction.redex, c.structure.physical)


def _unmoved(request: CTR | FLY, match: Match) -> list[Relation]:
    travelling = {node for node, _ in moved(request.reaction, match)}
    pairs = match.relations(request.reaction.redex)
    return [pair for pair in pairs if not (isinstance(pair, Parent) and pair.node in travelling)]


_FOREST: Final = Premise("L[m(R) ↦ m(R′)] a forest", leaves_forest, Obstacle.UNMATCHED)

PREMISES: Final[Mapping[type[CTR | FLY], tuple[Premise, ...]]] = {
    CTR: (
        Premise("a's host in m(R)", involves_host, Obstacle.UNMATCHED),
        _FOREST,
        Premise("S locally consistent w.r.t. m(R)", is_consistent, Obstacle.INCONSISTENT),
    ),
    FLY: (
        Premise("m(R) in P, its travelling nodes in transit there", is_under_way, Obstacle.INCONSISTENT),
        Premise("R still matches, except for the place of the moved node", still_matches, Obstacle.UNMATCHED),
        _FOREST,
        Premise("its unmoved part is consistent", is_unmoved_consistent, Obstacle.INCONSISTENT),
    ),
}
"""The premises of `actuate` and `command` on a CTR, and of `commit` on a FLY, in this order; then `drive` must give P′.
"""


def _driven(
    c: Configuration, request: CTR | FLY, match: Match, reach: Reach | None = None
) -> Driven | Obstacle:
    """Return the P′ of a match, or the obstacle of the first premise that fails."""
    failed = (each.otherwise for each in PREMISES[type(request)] if not each.holds(c, request, match))
    obstacle = next(failed, None)
    return obstacle or drive(c, c.setting, request.reaction, match, reach) or Obstacle.UNREALISABLE


# --- guards -----------------------------------------------------------------------------------------------------


def applicable(c: Configuration, agent: Name, reaction: Reaction) -> Iterator[Match]:
    """Yield the matches of R in L that leave L a forest and involve the agent's host."""
    request = CTR(agent, reaction)
    asked = [each for each in PREMISES[CTR] if each.otherwise is Obstacle.UNMATCHED]
    for match in matches(reaction.redex, c.structure.logical):
        if all(each.holds(c, request, match) for each in asked):
            yield match


def realisations(c: Configuration, request: CTR) -> Iterator[Realisation]:
    """Yield the realisations of a requested control, in the order of the matches."""
    for match in matches(request.reaction.redex, c.structure.logical):
        driven = _driven(c, request, match)
        if isinstance(driven, Driven):
            yield _realisation(c, request, match, driven)


def commits(c: Configuration, fly: FLY, reach: Reach | None = None) -> Realisation | None:
    """Return the realisation of a flight that ends now, None if it can't; `reach` is the `observed` of `drive`."""
    driven = _driven(c, fly, fly.match, reach)
    return _realisation(c, fly, fly.match, driven) if isinstance(driven, Driven) else None


def _realisation(c: Configuration, request: CTR | FLY, match: Match, driven: Driven) -> Realisation:
    """Return the realisation: P′, and for L[m(R) ↦ m(R′)] only the relations that R′ changes."""
    reaction, logical = request.reaction, c.structure.logical
    changes: Changes = {}
    for node, place in moved(reaction, match):
        changes |= logical.nesting(node, place)
    for node, lost, gained in relinked(reaction, match, logical):
        changes |= logical.linking(node, (frozenset(logical.links(node)) - lost) | gained)
    return Realisation(match, changes, driven.changes, driven.flying, reaction.via)


# --- findings ---------------------------------------------------------------------------------------------------


def obstacle(c: Configuration, request: CTR | FLY) -> Obstacle | None:
    """Return why the control next in its agent's line can't be served, None if it can, or only waits.

    Of several matches, the one that fulfils the most premises counts. Waiting for an entity in transit (`control
    timed`) is not an inconsistency.
    """
    if isinstance(request, FLY):
        driven = _driven(c, request, request.match)
        return None if isinstance(driven, Driven) else driven
    hindered: dict[Match, Obstacle] = {}
    for match in matches(request.reaction.redex, c.structure.logical):
        driven = _driven(c, request, match)
        if isinstance(driven, Driven):
            return None
        hindered[match] = driven
    furthest = max(hindered.values(), key=list(Obstacle).index, default=Obstacle.UNMATCHED)
    those = [match for match, each in hindered.items() if each is furthest is not Obstacle.UNMATCHED]
    return None if any(_waits(c, request.reaction, match) for match in those) else furthest


def _waits(c: Configuration, reaction: Reaction, match: Match) -> bool:
    physical = c.structure.physical
    placed = [pair.node for pair in match.relations(reaction.redex) if isinstance(pair, Parent)]
    return any(physical.transit(node) is not None for node in placed)
