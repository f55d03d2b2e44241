"""A process that compiles the loops of a check, by a check of the same mission (`checker.handover`)."""

import pickle
import sys

from checker.check import check
from checker.engines.contract import Engine
from checker.handover import Compilation
from checker.limits import Limits

ENOUGH = 20_000
"""The configurations in which a check uses all its loops, also those of several threads."""


def compile_loops(job: Compilation) -> None:
    """Compile the loops into numba's cache."""
    limits = Limits(configurations=ENOUGH)
    check(
        job.initial,
        job.properties,
        limits,
        engine=Engine.FAST,
        reduce=job.reductions,
        threads=job.threads,
        times=job.times,
        ways=job.ways,
    )


if __name__ == "__main__":
    compile_loops(pickle.load(sys.stdin.buffer))  # the process that started this one wrote it
