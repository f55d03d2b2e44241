"""The search for occurrences: one plan per pattern form and start node, compiled once and run on every state.

A plan places the nodes of a pattern one after the other, each close to the placed ones, so that the candidates are an
intersection of a few masks. An occurrence maps nodes injectively and preserves controls, nesting and links. A node
without a site has no other content. An edge matches with all its points, a name matches any link. A region may have no
place only if all its nodes have other parents. `bigraphs.engine.contexts` checks afterwards whether the regions are
active, since that can change although no node of the occurrence is touched. Patterns that differ only in their controls
have one form.
"""

from __future__ import annotations

from typing import Final

from bigraphs.engine.bindings import binding
from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.multiple_parents import shared_places_fit
from bigraphs.engine.patterns import CompiledPattern
from bigraphs.engine.search_state import OFTEN, PatternOccurrence, PatternSearch, Placing, Step
from bigraphs.engine.state_arrays import GroundState, bits

_SELDOM: Final = 8
"""Up to this number of searches, a pattern is searched everywhere instead of only at touched nodes."""


class _Plans:
    """The plans of one pattern form, one per start node, and the number of searches with them."""

    __slots__ = ("placings", "searches")

    def __init__(self, size: int) -> None:
        self.placings: list[Placing | None] = [None] * size
        self.searches = 0


class Matcher:
    """Finds a pattern in the states of one world."""

    def __init__(self, world: InternTables, pattern: CompiledPattern) -> None:
        self.world = world
        self.pattern = pattern
        self.wide = pattern.wide()
        self._plans: _Plans = world.plans.setdefault(pattern.form(world), _Plans(pattern.size))

    def plan(self, first: int) -> Placing:
        """Return the plan that places the whole pattern from a start node on; it is compiled on first use."""
        found = self._plans.placings[first]
        if found is None:
            found = self._plans.placings[first] = _plan(self.world, self.pattern, first)
        return found

    def unplanned(self) -> bool:
        """Return whether searches were so rare that a full search costs less than a plan for each start node."""
        return self._plans.searches < _SELDOM

    def find(self, state: GroundState, allowed: int = -1, *, once: bool = False) -> list[PatternOccurrence]:
        """Return every occurrence within the allowed slots; with `once` at most one."""
        self._plans.searches += 1
        pattern, run = self.pattern, PatternSearch(state, self.pattern, allowed, once=once)
        if not pattern.size:
            return [PatternOccurrence((), tuple(run.links), 0)]
        counts = [state.by_control[control].bit_count() for control in pattern.controls]
        first = counts.index(min(counts))
        candidates = state.by_control[pattern.controls[first]] & allowed
        if candidates:
            plan = self.plan(first)
            any(plan(run, 0, slot) for slot in bits(candidates))
        return run.found

    def find_at(self, state: GroundState, touched: int) -> list[PatternOccurrence]:
        """Return every occurrence with a touched node."""
        run = PatternSearch(state, self.pattern, -1, once=False)
        controls = self.pattern.controls
        for slot in bits(touched & ~state.free):
            control = self.world.control_of[state.labels[slot]]
            for node, wanted in enumerate(controls):
                if wanted == control:
                    self.plan(node)(run, 0, slot)
            run.allowed &= ~(1 << slot)  # all occurrences with this slot have been found
        return run.found


def _plan(world: InternTables, pattern: CompiledPattern, first: int) -> Placing:
    """Return the plan that places the whole pattern from a start node on."""
    order = _order(pattern, first)
    step = _end(world, pattern)
    for place in reversed(range(1, pattern.size)):
        bound = frozenset(order[:place])
        placing = _placing(world, pattern, order[place], step)
        step = _choice(pattern, order[place], bound, placing)
    return _placing(world, pattern, first, step)


def _order(pattern: CompiledPattern, first: int) -> list[int]:
    """Return the nodes in an order in which each is as close as possible to the previous ones."""
    order, left = [first], set(range(pattern.size)) - {first}
    near = dict.fromkeys(left, 0)
    while left:
        for node in left:
            near[node] |= _nearness(pattern, node, order[-1])
        order.append(max(left, key=lambda node: (near[node], -node)))
        left.remove(order[-1])
    return order


def _nearness(pattern: CompiledPattern, node: int, placed: int) -> int:
    """Return how much a placed node constrains another one, as bits; the strongest constraint is the highest bit."""
    return (
        8 * (placed in pattern.kids[node])
        + 4 * any(placed in pattern.on[link] for link in pattern.ports[node])
        + 2 * (placed in pattern.parents[node])
        + _beside(pattern, node, placed)
    )


def _choice(pattern: CompiledPattern, node: int, bound: frozenset[int], placing: Placing) -> Step:
    """Return the step that tries every slot for a node that the placed nodes permit."""
    above = tuple(parent for parent in pattern.parents[node] if parent in bound)
    below = tuple(kid for kid in pattern.kids[node] if kid in bound)
    beside = next((other for other in sorted(bound) if _beside(pattern, node, other)), -1)
    along = tuple({link for link in pattern.ports[node] if bound & frozenset(pattern.on[link])})
    group = next((group for group in pattern.twins if node in group), ())
    before = [twin for twin in group if twin < node and twin in bound]
    after = [twin for twin in group if twin > node and twin in bound]
    between = [twin for twin in group if node < twin < min(after, default=pattern.size)]
    reserve = len(between)  # slots to leave for the twins that come between

    def step(run: PatternSearch, used: int) -> bool:
        run.steps += 1
        if run.steps & OFTEN == 0:
            run.state.world.pause()
        state, nodes = run.state, run.nodes
        mask = state.by_control[run.pattern.controls[node]] & run.allowed & ~used
        for parent in above:
            mask &= state.kids[nodes[parent]]
        for kid in below:
            mask &= _mask(state.parents[nodes[kid]])
        if beside >= 0:
            mask &= state.kids[state.parents[nodes[beside]][0]]
        for link in along:
            mask &= state.points[run.links[link]]
        for twin in before:
            mask &= -2 << nodes[twin]
        for twin in after:
            mask &= (1 << nodes[twin]) - 1
        while mask:
            low = mask & -mask
            mask ^= low
            if reserve and mask.bit_count() < reserve:
                return False
            if placing(run, used, low.bit_length() - 1):
                return True
        return False

    return step


def _beside(pattern: CompiledPattern, node: int, other: int) -> bool:
    """Return whether two nodes are in one region only, and in the same one, so that their places are equal."""
    alone = not pattern.parents[node] and not pattern.parents[other]
    return alone and len(pattern.homes[node]) == 1 and pattern.homes[node] == pattern.homes[other]


def _mask(places: tuple[int, ...]) -> int:
    found = 0
    for place in places:
        if place >= 0:
            found |= 1 << place
    return found


def _placing(world: InternTables, pattern: CompiledPattern, node: int, then: Step) -> Placing:
    """Return the step that checks a slot for a node, binds its links, and continues."""
    inside, sited = len(pattern.kids[node]), pattern.sited[node]
    above, rooted = len(pattern.parents[node]), bool(pattern.homes[node])
    alone = rooted and not above
    named = pattern.labels[node] >= 0
    bind = binding(world, pattern, node, then)

    def place(run: PatternSearch, used: int, slot: int) -> bool:
        state = run.state
        there = state.kids[slot].bit_count()
        if there < inside or (there > inside and not sited):
            return False
        spare = len(state.parents[slot]) - above
        if (
            spare < 0
            or (spare > 0 and not rooted)
            or (not spare and alone)
            or (named and state.labels[slot] != run.pattern.labels[node])
        ):
            return False
        run.nodes[node] = slot
        return bind(run, used | 1 << slot, slot)

    return place


def _end(world: InternTables, pattern: CompiledPattern) -> Step:
    """Return the last step: it checks conditions on whole occurrences, and stores them."""
    roots = pattern.roots
    closed = [(link, pattern.on[link]) for link in pattern.closed if pattern.on[link]]
    above = [len(pattern.parents[node]) for node in range(pattern.size)]
    sharing = world.sharing

    def end(run: PatternSearch, used: int) -> bool:
        state, nodes, links = run.state, run.nodes, run.links
        for node in roots:
            if (_mask(state.parents[nodes[node]]) & used).bit_count() != above[node]:
                return False
        for link, on in closed:
            mask = 0
            for node in on:
                mask |= 1 << nodes[node]
            if mask != state.points[links[link]] or links.count(links[link]) != 1:
                return False
        if sharing and not shared_places_fit(pattern, state, nodes, used):
            return False
        run.found.append(PatternOccurrence(tuple(nodes), tuple(links), used))
        return run.once

    return end
