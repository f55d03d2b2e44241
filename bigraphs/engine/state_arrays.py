"""A state as arrays of integers: places, links, and containment as bit masks.

A node keeps its *slot* for its whole life; slot `n` is bit `n` of a mask. Region `r` is place `~r`; as each list ends
with the regions, `~r` is also an index. Links are numbered from 0, names first, then edges.
"""

from __future__ import annotations

from array import array
from functools import lru_cache
from typing import Any, TypeAlias

from bigraphs.bigraph import Bigraph
from bigraphs.engine.intern_tables import REFERENCE, InternTables

Key: TypeAlias = bytes


class GroundState:
    """A ground bigraph, over one world.

    Attributes:
        labels: The label of each slot, -1 for a free slot.
        parents: The places of each slot.
        kids: The mask of the children in each slot and, from the end, in each region.
        ports: The links of each slot's ports, sorted where ports are unordered.
        points: The mask of the nodes on each link.
        by_control: The mask of the nodes of each control.
        codes: The code of each slot.
        free: The mask of the free slots.
    """

    __slots__ = ("by_control", "codes", "free", "kids", "labels", "parents", "points", "ports", "world")

    def __init__(self, world: InternTables) -> None:
        self.world = world
        self.labels: list[int] = []
        self.parents: list[tuple[int, ...]] = []
        self.kids: list[int] = [0] * world.regions
        self.ports: list[tuple[int, ...]] = []
        self.points: list[int] = [0] * len(world.names)
        self.by_control: list[int] = [0] * len(world.controls)
        self.codes: list[int] = []
        self.free = 0

    def copy(self) -> GroundState:
        """Return an independent copy."""
        found = GroundState.__new__(GroundState)
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
        """Return the parts of a state, as plain values."""
        lists = self.labels, self.parents, self.kids, self.ports, self.points, self.by_control, self.codes
        return *lists, self.free

    def remade(self, parts: tuple[Any, ...]) -> GroundState:
        """Return the state with these parts, which must belong to the same world."""
        found = GroundState.__new__(GroundState)
        found.world = self.world
        found.labels, found.parents, found.kids, found.ports, found.points, *rest = parts
        found.by_control, found.codes, found.free = rest
        return found

    def occupied(self) -> int:
        """Return the mask of all nodes."""
        return ((1 << len(self.labels)) - 1) & ~self.free

    def key(self) -> Key:
        """Return a key of this state; it depends on the numbers of edges and shared nodes."""
        kids, codes = self.kids, self.codes
        if self.world.regions == 1 and not self.world.sharing:
            return array("I", sorted([codes[slot] for slot in bits(kids[-1])])).tobytes()
        inside = [
            [self.kid_code(slot) for slot in bits(kids[~region])] for region in range(self.world.regions)
        ]
        shared = bits(self.occupied()) if self.world.sharing else ()
        return to_key(self.world, [*inside, [codes[slot] for slot in shared if len(self.parents[slot]) > 1]])

    def kid_code(self, slot: int) -> int:
        """Return the code of a node in the row of a parent."""
        if len(self.parents[slot]) > 1:
            return self.world.code((REFERENCE, (~slot,), (), 0))
        return self.codes[slot]

    def recode(self, dirty: int) -> None:
        """Recompute the codes of changed nodes and of all their ancestors."""
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
        """Compute the code of a node from the codes of its children."""
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


def to_key(world: InternTables, codes: list[list[int]]) -> Key:
    """Return the key of a state with these codes in its regions and, last, of its shared nodes."""
    if world.regions == 1 and not world.sharing:
        return array("I", sorted(codes[0])).tobytes()
    parts = [part for inside in codes[:-1] for part in (len(inside), *sorted(inside))]
    return array("I", parts + sorted(codes[-1])).tobytes()


def codes_in(world: InternTables, key: Key) -> list[list[int]]:
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
    """Return the numbers of the set bits, in ascending order; cached because the same masks recur."""
    found = []
    while mask:
        low = mask & -mask
        mask ^= low
        found.append(low.bit_length() - 1)
    return tuple(found)


def make_state(world: InternTables, bigraph: Bigraph) -> GroundState:
    """Return a ground bigraph as a state; node `n` has slot `n`."""
    state = GroundState(world)
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
