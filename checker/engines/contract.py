"""The interface of engines: an exploration's task, the reductions it may use, and its result."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from random import Random
from typing import TYPE_CHECKING, Protocol

from checker.engines.edges import Edges
from checker.engines.estimate import Estimate
from checker.limits import Bound, Limits
from semantics.properties.propositions import Proposition
from semantics.state.configuration import Configuration
from semantics.state.requests import Request
from semantics.successors import Expansion

if TYPE_CHECKING:
    from networkx import MultiDiGraph
    from pandas import DataFrame

    from checker.engines.graph import Bools, Graph, Numbers
    from checker.engines.times import Times
    from checker.reduction.reducer import Reduced


class MachineError(Exception):
    """What the machine does not give: workers that start in time and stay, room for an engine. Nothing is decided."""


class CompilerError(Exception):
    """The loops cannot be compiled here."""


class EngineError(Exception):
    """An engine that cannot explore a mission."""


class TickError(EngineError):
    """Times of more ticks than an engine counts."""


class CheckpointError(Exception):
    """A checkpoint that can't be read, or that is of something else."""


@dataclass(frozen=True, slots=True)
class Keeping:
    """What is kept of an exploration, and what is doubted.

    Attributes:
        folder: Where checkpoints are written; None for nowhere.
        resumed: Whether it goes on from the checkpoint that is there.
        digest: What the checkpoint is of.
        every: Seconds between two checkpoints.
        doubted: Of how many configurations it is asked once more what follows, and whether what reductions take for
            granted is so (`--paranoid`).
    """

    folder: str | None = None
    resumed: bool = False
    digest: str = ""
    every: float = 60.0
    doubted: int = 0


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an exploration has come.

    Attributes:
        configurations: How many were met.
        transitions: How many were followed.
        depth: The distance of those that are being expanded.
        frontier: How many wait to be expanded.
        rate: How many are expanded in a second.
        estimate: How many there may be in all; None while nobody can say.
        compiling: Which of the compiled functions is being compiled, counted from 1; 0 when none is.
    """

    configurations: int
    transitions: int
    depth: int
    frontier: int
    rate: float
    estimate: Estimate | None = None
    compiling: int = 0

    @property
    def left(self) -> tuple[float, float] | None:
        """How many seconds it may go on, at least and at most, if layers and rate go on as they do."""
        if self.estimate is None or self.rate <= 0:
            return None
        more = self.estimate.most - self.configurations
        return self.frontier / self.rate, (self.frontier + more) / self.rate


class Engine(Enum):
    """How configurations are expanded; the results are the same."""

    REFERENCE = "reference"
    FAST = "fast"
    RAY = "ray"


@dataclass(frozen=True, slots=True)
class Cluster:
    """With whom `Engine.RAY` explores.

    Attributes:
        workers: How many processes, from 2 on.
        address: The Ray cluster that is joined (`auto` for the one of this machine); None for one of its own, here.
    """

    workers: int = 2
    address: str | None = None


class Surveyed(Protocol):
    """What temporal properties ask of an exploration whose configurations are not at hand one by one."""

    def graph(self) -> Graph:
        """Return every transition of the configurations that were expanded."""

    def valuation(self, asked: Iterable[Proposition]) -> Mapping[Proposition, Bools]:
        """Return where each proposition is true."""

    def is_still(self, asked: Iterable[Proposition]) -> bool:
        """Tell whether nothing that propositions without connectives ask of configurations ever changes."""

    def pending(self) -> Mapping[Request, Numbers]:
        """Return for each request the configurations in which it is pending, in their order."""


Inspect = Callable[[int, Configuration, Expansion], None]
"""What looks at each configuration as it is expanded, given its number."""

Reporter = Callable[[Progress], None]
"""What is told of the progress."""


@dataclass(frozen=True, slots=True)
class Options:
    """How everything is visited.

    Attributes:
        limits: Where to stop.
        report: Told of the progress about once in `every` seconds.
        every: Seconds.
        engine: Whether the rules are run everywhere, or once for each way in which they look at cells.
        edges: Whether every transition is kept, as temporal properties need; explorers with rows find them again.
        reduce: What lets it visit less.
        keeping: What explorers with rows keep on the way, and what is doubted.
        cluster: With whom, on several processes or machines.
        threads: On how many threads the fast engine explores; None for as many as there are cores.
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


@dataclass(slots=True)
class Exploration:
    """What was explored.

    Attributes:
        configurations: In the order of discovery; the first is the initial one.
        origins: For each, the number of the one that it was first reached from (of the initial one, its own).
        depth: How far the farthest is from the initial one.
        expanded: How many of them were expanded: all, unless time ran out.
        transitions: How many transitions there are.
        rules: How many transitions each rule has.
        bounds: Those that were met; empty where the exploration is complete.
        seconds: How long it took.
        compiling: How much of that loops were compiled, which counts to no limit.
        rule_runs: How often an actor's rules were run in Python, where they were learned.
        edges: Every transition, where they were asked for and the reference explorer kept them.
        survey: What explorers with rows can be asked; None of the reference explorer.
        allowed: How many transitions the visited configurations allow; more than `transitions` where it was reduced.
        reducer: What made it visit less, None where it visited everything.
        start: What it started from, where another configuration stands for it.
        times: When everything may be done, where the mission says how long things take.
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
            f"complete={self.complete}>"
        )

    @property
    def size(self) -> int:
        """How many configurations were visited."""
        return len(self.configurations)

    @property
    def complete(self) -> bool:
        """Whether everything reachable was visited."""
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
    """Return so many of the numbers below a size, the same in every run."""
    return sorted(Random(SEED).sample(range(size), min(count, size)))
