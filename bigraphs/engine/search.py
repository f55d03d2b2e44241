"""The search for occurrences: one plan for each form of a pattern and start node, made once, run on every state.

A plan places the nodes of a pattern one after the other, next to those that are placed already, so that its
candidates are an intersection of a few masks. An occurrence maps nodes injectively and keeps controls, nesting
and links: a node without a site has nothing else in it, an edge is matched with all of its points, a name by any
link. Only a region all of whose nodes are in other nodes, too, may lie nowhere. Whether the regions lie where rules
may act is asked afterwards (`bigraphs.engine.contexts`), since that can change without any node of the occurrence
being touched. Patterns that differ in their controls only have one form.
"""

from __future__ import annotations

from typing import Final

from bigraphs.engine.bindings import binding
from bigraphs.engine.patterns import Pattern
from bigraphs.engine.search_state import OFTEN, Occurrence, Placing, Run, Step
from bigraphs.engine.sharing import shared_places_fit
from bigraphs.engine.state import State, bits
from bigraphs.engine.world import World

_SELDOM: Final = 8
"""Up to how many searches a pattern is looked for everywhere, and not where a state was touched."""


class _Plans:
    """What places the patterns of one form, from each of their nodes on, and how often they were looked for."""

    __slots__ = ("placings", "searches")

    def __init__(self, size: int) -> None:
        self.placings: list[Placing | None] = [None] * size
        self.searches = 0


class Matcher:
    """Finds a pattern in the states of one world."""

    def __init__(self, world: World, pattern: Pattern) -> None:
        self.world = world
        self.pattern = pattern
        self.wide = pattern.wide()
        self._plans: _Plans = world.plans.setdefault(pattern.form(world), _Plans(pattern.size))

    def plan(self, first: int) -> Placing:
        """Return what places the whole pattern from one node on; it is made when it is first asked for."""
        found = self._plans.placings[first]
        if found is None:
            found = self._plans.placings[first] = _plan(self.world, self.pattern, first)
        return found

    def unplanned(self) -> bool:
        """Say whether it has searched so seldom that to look everywhere costs less than to plan from each node."""
        return self._plans.searches < _SELDOM

    def find(self, state: State, allowed: int = -1, *, once: bool = False) -> list[Occurrence]:
        """Return every occurrence within the allowed slots, or one of them."""
        self._plans.searches += 1
        pattern, run = self.pattern, Run(state, self.pattern, allowed, once=once)
        if not pattern.size:
            return [Occurrence((), tuple(run.links), 0)]
        counts = [state.by_control[control].bit_count() for control in pattern.controls]
        first = counts.index(min(counts))
        candidates = state.by_control[pattern.controls[first]] & allowed
        if candidates:
            plan = self.plan(first)
            any(plan(run, 0, slot) for slot in bits(candidates))
        return run.found

    def find_at(self, state: State, touched: int) -> list[Occurrence]:
        """Return every occurrence that has a node among the touched ones."""
        run = Run(state, self.pattern, -1, once=False)
        controls = self.pattern.controls
        for slot in bits(touched & ~state.free):
            control = self.world.control_of[state.labels[slot]]
            for node, wanted in enumerate(controls):
                if wanted == control:
                    self.plan(node)(run, 0, slot)
            run.allowed &= ~(1 << slot)  # what holds this slot has been found
        return run.found


def _plan(world: World, pattern: Pattern, first: int) -> Placing:
    """Return what places the whole pattern, from one node on."""
    order = _order(pattern, first)
    step = _end(world, pattern)
    for place in reversed(range(1, pattern.size)):
        bound = frozenset(order[:place])
        placing = _placing(world, pattern, order[place], step)
        step = _choice(pattern, order[place], bound, placing)
    return _placing(world, pattern, first, step)


def _order(pattern: Pattern, first: int) -> list[int]:
    """Return the nodes so that each is as near to those before as can be."""
    order, left = [first], set(range(pattern.size)) - {first}
    near = dict.fromkeys(left, 0)
    while left:
        for node in left:
            near[node] |= _nearness(pattern, node, order[-1])
        order.append(max(left, key=lambda node: (near[node], -node)))
        left.remove(order[-1])
    return order


def _nearness(pattern: Pattern, node: int, placed: int) -> int:
    """Return how much a placed node says about another one, as bits, the highest for what says most."""
    return (
        8 * (placed in pattern.kids[node])
        + 4 * any(placed in pattern.on[link] for link in pattern.ports[node])
        + 2 * (placed in pattern.parents[node])
        + _beside(pattern, node, placed)
    )


def _choice(pattern: Pattern, node: int, bound: frozenset[int], placing: Placing) -> Step:
    """Return the step that tries every slot for a node which the placed ones leave."""
    above = tuple(parent for parent in pattern.parents[node] if parent in bound)
    below = tuple(kid for kid in pattern.kids[node] if kid in bound)
    beside = next((other for other in sorted(bound) if _beside(pattern, node, other)), -1)
    along = tuple({link for link in pattern.ports[node] if bound & frozenset(pattern.on[link])})
    group = next((group for group in pattern.twins if node in group), ())
    before = [twin for twin in group if twin < node and twin in bound]
    after = [twin for twin in group if twin > node and twin in bound]
    between = [twin for twin in group if node < twin < min(after, default=pattern.size)]
    reserve = len(between)  # twins that are still to be placed above this one

    def step(run: Run, used: int) -> bool:
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


def _beside(pattern: Pattern, node: int, other: int) -> bool:
    """Say whether two nodes are in one region and nowhere else, so that all their places are the same."""
    alone = not pattern.parents[node] and not pattern.parents[other]
    return alone and len(pattern.homes[node]) == 1 and pattern.homes[node] == pattern.homes[other]


def _mask(places: tuple[int, ...]) -> int:
    found = 0
    for place in places:
        if place >= 0:
            found |= 1 << place
    return found


def _placing(world: World, pattern: Pattern, node: int, then: Step) -> Placing:
    """Return what checks a slot for a node, binds its links, and goes on."""
    inside, sited = len(pattern.kids[node]), pattern.sited[node]
    above, rooted = len(pattern.parents[node]), bool(pattern.homes[node])
    alone = rooted and not above
    named = pattern.labels[node] >= 0
    bind = binding(world, pattern, node, then)

    def place(run: Run, used: int, slot: int) -> bool:
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


def _end(world: World, pattern: Pattern) -> Step:
    """Return the step that checks what only whole occurrences show, and keeps them."""
    roots = pattern.roots
    closed = [(link, pattern.on[link]) for link in pattern.closed if pattern.on[link]]
    above = [len(pattern.parents[node]) for node in range(pattern.size)]
    sharing = world.sharing

    def end(run: Run, used: int) -> bool:
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
        run.found.append(Occurrence(tuple(nodes), tuple(links), used))
        return run.once

    return end
