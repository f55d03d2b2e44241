"""The numbering of configurations: layer by layer, and within a layer worker by worker.

So numbers grow with the distance from the initial configuration, as those of one process do: the smallest number of
several is a nearest one.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Places:
    """Where the rows of each layer begin.

    Attributes:
        begins: For each worker the first of its rows in each layer, and after the last layer how many it has.
        numbers: For each layer and worker in turn the first number, and at the end how many there are.
    """

    begins: tuple[tuple[int, ...], ...]
    numbers: tuple[int, ...]

    @staticmethod
    def of(begins: Sequence[Sequence[int]]) -> "Places":
        """Number the rows of workers, of whom each has as many layers."""
        layers = range(len(begins[0]) - 1)
        sizes = (each[layer + 1] - each[layer] for layer in layers for each in begins)
        return Places(tuple(map(tuple, begins)), tuple(accumulate(sizes, initial=0)))

    def __len__(self) -> int:
        return self.numbers[-1]

    @property
    def depth(self) -> int:
        """How far the farthest configuration is from the first."""
        return max(0, bisect_left(self.numbers, len(self)) - 1) // len(self.begins)

    def find(self, number: int) -> tuple[int, int]:
        """Return the worker of a configuration, and which of its rows that is."""
        at = bisect_right(self.numbers, number) - 1
        layer, worker = divmod(at, len(self.begins))
        return worker, self.begins[worker][layer] + number - self.numbers[at]

    def number(self, worker: int, row: int) -> int:
        """Return the number of a worker's row."""
        layer = bisect_right(self.begins[worker], row) - 1
        return self.numbers[layer * len(self.begins) + worker] + row - self.begins[worker][layer]

    def all_of(self, worker: int, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the numbers of a worker's rows."""
        begins = np.array(self.begins[worker], np.int64)
        layer = np.searchsorted(begins, rows, side="right") - 1
        firsts = np.array(self.numbers, np.int64)[layer * len(self.begins) + worker]
        found: NDArray[np.int64] = firsts + rows - begins[layer]
        return found
