"""Rations: of what anybody may send as often as they like, so many a second are kept, and the others counted."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Hashable
from typing import Generic, TypeVar

Source = TypeVar("Source", bound=Hashable)


class Ration(Generic[Source]):
    """How much of each source is kept in a second, and how much was not."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._end = -math.inf
        self._met: Counter[Source] = Counter()
        self._left_out: Counter[Source] = Counter()

    def takes(self, source: Source, now: float) -> bool:
        """Count one of a source, and tell whether it is kept."""
        self._end_second(now)
        self._met[source] += 1
        return self._met[source] <= self._most

    def left_out(self, now: float = math.inf) -> tuple[tuple[Source, int], ...]:
        """Return, once, how many of each source were not kept in the seconds that are over."""
        self._end_second(now)
        found, self._left_out = tuple(self._left_out.items()), Counter()
        return found

    def _end_second(self, now: float) -> None:
        if now >= self._end:
            over = {source: met - self._most for source, met in self._met.items() if met > self._most}
            self._left_out.update(over)
            self._met, self._end = Counter(), now + 1.0
