"""Decoding of a state, or of its key, to its bigraph."""

from __future__ import annotations

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


def from_key(world: InternTables, key: Key) -> GroundState:
    """Return a state with this key of `GroundState.key`; the key alone determines the order of its nodes."""
    builder = _Builder(world)
    *regions, shared = codes_in(world, key)
    for region, codes in enumerate(regions):
        builder.region(region, codes)
    builder.shared(shared)
    return builder.finish()


class _Builder:
    """A state under construction, from the regions inwards."""

    def __init__(self, world: InternTables) -> None:
        self.world = world
        self.labels: list[int] = []
        self.parents: list[list[int]] = []
        self.ports: list[tuple[int, ...]] = []
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
            slot = len(self.labels)
            self.labels.append(label)
            self.ports.append(ports)
            self.parents.append([place] if itself == 0 else self.homes.setdefault(itself, []))
            waiting += [(kid, slot) for kid in reversed(kids)]

    def shared(self, codes: list[int]) -> None:
        for code in codes:
            self.put(code, 0)

    def finish(self) -> GroundState:
        world = self.world
        state = GroundState(world)
        state.labels, state.ports = self.labels, self.ports
        state.parents = [tuple(sorted(places)) for places in self.parents]
        state.kids = [0] * (len(self.labels) + world.regions)
        last = max((link for ports in self.ports for link in ports), default=-1)
        state.points = [0] * max(last + 1, len(world.names))
        state.codes = [0] * len(self.labels)
        for slot, label in enumerate(self.labels):
            state.by_control[world.control_of[label]] |= 1 << slot
            for place in state.parents[slot]:
                state.kids[place] |= 1 << slot
            for link in self.ports[slot]:
                state.points[link] |= 1 << slot
        state.recode(state.occupied())
        return state


def history_free(state: GroundState) -> str:
    """Return a canonical text of a state that does not depend on earlier states."""
    found = canonical(to_bigraph(state))
    return repr((found.nodes, found.regions, found.edges))
