"""Slots: the parts of a configuration that reductions distinguish, and footprints as bits over them.

A slot is mostly a cell. Where one question of a cell has an answer of its own that changes far less often (is an entity
there at all? may a message wake this `react`?) the question is a slot beside the cell.
"""

from collections.abc import Iterable
from dataclasses import dataclass

Slot = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Footprint:
    """What somebody may read, write and merge, a bit for each slot.

    Attributes:
        reads: What decides whether something is enabled and what it does.
        writes: What may be given another value.
        merges: What may be added to so that the order of two who add doesn't matter: messages posted to one mailbox,
            and what two who look at the same P put into L.
    """

    reads: int = 0
    writes: int = 0
    merges: int = 0

    @property
    def changes(self) -> int:
        """What may be different afterwards."""
        return self.writes | self.merges

    def __or__(self, other: "Footprint") -> "Footprint":
        return Footprint(self.reads | other.reads, self.writes | other.writes, self.merges | other.merges)

    def disturbs(self, other: "Footprint") -> bool:
        """Tell whether one may disable the other, change what it does, or end differently after it than before it."""
        return bool(
            self.writes & (other.reads | other.changes)
            or other.writes & (self.reads | self.merges)
            or self.merges & other.reads
            or other.merges & self.reads
        )

    def beyond(self, bound: "Footprint") -> int:
        """Return the slots that another leaves out; who writes or merges something may read it, too."""
        reads = self.reads & ~(bound.reads | bound.changes)
        return reads | self.merges & ~bound.changes | self.writes & ~bound.writes


NOTHING = Footprint()


def joined(footprints: Iterable[Footprint]) -> Footprint:
    """Return what any of them may do."""
    reads = writes = merges = 0
    for each in footprints:
        reads, writes, merges = reads | each.reads, writes | each.writes, merges | each.merges
    return Footprint(reads, writes, merges)


class Slots:
    """Numbers slots as they are met."""

    def __init__(self) -> None:
        self.numbers: dict[Slot, int] = {}

    def bits(self, slots: Iterable[Slot]) -> int:
        """Return the bits of some slots."""
        bits = 0
        for slot in slots:
            bits |= 1 << self.numbers.setdefault(slot, len(self.numbers))
        return bits

    def footprint(
        self, reads: Iterable[Slot] = (), writes: Iterable[Slot] = (), merges: Iterable[Slot] = ()
    ) -> Footprint:
        """Return the footprint over these slots."""
        return Footprint(self.bits(reads), self.bits(writes), self.bits(merges))

    def has(self, bits: int, slot: Slot) -> bool:
        """Tell whether a slot is among some bits; one that has no number is where all are."""
        return bool(bits >> self.numbers.get(slot, len(self.numbers)) & 1)

    def named(self, bits: int) -> tuple[Slot, ...]:
        """Return the slots of some bits, sorted: for messages and tests."""
        found = (slot for slot, number in self.numbers.items() if bits >> number & 1)
        return tuple(sorted(found, key=lambda slot: tuple(map(str, slot))))
