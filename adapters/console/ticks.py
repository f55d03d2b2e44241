"""The ticks of the time line: the times of events in the whole recording."""

from __future__ import annotations

from collections import Counter
from typing import Final

from adapters.console.mutable_facts import Draft

MOST: Final = 2_000


def tick(draft: Draft, time: float, sort: str) -> None:
    """Add a tick; above `MOST`, every second tick of the commonest sort is dropped."""
    draft.ticked += 1
    draft.ticks[str(draft.ticked)] = (time, sort)
    if len(draft.ticks) > MOST:
        ((commonest, _),) = Counter(said for _, said in draft.ticks.values()).most_common(1)
        numbers = [number for number, (_, said) in draft.ticks.items() if said == commonest]
        for number in numbers[1::2]:
            del draft.ticks[number]
