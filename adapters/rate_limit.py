"""Rate limits: of input from any source, a bounded number a second is kept, and the rest is counted.

Repeated troubles are reported once a second, with their number.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Hashable
from typing import Final, Generic, TypeVar

from adapters.plugin import Trouble, World

Source = TypeVar("Source", bound=Hashable)

LONGEST_PAUSE = 10.0
"""Seconds; longer pauses count as this long."""


class Ration(Generic[Source]):
    """Counts of kept and dropped input by source, for each second.

    Input that arrives at once after a pause without readings came during the pause: its seconds count too.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._kept = float(most)
        self._end = -math.inf
        self._met: Counter[Source] = Counter()
        self._passed: Counter[Source] = Counter()
        self._left_out: Counter[Source] = Counter()

    def takes(self, source: Source, now: float) -> bool:
        """Count one input of a source, and return whether it is kept."""
        self._end_second(now)
        self._met[source] += 1
        return self._met[source] <= self._kept

    def leave_out(self, source: Source) -> None:
        """Count one input of a source as dropped, with those of this second."""
        self._passed[source] += 1

    def left_out(self, now: float = math.inf) -> tuple[tuple[Source, int], ...]:
        """Return, once, the number dropped of each source in the completed seconds."""
        self._end_second(now)
        if not self._left_out:
            return ()
        found, self._left_out = tuple(self._left_out.items()), Counter()
        return found

    def _end_second(self, now: float) -> None:
        if now >= self._end:
            over = {source: met - int(self._kept) for source, met in self._met.items() if met > self._kept}
            self._left_out.update(over)
            self._left_out.update(self._passed)
            pause = min(now - self._end, LONGEST_PAUSE) if math.isfinite(self._end) else 0.0
            self._kept = self._most * (1.0 + pause)
            self._met, self._passed, self._end = Counter(), Counter(), now + 1.0


class Turns(Generic[Source]):
    """A common limit a second for all sources; a source that had its turn waits until the others had theirs."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._end = -math.inf
        self._left = most
        self._apart = 0.0
        self._met: set[Source] = set()
        self._kept: dict[Source, float] = {}

    def takes(self, source: Source, now: float) -> bool:
        """Return whether one input of a source is kept."""
        if now >= self._end:
            self._begin_second(now)
        self._met.add(source)
        if not self._left or now - self._kept.get(source, -math.inf) < self._apart:
            return False
        self._left -= 1
        self._kept[source] = now
        return True

    def _begin_second(self, now: float) -> None:
        """Begin a new second; the interval of turns fits the number of sources in the last second."""
        self._apart = len(self._met) / self._most if len(self._met) > self._most else 0.0
        self._kept = {source: at for source, at in self._kept.items() if now - at < self._apart}
        self._met, self._end, self._left = set(), now + 1.0, self._most


EVERY: Final = 1.0
MAX_KINDS: Final = 64
"""The most kinds of troubles that are counted apart; others are counted together."""


class Troubles:
    """The troubles since the last report, by kind."""

    def __init__(self, source: str) -> None:
        self._source = source
        self._found: dict[str, tuple[str, int]] = {}
        self._reported: float | None = None

    def note(self, what: str, detail: str = "", count: int = 1) -> None:
        """Count one trouble, or several; the first detail of its kind is kept."""
        kind = what if what in self._found or len(self._found) < MAX_KINDS else "other troubles"
        first, before = self._found.get(kind, (detail, 0))
        self._found[kind] = (first, before + count)

    def report(self, world: World, *, now: bool = False) -> None:
        """Report all troubles, if a second has passed since the last report, or at once."""
        time = world.now()
        early = self._reported is not None and time - self._reported < EVERY
        if not self._found or (early and not now):
            return
        for what, (detail, count) in self._found.items():
            world.report(Trouble(self._source, time, what, detail, count))
        self._found.clear()
        self._reported = time
