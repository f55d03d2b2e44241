"""Estimate the total number of configurations from the sizes of layers: a range, or none while layers grow.

Layers of interleavings mostly rise and then fall. After some falling layers, two extrapolations bound the rest: layers
keep falling at their slowest recent rate, or fall as slowly as they rose. If layers rise again, the estimate was wrong
and is withdrawn. The lower bound is always the number of configurations found.
"""

from collections.abc import Sequence
from itertools import accumulate, pairwise, takewhile
from typing import NamedTuple

BLOCKS = 24
"""The number of blocks that layers are grouped into, since the sizes of single layers fluctuate."""

FALLS = 3
"""The number of consecutive falling blocks before there is an estimate."""

MOST = 20
"""The largest useful ratio of the upper bound to the configurations found."""


class SizeEstimate(NamedTuple):
    """A range for the total number of configurations, if layers keep falling."""

    least: int
    most: int


def estimate(layers: Sequence[int]) -> SizeEstimate | None:
    """Return the estimated total, given the sizes of all complete layers; None while they grow.

    >>> estimate([1, 4, 16, 64])
    >>> estimate([1, 4, 16, 20, 15, 9, 4])
    SizeEstimate(least=69, most=81)
    """
    blocks = _blocks(layers)
    recent = blocks[-FALLS - 1 :]
    falling = all(after < before for before, after in pairwise(recent))
    if len(blocks) < FALLS + 3 or not falling:
        return None
    met, last = sum(layers), blocks[-1]
    slowest = max(after / before for before, after in pairwise(recent))
    most = met + max(last * slowest / (1 - slowest), _rise_up_to(last, blocks))
    return SizeEstimate(met, int(most)) if most <= MOST * met else None


def _blocks(layers: Sequence[int]) -> list[int]:
    """Sum layers by blocks; the last blocks have full width, and the first may be narrower."""
    width = max(1, len(layers) // BLOCKS)
    ends = range(len(layers) % width or width, len(layers) + 1, width)
    sums = [0, *accumulate(layers)]
    return [sums[end] - sums[max(0, end - width)] for end in ends]


def _rise_up_to(size: int, blocks: Sequence[int]) -> int:
    """Return the number of configurations in the blocks before the first of at least this size."""
    return sum(takewhile(lambda block: block < size, blocks))
