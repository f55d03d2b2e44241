"""Exploration of a system: its full transition system, breadth first."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple

from bigraphs.engine.machine import Machine
from bigraphs.state_store import StateStore
from bigraphs.system import System
from bigraphs.transitions import TransitionSystem
from bigraphs.worker_results import Copy, slices_of
from bigraphs.workers import Workers

LOOK_EVERY: Final = 0.2
"""Seconds between two progress reports."""


class ExplorationProgress(NamedTuple):
    """The progress of an exploration."""

    states: int
    transitions: int
    waiting: int
    seconds: float


class OutOfTime(Exception):
    """Ends an exploration inside a state; the transitions of that state are discarded."""


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
    return _Search(system, max_states, max_time, threads, watch).run()


class _Search:
    """An exploration within its limits."""

    def __init__(
        self,
        system: System,
        max_states: int | None,
        max_time: float | None,
        threads: int,
        watch: Callable[[ExplorationProgress], None],
    ) -> None:
        self.begun = time.monotonic()
        self.next_look = self.begun + LOOK_EVERY
        self.end = None if max_time is None else self.begun + max_time
        self.max_states, self.max_time, self.watch = max_states, max_time, watch
        self.process = os.getpid()
        self.machine = Machine(system, self.pause)
        self.reached = StateStore(self.machine, max_states)
        work = partial(slices_of, self.reached)
        self.workers = Workers(threads, work, partial(Copy, self.reached))

    def check_time(self) -> None:
        if self.end is not None and time.monotonic() > self.end:
            raise OutOfTime

    def pause(self) -> None:
        """Report progress inside a state too, since one match may take long; a worker checks only the time limit."""
        if os.getpid() == self.process:
            self.look()
        else:
            self.check_time()

    def run(self) -> TransitionSystem:
        """Explore; return the transition system, with the reason if it ended early."""
        reason = ""
        try:
            self.reached.begin()
            while self.reached.waiting:
                if not self.go_on():
                    reason = f"the limit of {self.max_states:,} states was reached"
                    break
                self.look()
        except OutOfTime:
            reason = f"the limit of {self.max_time:g} seconds was reached"
        except KeyboardInterrupt:
            reason = "it was interrupted"
        finally:
            self.workers.close()
        return self.reached.result(time.monotonic() - self.begun, reason)

    def go_on(self) -> bool:
        """Add the transitions of the next state, or a worker's slice; return whether the state limit allowed it."""
        state, waiting = self.reached.expanded, self.reached.waiting
        self.workers.share(state, len(waiting))
        found = self.workers.found(state, self.look)
        if found is not None:
            copy, answer = found
            return copy.take_over(answer)
        return self.reached.expand(waiting.popleft(), state)

    def look(self) -> None:
        """Check the time limit, and report progress at intervals."""
        self.check_time()
        now = time.monotonic()
        if now >= self.next_look:
            reached = self.reached
            self.watch(
                ExplorationProgress(
                    len(reached), len(reached.targets), len(reached.waiting), now - self.begun
                )
            )
            self.next_look = time.monotonic() + LOOK_EVERY
