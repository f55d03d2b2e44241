"""Decoding of a state, or of its key, to its bigraph."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count

from bigraphs.bigraph import Bigraph, Link, Node, assemble
from bigraphs.canonical_form import canonical
from bigraphs.engine.intern_tables import REFERENCE, InternTables
from bigraphs.engine.state_arrays import GroundState, Key, bits, codes_in


def to_bigraph(state: GroundState) -> Bigraph:
    """Return the bigraph: named nodes first, by name, then anonymous nodes in slot order."""
    world, slots = state.world, list(bits(state.occupied()))
    rank = {slot: place for place, slot in enumerate(slots)}
    edges = {edge: place for place, edge in enumerate(_live_edges(state))}

    def link(old: int) -> Link:
        return world.names[old] if old < len(world.names) else edges[old]

    nodes = []
    for slot in slots:
        control, name = world.control_of[state.labels[slot]], world.name_of[state.labels[slot]]
        parents = tuple(rank.get(place, place) for place in state.parents[slot])
        kind = world.signature.controls[control].name
        nodes.append(Node(kind, name, tuple(map(link, state.ports[slot])), parents))
    return assemble(world.signature, nodes, regions=world.regions, edges=len(edges), outer_names=world.names)


def _live_edges(state: GroundState) -> list[int]:
    return [edge for edge in range(len(state.world.names), len(state.points)) if state.points[edge]]


def from_key(world: InternTables, key: Key, slots: Iterable[int] | None = None) -> GroundState:
    """Return a state with this key of `GroundState.key`, its nodes in the next `slots`; else the key alone orders them.

    Raises:
        ValueError: There are too few slots, or one slot twice.
    """
    builder = _Builder(world, slots)
    *regions, shared = codes_in(world, key)
    for region, codes in enumerate(regions):
        builder.region(region, codes)
    builder.shared(shared)
    return builder.finish()


class _Builder:
    """A state under construction, from the regions inwards."""

    def __init__(self, world: InternTables, slots: Iterable[int] | None) -> None:
        self.world = world
        self.slots = count() if slots is None else iter(slots)
        self.nodes: list[tuple[int, int, tuple[int, ...], list[int]]] = []  # slot, label, ports and places
        self.homes: dict[int, list[int]] = {}  # the places of each shared node

    def region(self, region: int, codes: list[int]) -> None:
        for code in codes:
            self.put(code, ~region)

    def put(self, code: int, place: int) -> None:
        waiting = [(code, place)]
        while waiting:
            code, place = waiting.pop()
            label, ports, kids, itself = self.world.rows[code]
            if label == REFERENCE:
                self.homes.setdefault(ports[0], []).append(place)
                continue
            slot = next(self.slots, -1)
            if slot < 0:
                raise ValueError("a state has more nodes than slots")
            places = [place] if itself == 0 else self.homes.setdefault(itself, [])
            self.nodes.append((slot, label, ports, places))
            waiting += [(kid, slot) for kid in reversed(kids)]

    def shared(self, codes: list[int]) -> None:
        for code in codes:
            self.put(code, 0)

    def finish(self) -> GroundState:
        world = self.world
        state = GroundState(world)
        size = max((slot for slot, *_ in self.nodes), default=-1) + 1
        state.labels, state.parents, state.ports = [-1] * size, [()] * size, [()] * size
        state.kids = [0] * (size + world.regions)
        last = max((link for _, _, ports, _ in self.nodes for link in ports), default=-1)
        state.points = [0] * max(last + 1, len(world.names))
        state.codes = [-1] * size
        state.free = (1 << size) - 1
        for slot, label, ports, places in self.nodes:
            if not state.free >> slot & 1:
                raise ValueError("two nodes of a state have one slot")
            state.labels[slot], state.ports[slot], state.parents[slot] = label, ports, tuple(sorted(places))
            state.free &= ~(1 << slot)
            state.by_control[world.control_of[label]] |= 1 << slot
            for place in places:
                state.kids[place] |= 1 << slot
            for link in ports:
                state.points[link] |= 1 << slot
        state.recode(state.occupied())
        return state


def slots_of(state: GroundState) -> Iterator[int]:
    """Yield the slots of a state's nodes, in the order in which `from_key` makes the nodes of its key."""

    def below(place: int) -> list[int]:
        found = bits(state.kids[place])
        return sorted([slot for slot in found if len(state.parents[slot]) == 1], key=in_order)

    def in_order(slot: int) -> int:
        return -state.codes[slot]

    shared = [slot for slot in bits(state.occupied()) if len(state.parents[slot]) > 1]
    tops = [slot for region in range(state.world.regions) for slot in reversed(below(~region))]
    for top in (*tops, *sorted(shared, key=state.codes.__getitem__)):
        waiting = [top]
        while waiting:
            yield (slot := waiting.pop())
            waiting += below(slot)


def history_free(state: GroundState) -> str:
    """Return a canonical text of a state that does not depend on earlier states."""
    found = canonical(to_bigraph(state))
    return repr((found.nodes, found.regions, found.edges))
