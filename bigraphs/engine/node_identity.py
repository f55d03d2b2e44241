"""Node identity across a step: the nodes of a state that survive in the next state."""

from __future__ import annotations

from collections.abc import Iterator

from bigraphs.engine.machine import RewritingStep
from bigraphs.engine.occurrences import Spot
from bigraphs.engine.state_arrays import GroundState, bits


def identities(spot: Spot, step: RewritingStep) -> Iterator[tuple[int, int]]:
    """Yield the number of each surviving node before a step with its number after it.

    A node outside the redex survives. A node of the redex survives if it is in the reactum
    (`bigraphs.engine.tracking`). The numbers are those in the bigraphs that `to_bigraph` returns for the two states.
    """
    before, after = _numbers(spot.state), _numbers(step.target.state)
    for slot, number in before.items():
        if slot in after and not step.target.lost >> slot & 1:
            yield number, after[slot]


def _numbers(state: GroundState) -> dict[int, int]:
    """Return the number of each slot in the bigraph of a state: named nodes first, by name."""
    names = state.world.name_of

    def key(slot: int) -> tuple[bool, str, int]:
        name = names[state.labels[slot]]
        return name is None, name or "", slot

    return {slot: number for number, slot in enumerate(sorted(bits(state.occupied()), key=key))}
