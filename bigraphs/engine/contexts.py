"""The context of an occurrence: whether rules may act there, and the part that conditions inspect."""

from __future__ import annotations

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph, Place, assemble, moved
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import CompiledPattern, compile_pattern
from bigraphs.engine.search_state import PatternOccurrence
from bigraphs.engine.state_arrays import GroundState, bits
from bigraphs.system import Condition, Where


class PlaceContexts:
    """The ancestors of places in one state, cached; `passive` is whether passive controls have to be considered."""

    def __init__(self, state: GroundState, *, passive: bool) -> None:
        self.state = state
        self.passive = passive
        self._above: dict[int, int] = {}

    def above(self, place: int) -> int:
        """Return the mask of a node and all its ancestors; 0 for a region."""
        if place < 0:
            return 0
        found = self._above.get(place)
        if found is None:
            found = pending = 1 << place
            while pending:
                low = pending & -pending
                pending ^= low
                around = _mask(self.state.parents[low.bit_length() - 1]) & ~found
                found |= around
                pending |= around
            self._above[place] = found
        return found

    def admits(self, pattern: CompiledPattern, occurrence: PatternOccurrence) -> bool:
        """Return whether all regions are in active places outside the matched nodes."""
        parents, nodes, used = self.state.parents, occurrence.nodes, occurrence.mask
        for node in pattern.roots:
            for place in parents[nodes[node]]:
                if place >= 0 and not used >> place & 1:
                    above = self.above(place)
                    if above & used or (self.passive and not self.is_active(above)):
                        return False
        return True

    def is_active(self, above: int) -> bool:
        """Return whether all these nodes are active."""
        world = self.state.world
        return all(world.active[world.control_of[self.state.labels[slot]]] for slot in bits(above))


def _mask(places: tuple[int, ...]) -> int:
    found = 0
    for place in places:
        if place >= 0:
            found |= 1 << place
    return found


class ConditionCheck:
    """A compiled condition of a rule.

    A condition sees only its part of the state. An edge of its pattern matches only an edge whose points all lie in
    that part. A node that contains the occurrence of the redex has a site in its place.
    """

    def __init__(self, world: InternTables, condition: Condition) -> None:
        self.positive = condition.positive
        self.where = condition.where
        self.matcher = Matcher(world, compile_pattern(world, without_idle(condition.pattern)))

    def holds(self, state: GroundState, occurrence: PatternOccurrence) -> bool:
        """Return whether the condition holds at an occurrence; it skips the search if a needed control is missing."""
        if not all(state.by_control[control] & ~occurrence.mask for control in self.matcher.pattern.controls):
            return not self.positive
        inside = below(state, occurrence.mask) & ~occurrence.mask
        if self.where is Where.PARAM:
            return occurs(self.matcher, state, inside) is self.positive
        return occurs(self.matcher, state, state.occupied() & ~inside & ~occurrence.mask) is self.positive


def occurs(matcher: Matcher, state: GroundState, allowed: int = -1) -> bool:
    """Return whether a pattern occurs among the allowed slots, in active places or not."""
    if not matcher.wide:
        return bool(matcher.find(state, allowed, once=True))
    around = PlaceContexts(state, passive=False)
    return any(around.admits(matcher.pattern, found) for found in matcher.find(state, allowed))


def below(state: GroundState, slots: int) -> int:
    """Return the mask of all descendants of these nodes."""
    found, waiting = 0, slots
    while waiting:
        low = waiting & -waiting
        waiting ^= low
        fresh = state.kids[low.bit_length() - 1] & ~found
        found |= fresh
        waiting |= fresh
    return found


def without_idle(pattern: Bigraph) -> Bigraph:
    """Return a pattern without parts that match anything: empty regions, sites in regions, idle links."""
    used = sorted({place for node in pattern.nodes for place in node.parents if place < 0}, reverse=True)
    rank = {place: ~number for number, place in enumerate(used)}
    names = {link for node in pattern.nodes for link in node.ports if isinstance(link, str)}

    def places(place: Place) -> tuple[Place, ...]:
        return (rank.get(place, place),)

    kept = [[place for place in parents if place >= 0] for parents in pattern.sites]
    return lean(
        assemble(
            pattern.signature,
            [moved(node, places, lambda link: link) for node in pattern.nodes],
            regions=len(used),
            sites=[parents for parents in kept if parents],
            edges=pattern.edges,
            outer_names=names,
        )
    )
