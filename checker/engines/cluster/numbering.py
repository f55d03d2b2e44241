"""The numbering of configurations: by layer, then by worker.

So numbers grow with the distance from the initial configuration, as with a single process. The smallest of several
numbers belongs to a nearest configuration.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Places:
    """The first rows and numbers of each layer.

    Attributes:
        begins: For each worker, its first row in each layer, and the number of its rows.
        numbers: The first number for each layer and worker, in this order, and the total.
    """

    begins: tuple[tuple[int, ...], ...]
    numbers: tuple[int, ...]

    @staticmethod
    def of(begins: Sequence[Sequence[int]]) -> "Places":
        """Number the rows of workers that all have the same number of layers."""
        layers = range(len(begins[0]) - 1)
        sizes = (each[layer + 1] - each[layer] for layer in layers for each in begins)
        return Places(tuple(map(tuple, begins)), tuple(accumulate(sizes, initial=0)))

    def __len__(self) -> int:
        return self.numbers[-1]

    @property
    def depth(self) -> int:
        """The greatest distance of a configuration from the initial one."""
        return max(0, bisect_left(self.numbers, len(self)) - 1) // len(self.begins)

    def find(self, number: int) -> tuple[int, int]:
        """Return the worker and the row of a configuration."""
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
