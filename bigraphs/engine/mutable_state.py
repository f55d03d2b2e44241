"""A state during rewriting: it performs and records every change."""

from __future__ import annotations

from bigraphs.engine.state_arrays import GroundState, bits
from bigraphs.errors import BigraphError


class MutableState:
    """A changing copy of a state.

    Attributes:
        changed: The mask of the slots with a new control, new places or new links.
        emptied: The mask of the slots with changed content.
        relinked: The mask of the links with changed points.
        removed: The mask of the slots whose node was removed, even if a new node uses the slot.
        counted: The controls whose number of nodes changed.
    """

    __slots__ = ("changed", "counted", "emptied", "relinked", "removed", "state")

    def __init__(self, state: GroundState) -> None:
        self.state = state.copy()
        self.changed = 0
        self.emptied = 0
        self.relinked = 0
        self.removed = 0
        self.counted: set[int] = set()

    def touched_by_links(self) -> int:
        """Return the mask of the nodes on changed links."""
        found = 0
        for link in bits(self.relinked):
            found |= self.state.points[link]
        return found

    def move(self, slot: int, places: tuple[int, ...]) -> None:
        """Move a node to other places."""
        kids, bit = self.state.kids, 1 << slot
        for place in self.state.parents[slot]:
            kids[place] &= ~bit
            if place >= 0:
                self.emptied |= 1 << place
        for place in places:
            kids[place] |= bit
            if place >= 0:
                self.emptied |= 1 << place
        self.state.parents[slot] = places
        self.changed |= bit

    def relink(self, slot: int, links: tuple[int, ...]) -> None:
        """Link the ports of a node to other links."""
        points, bit = self.state.points, 1 << slot
        for link in self.state.ports[slot]:
            points[link] &= ~bit
            self.relinked |= 1 << link
        for link in links:
            points[link] |= bit
            self.relinked |= 1 << link
        self.state.ports[slot] = links
        self.changed |= bit

    def relabel(self, slot: int, label: int) -> None:
        """Give a node another label."""
        self.state.labels[slot] = label
        self.changed |= 1 << slot

    def new_edge(self) -> int:
        """Return the first edge that is idle and was idle before the rewrite, or a new one."""
        points, first = self.state.points, len(self.state.world.names)
        for edge in range(first, len(points)):
            if not points[edge] and not self.relinked >> edge & 1:
                self.relinked |= 1 << edge
                return edge
        points.append(0)
        self.relinked |= 1 << len(points) - 1
        return len(points) - 1

    def new_slot(self, label: int) -> int:
        """Return a slot with a new node, which has no place yet."""
        state = self.state
        if state.free:
            slot = (state.free & -state.free).bit_length() - 1
            state.free ^= 1 << slot
        else:
            slot = len(state.labels)
            state.labels.append(-1)
            state.parents.append(())
            state.kids.insert(slot, 0)
            state.ports.append(())
            state.codes.append(-1)
        state.labels[slot] = label
        control = state.world.control_of[label]
        state.by_control[control] |= 1 << slot
        self.counted.add(control)
        self.changed |= 1 << slot
        return slot

    def remove(self, slot: int) -> None:
        """Remove a node; the caller must move or remove its content."""
        state = self.state
        self.move(slot, ())
        self.relink(slot, ())
        control = state.world.control_of[state.labels[slot]]
        state.by_control[control] &= ~(1 << slot)
        self.counted.add(control)
        state.labels[slot] = -1
        state.free |= 1 << slot
        self.removed |= 1 << slot

    def remove_all(self, slot: int) -> None:
        """Remove a node and all descendants that have no place outside it."""
        state, waiting = self.state, [slot]
        while waiting:
            gone = waiting.pop()
            for kid in bits(state.kids[gone]):
                rest = tuple(place for place in state.parents[kid] if place != gone)
                if rest:
                    self.move(kid, rest)
                else:
                    waiting.append(kid)
            self.remove(gone)

    def copy_all(self, slot: int, places: tuple[int, ...]) -> None:
        """Copy a node with all its descendants into these places; the copies share links."""
        state, waiting = self.state, [(slot, places)]
        while waiting:
            copied, places = waiting.pop()
            self._check_copied(copied, shared=copied != slot and len(state.parents[copied]) > 1)
            twin = self.new_slot(state.labels[copied])
            self.move(twin, places)
            self.relink(twin, state.ports[copied])
            waiting += [(kid, (twin,)) for kid in bits(state.kids[copied])]

    def _check_copied(self, slot: int, *, shared: bool) -> None:
        world, label = self.state.world, self.state.labels[slot]
        name, kind = world.name_of[label], world.signature.controls[world.control_of[label]].name
        if name is not None:
            message = f"the rule would copy {name}:{kind}"
            raise BigraphError("copy", message, "a name is one node; copy anonymous ones")
        if shared:
            raise BigraphError("copy", "the rule would copy a node that other places share")

    def finish(self) -> GroundState:
        """Return the state with updated codes."""
        self.state.recode((self.changed | self.emptied) & ~self.state.free)
        return self.state
