"""Chunks of a layer of zones: any thread makes their successors ahead of the thread that stores them."""

from dataclasses import dataclass
from typing import Protocol

from checker.engines.fast.search.pipeline import Chunk, Pipeline
from checker.engines.zones import keep_zones, make_zones
from checker.engines.zones.zone_tables import (
    AT,
    DONE,
    FULL,
    GATHERED,
    LAYER,
    NEXT,
    STORED,
    WANTED,
    CompiledAutomaton,
    State,
    ZoneBatch,
    Zones,
    new_batch,
)

BOUNDS = 1 << 20
"""The bounds of a batch, if they suffice for one row."""

WORTH = 1 << 5
"""The least number of zones for another thread; a zone takes as long as many rows."""


class LayerSearch(Protocol):
    """A search whose layers are divided into chunks.

    Attributes:
        model, zones, state: The tables of the loops, and their state.
        largest: The most rows of a matrix.
        processes: The number of processes with a date.
    """

    model: CompiledAutomaton
    zones: Zones
    state: State
    largest: int
    processes: int

    def end_of_row(self, zone: int) -> int:
        """Return the first end of a row's zones in the layer that is not before a zone."""


@dataclass(slots=True, eq=False)
class ZoneChunk(Chunk):
    """Zones of some rows of a layer: one thread makes their successors.

    Attributes:
        batch: The successors.
        why: Why making ended: at a `MISS`, or when the batch was `FULL`, there are zones left.
    """

    batch: ZoneBatch
    why: int = DONE

    @property
    def is_stored(self) -> bool:
        """Whether all that was made is stored."""
        return bool(self.batch.state[STORED] == self.batch.state[GATHERED])


class ZoneChunks:
    """The chunks ahead of the stored zones; with one thread it is one chunk, as long as its batch has room.

    Attributes:
        search: The search. Other threads read its tables only within a `with` statement, and not after `rest`.
        zones: The zones for which a batch has room.
    """

    def __init__(self, search: LayerSearch, threads: int) -> None:
        self.search = search
        self.pipeline = Pipeline[ZoneChunk](threads, self._make, self._sift, WORTH)
        self.current: ZoneChunk | None = None
        self.spare: list[ZoneBatch] = []
        self.zones, self.breadth = 0, 1.0
        self.shape = (0, 0, 0)

    # --- in any thread

    def _make(self, part: ZoneChunk) -> None:
        search = self.search
        part.why = make_zones.make(
            search.model, search.zones, search.state, part.end, search.largest, part.batch
        )

    def _sift(self, part: ZoneChunk) -> None:
        keep_zones.sift(self.search.model, self.search.zones, self.search.state, part.batch)

    # --- in the thread that stores

    def first(self) -> ZoneChunk:
        """Return the first chunk that is not stored yet, with its successors; let other chunks go ahead."""
        if self.current is None:
            self._fill()
            self.current = self.pipeline.take()
        return self.current

    def _fill(self) -> None:
        pipeline, state = self.pipeline, self.search.state
        begin, last = int(state[AT]) if pipeline.end is None else pipeline.end, int(state[LAYER])
        while not pipeline.is_full and begin < last:
            zones = min(pipeline.fair(last - begin), max(int(self.zones / self.breadth), 1))
            part = self._chunk(
                begin, last if pipeline.threads == 1 else self.search.end_of_row(begin + zones)
            )
            pipeline.add(part)
            begin = part.end

    def _chunk(self, begin: int, end: int) -> ZoneChunk:
        batch = self.spare.pop() if self.spare else self.batch()
        batch.state[:] = 0
        batch.state[NEXT] = begin
        return ZoneChunk(begin, end, batch)

    def batch(self, zones: int = 0) -> ZoneBatch:
        """Return an empty batch, with room for so many zones."""
        shape = (self.search.largest, self.search.processes, max(self.zones, zones))
        if shape != self.shape:
            self.spare.clear()
            self.zones = max(shape[2], BOUNDS // shape[0] ** 2)
            self.shape = (*shape[:2], self.zones)
        return new_batch(self.zones, *shape[:2])

    def stored(self) -> int:
        """Leave the first chunk, which is stored, and return why its making had ended."""
        part = self.current
        assert part is not None
        self.current, state = None, part.batch.state
        made = int(state[NEXT]) - part.begin
        self.breadth = max(int(state[GATHERED]) / max(made, 1), 1.0)
        if part.why == FULL and not made:
            self.batch(int(state[WANTED]))
        elif len(self.spare) <= len(self.pipeline.ahead):
            self.spare.append(part.batch)
        if state[NEXT] < part.end:
            self.pipeline.ahead.appendleft(self._chunk(int(state[NEXT]), part.end))
        return part.why

    def __enter__(self) -> None:
        """Let the other threads go on."""
        self.pipeline.go_on()

    def __exit__(self, *_: object) -> None:
        """Let the other threads rest, however the statement ends."""
        self.rest()

    def rest(self) -> None:
        """Let the other threads rest until `first` has new chunks for them; what they have made stays."""
        self.pipeline.rest()

    def drop(self) -> None:
        """Drop what is made and not stored."""
        self.pipeline.drop()
        self.current = None
        self.spare.clear()
