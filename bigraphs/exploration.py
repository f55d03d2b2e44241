"""Exploration of a system: its full transition system, breadth first."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from bigraphs.engine.machine import Machine
from bigraphs.resources import memory_taken
from bigraphs.state_store import StateStore
from bigraphs.system import System
from bigraphs.transitions import TransitionSystem
from bigraphs.worker_results import Copy, slices_of
from bigraphs.workers import Workers

if TYPE_CHECKING:
    from bigraphs.saved_search import SavedSearch

LOOK_EVERY: Final = 0.2
"""Seconds between two progress reports."""


class ExplorationProgress(NamedTuple):
    """The progress of an exploration."""

    states: int
    transitions: int
    waiting: int
    seconds: float


@dataclass(frozen=True, slots=True)
class ExplorationLimits:
    """The limits of an exploration, None for none.

    Attributes:
        states: The most states.
        seconds: The most seconds, with those of a saved search.
        memory: The most bytes of this process, or of a worker.
        spill: The folder to which states move when memory ends.
    """

    states: int | None = None
    seconds: float | None = None
    memory: int | None = None
    spill: str | None = None


@dataclass(frozen=True, slots=True)
class Saving:
    """The way in which an exploration is saved.

    Attributes:
        place: The name of the saved search, for messages.
        write: Saves the search, or raises OSError.
        every: Seconds between two calls of `write`; another one follows at the end.
        saved: The saved search to continue from, None to begin anew.
    """

    place: str
    write: Callable[[SavedSearch], None]
    every: float = 60.0
    saved: SavedSearch | None = None


class SearchEnd(Exception):
    """Ends an exploration, maybe inside a state; the transitions of that state are discarded."""


def explore(
    system: System,
    *,
    max_states: int | None = None,
    max_time: float | None = None,
    threads: int = 1,
    watch: Callable[[ExplorationProgress], None] = lambda _: None,
) -> TransitionSystem:
    """Return the transition system of a system; it is marked incomplete if the search stopped early.

    After half a second, up to `threads` processes share the work, where the platform supports fork. The result does not
    depend on their number. `watch` receives regular progress reports. A KeyboardInterrupt ends the search and keeps the
    states found so far.

    Raises:
        BigraphError: If the system cannot run.
    """
    return explore_long(system, ExplorationLimits(max_states, max_time), threads, watch)


def explore_long(
    system: System,
    limits: ExplorationLimits,
    threads: int,
    watch: Callable[[ExplorationProgress], None],
    saving: Saving | None = None,
) -> TransitionSystem:
    """Explore as `explore`; also limit memory, move states to files, save the search and continue a saved one.

    Raises:
        BigraphError: If the system cannot run, or the saved search is damaged.
    """
    return _Search(system, limits, threads, watch, saving).run()


class _Search:
    """An exploration within its limits.

    Attributes:
        begun: The time at which it began; a saved search began earlier.
        is_due: Whether the next moment between two states is one to save it, or to move states to files.
        is_whole: Whether it may be saved: it is no saved search that is still being read.
    """

    def __init__(
        self,
        system: System,
        limits: ExplorationLimits,
        threads: int,
        watch: Callable[[ExplorationProgress], None],
        saving: Saving | None,
    ) -> None:
        self.begun = self.kept = time.monotonic()
        self.next_look = self.begun + LOOK_EVERY
        self.limits, self.watch, self.saving = limits, watch, saving
        self.end = self.memory = math.inf
        self.is_due = self.is_whole = False
        self.process = os.getpid()
        self.machine = Machine(system, self.look)
        self.reached = StateStore(self.machine, limits.states)
        work = partial(slices_of, self.reached)
        self.workers = Workers(threads, work, partial(Copy, self.reached))

    def run(self) -> TransitionSystem:
        """Explore; return the transition system, with the reason if it ended early."""
        reason = ""
        try:
            self.begin()
            self.visit()
        except SearchEnd as ended:
            reason = str(ended)
        except KeyboardInterrupt:  # at any moment
            self.is_whole, reason = False, "it was interrupted"
        finally:
            self.workers.close()
        try:
            if self.is_whole:
                self.save()
        except SearchEnd as ended:
            reason = reason or str(ended)
        return self.reached.result(time.monotonic() - self.begun, reason)

    def begin(self) -> None:
        """Begin with the initial state or with a saved search."""
        if self.saving is not None and self.saving.saved is not None:
            from bigraphs.resumption import resume  # noqa: PLC0415 - few searches are saved

            self.begun -= resume(self.reached, self.saving.saved, self.saving.place)
            self.limit()
        else:
            self.limit()
            self.reached.begin()
        self.is_due = self.is_whole = True

    def limit(self) -> None:
        """Begin to check the limits: a saved search is first read as a whole."""
        self.end = math.inf if self.limits.seconds is None else self.begun + self.limits.seconds
        self.memory = math.inf if self.limits.memory is None else self.limits.memory

    def visit(self) -> None:
        """Explore all states."""
        while self.reached.waiting:
            if self.is_due:
                self.tidy()
            if not self.go_on():
                states = "state" if self.limits.states == 1 else "states"
                raise SearchEnd(f"the limit of {self.limits.states:,} {states} was reached")
            self.look()

    def go_on(self) -> bool:
        """Add the transitions of the next state, or a worker's slice; return whether the state limit allowed it."""
        state, waiting = self.reached.expanded, self.reached.waiting
        self.workers.share(state, len(waiting))
        found = self.workers.found(state, self.look)
        if found is not None:
            copy, answer = found
            return copy.take_over(answer)
        return self.reached.expand_next()

    def look(self) -> None:
        """Check the limits, and report progress at intervals, also inside a state; a worker checks the limits only."""
        now = time.monotonic()
        if now > self.end:
            raise SearchEnd(f"the limit of {self.limits.seconds:g} seconds was reached")
        if now < self.next_look:
            return
        self.next_look, self.is_due = now + LOOK_EVERY, True
        if self.is_full() and not self.may_spill():
            raise SearchEnd(f"the memory limit of {self.memory / 1e6:,.0f} MB was reached")
        if os.getpid() == self.process:
            self.report(now)

    def report(self, now: float) -> None:
        """Report progress; an interruption by the observer ends the exploration."""
        reached = self.reached
        try:
            self.watch(
                ExplorationProgress(
                    len(reached), len(reached.targets), len(reached.waiting), now - self.begun
                )
            )
        except KeyboardInterrupt:
            raise SearchEnd("it was interrupted") from None

    def is_full(self) -> bool:
        """Return whether the process exceeds the memory limit."""
        return self.memory < math.inf and memory_taken() > self.memory

    def may_spill(self) -> bool:
        """Return whether states may still move to files."""
        return self.limits.spill is not None and not self.reached.in_files

    def tidy(self) -> None:
        """Between two states: move states to files if memory ended, and save the search if that is due."""
        self.is_due = False
        try:
            if self.may_spill() and self.is_full():
                self.reached.spill(Path(self.limits.spill or ""))
            self.reached.write()
        except OSError as error:
            raise SearchEnd(f"the free space in {self.limits.spill} ended: {error.strerror}") from error
        if self.saving is not None and time.monotonic() - self.kept >= self.saving.every:
            self.save()

    def save(self) -> None:
        """Save the search, if that was asked for."""
        if self.saving is None:
            return
        from bigraphs.saved_search import save  # noqa: PLC0415 - few searches are saved

        try:
            self.saving.write(save(self.reached, time.monotonic() - self.begun))
        except OSError as error:
            raise SearchEnd(
                f"the checkpoint can't be written to {self.saving.place}: {error.strerror}"
            ) from error
        self.kept = time.monotonic()
