"""Choose the engine of an exploration."""

from collections.abc import Iterable

from checker.engines.contract import Cluster, Engine, Exploration, Inspect, Keeping, Reducer, Report
from checker.engines.reference import explore_one_by_one
from checker.limits import Limits
from semantics.state.configuration import Configuration


def explore(  # noqa: PLR0913 - each is optional, and named where it is used
    initial: Configuration,
    inspect: Iterable[Inspect] = (),
    limits: Limits | None = None,
    report: Report | None = None,
    every: float = 0.5,
    engine: Engine = Engine.REFERENCE,
    *,
    edges: bool = False,
    reduce: Reducer | None = None,
    keeping: Keeping | None = None,
    cluster: Cluster | None = None,
) -> Exploration:
    """Visit everything that is reachable, breadth-first.

    Args:
        initial: Where to start.
        inspect: Called with each configuration as it is expanded, in the order of discovery.
        limits: Where to stop.
        report: Called about once in `every` seconds.
        every: Seconds.
        engine: Whether the rules are run everywhere, or once for each way in which they look at cells.
        edges: Whether every transition is kept, as temporal properties need; the fast explorer finds them again.
        reduce: What lets it visit less; by symmetry only the reference explorer can.
        keeping: What the fast explorer keeps on the way, and what is doubted.
        cluster: With whom, on several processes or machines.
    """
    if engine is Engine.RAY:
        from checker.engines.cluster.ray_crew import explore_with_ray  # noqa: PLC0415  # Ray is an extra

        together = cluster or Cluster()
        return explore_with_ray(initial, tuple(inspect), limits or Limits(), report, every, keeping, together)
    if engine is Engine.FAST:
        from checker.engines.fast.explorer import explore_fast  # noqa: PLC0415  # numba takes its time to load

        return explore_fast(
            initial, tuple(inspect), limits or Limits(), report, every, keeping or Keeping(), reduce
        )
    return explore_one_by_one(
        initial, tuple(inspect), limits or Limits(), report, every, keeping or Keeping(), reduce, edges=edges
    )
