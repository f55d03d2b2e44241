"""One state as arrays of integers: places, links, and containment as bit masks.

A node has a *slot*, which it keeps for as long as it lives; slot `n` is bit `n` of a mask. Place `~r` is region
`r`, and as lists end with their regions it is also an index. Names are links from 0, edges follow them.
"""

from __future__ import annotations

from array import array
from functools import lru_cache
from typing import Any, TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.engine.world import REFERENCE, World

Key: TypeAlias = bytes


class State:
    """A ground bigraph, over one world.

    Attributes:
        labels: The label of each slot, -1 for one that is free.
        parents: The places of each slot.
        kids: The mask of what is in each slot and, from the end, in each region.
        ports: The links of each slot's ports, sorted where ports have no order.
        points: The mask of what is on each link.
        by_control: The mask of the nodes of each control.
        codes: The code of each slot.
        free: The mask of the slots that are free.
    """

    __slots__ = ("by_control", "codes", "free", "kids", "labels", "parents", "points", "ports", "world")

    def __init__(self, world: World) -> None:
        self.world = world
        self.labels: list[int] = []
        self.parents: list[tuple[int, ...]] = []
        self.kids: list[int] = [0] * world.regions
        self.ports: list[tuple[int, ...]] = []
        self.points: list[int] = [0] * len(world.names)
        self.by_control: list[int] = [0] * len(world.controls)
        self.codes: list[int] = []
        self.free = 0

    def copy(self) -> State:
        """Return a state that can be changed by itself."""
        found = State.__new__(State)
        found.world = self.world
        found.labels = self.labels.copy()
        found.parents = self.parents.copy()
        found.kids = self.kids.copy()
        found.ports = self.ports.copy()
        found.points = self.points.copy()
        found.by_control = self.by_control.copy()
        found.codes = self.codes.copy()
        found.free = self.free
        return found

    def parts(self) -> tuple[Any, ...]:
        """Return what a state is made of, as plain values."""
        lists = self.labels, self.parents, self.kids, self.ports, self.points, self.by_control, self.codes
        return *lists, self.free

    def remade(self, parts: tuple[Any, ...]) -> State:
        """Return the state of such parts, which are of this one's world."""
        found = State.__new__(State)
        found.world = self.world
        found.labels, found.parents, found.kids, found.ports, found.points, *rest = parts
        found.by_control, found.codes, found.free = rest
        return found

    def occupied(self) -> int:
        """Return the mask of all nodes."""
        return ((1 << len(self.labels)) - 1) & ~self.free

    def key(self) -> Key:
        """Return what tells this state from others, the numbers of its edges and shared nodes included."""
        kids, codes = self.kids, self.codes
        if self.world.regions == 1 and not self.world.sharing:
            return array("I", sorted([codes[slot] for slot in bits(kids[-1])])).tobytes()
        inside = [
            [self.kid_code(slot) for slot in bits(kids[~region])] for region in range(self.world.regions)
        ]
        shared = bits(self.occupied()) if self.world.sharing else ()
        return to_key(self.world, [*inside, [codes[slot] for slot in shared if len(self.parents[slot]) > 1]])

    def kid_code(self, slot: int) -> int:
        """Return the code that a node has in a row of one of its parents."""
        if len(self.parents[slot]) > 1:
            return self.world.code((REFERENCE, (~slot,), (), 0))
        return self.codes[slot]

    def recode(self, dirty: int) -> None:
        """Compute anew the codes of nodes that have changed, and of all that they are in."""
        stale, pending, parents = dirty, dirty, self.parents
        while pending:
            low = pending & -pending
            pending ^= low
            around = parents[low.bit_length() - 1]
            if len(around) == 1 and around[0] >= 0 and not stale >> around[0] & 1:
                stale |= 1 << around[0]
                pending |= 1 << around[0]
        while stale:
            path = [stale.bit_length() - 1]
            while path:
                inside = self.kids[path[-1]] & stale & ~(1 << path[-1])
                if inside:
                    path.append(inside.bit_length() - 1)
                else:
                    stale &= ~(1 << path[-1])
                    self._recode(path.pop())

    def _recode(self, slot: int) -> None:
        """Compute the code of a node from those of what is in it."""
        inside, codes = self.kids[slot], self.codes
        if self.world.sharing:
            kids = tuple(sorted([self.kid_code(kid) for kid in bits(inside)]))
            itself = ~slot if len(self.parents[slot]) > 1 else 0
        else:
            kids = tuple(sorted([codes[kid] for kid in bits(inside)])) if inside else ()
            itself = 0
        row = (self.labels[slot], self.ports[slot], kids, itself)
        found = self.world.codes.get(row)
        codes[slot] = self.world.code(row) if found is None else found


def to_key(world: World, codes: list[list[int]]) -> Key:
    """Return the key of a state with these codes in its regions and, last, of its shared nodes."""
    if world.regions == 1 and not world.sharing:
        return array("I", sorted(codes[0])).tobytes()
    parts = [part for inside in codes[:-1] for part in (len(inside), *sorted(inside))]
    return array("I", parts + sorted(codes[-1])).tobytes()


def codes_in(world: World, key: Key) -> list[list[int]]:
    """Return the codes in each region of a state and, last, of its shared nodes."""
    numbers = array("I", key).tolist()
    if world.regions == 1 and not world.sharing:
        return [numbers, []]
    found, start = [], 0
    for _ in range(world.regions):
        end = start + 1 + numbers[start]
        found.append(numbers[start + 1 : end])
        start = end
    return [*found, numbers[start:]]


@lru_cache(maxsize=1 << 17)
def bits(mask: int) -> tuple[int, ...]:
    """Return the numbers of the bits that are set, from the least; the same masks are asked for again and again."""
    found = []
    while mask:
        low = mask & -mask
        mask ^= low
        found.append(low.bit_length() - 1)
    return tuple(found)


def make_state(world: World, bigraph: Bigraph) -> State:
    """Return a ground bigraph as a state; node `n` has slot `n`."""
    state = State(world)
    number = {name: link for link, name in enumerate(world.names)}
    size, fixed = len(bigraph.nodes), len(world.names)
    state.kids = [0] * (size + world.regions)
    state.points += [0] * bigraph.edges
    state.codes = [0] * size
    for slot, node in enumerate(bigraph.nodes):
        label = world.label(node.control, node.name)
        control = world.control_of[label]
        ports = [number[link] if isinstance(link, str) else fixed + link for link in node.ports]
        state.labels.append(label)
        state.parents.append(node.parents)
        state.ports.append(tuple(ports) if world.ordered[control] else tuple(sorted(ports)))
        state.by_control[control] |= 1 << slot
        for place in node.parents:
            state.kids[place] |= 1 << slot
        for link in ports:
            state.points[link] |= 1 << slot
    state.recode(state.occupied())
    return state
