"""The settings of a check from the command line's options: limits, engine, checkpoints."""

from argparse import Namespace

from bigactors.checking import How
from bigactors.files import make_folder
from bigactors.mistakes import Mistake
from checker import Cluster, CombinationError, Engine, Keeping, Limits, Reduction
from checker.engines.capabilities import engines, features
from checker.engines.contract import ZoneClock
from checker.limits import MOST_PENDING

MOST, MOST_OF_REFERENCE = 100_000_000, 2_000_000
"""The most configurations visited. Those of the reference explorer take a thousand bytes each."""


def settings_of(options: Namespace) -> tuple[Limits, How]:
    """Return the limits of the exploration and the way in which missions are explored.

    Raises:
        Mistake: Two options do not work together.
    """
    limits, how = _limits_of(options), _how_of(options)
    asked = features(limits, how.keeping, how.reduce, cluster=how.cluster, threads=how.threads, ways=how.ways)
    try:
        engines(asked, how.engine)
    except CombinationError as unmet:
        raise Mistake(str(unmet), unmet.remedy) from unmet
    if limits.spill is not None:
        make_folder(limits.spill)
    return limits, how


def _how_of(options: Namespace) -> How:
    return How(
        options.engine and Engine(options.engine),
        options.violations,
        tuple(map(Reduction, options.reduce)),
        _keeping_of(options),
        _cluster_of(options),
        options.threads,
        ZoneClock(options.clock),
        options.times,
        options.ways,
        any(name == "geojson" for name, _ in options.output),
    )


def _limits_of(options: Namespace) -> Limits:
    usual = MOST_OF_REFERENCE if options.engine == "reference" else MOST
    return Limits(
        options.max_configurations or usual * (options.workers or 1),
        options.max_time,
        pending=options.max_pending or MOST_PENDING,
        memory=options.max_memory,
        spill=options.spill,
    )


def _cluster_of(options: Namespace) -> Cluster | None:
    """Return the workers of the exploration; None without any option of them."""
    if options.workers is None and options.address is None:
        return None
    return Cluster(options.workers or Cluster().workers, options.address)


def _keeping_of(options: Namespace) -> Keeping | None:
    """Return the options on checkpoints and re-checking; None without any."""
    if options.checkpoint is None and options.paranoid is None and not options.resume:
        return None
    return Keeping(options.checkpoint, options.resume, every=options.every, doubted=options.paranoid or 0)
