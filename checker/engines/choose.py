"""Choose the engine of an exploration."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol, assert_never, cast, overload

from checker.engines.capabilities import Feature, engines, features
from checker.engines.contract import (
    Cluster,
    CompilerError,
    Engine,
    Exploration,
    Inspect,
    Keeping,
    Options,
    Reporter,
    ZoneClock,
)
from checker.engines.fast.compiled.numba_loading import load_numba
from checker.engines.reference import explore_one_by_one
from checker.limits import Limits
from checker.models import Model, ModelExploration, State, explore_model
from semantics.state.configuration import Configuration

if TYPE_CHECKING:
    from checker.reduction.reducer import Reduced


class Mission(Protocol):
    """What an exploration needs of a mission."""

    @property
    def initial(self) -> Configuration:
        """The first configuration."""


@overload
def explore(
    initial: Configuration | Mission,
    inspect: Iterable[Inspect] = (),
    limits: Limits | None = None,
    report: Reporter | None = None,
    every: float = 0.5,
    engine: Engine = Engine.REFERENCE,
    *,
    edges: bool = False,
    reduce: Reduced | None = None,
    keeping: Keeping | None = None,
    cluster: Cluster | None = None,
    threads: int | None = None,
    clock: ZoneClock = ZoneClock.LOCAL,
) -> Exploration: ...
@overload
def explore(
    initial: Model[State],
    *,
    limits: Limits | None = None,
    report: Reporter | None = None,
    every: float = 0.5,
) -> ModelExploration[State]: ...
def explore(  # noqa: PLR0913 - independent options, passed by name
    initial: Configuration | Mission | Model[State],
    inspect: Iterable[Inspect] = (),
    limits: Limits | None = None,
    report: Reporter | None = None,
    every: float = 0.5,
    engine: Engine = Engine.REFERENCE,
    *,
    edges: bool = False,
    reduce: Reduced | None = None,
    keeping: Keeping | None = None,
    cluster: Cluster | None = None,
    threads: int | None = None,
    clock: ZoneClock = ZoneClock.LOCAL,
) -> Exploration | ModelExploration[State]:
    """Visit the configurations of a mission, or those that are reachable from one, or a model's states, breadth-first.

    Each of `inspect` sees each configuration as it is expanded, in the order of discovery. The other arguments are the
    attributes of `Options`. The transitions of a model are always kept.

    Raises:
        CombinationError: Two options do not work together, or one with the mission or the model.
        TypeError: A model is given with inspections, which are about configurations; or neither is given.
    """
    if not isinstance(initial, Configuration) and not hasattr(initial, "successors"):
        start = getattr(initial, "initial", None)
        if not isinstance(start, Configuration):
            raise TypeError("explore takes a mission, a configuration, or a model with `successors`")
        initial = start
    is_model, names = not isinstance(initial, Configuration), () if reduce is None else reduce.names
    options = Options(
        limits or Limits(),
        report,
        every,
        engine,
        edges or is_model,
        reduce,
        keeping or Keeping(),
        cluster or Cluster(),
        threads,
        clock,
    )
    asked = features(options.limits, keeping, names, cluster=cluster, threads=threads)
    if not isinstance(initial, Configuration):
        engines(asked | {Feature.MODEL}, engine)
        if tuple(inspect):
            raise TypeError("inspections are about configurations: ask the exploration of a model afterwards")
        return explore_model(cast("Model[State]", initial), options)
    engines(asked if initial.setting.timing is None else asked | {Feature.TIMING}, engine)
    return explore_by(initial, tuple(inspect), options)


def explore_by(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    """Visit the reachable configurations with these options, which work together."""
    if initial.setting.timing is not None:
        return _explore_in_time(initial, inspect, options)
    match options.engine:
        case Engine.REFERENCE:
            return explore_one_by_one(initial, inspect, options)
        case Engine.FAST:
            return _explore_fast(initial, inspect, options)
        case Engine.RAY:
            from checker.engines.cluster.ray_crew import explore_with_ray  # noqa: PLC0415  # Ray is an extra

            return explore_with_ray(initial, inspect, options)
        case _:
            assert_never(options.engine)


def _explore_in_time(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    if options.engine is Engine.FAST:
        load_numba()
        from checker.engines.zones.explorer import explore_in_zones  # noqa: PLC0415  # numba takes its time to load

        return explore_in_zones(initial, inspect, options)
    from checker.engines.timed.digital_clocks import explore_in_ticks  # noqa: PLC0415 - few missions speak of time

    return explore_in_ticks(initial, inspect, options)


def _explore_fast(initial: Configuration, inspect: tuple[Inspect, ...], options: Options) -> Exploration:
    load_numba()
    try:
        from checker.engines.fast.explorer import explore_fast  # noqa: PLC0415  # numba takes its time to load
    except RuntimeError as error:
        if "locator" not in str(error):
            raise
        raise CompilerError("numba has no writable folder here for its compiled loops") from error
    return explore_fast(initial, inspect, options)
