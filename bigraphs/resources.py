"""The resources of this process: its cores and its memory."""

from __future__ import annotations

import os
import resource
import sys


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def memory_taken() -> int:
    """Return the bytes of memory of the process; its peak on a system without `/proc`.

    Pages of files don't count: the system reclaims them under pressure.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            resident, of_files = map(int, file.read().split()[1:3])
            return (resident - of_files) * resource.getpagesize()
    except OSError:
        unit = 1 if sys.platform == "darwin" else 1024
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
