"""The interface of engines: an exploration's task, the reductions it may use, and its result."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from random import Random
from typing import TYPE_CHECKING, Protocol

from checker.engines.edges import Edges
from checker.engines.estimate import SizeEstimate
from checker.limits import Bound, Limits
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration
from semantics.state.requests import Request
from semantics.successors import Expansion

if TYPE_CHECKING:
    from networkx import MultiDiGraph
    from pandas import DataFrame

    from checker.engines.graph import Bools, Graph, Numbers
    from checker.engines.timed.answers import Times
    from checker.reduction.reducer import Reduced


class MachineError(Exception):
    """A failure of the machine, such as lost workers or too little memory for an engine; no property is decided."""


class CompilerError(Exception):
    """A machine on which the loops can't be compiled."""


class EngineError(Exception):
    """A mission that an engine can't explore."""


class TickError(EngineError):
    """Times of more ticks than an engine counts."""


class WindowsError(TickError):
    """More timed appearances and disappearances than an engine counts."""

    remedy = "add --engine reference, or give fewer of them times"


class CheckpointError(Exception):
    """A checkpoint that can't be read, or that belongs to another exploration."""


@dataclass(frozen=True, slots=True)
class Keeping:
    """Checkpoints and self-checks of an exploration.

    Attributes:
        folder: The folder for checkpoints; None for none.
        resumed: Whether the exploration continues from the checkpoint in the folder.
        digest: The digest of the mission, the build and the limits that a checkpoint belongs to.
        every: Seconds between two checkpoints.
        doubted: The number of sampled configurations on which successors, and the assumptions of reductions, are
            checked again (`--paranoid`).
    """

    folder: str | None = None
    resumed: bool = False
    digest: str = ""
    every: float = 60.0
    doubted: int = 0


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of an exploration.

    Attributes:
        configurations: The number of configurations found.
        transitions: The number of transitions followed.
        depth: The depth of the configurations that are being expanded.
        frontier: The number of configurations to expand.
        rate: Expansions per second.
        estimate: The estimated total of configurations; None while there is no estimate.
        compiling: The number, from 1, of the function that is being compiled; 0 for none.
    """

    configurations: int
    transitions: int
    depth: int
    frontier: int
    rate: float
    estimate: SizeEstimate | None = None
    compiling: int = 0

    @property
    def left(self) -> tuple[float, float] | None:
        """The least and the most seconds left, if the layers and the rate continue alike."""
        if self.estimate is None or self.rate <= 0:
            return None
        more = self.estimate.most - self.configurations
        return self.frontier / self.rate, (self.frontier + more) / self.rate


class Engine(Enum):
    """The way to expand configurations; all engines give the same results."""

    REFERENCE = "reference"
    FAST = "fast"
    RAY = "ray"


class ZoneClock(Enum):
    """The clock of a search through zones; both give the same answers.

    A zone in local time has a date for each process, so unrelated steps of several are not ordered. Local time is used
    where it is sound: not under `fcfs`, where all agents share one queue, nor with spawned agents or symmetry.
    """

    LOCAL = "local"
    GLOBAL = "global"


@dataclass(frozen=True, slots=True)
class Cluster:
    """The cluster of `Engine.RAY`.

    Attributes:
        workers: The number of processes, at least 2.
        address: The Ray cluster to join (`auto` for this machine's); None to start one here.
    """

    workers: int = 2
    address: str | None = None


class Surveyed(Protocol):
    """The whole-exploration queries of temporal properties, for engines that keep rows instead of configurations."""

    def graph(self) -> Graph:
        """Return every transition of the expanded configurations."""

    def valuation(self, asked: Iterable[Proposition]) -> Mapping[Proposition, Bools]:
        """Return the configurations in which each proposition is true."""

    def is_still(self, asked: Iterable[Proposition]) -> bool:
        """Return whether the values read by these atomic propositions never change."""

    def pending(self) -> Mapping[Request, Numbers]:
        """Return for each request the configurations in which it is pending, in order."""


Inspect = Callable[[int, Configuration, Expansion], None]
"""An inspection: receives each configuration as it is expanded, with its number."""

Reporter = Callable[[Progress], None]
"""A function that receives the progress."""


@dataclass(frozen=True, slots=True)
class Options:
    """The options of an exploration.

    Attributes:
        limits: The bounds of the exploration.
        report: Receives the progress about once in `every` seconds.
        every: Seconds between two reports.
        engine: The engine.
        edges: Whether to keep every transition, for temporal properties; explorers with rows recompute them instead.
        reduce: The reductions to apply.
        keeping: Checkpoints and self-checks, for explorers with rows.
        cluster: The workers of the engine Ray.
        threads: The most threads of the fast engine; None for one for each core.
        clock: The clock of a search through zones.
    """

    limits: Limits = field(default_factory=Limits)
    report: Reporter | None = None
    every: float = 0.5
    engine: Engine = Engine.REFERENCE
    edges: bool = False
    reduce: Reduced | None = None
    keeping: Keeping = Keeping()
    cluster: Cluster = Cluster()
    threads: int | None = None
    clock: ZoneClock = ZoneClock.LOCAL


@dataclass(slots=True)
class Exploration:
    """The result of an exploration.

    Attributes:
        configurations: The configurations in the order of discovery; the first is the initial one.
        origins: For each configuration the number of its predecessor on a shortest path; the initial one has its own.
        depth: The greatest distance from the initial configuration.
        expanded: The number of expanded configurations; all of them, unless a bound was met.
        transitions: The number of transitions.
        rules: The number of transitions by each rule.
        bounds: The bounds that were met; empty for a complete exploration.
        seconds: The duration.
        compiling: The part of it spent on compiling loops, which counts towards no limit.
        rule_runs: How often the engine ran an actor's rules in Python to learn them.
        edges: Every transition, if the reference explorer kept them.
        survey: The queries of explorers with rows; None from the reference explorer.
        allowed: The number of enabled transitions in the visited configurations; a reduction follows fewer.
        reducer: The reductions that were applied, None without.
        start: The configuration it started from, where another one represents that.
        times: The answers about time, for a mission with timing.
    """

    configurations: Sequence[Configuration]
    origins: Sequence[int]
    depth: int = 0
    expanded: int = 0
    transitions: int = 0
    rules: Counter[str] = field(default_factory=Counter)
    bounds: list[Bound] = field(default_factory=list)
    seconds: float = 0.0
    compiling: float = 0.0
    rule_runs: int | None = None
    edges: Edges | None = None
    survey: Surveyed | None = None
    allowed: int = 0
    reducer: Reduced | None = None
    start: Configuration | None = None
    times: Times | None = None

    def __repr__(self) -> str:
        return (
            f"<Exploration configurations={self.size} transitions={self.transitions} depth={self.depth} "
            f"complete={f'False: {self.bounds[0]}' if self.bounds else True}>"
        )

    @property
    def size(self) -> int:
        """The number of visited configurations."""
        return len(self.configurations)

    @property
    def complete(self) -> bool:
        """Whether all reachable configurations were visited."""
        return not self.bounds

    def to_networkx(self) -> MultiDiGraph[int]:
        """Return the transition system as a graph; raises ValueError where transitions were not kept (`edges=True`).

        A node is the number of a configuration, 0 the initial one, with its `configuration`. An edge has the `rule`,
        the `agent` (None for the environment), `about` and the `label` of its transition.
        """
        from checker.transition_system import to_networkx  # noqa: PLC0415 - graphs are made of explorations

        return to_networkx(self)

    def to_pandas(self) -> DataFrame:
        """Return the transition system as a table (extra `notebook`); raises ValueError as `to_networkx` does.

        A row is a transition: the numbers of its `source` and `target`, its `rule`, `agent` (None for the environment),
        `about` and `label`.
        """
        from checker.transition_system import to_pandas  # noqa: PLC0415 - graphs are made of explorations

        return to_pandas(self)

    def path(self, number: int) -> tuple[int, ...]:
        """Return the numbers of the configurations on a shortest path to one, both ends included."""
        path = [number]
        while path[-1] > 0:
            path.append(int(self.origins[path[-1]]))
        return tuple(reversed(path))


SEED = 20260


def sample(size: int, count: int) -> list[int]:
    """Return a sample of the numbers below a size, the same in every run."""
    return sorted(Random(SEED).sample(range(size), min(count, size)))
