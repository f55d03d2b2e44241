"""Effort: a bound on a search in edges, not seconds, so that its result is the same on every machine."""

from dataclasses import dataclass
from typing import Final

from checker.limits import look

MOST: Final = 8_000_000
LAYER: Final = 250
"""The cost of a layer besides its edges, in edges: about 10 to 20 microseconds."""


class Exhausted(Exception):
    """A search exceeds its effort."""


@dataclass(slots=True)
class Effort:
    """The effort left."""

    left: int = MOST

    def spend(self, edges: int) -> None:
        """Count a layer with so many edges.

        Raises:
            Exhausted: No effort is left.
        """
        look()
        self.left -= edges + LAYER
        if self.left < 0:
            raise Exhausted
