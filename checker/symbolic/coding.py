"""Columns as bits of diagrams: how a column's codes are written, and how its bits grow with its values."""

from collections.abc import Iterable, Sequence

from checker.fast.columns import Columns
from checker.symbolic.diagrams import Diagrams, Set

SPARE = 2
"""Bits that a column gets beyond what it needs, so that it may grow."""


class Coding:
    """The bits of all columns; those that have one value take none.

    Attributes:
        diagrams: Where the bits are.
        columns: What they stand for.
        bits: For each column the numbers of its pairs, the highest bit first.
    """

    def __init__(self, diagrams: Diagrams, columns: Columns) -> None:
        self.diagrams = diagrams
        self.columns = columns
        self.bits: list[list[int]] = []
        self._codes: dict[tuple[int, int, bool], Set] = {}
        self._alike: dict[tuple[int, int], Set] = {}

    @property
    def holds(self) -> bool:
        """Whether each column has bits for its values."""
        self._meet()
        pairs = zip(self.columns.all, self.bits, strict=True)
        return all(len(column.values) <= 1 << len(bits) for column, bits in pairs)

    def grow(self) -> Set:
        """Give each column bits for its values, and some to spare; return where all new bits are zero.

        A column's first code is zero, and so are the new bits of codes that it had before.
        """
        new: list[int] = []
        self._meet()
        for column, bits in zip(self.columns.all, self.bits, strict=True):
            needed = (len(column.values) - 1).bit_length()
            if needed > len(bits) or (bits and needed == len(bits)):
                added = list(self.diagrams.add(needed + SPARE - len(bits)))
                bits[:0] = added
                new += added
        self._codes.clear()
        self._alike.clear()
        return self.diagrams.meet(~self.diagrams.bit(pair) for pair in new)

    def _meet(self) -> None:
        """Take in the columns that are new: they have one value so far."""
        self.bits += [[] for _ in range(len(self.columns) - len(self.bits))]

    def order(self, columns: Iterable[int]) -> None:
        """Let the bits of columns stand in an order."""
        self.diagrams.order([pair for column in columns for pair in self.bits[column]])

    def varying(self) -> list[int]:
        """Return the columns that have bits."""
        return [column for column, bits in enumerate(self.bits) if bits]

    def pairs(self, columns: Iterable[int]) -> list[int]:
        """Return the pairs of bits of some columns."""
        return [pair for column in columns for pair in self.bits[column]]

    # --- sets -----------------------------------------------------------------------------------------------------

    def code(self, column: int, code: int, following: bool = False) -> Set:
        """Return where a column holds a code, now or next."""
        known = self._codes.get((column, code, following))
        if known is None:
            bits = self.bits[column]
            literals = (
                bit if code >> power & 1 else ~bit
                for power, bit in enumerate(self.diagrams.bit(pair, following) for pair in reversed(bits))
            )
            known = self._codes[column, code, following] = self.diagrams.meet(literals)
        return known

    def copied(self, target: int, source: int) -> Set:
        """Return where a column holds next what another holds now; itself, where nothing changes."""
        known = self._alike.get((target, source))
        if known is None:
            known = self._alike[target, source] = self.diagrams.meet(self._copied(target, source))
        return known

    def _copied(self, target: int, source: int) -> Iterable[Set]:
        ones, others = self.bits[target][::-1], self.bits[source][::-1]
        for power in range(max(len(ones), len(others))):
            after = (
                self.diagrams.bit(ones[power], following=True) if power < len(ones) else self.diagrams.none
            )
            before = self.diagrams.bit(others[power]) if power < len(others) else self.diagrams.none
            yield after.equiv(before)

    def configuration(self, codes: Sequence[int]) -> Set:
        """Return the set of one configuration."""
        return self.diagrams.meet(self.code(column, code) for column, code in enumerate(codes))

    def codes(self, configurations: Set) -> list[int]:
        """Return the codes of some member; there must be one."""
        bits = self.diagrams.member(configurations)
        found = []
        for pairs in self.bits:
            code = 0
            for pair in pairs:
                code = 2 * code + bits[pair]
            found.append(code)
        return found
