"""The settings of a check from the command line's options: limits, engine, checkpoints."""

from argparse import Namespace

from bigactors.checking import How
from bigactors.long_runs import checkpoint_folder, spill_folder
from bigactors.mistakes import Mistake
from checker import Cluster, Engine, Keeping, Limits, Reduction
from checker.limits import MOST_PENDING

MOST, MOST_OF_REFERENCE = 100_000_000, 2_000_000
"""The most configurations visited. Those of the reference explorer take a thousand bytes each."""


def how_of(options: Namespace) -> How:
    """Return the way in which missions are explored."""
    if options.times and options.engine not in (None, "reference"):
        raise Mistake("--times works with the reference engine only", "leave --engine out")
    return How(
        options.engine and Engine(options.engine),
        options.violations,
        tuple(map(Reduction, options.reduce)),
        keeping_of(options),
        cluster_of(options),
        threads_of(options),
        options.times,
    )


def limits_of(options: Namespace) -> Limits:
    """Return the limits of the exploration."""
    spill = spill_folder(options)
    if spill is not None and options.engine in ("reference", "ray"):
        raise Mistake("--spill works with the fast engine only", "leave --engine out")
    most, memory = most_of(options), options.max_memory
    pending = options.max_pending or MOST_PENDING
    return Limits(most, options.max_time, pending=pending, memory=memory, spill=spill)


def most_of(options: Namespace) -> int:
    """Return the most configurations to visit."""
    usual = MOST_OF_REFERENCE if options.engine == "reference" else MOST
    return options.max_configurations or usual * (options.workers or 1)


def cluster_of(options: Namespace) -> Cluster | None:
    """Return the Ray cluster of the exploration; None for another engine."""
    if options.engine != "ray":
        if options.workers is not None or options.address is not None:
            raise Mistake(
                "--workers and --address work with the Ray engine only", "add --engine ray, or leave them out"
            )
        return None
    return Cluster(options.workers or Cluster().workers, options.address)


def threads_of(options: Namespace) -> int | None:
    """Return the most threads of the exploration; None without the option."""
    if options.threads is not None and options.engine in ("reference", "ray"):
        raise Mistake(
            "--threads works with the fast engine only",
            "leave --engine out, or give --workers with --engine ray",
        )
    threads: int | None = options.threads
    return threads


def keeping_of(options: Namespace) -> Keeping | None:
    """Return the options on checkpoints and re-checking; None without any."""
    folder = checkpoint_folder(options)
    if folder is None and options.paranoid is None:
        return None
    if folder is not None and options.engine == "reference":
        raise Mistake("--checkpoint works with the fast and Ray engines only", "leave --engine out")
    if options.paranoid is not None and options.engine not in (None, "fast") and not options.reduce:
        raise Mistake("--paranoid works with the fast engine and with reductions only", "leave --engine out")
    return Keeping(folder, options.resume, every=options.every, doubted=options.paranoid or 0)
