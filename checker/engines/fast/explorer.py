"""The fast explorer's search: breadth-first over learned trees, with the reference explorer's bounds."""

import errno
import gc
import math
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from bigraphs.resources import cores
from checker.engines.contract import Exploration, Inspect, Options, Progress, sample
from checker.engines.estimate import estimate
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.search.checkpoint import Journey, resume, save
from checker.engines.fast.search.compile_progress import compilation_uncounted
from checker.engines.fast.search.row_search import RowSearch, choosing, exchanging
from checker.engines.fast.survey.row_graph import GraphSurvey
from checker.engines.fast.survey.row_inspection import inspect_fast
from checker.engines.made_on_access import MadeOnAccess
from checker.limits import EXPLORING, Bound, BoundMet, CheckPart, Limits, Stop, bounded, is_full, memory_left
from semantics.state.configuration import Configuration

CHUNK = 1 << 15
"""Rows expanded between two checks of the clock."""

OBJECTS_BETWEEN_COLLECTIONS = 200_000
"""The threshold of garbage collection: scanning all learned data every 700 objects takes a quarter of learning time."""

HOLDING = 0.0005
"""The thread switch interval in seconds while rules run; Python's 5 ms are as long as ten loops."""


def explore_fast(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Explore all reachable configurations, running the rules once for each distinct sequence of answers.

    Raises:
        CheckpointError: The checkpoint to resume from is damaged, or of another mission or limit.
    """
    with compilation_uncounted(options) as counted, seldom_disturbed():
        found = _Explorer(initial, counted).run(inspect)
        found.compiling = counted.limits.uncounted.seconds
        return found


@contextmanager
def seldom_disturbed() -> Iterator[None]:
    """Adapt garbage collection and thread switching to an exploration; restore them afterwards."""
    thresholds, interval = gc.get_threshold(), sys.getswitchinterval()
    if thresholds[0]:  # 0 disables collection
        gc.set_threshold(max(thresholds[0], OBJECTS_BETWEEN_COLLECTIONS), *thresholds[1:])
    sys.setswitchinterval(min(interval, HOLDING))
    try:
        yield
    finally:
        gc.set_threshold(*thresholds)
        sys.setswitchinterval(interval)


class _Explorer:
    def __init__(self, initial: Configuration, options: Options) -> None:
        self.options = options
        self.initial = initial
        self.limits = limits = options.limits
        self.keeping = options.keeping
        self.learner = Learner(initial.setting, initial.state, limits.pending)  # type: ignore[arg-type]  # a stored one
        self.reduce = options.reduce
        self.search = RowSearch(
            self.learner,
            limits.configurations,
            choosing(self.learner, self.reduce),
            exchanging(self.learner, self.reduce),
            options.threads or cores(),
        )
        self.search.store.left = self.left
        self.journey = Journey(0, 1, 0.0)
        self.layers = [1]
        self.bounds: list[Bound] = []
        self.exploring = 1.0
        self.is_kept = False

    @property
    def checkpoint(self) -> Path | None:
        """The path of the checkpoint, None without a folder; the search for stale observations has its own file."""
        name = "monitored.checkpoint" if self.learner.setting.monitored else "exploration.checkpoint"
        return None if self.keeping.folder is None else Path(self.keeping.folder) / name

    @property
    def digest(self) -> str:
        """The digest of the exploration that a checkpoint belongs to; reductions visit other configurations."""
        return self.keeping.digest + ("" if self.reduce is None else f", {self.reduce.identity}")

    def run(self, inspect: tuple[Inspect, ...]) -> Exploration:
        began = time.monotonic()
        self.exploring = EXPLORING if inspect or self.keeping.doubted else 1.0
        path = self.checkpoint
        if path is not None and self.keeping.resumed and path.exists():
            self.journey = resume(self.search, self.digest, path)
            self.layers = list(self.journey.layers)
        began -= self.journey.seconds
        with bounded(self.limits if self.limits.spill is None else replace(self.limits, memory=None), began):
            self.visit(began)
        self.keep(time.monotonic() - began)
        search, numbers = self.search, range(self.search.size)
        survey = GraphSurvey(search)
        with bounded(self.limits_of_looking(), began):
            self.look_at(survey, inspect)
        rules = search.rules()
        return Exploration(
            MadeOnAccess(search.model.configuration, numbers),
            MadeOnAccess(search.store.origin, numbers),
            self.journey.depth,
            search.expanded,
            sum(rules.values()),
            rules,
            sorted(self.bounds + self.met(), key=str),
            time.monotonic() - began,
            rule_runs=self.learner.runs,
            survey=survey,
            allowed=int(search.expander.met.used.sum()),
            reducer=self.reduce,
            start=self.initial if self.reduce is not None else None,
        )

    def visit(self, began: float) -> None:
        """Explore until the end or until a bound is met."""
        try:
            self.visit_all(began)
        except BoundMet as met:
            self.bounds.append(met.bound)
        except (OSError, MemoryError) as error:
            self.bounds.append(self.end_of_room(error))

    def look_at(self, survey: GraphSurvey, inspect: tuple[Inspect, ...]) -> None:
        """Inspect the explored configurations within the time limit; an unfinished inspection yields no findings."""
        try:
            if self.keeping.doubted:
                from checker.engines.fast.search.crosscheck import crosscheck  # noqa: PLC0415  # for --paranoid only

                crosscheck(
                    self.search.expander, sample(self.search.expanded, self.keeping.doubted), self.reduce
                )
            inspect_fast(survey, inspect)
        except BoundMet as met:
            self.bounds.append(met.bound.met_in(CheckPart.LOOKING))
        except (OSError, MemoryError) as error:
            self.bounds.append(self.end_of_room(error).met_in(CheckPart.LOOKING))

    def end_of_room(self, error: OSError | MemoryError) -> Bound:
        """Return the bound for exhausted memory, or for exhausted room in files."""
        if isinstance(error, MemoryError) or error.errno == errno.ENOMEM:
            return Bound(Stop.NO_MEMORY)
        return Bound(Stop.NO_ROOM, (self.limits.spill or "memory", error.strerror))

    def limits_of_looking(self) -> Limits:
        """Return the limits of inspection: without the memory limit if exploration met it or spilled to files."""
        full = self.limits.bound(Stop.MEMORY) in self.bounds or self.search.store.spilled
        return replace(self.limits, memory=None) if full else self.limits

    def keep(self, seconds: float) -> None:
        """Write a checkpoint if one is due; a write that fails ends the exploration with a bound."""
        path = self.checkpoint
        if path is None or self.is_kept:
            return
        journey = replace(self.journey, seconds=seconds, layers=tuple(self.layers))
        try:
            save(self.search, journey, self.digest, path)
        except OSError as error:
            unkept = Bound(Stop.NO_CHECKPOINT, (str(path), error.strerror))
            self.bounds += [] if unkept in self.bounds else [unkept]
        self.is_kept = self.limits.interruption.is_due()

    def met(self) -> list[Bound]:
        """Return the bounds that left configurations out."""
        limits, search = self.limits, self.search
        met = {
            Stop.CONFIGURATIONS: search.store.was_cut and limits.configurations is not None,
            Stop.PENDING: search.expander.is_crowded,
        }
        return [limits.bound(stop) for stop, is_met in met.items() if is_met]

    def visit_all(self, started: float) -> None:
        reported = kept = time.monotonic()
        while self.search.expanded < self.search.size:
            self.advance()
            now = time.monotonic()
            if self.is_over(now - started):
                return
            if self.options.report is not None and now - reported >= self.options.every:
                self.options.report(self.progress(now - started))
                reported = now
            if now - kept >= self.keeping.every:
                self.keep(now - started)
                kept = time.monotonic()

    def advance(self) -> None:
        """Expand some rows of a layer; begin the next layer at its end."""
        search, end = self.search, self.journey.layer_end
        search.advance(min(search.expanded + CHUNK, end), end)
        if search.expanded == end and search.size > end:
            self.layers.append(search.size - end)
            self.journey = Journey(self.journey.depth + 1, search.size, self.journey.seconds)

    def is_over(self, seconds: float) -> bool:
        """Return whether time, memory or the user ends the exploration, and record the bound."""
        if (end := self.limits.end(seconds, self.exploring)) is not None:
            self.bounds.append(end)
        elif is_full(self.limits) and not self.makes_room():
            self.bounds.append(self.limits.bound(Stop.MEMORY))
        return bool(self.bounds)

    def left(self) -> float:
        """Return the bytes of memory that are left; infinity as long as rows may still spill to files."""
        may_spill = self.limits.spill is not None and not self.search.store.spilled
        return math.inf if may_spill else memory_left(self.limits)

    def makes_room(self) -> bool:
        """Spill rows to files if that is enabled and not done yet; return whether memory is free again."""
        if self.limits.spill is None or self.search.store.spilled:
            return False
        self.search.spill(Path(self.limits.spill))
        return not is_full(self.limits)

    def progress(self, seconds: float) -> Progress:
        search = self.search
        rate = search.expanded / max(seconds, 1e-9)
        transitions = int(search.expander.counts.used.sum())
        frontier, guess = search.size - search.expanded, estimate(self.layers)
        return Progress(search.size, transitions, self.journey.depth, frontier, rate, guess)
