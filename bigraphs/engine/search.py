"""The search for occurrences: one plan per pattern and node to begin with, made once, run on every state.

A plan places the nodes of a pattern one after the other, next to those that are placed already, so that its
candidates are an intersection of a few masks. An occurrence maps nodes injectively and keeps controls, nesting
and links: a node without a site has nothing else in it, an edge is matched with all of its points, a name by any
link. Only a region all of whose nodes are in other nodes, too, may lie nowhere. Whether the regions lie where rules
may act is asked afterwards (`bigraphs.engine.contexts`), since that can change without any node of the occurrence
being touched.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple, TypeAlias

from bigraphs.engine.patterns import Pattern
from bigraphs.engine.sharing import shared_places_fit
from bigraphs.engine.state import State, bits
from bigraphs.engine.world import World


class Occurrence(NamedTuple):
    """Where a pattern is: the slot of each of its nodes, the link of each of its links, the mask of the slots.

    A link of the pattern that is on no node has -1.
    """

    nodes: tuple[int, ...]
    links: tuple[int, ...]
    mask: int


class Run:
    """One search: the state, what is placed so far, and what was found."""

    __slots__ = ("allowed", "found", "links", "nodes", "once", "state", "steps")

    def __init__(self, state: State, pattern: Pattern, allowed: int, *, once: bool) -> None:
        self.state = state
        self.allowed = allowed
        self.once = once
        self.steps = 0
        self.nodes = [-1] * pattern.size
        self.links = [-1] * len(pattern.on)
        self.found: list[Occurrence] = []


_OFTEN: Final = 0x3FF
"""After how many steps, less one, a search pauses."""

Step: TypeAlias = Callable[[Run, int], bool]
"""Places what is left of a pattern beside the slots in a mask; says whether the search is over."""

Placing: TypeAlias = Callable[[Run, int, int], bool]
"""Places one node at a slot, and then what is left."""


class Matcher:
    """Finds a pattern in the states of one world."""

    def __init__(self, world: World, pattern: Pattern) -> None:
        self.world = world
        self.pattern = pattern
        self._plans: list[Placing | None] = [None] * pattern.size

    def plan(self, first: int) -> Placing:
        """Return what places the whole pattern from one node on; it is made when it is first asked for."""
        found = self._plans[first]
        if found is None:
            found = self._plans[first] = _plan(self.world, self.pattern, first)
        return found

    def find(self, state: State, allowed: int = -1, *, once: bool = False) -> list[Occurrence]:
        """Return every occurrence within the allowed slots, or one of them."""
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
    order = [first]
    while len(order) < pattern.size:
        left = [node for node in range(pattern.size) if node not in order]
        order.append(max(left, key=lambda node: (_nearness(pattern, node, order), -node)))
    return order


def _nearness(pattern: Pattern, node: int, placed: list[int]) -> tuple[bool, ...]:
    return (
        any(child in placed for child in pattern.kids[node]),
        any(other in placed for link in pattern.ports[node] for other in pattern.on[link]),
        any(parent in placed for parent in pattern.parents[node]),
        any(_beside(pattern, node, other) for other in placed),
    )


def _choice(pattern: Pattern, node: int, bound: frozenset[int], placing: Placing) -> Step:
    """Return the step that tries every slot for a node which the placed ones leave."""
    control = pattern.controls[node]
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
        if run.steps & _OFTEN == 0:
            run.state.world.pause()
        state, nodes = run.state, run.nodes
        mask = state.by_control[control] & run.allowed & ~used
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
    label = pattern.labels[node]
    bind = _binding(world, pattern, node, then)

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
            or (label >= 0 and state.labels[slot] != label)
        ):
            return False
        run.nodes[node] = slot
        return bind(run, used | 1 << slot, slot)

    return place


def _binding(world: World, pattern: Pattern, node: int, then: Step) -> Placing:
    """Return what binds the links of a node in each way that fits."""
    ports = pattern.ports[node]
    if not ports:
        return lambda run, used, _: then(run, used)
    if len(ports) == 1 or world.ordered[pattern.controls[node]]:
        return _in_order(world, pattern, ports, then)
    return _in_any_order(world, pattern, ports, then)


def _in_order(world: World, pattern: Pattern, ports: tuple[int, ...], then: Step) -> Placing:
    fits = _fitting(world, pattern)

    def bind(run: Run, used: int, slot: int) -> bool:
        targets, links, fresh = run.state.ports[slot], run.links, []
        over = False
        if len(targets) == len(ports):
            for link, target in zip(ports, targets, strict=True):
                known = links[link]
                if known < 0 and fits(run.state, link, target):
                    links[link] = target
                    fresh.append(link)
                elif known != target:
                    break
            else:
                over = then(run, used)
        for link in fresh:
            links[link] = -1
        return over

    return bind


def _in_any_order(world: World, pattern: Pattern, ports: tuple[int, ...], then: Step) -> Placing:
    """Give each link of a node one of the slot's links that it has as often."""
    fits = _fitting(world, pattern)
    wanted = sorted(Counter(ports).items())

    def bind(run: Run, used: int, slot: int) -> bool:
        targets = run.state.ports[slot]
        if len(targets) != len(ports):
            return False
        return any(then(run, used) for _ in ways(run, Counter(targets), 0))

    def ways(run: Run, left: Counter[int], place: int) -> Iterator[None]:
        if place == len(wanted):
            yield
            return
        link, times = wanted[place]
        known = run.links[link]
        for target in [target for target in left if left[target] >= times]:
            if target != known and (known >= 0 or not fits(run.state, link, target)):
                continue
            left[target] -= times
            run.links[link] = target
            yield from ways(run, left, place + 1)
            run.links[link] = known
            left[target] += times

    return bind


def _fitting(world: World, pattern: Pattern) -> Callable[[State, int, int], bool]:
    """Return what says whether a link of the pattern may be a link of the state: an edge needs an edge as large."""
    names, fixed = pattern.names, len(world.names)
    sizes = [len(nodes) for nodes in pattern.on]

    def fits(state: State, link: int, target: int) -> bool:
        return link < names or (target >= fixed and state.points[target].bit_count() == sizes[link])

    return fits


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
