"""Estimate the total number of configurations from the sizes of layers: a range, none while layers grow.

Nobody knows the size of what was not visited. Layers of interleavings mostly rise and then fall; once they have fallen
for a while, what is left is taken to be no more than if they went on at their slowest recent fall, or fell as slowly as
they rose. Where they rise once more, the range is given up, and was wrong. At least as much as was met there is in any
case.
"""

from collections.abc import Sequence
from itertools import accumulate, pairwise, takewhile
from typing import NamedTuple

BLOCKS = 24
"""How many blocks the layers are put together to, where there are so many: single layers go up and down."""

FALLS = 3
"""So many blocks have to be smaller each than the one before."""

MOST = 20
"""A range up to more than so many times what was met says nothing."""


class Estimate(NamedTuple):
    """How many configurations there are in all: at least, and at most if layers go on falling as they do."""

    least: int
    most: int


def estimate(layers: Sequence[int]) -> Estimate | None:
    """Return how many there may be in all, given the sizes of all layers that were found whole; None while they grow.

    >>> estimate([1, 4, 16, 64])
    >>> estimate([1, 4, 16, 20, 15, 9, 4])
    Estimate(least=69, most=81)
    """
    blocks = _blocks(layers)
    recent = blocks[-FALLS - 1 :]
    falling = all(after < before for before, after in pairwise(recent))
    if len(blocks) < FALLS + 3 or not falling:
        return None
    met, last = sum(layers), blocks[-1]
    slowest = max(after / before for before, after in pairwise(recent))
    most = met + max(last * slowest / (1 - slowest), _rise_up_to(last, blocks))
    return Estimate(met, int(most)) if most <= MOST * met else None


def _blocks(layers: Sequence[int]) -> list[int]:
    """Put layers together, the last ones whole: what is left over stands at the beginning."""
    width = max(1, len(layers) // BLOCKS)
    ends = range(len(layers) % width or width, len(layers) + 1, width)
    sums = [0, *accumulate(layers)]
    return [sums[end] - sums[max(0, end - width)] for end in ends]


def _rise_up_to(size: int, blocks: Sequence[int]) -> int:
    """Return how many there were before blocks first were so large."""
    return sum(takewhile(lambda block: block < size, blocks))
