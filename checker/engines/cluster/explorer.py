"""Explore with a crew of workers, layer by layer, up to the same bounds as one process.

Whoever leads knows how far each worker has come and where checkpoints are, and no configurations. When a worker is
lost, all go back to the last checkpoint that all have written; the way from there is the same once more.
"""

import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from checker.engines.cluster.checkpoints import Latest, read_latest, write_latest
from checker.engines.cluster.crew import Crew, LostError
from checker.engines.cluster.lookup import Configurations, Found, Origins, Survey, look_at_each
from checker.engines.cluster.merging import is_mergeable, merge
from checker.engines.cluster.numbering import Places
from checker.engines.cluster.rounds import Stage
from checker.engines.cluster.shard import Standing
from checker.engines.contract import (
    Exploration,
    Inspect,
    MachineError,
    Options,
    Progress,
)
from checker.limits import Bound, Stop
from semantics.state.configuration import Configuration

MOST_LOSSES = 5
"""How often workers may be lost between two checkpoints."""

ROUND = 1 << 14
"""Rows that each worker expands between two exchanges, for each worker that there is: so parcels stay as large."""

LONGEST = 0.25
"""Seconds for which workers go on by themselves at most: so soon the user's wish for the end is noticed."""

Answer = TypeVar("Answer")


class Expedition:
    """An exploration by a crew.

    Attributes:
        crew: The workers.
        initial: Where it starts.
        folder: Where checkpoints are, None for nowhere.
        is_temporary: Whether that is gone when all ends, so that only a worker that dies meanwhile goes back to them.
        latest: The last one.
        layer: How far the rows that are expanded are from the first.
        standings: How far each worker has come.
        bounds: What has ended it early.
        is_lost: Whether a worker has died since all began.
        is_kept: Whether the last checkpoint is of where they are.
    """

    def __init__(
        self, crew: Crew, initial: Configuration, options: Options, *, is_temporary: bool = False
    ) -> None:
        self.crew = crew
        self.is_temporary = is_temporary
        self.initial = initial
        self.options = options
        self.limits = limits = options.limits
        self.keeping = options.keeping
        self.digest = f"{options.keeping.digest}, {limits.configurations}, {limits.pending}"
        self.folder = self._folder()
        self.latest = self._resumed()
        self.layer = 0
        self.standings: list[Standing] = []
        self.bounds: list[Bound] = []
        self.is_lost = True
        self.is_kept = False
        self.losses = 0
        self.began = time.monotonic() - (self.latest.seconds if self.latest else 0.0)
        self.reported = self.kept = time.monotonic()

    def _folder(self) -> Path | None:
        """Return where checkpoints are kept: the search for stale observations has its own."""
        name = "monitored" if self.initial.setting.monitored else "exploration"
        if self.keeping.folder is None:
            return None
        folder = Path(self.keeping.folder).resolve() / f"{name}-ray"  # workers may be in other folders
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def _resumed(self) -> Latest | None:
        if self.folder is None or not self.keeping.resumed:
            return None
        return read_latest(self.folder, self.digest, self.crew.size)

    # --- all the way ----------------------------------------------------------------------------------------------

    def run(self, inspect: tuple[Inspect, ...]) -> Exploration:
        """Visit everything that is reachable, and let inspections have found what there is."""
        found = Found(self.crew, self.surely, self.initial.setting)
        together = tuple(each for each in inspect if is_mergeable(each))
        parts = self.surely(lambda: self.crew.every("inspect", together))
        summaries = self.surely(lambda: self.crew.every("summary"))
        found.places = places = Places.of([boundaries for boundaries, _ in summaries])
        found.expanded = [standing.expanded for standing in self.standings]
        found.crowded = any(standing.crowded for standing in self.standings)
        for number, inspection in enumerate(together):
            merge(inspection, [part[number] for part in parts], places)
        look_at_each(found, [each for each in inspect if each not in together])
        rules: Counter[str] = Counter()
        for _, counts in summaries:
            rules.update(counts)
        return Exploration(
            Configurations(found),
            Origins(found),
            places.depth,
            sum(found.expanded),
            rules.total(),
            rules,
            sorted(self.bounds + self.met(), key=str),
            time.monotonic() - self.began,
            rule_runs=sum(standing.runs for standing in self.standings),
            survey=Survey(found),
            allowed=rules.total(),
        )

    def surely(self, ask: Callable[[], Answer]) -> Answer:
        """Ask the crew when all is explored; if a worker is lost, explore once more what is lost with it."""
        while True:
            try:
                self.visit_all()
                return ask()
            except LostError as lost:
                self.is_lost = True
                self.losses += 1
                if self.losses > MOST_LOSSES:
                    often = f"workers were lost {self.losses} times without a checkpoint between"
                    raise MachineError(f"{often}: {lost}") from lost

    def met(self) -> list[Bound]:
        """Return the bounds that left something out."""
        limits, standings = self.limits, self.standings
        met = {
            Stop.CONFIGURATIONS: any(each.cut for each in standings) and limits.configurations is not None,
            Stop.PENDING: any(each.crowded for each in standings),
        }
        return [limits.bound(stop) for stop, is_met in met.items() if is_met]

    # --- stages ---------------------------------------------------------------------------------------------------

    def visit_all(self) -> None:
        """Go on until all is explored, or a bound is met."""
        if self.is_lost:
            self.begin()
        if self.is_done():
            return
        while not self.is_done():
            self.go_on()
        if self.bounds or not self.is_temporary:  # else the last one is not older than it may ever be
            self.save()

    def is_done(self) -> bool:
        """Tell whether there is nothing to be expanded, or a bound was met."""
        return bool(self.bounds) or all(each.expanded == each.size for each in self.standings)

    def begin(self) -> None:
        """Begin, or go back to the last checkpoint."""
        if self.bounds and not self.is_kept:
            raise MachineError("a worker was lost when a bound was met, and where they were was not kept")
        self.crew.revive()
        if self.latest is None:
            self.layer, self.standings = 0, self.crew.every("start")
        else:
            self.layer = self.latest.layer
            self.standings = self.load(self.latest.number)
        self.is_lost = False

    def go_on(self) -> None:
        """Let the workers go on until there is something to be looked at, unless a bound is met."""
        now = time.monotonic()
        self.look_at_bounds(now - self.began)
        if self.bounds:
            return
        self.is_kept = False
        stage = Stage(
            ROUND * self.crew.size, self.seconds_left(now), self.limits.configurations, self.limits.memory
        )
        explored = self.crew.every("explore", self.layer, stage)
        self.layer, self.standings = explored[0][0], [standing for _, standing in explored]
        now = time.monotonic()
        if self.options.report is not None and now - self.reported >= self.options.every:
            self.options.report(self.progress(now - self.began))
            self.reported = now
        if now - self.kept >= self.keeping.every:
            self.save()

    def seconds_left(self, now: float) -> float:
        """Return how long there is nothing to be looked at: no report, no checkpoint, and no end of the time."""
        left = [LONGEST]
        if self.options.report is not None:
            left.append(self.reported + self.options.every - now)
        if self.folder is not None:
            left.append(self.kept + self.keeping.every - now)
        if self.limits.seconds is not None:
            left.append(self.limits.seconds - self.limits.spent - (now - self.began))
        return min(left)

    def look_at_bounds(self, seconds: float) -> None:
        """Note whether time, or some worker's memory, has come to its end, or the user wants the end."""
        limits = self.limits
        if (end := limits.end(seconds)) is not None:
            self.bounds.append(end)
        elif limits.memory is not None and max(each.memory for each in self.standings) > limits.memory:
            self.bounds.append(limits.bound(Stop.MEMORY))

    def progress(self, seconds: float) -> Progress:
        """Return how far all have come."""
        size, expanded, transitions = (
            sum(getattr(each, name) for each in self.standings)
            for name in ("size", "expanded", "transitions")
        )
        return Progress(size, transitions, self.layer, size - expanded, expanded / max(seconds, 1e-9))

    # --- checkpoints ----------------------------------------------------------------------------------------------

    def save(self) -> None:
        """Let all workers write a checkpoint, if one is wanted; the one before is removed when all have."""
        if self.folder is None:
            return
        before = self.latest.number if self.latest else 0
        self.crew.every("save", str(self.folder), before + 1, self.digest)
        self.latest = Latest(before + 1, self.layer, time.monotonic() - self.began)
        write_latest(self.folder, self.latest, self.digest, self.crew.size)
        self.crew.every("drop", str(self.folder), before)
        self.losses, self.is_kept = 0, True
        self.kept = time.monotonic()

    def load(self, number: int) -> list[Standing]:
        """Let all workers go back to a checkpoint."""
        return self.crew.every("load", str(self.folder), number, self.digest, self.layer)
