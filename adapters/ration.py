"""Rations: of what anybody may send as often as they like, so many a second are kept, and the others counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from typing import Generic, TypeVar

Source = TypeVar("Source", bound=Hashable)


class Ration(Generic[Source]):
    """How much of each source is kept in a second, and how much was not."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._second = 0
        self._met: Counter[Source] = Counter()
        self._left_out: Counter[Source] = Counter()

    def takes(self, source: Source, now: float) -> bool:
        """Count one of a source, and tell whether it is kept."""
        if int(now) != self._second:
            self._second, self._met = int(now), Counter()
        self._met[source] += 1
        if self._met[source] > self._most:
            self._left_out[source] += 1
        return self._met[source] <= self._most

    def left_out(self, now: float | None = None) -> Iterator[tuple[Source, int]]:
        """Yield, once, how many of each source were not kept in the seconds before this one; in all, without a time."""
        if now is None or int(now) != self._second:
            yield from self._left_out.items()
            self._left_out = Counter()
