"""Explore a mission with times by zones, up to the same limits as the reference explorer."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bigraphs.resources import cores
from checker.engines.contract import (
    Exploration,
    Inspect,
    Keeping,
    Options,
    Progress,
    ZoneClock,
    sample,
)
from checker.engines.fast.search.compile_progress import compilation_uncounted
from checker.engines.fast.search.expander import Expander
from checker.engines.made_on_access import MadeOnAccess
from checker.engines.timed.exchanged_clocks import ClockExchange
from checker.engines.timed.original_times import OriginalTimes
from checker.engines.timed.zone_answers import ZoneTimes
from checker.engines.zones.timed_automaton_of import Network
from checker.engines.zones.timed_checkpoint import digest_in, resume, save
from checker.engines.zones.zone_inspection import inspect_zones
from checker.engines.zones.zone_search import CHUNK, Search
from checker.limits import Bound, BoundMet, Limits, Stop, bounded, is_full
from semantics.behaviours.statements import Spawn
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler, Setting

if TYPE_CHECKING:
    from checker.reduction.reducer import Reduced


FEW = 64
"""The zones in local time before the first look at what is shared; then twice as many each time."""


class _Files:
    """The files of a timed search: its checkpoint, and its zones when memory is full.

    Attributes:
        seconds: The time that the search had taken at the checkpoint from which it goes on.
    """

    def __init__(self, network: Network, options: Options) -> None:
        self.network, self.keeping, self.folder = network, options.keeping, options.limits.spill
        self.path = _path(network.learner.setting, self.keeping)
        self.digest = _digest(options, is_local=network.participants is not None)
        self.seconds, self.kept = 0.0, time.monotonic()

    def begin(self) -> None:
        """Begin the search, or go on from the checkpoint."""
        if self.path is not None and self.keeping.resumed and self.path.exists():
            self.seconds = resume(self.network, self.digest, self.path)
        else:
            self.network.begin()

    def keep(self, seconds: float, *, always: bool) -> list[Bound]:
        """Write a checkpoint if one is due; return a bound if it can't be written."""
        if self.path is None or not (always or time.monotonic() - self.kept >= self.keeping.every):
            return []
        try:
            save(self.network, seconds, self.digest, self.path)
        except OSError as error:
            return [Bound(Stop.NO_CHECKPOINT, (str(self.path), error.strerror))]
        self.kept = time.monotonic()
        return []

    def makes_room(self, search: Search, limits: Limits) -> bool:
        """Spill to files if that is enabled and not done yet; return whether memory is free again."""
        if self.folder is None:
            return False
        folder, self.folder = Path(self.folder), None
        self.network.spill(folder)
        search.spill(folder)
        return not is_full(limits)


def _path(setting: Setting, keeping: Keeping) -> Path | None:
    """Return the path of the checkpoint."""
    name = "monitored" if setting.monitored else "exploration"
    return None if keeping.folder is None else Path(keeping.folder) / f"{name}.timed.checkpoint"


def _digest(options: Options, *, is_local: bool) -> str:
    """Return the digest of the searches that may go on from a checkpoint."""
    digest = options.keeping.digest
    if options.reduce is not None:  # it reaches other rows
        digest += f", {options.reduce.identity}"
    if is_local:  # it may reach more rows before it knows all participants
        digest += ", local time"
    return digest


class _Learning(Search):
    """A search that unfolds the locations it reaches."""

    def __init__(self, network: Network, threads: int) -> None:
        self.network = network
        is_local = network.participants is not None
        start = network.automaton, network.first, network.first_ages
        super().__init__(*start, is_local=is_local, threads=threads)

    def learn(self) -> None:
        """Work out the edges of all reached locations."""
        self.network.leave(self.waiting())


def explore_in_zones(initial: Configuration, inspect: Iterable[Inspect], options: Options) -> Exploration:
    """Visit the configurations that are reachable in time, then show each to the inspections.

    Raises:
        TickError: A constant is too large.
    """
    inspect, started = tuple(inspect), time.monotonic()
    found, uncounted = Exploration([], []), options.limits.uncounted
    with compilation_uncounted(options) as counted:
        uncounted = counted.limits.uncounted
        network = Network(
            initial, options.limits.pending, _exchange(options), local=_is_local(initial, options)
        )
        files = _Files(network, counted)
        files.begin()
        started -= files.seconds
        search = _Learning(network, options.threads or cores())
        within = counted.limits if counted.limits.spill is None else replace(counted.limits, memory=None)
        try:
            with bounded(within, started):
                _visit_all(network, search, files, found, counted, started)
                _doubt(network, options.keeping.doubted, options.reduce)
        except BoundMet as met:
            found.bounds.append(met.bound)
        except OSError as error:  # files or memory have no room for growth
            found.bounds.append(Bound(Stop.NO_ROOM, (options.limits.spill or "memory", error.strerror)))
        found.bounds += files.keep(time.monotonic() - started, always=True)
    times = ZoneTimes(network, search)
    if search.is_local and (search.is_far or network.crowded(times.reached)):
        spent = options.limits.spent + time.monotonic() - started
        anew = replace(options.keeping, resumed=False)  # the checkpoint is of local time
        limits = replace(options.limits, spent=spent)
        once_more = replace(options, clock=ZoneClock.GLOBAL, limits=limits, keeping=anew)
        return explore_in_zones(initial, inspect, once_more)
    if network.crowded(times.reached):
        found.bounds.append(options.limits.bound(Stop.PENDING))
    _summarise(times, found)
    inspect_zones(times, inspect)
    if network.exchange is not None:
        found.times, found.reducer = OriginalTimes(times, network.exchange), options.reduce
        found.start = initial
    found.seconds, found.compiling = time.monotonic() - started, uncounted.seconds
    return found


def _is_local(initial: Configuration, options: Options) -> bool:
    """Whether to search in local time."""
    return (
        options.clock is ZoneClock.LOCAL
        and not why_global(initial)
        and _exchange(options) is None
        and not _goes_on_with_one_clock(initial.setting, options)
    )


def why_global(initial: Configuration) -> str:
    """Return why a mission is always searched by one clock, empty if local time is sound and may gain something."""
    setting = initial.setting
    if setting.scheduler is Scheduler.FCFS:
        return "fcfs has one queue of all requests"
    if any(isinstance(each, Spawn) for each in setting.program.statements):
        return "spawn makes new bigActors"
    if len(initial.alpha.names()) + len(setting.environment) == 1:
        return "the mission has a single bigActor and no environment"
    return ""


def _goes_on_with_one_clock(setting: Setting, options: Options) -> bool:
    """Whether the search goes on from a checkpoint of one that had one clock, or had gone over to it."""
    path = _path(setting, options.keeping)
    if path is None or not options.keeping.resumed or not path.exists():
        return False
    return digest_in(path) == _digest(options, is_local=False)


def _exchange(options: Options) -> ClockExchange | None:
    symmetry = None if options.reduce is None else options.reduce.symmetry
    return None if symmetry is None else ClockExchange(symmetry)


def _doubt(network: Network, count: int, reduce: Reduced | None) -> None:
    """Compare the learned successors of some rows with the interpreter's.

    Raises:
        Disagreement: They differ.
    """
    if count:
        from checker.engines.fast.search.crosscheck import crosscheck  # noqa: PLC0415  # for --paranoid only

        expander = Expander(network.model)
        network.model.see()
        automaton = network.automaton
        rows = np.unique(automaton.rows.used[automaton.left()])
        crosscheck(expander, rows[sample(len(rows), count)].tolist(), reduce)


def _visit_all(
    network: Network, search: Search, files: _Files, found: Exploration, options: Options, started: float
) -> None:
    reported, goes_on = started, True
    most, zones = options.limits.configurations, FEW if search.is_local else CHUNK
    while goes_on:
        zones = min(2 * zones, CHUNK)  # what is shared shows early
        goes_on = search.advance(zones if most is None else min(zones, max(most - search.count, 0) + 1))
        network.settle()
        if search.is_far:
            return
        if network.outgrown:  # a constant has grown: zones were extrapolated too far
            network.outgrown = False
            search.again()
            goes_on = True
        now = time.monotonic()
        found.bounds += _stop(search, files, options.limits, now - started, goes_on=goes_on)
        if found.bounds:
            return
        if options.report is not None and now - reported >= options.every:
            options.report(_progress(search, now - started))
            reported = now


def _stop(search: Search, files: _Files, limits: Limits, seconds: float, *, goes_on: bool) -> list[Bound]:
    """Return the bounds that end the search now; keep a checkpoint, or move to files, where that is due."""
    if limits.configurations is not None and search.count > limits.configurations:
        return [limits.bound(Stop.CONFIGURATIONS)]
    if not goes_on:
        return []
    if (end := limits.end(seconds)) is not None:
        return [end]
    try:
        if is_full(limits) and not files.makes_room(search, limits):
            return [limits.bound(Stop.MEMORY)]
    except OSError as error:
        return [Bound(Stop.NO_ROOM, (limits.spill or "memory", error.strerror))]
    return files.keep(seconds, always=False)


def _progress(search: Search, seconds: float) -> Progress:
    waiting = search.count - search.followed
    return Progress(search.count, 0, 0, waiting, search.count / max(seconds, 1e-9))


def _summarise(times: ZoneTimes, found: Exploration) -> None:
    """Record the configurations in the order of discovery, and count each taken transition once."""
    network = times.network
    found.origins = times.search.origins.tolist()
    found.times, found.expanded = times, len(times.order)
    found.configurations = MadeOnAccess(network.configuration, times.order)
    found.depth = times.search.deepest
    names = {number: name for name, number in network.learner.rules.items()}
    rules, counts = np.unique(times.taken_rules(), return_counts=True)
    found.rules = Counter(
        {names[rule]: count for rule, count in zip(rules.tolist(), counts.tolist(), strict=True)}
    )
    found.transitions = found.allowed = found.rules.total()
