"""Decision diagrams: the only place that knows oxidd.

Bits come in pairs: one for what a configuration holds, and one, its *next*, for what it holds after a step.
"""

import mmap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from checker.exploration import EngineError, MachineError

CACHE = 1 << 21
"""Results that are remembered; 20 bytes each, taken at once."""

NODES, NODE = 1 << 28, 32
"""The most nodes of a diagram, unless memory is limited; the bytes that are reckoned for one."""

ROOM = 16
"""Bytes of address space that are taken for each of them at once."""

LITTER = 1 << 21
"""Nodes that are met before any are thrown away."""

Set = Any
"""A diagram: a set of configurations, or of pairs of one and the next."""


@dataclass(frozen=True, slots=True)
class Image:
    """What an image forgets, and how what comes after takes its place.

    Attributes:
        forgotten: The bits that are written.
        renaming: From the next bits to those.
    """

    forgotten: Set
    renaming: Any


class Diagrams:
    """A manager of diagrams.

    Attributes:
        all: The set of all configurations.
        none: The empty set.
        pairs: How many pairs of bits there are.
    """

    def __init__(self, memory: int | None = None) -> None:
        try:
            from oxidd import bcdd  # noqa: PLC0415 - an extra
            from oxidd.util import BooleanOperator  # noqa: PLC0415 - the same
        except ImportError as error:
            raise EngineError("the symbolic engine needs oxidd: pip install 'bigactors[symbolic]'") from error
        nodes = NODES if memory is None else max(LITTER, min(NODES, memory // NODE))
        _check_room(ROOM * nodes)
        self._manager = bcdd.BCDDManager(nodes, CACHE, 1)
        self._renaming = bcdd.BCDDFunction.make_substitution
        self._and = BooleanOperator.AND
        self.all, self.none = self._manager.true(), self._manager.false()
        self.pairs = 0
        self._litter = LITTER

    def add(self, count: int) -> range:
        """Add pairs of bits, in the end of the order, and return their numbers."""
        self._manager.add_vars(2 * count)
        self.pairs += count
        return range(self.pairs - count, self.pairs)

    def bit(self, pair: int, following: bool = False) -> Set:
        """Return where a bit, or its next, is one."""
        return self._manager.var(2 * pair + following)

    def order(self, pairs: Iterable[int]) -> None:
        """Let the pairs of bits stand in an order."""
        self._manager.gc()
        self._manager.set_var_order([2 * pair + following for pair in pairs for following in (0, 1)])

    def meet(self, sets: Iterable[Set]) -> Set:
        """Return what is in all sets."""
        found = self.all
        for each in sets:
            found &= each
        return found

    def join(self, sets: Iterable[Set]) -> Set:
        """Return what is in any set."""
        found = self.none
        for each in sets:
            found |= each
        return found

    def image_of(self, pairs: Sequence[int]) -> Image:
        """Return the image by steps that write some pairs of bits."""
        renaming = self._renaming([(2 * pair + 1, self.bit(pair)) for pair in pairs])
        return Image(self.meet(map(self.bit, pairs)), renaming)

    def step(self, configurations: Set, relation: Set, image: Image) -> Set:
        """Return where steps lead from some configurations."""
        after = configurations.apply_exists(self._and, relation, image.forgotten)
        return after.substitute(image.renaming)

    def member(self, configurations: Set) -> list[bool]:
        """Return the bits of some member; there must be one."""
        bits = configurations.pick_cube()
        assert bits is not None
        return [bool(bit) for bit in bits[::2]]

    def count(self, configurations: Set) -> int:
        """Return how many members there are, exactly."""
        return int(configurations.sat_count(2 * self.pairs)) >> self.pairs

    def count_steps(self, relation: Set, written: int) -> int:
        """Return how many pairs there are of a configuration and what it holds next in so many written pairs."""
        return int(relation.sat_count(2 * self.pairs)) >> (self.pairs - written)

    def tidy(self) -> None:
        """Throw away what nobody needs any more, if there is much."""
        if self._manager.approx_num_inner_nodes() > self._litter:
            self._manager.gc()
            self._litter = max(LITTER, 2 * int(self._manager.approx_num_inner_nodes()))


def _check_room(size: int) -> None:
    """Refuse where there is no such address space: oxidd would end the process."""
    try:
        mmap.mmap(-1, size, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS).close()
    except OSError as error:
        raise MachineError(
            f"decision diagrams take {size / 1e9:.1f} GB of address space at once, and there is not so much: give them "
            f"less by --max-memory ({error.strerror})"
        ) from error
