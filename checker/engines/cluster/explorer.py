"""The cluster explorer's leader: a crew of workers explores layer by layer, with the bounds of a single process.

The leader knows the progress of each worker and the checkpoints, but no configurations. If a worker is lost, all
workers return to their last common checkpoint. The search from there is deterministic.
"""

import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from checker.engines.cluster.checkpoints import Latest, read_latest, write_latest
from checker.engines.cluster.crew import Crew, LostError
from checker.engines.cluster.lookup import CrewRows, CrewSurvey, look_at_each
from checker.engines.cluster.merged_findings import is_mergeable, merge
from checker.engines.cluster.numbering import Places
from checker.engines.cluster.rounds import RoundLimits
from checker.engines.cluster.shard import ShardProgress
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
"""The greatest number of losses of workers between two checkpoints."""

ROUND = 1 << 14
"""Rows that a worker expands between two exchanges, for each worker: the size of a parcel stays constant."""

LONGEST = 0.25
"""The greatest time in seconds before workers return to the leader: an interruption takes effect within it."""

Answer = TypeVar("Answer")


class Expedition:
    """An exploration by a crew.

    Attributes:
        crew: The workers.
        initial: The initial configuration.
        folder: The folder of checkpoints, None for no checkpoints.
        is_temporary: Whether the folder is deleted at the end; its checkpoints then only serve lost workers.
        latest: The last common checkpoint.
        layer: The distance of the layer in expansion.
        standings: The progress of each worker.
        bounds: The bounds that ended the exploration early.
        is_lost: Whether the workers must begin, or return to a checkpoint.
        is_kept: Whether the last checkpoint has the present state.
        is_spilled: Whether the workers' rows are in files.
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
        self.reduce = options.reduce
        self.digest = f"{options.keeping.digest}, {limits.configurations}, {limits.pending}"
        self.digest += "" if self.reduce is None else f", {self.reduce.identity}"
        self.folder = self._folder()
        self.latest = self._resumed()
        self.layer = 0
        self.standings: list[ShardProgress] = []
        self.bounds: list[Bound] = []
        self.is_lost = True
        self.is_kept = self.is_spilled = False
        self.losses = 0
        self.began = time.monotonic() - (self.latest.seconds if self.latest else 0.0)
        self.reported = self.kept = time.monotonic()

    def _folder(self) -> Path | None:
        """Return the folder of checkpoints; the search for stale observations has its own."""
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

    # --- the whole exploration --------------------------------------------------------------------------------------

    def run(self, inspect: tuple[Inspect, ...]) -> Exploration:
        """Explore all reachable configurations, and collect the findings of inspections."""
        found = CrewRows(self.crew, self.surely, self.initial.setting)
        if self.keeping.doubted:
            self.surely(self.crosscheck)
        together = tuple(each for each in inspect if is_mergeable(each))
        parts = self.surely(lambda: self.crew.every("inspect", together))
        summaries = self.surely(lambda: self.crew.every("summary"))
        found.places = places = Places.of([boundaries for boundaries, *_ in summaries])
        found.expanded = [standing.expanded for standing in self.standings]
        found.puts_off = self.reduce is not None and self.reduce.putting_off
        found.puts_off = found.puts_off and not any(standing.cut for standing in self.standings)
        found.crowded = any(standing.crowded for standing in self.standings)
        for number, inspection in enumerate(together):
            merge(inspection, [part[number] for part in parts], places)
        look_at_each(found, [each for each in inspect if each not in together])
        rules: Counter[str] = Counter()
        for _, counts, _ in summaries:
            rules.update(counts)
        return Exploration(
            found.configurations,
            found.origins,
            places.depth,
            sum(found.expanded),
            rules.total(),
            rules,
            sorted(self.bounds + self.met(), key=str),
            time.monotonic() - self.began,
            rule_runs=sum(standing.runs for standing in self.standings),
            survey=CrewSurvey(found),
            allowed=sum(allowed for *_, allowed in summaries),
            reducer=self.reduce,
            start=self.initial if self.reduce is not None else None,
        )

    def crosscheck(self) -> None:
        """Check a sample of configurations again."""
        expanded = [standing.expanded for standing in self.standings]
        self.crew.every("crosscheck", expanded, self.keeping.doubted)

    def surely(self, ask: Callable[[], Answer]) -> Answer:
        """Call the crew after the exploration; if a worker is lost, explore its part again and repeat the call."""
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
        """Return the bounds that left configurations out."""
        limits, standings = self.limits, self.standings
        met = {
            Stop.CONFIGURATIONS: any(each.cut for each in standings) and limits.configurations is not None,
            Stop.PENDING: any(each.crowded for each in standings),
        }
        return [limits.bound(stop) for stop, is_met in met.items() if is_met]

    # --- stages ---------------------------------------------------------------------------------------------------

    def visit_all(self) -> None:
        """Explore until the end or until a bound is met."""
        if self.is_lost:
            self.begin()
        if self.is_done():
            return
        while not self.is_done():
            self.go_on()
        if self.bounds or not self.is_temporary:  # a complete search needs no temporary one
            self.save()

    def is_done(self) -> bool:
        """Return whether a bound was met or no row is left to expand."""
        return bool(self.bounds) or all(each.expanded == each.size for each in self.standings)

    def begin(self) -> None:
        """Begin the exploration, or return to the last checkpoint."""
        if self.bounds and not self.is_kept:
            raise MachineError("a worker was lost when a bound was met, and its rows were not kept")
        self.crew.revive()
        self.is_spilled = False
        if self.latest is None:
            self.layer, self.standings = 0, self.crew.every("start")
        else:
            self.layer = self.latest.layer
            self.standings = self.load(self.latest.number)
        self.is_lost = False

    def go_on(self) -> None:
        """Let the workers explore until the leader has something to do, unless a bound is met."""
        now = time.monotonic()
        self.look_at_bounds(now - self.began)
        if self.bounds:
            return
        self.is_kept = False
        stage = RoundLimits(
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
        """Return the seconds until the next report, checkpoint or end of the time limit, at most `LONGEST`."""
        left = [LONGEST]
        if self.options.report is not None:
            left.append(self.reported + self.options.every - now)
        if self.folder is not None:
            left.append(self.kept + self.keeping.every - now)
        if self.limits.seconds is not None:
            left.append(self.limits.seconds - self.limits.spent - (now - self.began))
        return min(left)

    def look_at_bounds(self, seconds: float) -> None:
        """Note a bound if the time limit, a worker's memory limit or the user ends the exploration."""
        limits = self.limits
        if (end := limits.end(seconds)) is not None:
            self.bounds.append(end)
        elif self.is_full():
            self.bounds += self.spill()
            if self.is_full() and not self.bounds:
                self.bounds.append(limits.bound(Stop.MEMORY))

    def is_full(self) -> bool:
        """Return whether some worker exceeds the memory limit."""
        most = self.limits.memory
        return most is not None and max(each.memory for each in self.standings) > most

    def spill(self) -> list[Bound]:
        """Let the workers move their rows to files, if that is enabled and not done yet; return why some could not."""
        folder = self.limits.spill
        if folder is None or self.is_spilled:
            return []
        told = self.crew.every("spill", str(Path(folder).resolve()))
        self.is_spilled, self.standings = True, [standing for _, standing in told]
        return [Bound(Stop.NO_ROOM, (folder, failure)) for failure, _ in told if failure][:1]

    def progress(self, seconds: float) -> Progress:
        """Return the progress of all workers together."""
        size, expanded, transitions = (
            sum(getattr(each, name) for each in self.standings)
            for name in ("size", "expanded", "transitions")
        )
        return Progress(size, transitions, self.layer, size - expanded, expanded / max(seconds, 1e-9))

    # --- checkpoints ----------------------------------------------------------------------------------------------

    def save(self) -> None:
        """Let all workers write a checkpoint if there is a folder, then remove the previous one."""
        if self.folder is None:
            return
        before = self.latest.number if self.latest else 0
        self.crew.every("save", str(self.folder), before + 1, self.digest)
        self.latest = Latest(before + 1, self.layer, time.monotonic() - self.began)
        write_latest(self.folder, self.latest, self.digest, self.crew.size)
        self.crew.every("drop", str(self.folder), before)
        self.losses, self.is_kept = 0, True
        self.kept = time.monotonic()

    def load(self, number: int) -> list[ShardProgress]:
        """Let all workers return to a checkpoint."""
        return self.crew.every("load", str(self.folder), number, self.digest, self.layer)
