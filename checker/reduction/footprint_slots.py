"""Slots: the parts of a configuration that reductions distinguish, and footprints as bits over them.

A slot is usually a cell. A question about a cell whose answer changes far less often than the cell (does an entity
exist? may a message wake this `react`?) is a slot of its own.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from semantics.state.signature import Name

Slot = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class SlotFootprint:
    """The slots that an actor may read, write and merge, a bit for each.

    Attributes:
        reads: The slots that determine whether it is enabled, and its effect.
        writes: The slots whose value it may change.
        merges: The slots to which it may add commutatively: messages in a mailbox, and observations of the same P in L.
    """

    reads: int = 0
    writes: int = 0
    merges: int = 0

    @property
    def changes(self) -> int:
        """The slots that may change."""
        return self.writes | self.merges

    def __or__(self, other: "SlotFootprint") -> "SlotFootprint":
        return SlotFootprint(self.reads | other.reads, self.writes | other.writes, self.merges | other.merges)

    def disturbs(self, other: "SlotFootprint") -> bool:
        """Return whether one actor may disable the other, change its effect, or not commute with it."""
        return bool(
            self.writes & (other.reads | other.changes)
            or other.writes & (self.reads | self.merges)
            or self.merges & other.reads
            or other.merges & self.reads
        )

    def beyond(self, bound: "SlotFootprint") -> int:
        """Return this footprint without another's slots; an actor may also read the slots that it writes or merges."""
        reads = self.reads & ~(bound.reads | bound.changes)
        return reads | self.merges & ~bound.changes | self.writes & ~bound.writes


NOTHING = SlotFootprint()


def joined(footprints: Iterable[SlotFootprint]) -> SlotFootprint:
    """Return the union of footprints."""
    reads = writes = merges = 0
    for each in footprints:
        reads, writes, merges = reads | each.reads, writes | each.writes, merges | each.merges
    return SlotFootprint(reads, writes, merges)


class Slots:
    """A numbering of slots by first use."""

    def __init__(self) -> None:
        self.numbers: dict[Slot, int] = {}
        self._of_names = cache(self._of)

    def bits(self, slots: Iterable[Slot]) -> int:
        """Return the bits of some slots."""
        bits = 0
        for slot in slots:
            bits |= 1 << self.numbers.setdefault(slot, len(self.numbers))
        return bits

    def of(self, sort: str, names: Iterable[Name]) -> int:
        """Return the bits of the slots of one sort, one for each name."""
        return self._of_names(sort, frozenset(names))

    def _of(self, sort: str, names: frozenset[Name]) -> int:
        return self.bits((sort, name) for name in names)

    def footprint(
        self, reads: Iterable[Slot] = (), writes: Iterable[Slot] = (), merges: Iterable[Slot] = ()
    ) -> SlotFootprint:
        """Return the footprint over these slots."""
        return SlotFootprint(self.bits(reads), self.bits(writes), self.bits(merges))

    def has(self, bits: int, slot: Slot) -> bool:
        """Return whether a slot is among some bits; an unnumbered slot only belongs to `EVERYTHING`."""
        return bool(bits >> self.numbers.get(slot, len(self.numbers)) & 1)

    def named(self, bits: int) -> tuple[Slot, ...]:
        """Return the slots of some bits, sorted: for messages and tests."""
        found = (slot for slot, number in self.numbers.items() if bits >> number & 1)
        return tuple(sorted(found, key=lambda slot: tuple(map(str, slot))))
