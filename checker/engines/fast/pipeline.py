"""Slices of rows that are expanded ahead of what is stored, by several threads.

Slices are taken in their order by the thread that stores them, so that rows get the numbers that one thread alone would
give them. Where no slice is ready, that thread expands one, too: so no thread waits while there is something to do.
"""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from checker.engines.fast.kernel import AT, GATHERED, LATER, PUT_OFF, SIFTED, Batch, Model, State

EACH = 4
"""Slices for each thread that are ahead of what is stored: one that is expanded, some that wait."""

SHARE = 2
"""Into how many slices for each thread what is to be expanded is divided at least."""

WORTH = 1 << 8
"""From how many rows on a slice is expanded by another thread: handing over takes time, too."""


@dataclass(slots=True, eq=False)
class Slice:
    """Rows that are expanded by one thread.

    Attributes:
        begin, end: Which rows.
        epoch: What was known when it was begun: what it finds is worth nothing once some of that was wrong.
        model: What was known then.
        batch: What it finds.
        state: That of the loops that expand it.
        expanding: What it is waited for by, None while nobody has begun it.
    """

    begin: int
    end: int
    epoch: int
    model: Model
    batch: Batch
    state: State
    expanding: Future[None] | None = None

    @property
    def at(self) -> int:
        """The first row that it did not come to: its end, unless its batch was full before."""
        return int(self.state[AT])

    @property
    def gathered(self) -> int:
        """How many transitions it found."""
        return int(self.state[GATHERED])

    @property
    def sifted(self) -> int:
        """How many of their successors were not found among the rows."""
        return int(self.state[SIFTED])

    def put_off(self) -> Iterator[tuple[int, int, int]]:
        """Yield the rows that were put off: how many transitions and successors came before each."""
        rows = self.batch.later[: LATER * int(self.state[PUT_OFF])].reshape(-1, LATER)
        return ((row, steps, found) for row, steps, found in rows.tolist())


class Pipeline:
    """The slices that are ahead.

    Attributes:
        threads: How many threads there are, with the one that stores.
        expand: Expands a slice, in any thread.
        sift: Looks up what a slice found, which else is done where it is stored.
        ahead: The slices, in their order.
        awaited: The slice that is to be stored next, if it is waited for.
        is_far_ahead: Whether there were more slices ready, when one was taken last, than could be stored just then.
    """

    def __init__(self, threads: int, expand: Callable[[Slice], None], sift: Callable[[Slice], None]) -> None:
        self.threads = threads
        self.expand = expand
        self.sift = sift
        self.awaited: Slice | None = None
        self.is_far_ahead = False
        self.ahead: deque[Slice] = deque()
        self.beside = ThreadPoolExecutor(threads - 1, "expanding") if threads > 1 else None

    @property
    def begin(self) -> int | None:
        """Where the first slice that is ahead begins; None where there is none."""
        return self.ahead[0].begin if self.ahead else None

    @property
    def end(self) -> int | None:
        """Where the last slice that is ahead ends; None where there is none."""
        return self.ahead[-1].end if self.ahead else None

    @property
    def is_full(self) -> bool:
        """Whether as many slices are ahead as there should be."""
        return len(self.ahead) >= (1 if self.beside is None else EACH * self.threads)

    def fair(self, rows: int) -> int:
        """Return how many rows a slice should have at most, so that all threads have some of so many."""
        return rows if self.beside is None else max(rows // (SHARE * self.threads), WORTH)

    def add(self, part: Slice) -> None:
        """Add a slice behind the others, which is expanded by other threads, or by this one when its turn comes."""
        self.ahead.append(part)
        if self.beside is not None and part.end - part.begin >= WORTH:
            part.expanding = self.beside.submit(self._expand_beside, part)

    def _expand_beside(self, part: Slice) -> None:
        """Expand a slice in another thread, and sift it, too, if there are more ready than can be stored just now."""
        self.expand(part)
        if self.is_far_ahead and part is not self.awaited:
            self.sift(part)

    def take(self) -> Slice:
        """Return the first slice when it is expanded; meanwhile this thread expands those that nobody has begun."""
        self.awaited = first = self.ahead.popleft()
        ready = sum(each.expanding is not None and each.expanding.done() for each in self.ahead)
        # Told here: only this thread may look through what is ahead.
        self.is_far_ahead = ready >= self.threads
        for part in (first, *self.ahead):
            if part.expanding is None or part.expanding.cancel():
                part.expanding = Future()
                self.expand(part)
                part.expanding.set_result(None)
            if first.expanding is not None and first.expanding.done():
                break
        assert first.expanding is not None
        first.expanding.result()
        self.awaited = None
        return first

    def rest(self) -> None:
        """Let no thread expand anything any more; what was begun is finished, and stands."""
        for part in self.ahead:
            if part.expanding is not None and part.expanding.cancel():
                part.expanding = None
        for part in self.ahead:
            if part.expanding is not None:
                part.expanding.result()

    def drop(self) -> None:
        """Forget the slices that are ahead."""
        self.rest()
        self.ahead.clear()

    def divide(self, work: Callable[[range], Any], parts: int) -> list[Any]:
        """Do some work with ranges of so many parts, in all threads; nothing else is done meanwhile."""
        self.rest()
        bounds = [parts * k // self.threads for k in range(self.threads + 1)]
        ranges = [range(begin, end) for begin, end in pairwise(bounds) if begin < end]
        begun = [self.beside.submit(work, each) for each in ranges[1:]] if self.beside is not None else []
        return [work(ranges[0]), *(each.result() for each in begun)]
