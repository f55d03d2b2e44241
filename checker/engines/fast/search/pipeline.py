"""Chunks of rows, or of zones, that several threads expand ahead of the thread that stores them.

One thread stores the chunks in order, so rows get the same numbers as with a single thread. If no chunk is ready, this
thread expands one itself, so no thread idles while there is work.
"""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Generic, NamedTuple, TypeVar

from checker.engines.fast.model.learned_model import (
    AT,
    GATHERED,
    LATER,
    PUT_OFF,
    SIFTED,
    State,
)

EACH = 4
"""The number of chunks ahead for each thread: one in expansion, the others waiting."""

SHARE = 2
"""The least number of chunks for each thread into which the pending rows are divided."""


class ChunkMark(NamedTuple):
    """A place in a chunk: a row, and the numbers of transitions and of successors before it."""

    row: int
    steps: int = 0
    found: int = 0


@dataclass(slots=True, eq=False)
class Chunk:
    """What one thread expands.

    Attributes:
        begin, end: The range of rows or zones.
        expanding: The future of its expansion; None if no thread has begun it.
    """

    begin: int
    end: int
    expanding: Future[None] | None = field(default=None, init=False)


Part = TypeVar("Part", bound=Chunk)


@dataclass(slots=True, eq=False)
class RowChunk(Chunk):
    """Rows that one thread expands.

    Attributes:
        epoch: The epoch at its start; its results are void if the epoch has changed since.
        shape: The shape of its batch.
        tables: The learned tables at its start.
        batch: Its results.
        state: Its copy of the loops' state.
    """

    epoch: int
    shape: tuple[int, int, int]
    tables: Any
    batch: Any
    state: State

    @property
    def stop(self) -> ChunkMark:
        """The end of its results: before its end if the batch was full."""
        return ChunkMark(*map(int, self.state[[AT, GATHERED, SIFTED]]))

    def put_off(self) -> Iterator[ChunkMark]:
        """Yield the deferred rows."""
        rows = self.batch.later[: LATER * int(self.state[PUT_OFF])].reshape(-1, LATER)
        return (ChunkMark(*each) for each in rows.tolist())


class Pipeline(Generic[Part]):
    """The chunks ahead of what is stored.

    Attributes:
        threads: The number of threads, including the one that stores.
        worth: The least size of a chunk for which another thread pays off: handing over takes time.
        expand: Expands a chunk, in any thread.
        sift: Drops the known successors of a chunk; otherwise storing drops them.
        ahead: The chunks, in order.
        awaited: The chunk that the storing thread waits for, if any.
        is_far_ahead: Whether more chunks were ready at the last `take` than can be stored at once.
    """

    def __init__(
        self, threads: int, expand: Callable[[Part], None], sift: Callable[[Part], None], worth: int
    ) -> None:
        self.threads = threads
        self.worth = worth
        self.expand = expand
        self.sift = sift
        self.awaited: Part | None = None
        self.is_far_ahead = False
        self.ahead: deque[Part] = deque()
        self.beside = ThreadPoolExecutor(threads - 1, "expanding") if threads > 1 else None

    @property
    def begin(self) -> int | None:
        """The first row of the first chunk ahead; None if there is none."""
        return self.ahead[0].begin if self.ahead else None

    @property
    def end(self) -> int | None:
        """The end of the last chunk ahead; None if there is none."""
        return self.ahead[-1].end if self.ahead else None

    @property
    def is_full(self) -> bool:
        """Whether enough chunks are ahead."""
        return len(self.ahead) >= (1 if self.beside is None else EACH * self.threads)

    def fair(self, rows: int) -> int:
        """Return the greatest size of a chunk such that all threads get some of `rows` rows."""
        return rows if self.beside is None else max(rows // (SHARE * self.threads), self.worth)

    def add(self, part: Part) -> None:
        """Add a chunk behind the others; another thread expands it, or this one at its turn."""
        self.ahead.append(part)
        self._hand_over(part)

    def _hand_over(self, part: Part) -> None:
        if self.beside is not None and part.end - part.begin >= self.worth:
            part.expanding = self.beside.submit(self._expand_beside, part)

    def _expand_beside(self, part: Part) -> None:
        """Expand a chunk in another thread, and sift it if storing lags behind."""
        self.expand(part)
        if self.is_far_ahead and part is not self.awaited:
            self.sift(part)

    def take(self) -> Part:
        """Return the first chunk once it is expanded; meanwhile expand chunks that no thread has begun."""
        self.awaited = first = self.ahead.popleft()
        ready = sum(each.expanding is not None and each.expanding.done() for each in self.ahead)
        # Decided here, since only this thread may iterate over `ahead`.
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
        """Stop the other threads: cancel chunks not begun, and await those in expansion; their results stay valid."""
        for part in self.ahead:
            if part.expanding is not None and part.expanding.cancel():
                part.expanding = None
        for part in self.ahead:
            if part.expanding is not None:
                part.expanding.result()

    def go_on(self) -> None:
        """Let the other threads go on after a rest."""
        for part in self.ahead:
            if part.expanding is None:
                self._hand_over(part)

    def drop(self) -> None:
        """Discard the chunks ahead."""
        self.rest()
        self.ahead.clear()

    def divide(self, work: Callable[[range], Any], parts: int) -> list[Any]:
        """Run some work on ranges of `parts` parts in all threads, after stopping all expansion."""
        self.rest()
        bounds = [parts * k // self.threads for k in range(self.threads + 1)]
        ranges = [range(begin, end) for begin, end in pairwise(bounds) if begin < end]
        begun = [self.beside.submit(work, each) for each in ranges[1:]] if self.beside is not None else []
        return [work(ranges[0]), *(each.result() for each in begun)]
