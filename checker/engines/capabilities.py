"""What works together: the pairs of features that an exploration does not combine, each with its reason and remedy.

The command line, `check` and `explore` ask this table alone, and docs/reference/cli.md shows it. A pair without a row
works; to admit a pair, delete its row.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Final

from checker.engines.contract import Cluster, Engine, EngineError, Keeping
from checker.limits import Limits
from checker.reduction.refusals import Reduction


class Feature(Enum):
    """A feature of an exploration, as users know it."""

    REFERENCE = "--engine reference"
    FAST = "--engine fast"
    RAY = "--engine ray"
    WORKERS = "--workers"
    THREADS = "--threads"
    POR = "--reduce por"
    SYMMETRY = "--reduce symmetry"
    TIMING = "a section timing"
    CHECKPOINT = "--checkpoint"
    RESUME = "--resume"
    SPILL = "--spill"
    MEMORY = "--max-memory"
    PARANOID = "--paranoid"
    WAYS = "--ways"
    ATOMIC = "--control atomic"
    RUNS = "ltl, ctl, progress"
    MODEL = "a model of your own"


class Why(Enum):
    """Why two features do not combine."""

    MATHEMATICS = "by mathematics"
    DESIGN = "by design"
    UNDECIDED = "accepted; some properties stay incomplete"

    @property
    def is_refusal(self) -> bool:
        """Whether such a pair is an error."""
        return self is not Why.UNDECIDED


@dataclass(frozen=True, slots=True)
class UnsupportedPair:
    """A pair that does not work, or not fully.

    Attributes:
        one: A feature.
        other: The other feature.
        why: Whether it cannot work, or leaves some properties undecided.
        reason: The message.
        remedy: What to do instead.
        unless: Features of which each lifts the refusal.
    """

    one: Feature
    other: Feature
    why: Why
    reason: str
    remedy: str
    unless: frozenset[Feature] = frozenset()

    def is_met(self, asked: frozenset[Feature]) -> bool:
        """Return whether an exploration asks for this pair."""
        return {self.one, self.other} <= asked and not self.unless & asked


@dataclass(frozen=True, slots=True)
class OptionNeed:
    """A feature that is nothing without another one, as `UnsupportedPair`."""

    one: Feature
    other: Feature
    reason: str
    remedy: str

    def is_met(self, asked: frozenset[Feature]) -> bool:
        """Return whether an exploration asks for the one without the other."""
        return self.one in asked and self.other not in asked


_P, _N, _F, _W = UnsupportedPair, OptionNeed, Feature, Why
_ENGINE, _REDUCE = "leave --engine out", "leave --reduce out"

UNSUPPORTED: Final = (
    _P(_F.REFERENCE, _F.THREADS, _W.DESIGN, "--threads works with the fast engine only",
        "leave --engine out, or give --workers with --engine ray"),
    _P(_F.RAY, _F.THREADS, _W.DESIGN, "--threads works with the fast engine only",
        "leave --engine out, or give --workers with --engine ray"),
    _P(_F.REFERENCE, _F.CHECKPOINT, _W.DESIGN, "--checkpoint works with the fast and Ray engines only", _ENGINE),
    _P(_F.REFERENCE, _F.SPILL, _W.DESIGN, "--spill works with the fast and Ray engines only", _ENGINE),
    _P(_F.REFERENCE, _F.PARANOID, _W.DESIGN, "--paranoid works with the fast and Ray engines and with reductions only",
        _ENGINE, frozenset({_F.POR, _F.SYMMETRY})),
    _P(_F.RAY, _F.TIMING, _W.DESIGN, "the engine 'ray' does not explore missions with a section 'timing': each process "
        "would need the whole timed automaton, and two take more memory than one", _ENGINE),
    _P(_F.POR, _F.TIMING, _W.MATHEMATICS, "the reduction 'por' is refused: it is not sound for missions with a "
        "section 'timing', whose clock orders independent steps", _REDUCE),
    _P(_F.TIMING, _F.RUNS, _W.UNDECIDED,
        "properties of runs without times are not decided", "ask for times: within, time"),
    _P(_F.MODEL, _F.FAST, _W.DESIGN, "the other engines learn the rules of missions", "leave engine out"),
    _P(_F.MODEL, _F.RAY, _W.DESIGN, "the other engines learn the rules of missions", "leave engine out"),
    _P(_F.MODEL, _F.POR, _W.DESIGN, "the reduction 'por' is made for the rules of missions", "leave reduce out"),
    _P(_F.MODEL, _F.SYMMETRY, _W.DESIGN, "the reduction 'symmetry' is made for the rules of missions",
        "leave reduce out"),
    _P(_F.WAYS, _F.ATOMIC, _W.MATHEMATICS,
        "ways are those of flights, and with 'control atomic' nothing is under way",
        "check it with --control timed"),
    _P(_F.WAYS, _F.POR, _W.MATHEMATICS,
        "ways are compared in every configuration, and 'por' leaves configurations out", _REDUCE),
    _P(_F.WAYS, _F.SYMMETRY, _W.MATHEMATICS,
        "ways are those of each vehicle, and 'symmetry' visits one of several alike", _REDUCE),
    _P(_F.RUNS, _F.POR, _W.UNDECIDED, "X, enabled, fairness and progress depend on the order of "
        "independent steps (docs/explanation/reduction.md)", _REDUCE),
    _P(_F.RUNS, _F.SYMMETRY, _W.UNDECIDED, "progress and some formulas distinguish interchangeable entities "
        "(docs/explanation/reduction.md)", _REDUCE),
)  # fmt: skip
"""The pairs without a tick; the first one that is met is the error."""

NEEDS: Final = (
    _N(_F.WORKERS, _F.RAY, "--workers and --address work with the Ray engine only",
         "add --engine ray, or leave them out"),
    _N(_F.RESUME, _F.CHECKPOINT, "--resume goes on from a checkpoint", "give its folder: --checkpoint DIR"),
    _N(_F.SPILL, _F.MEMORY, "--spill needs a limit on memory", "give it: --max-memory SIZE"),
)  # fmt: skip
"""The features that need another one."""

ENGINES: Final = {Engine.REFERENCE: _F.REFERENCE, Engine.FAST: _F.FAST, Engine.RAY: _F.RAY}
REDUCTIONS: Final = {Reduction.POR: _F.POR, Reduction.SYMMETRY: _F.SYMMETRY}


class CombinationError(EngineError):
    """Two features that do not work together.

    Attributes:
        remedy: What to do instead.
    """

    def __init__(self, unmet: UnsupportedPair | OptionNeed) -> None:
        super().__init__(unmet.reason)
        self.remedy = unmet.remedy


def features(  # noqa: PLR0913 - each is one aspect of an exploration
    limits: Limits,
    keeping: Keeping | None,
    reductions: Iterable[Reduction],
    *,
    cluster: Cluster | None,
    threads: int | None,
    timing: bool = False,
    ways: bool = False,
    atomic: bool = False,
) -> frozenset[Feature]:
    """Return the features of an exploration, without its engine.

    Args:
        limits: Its limits.
        keeping: Its checkpoints and self-checks.
        reductions: Its reductions.
        cluster: Its workers, if they are given.
        threads: Its threads, if they are given.
        timing: Whether the mission has a section `timing`.
        ways: Whether the report lists the ways of flights.
        atomic: Whether control takes no time in the mission.
    """
    kept = keeping or Keeping()
    asked = {
        Feature.WORKERS: cluster is not None,
        Feature.THREADS: threads is not None,
        Feature.TIMING: timing,
        Feature.WAYS: ways,
        Feature.ATOMIC: atomic,
        Feature.CHECKPOINT: kept.folder is not None,
        Feature.RESUME: kept.resumed,
        Feature.SPILL: limits.spill is not None,
        Feature.MEMORY: limits.memory is not None,
        Feature.PARANOID: kept.doubted > 0,
    }
    return frozenset(REDUCTIONS[each] for each in reductions).union(each for each in asked if asked[each])


def engines(asked: frozenset[Feature], engine: Engine | None = None) -> tuple[Engine, ...]:
    """Return the engines that explore with some features: the given one, else those of one process, the simplest first.

    Without a given engine, `--threads` is only the most threads of an engine that has them.

    Raises:
        CombinationError: No engine does; with the first reason.
    """
    if engine is not None:
        require(asked | {ENGINES[engine]})
        return (engine,)
    require(asked)
    able = tuple(
        each
        for each in (Engine.REFERENCE, Engine.FAST)
        if not any(_unmet((asked | {ENGINES[each]}) - {Feature.THREADS}))
    )
    return able or engines(asked, Engine.FAST)


def require(asked: frozenset[Feature]) -> None:
    """Raise CombinationError at the first pair that does not work."""
    for unmet in _unmet(asked):
        raise CombinationError(unmet)


def _unmet(asked: frozenset[Feature]) -> Iterator[UnsupportedPair | OptionNeed]:
    yield from (pair for pair in UNSUPPORTED if pair.why.is_refusal and pair.is_met(asked))
    yield from (need for need in NEEDS if need.is_met(asked))


def pair_of(one: Feature, other: Feature) -> UnsupportedPair | None:
    """Return the row of two features, None where they work together."""
    return next((pair for pair in UNSUPPORTED if {pair.one, pair.other} == {one, other}), None)


def unsupported_list() -> str:
    """Return the table as a list of Markdown."""
    return "".join(
        f"- `{pair.one.value}` with `{pair.other.value}` ({pair.why.value}): {pair.reason}\n"
        for pair in UNSUPPORTED
    )
