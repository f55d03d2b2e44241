"""The three steps of a stale-observation race, as a trace carries them and every report marks them."""

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from semantics.state.configuration import Label

ROLES: Final = ("sensed", "changed", "acted")
"""The words that mark them, in the order of the steps."""


class RaceSteps(NamedTuple):
    """The numbers of the three steps, from 1.

    Attributes:
        sensed: The observation was sensed.
        changed: Another agent's control changed the answer.
        acted: A control that rests on the answer was served all the same.
    """

    sensed: int
    changed: int
    acted: int

    @property
    def roles(self) -> dict[int, str]:
        """The word of each of the three steps."""
        return dict(zip(self, ROLES, strict=True))

    def told(self, labels: Sequence[Label]) -> Iterator[str]:
        """Yield the three steps line by line, with the labels of the run."""
        by = labels[self.changed - 1].agent
        words = ("sensed", f"changed by {by}", "acted on")
        yield from (f"{what} in step {at}: {labels[at - 1]}" for what, at in zip(words, self, strict=True))
