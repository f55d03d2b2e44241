"""Effort: a bound on a search in edges, not seconds, so that it ends the same way on every machine."""

from dataclasses import dataclass
from typing import Final

from checker.limits import look

MOST: Final = 8_000_000
LAYER: Final = 250
"""What each layer of a search costs besides its edges: a hundredth of a millisecond or two, as they do."""


class Exhausted(Exception):
    """More would have to be looked at than is worth it."""


@dataclass(slots=True)
class Effort:
    """What is left to be spent."""

    left: int = MOST

    def spend(self, edges: int) -> None:
        """Count a layer with so many edges.

        Raises:
            Exhausted: Nothing is left.
        """
        look()
        self.left -= edges + LAYER
        if self.left < 0:
            raise Exhausted
