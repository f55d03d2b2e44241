"""Limits of an exploration: whether one is met, and the message about it."""

import math
import resource
import sys
from dataclasses import dataclass, field
from time import monotonic

MOST_PENDING = 64
"""Requests of one agent, or messages in one mailbox, beyond which a configuration is not explored further."""

INTERRUPTION = "an interruption"
"""The bound that is met where the user has asked for the end."""

GRACE = 2.0
"""For how many seconds what was explored is looked at after that."""


class Interruption:
    """The wish of the user for the end, made by a signal's handler at any moment and asked for where time is."""

    def __init__(self) -> None:
        self.wished: float | None = None

    def wish(self) -> None:
        """Ask for the end."""
        self.wished = monotonic() if self.wished is None else self.wished

    def is_due(self, grace: float = 0.0) -> bool:
        """Tell whether the end was asked for, so many seconds ago."""
        return self.wished is not None and monotonic() - self.wished >= grace


@dataclass(frozen=True, slots=True)
class Limits:
    """Where an exploration stops: then it is *incomplete*, and says so.

    Attributes:
        configurations: How many are visited at most.
        seconds: For how long.
        pending: How many requests an agent may have pending, or messages in its mailbox.
        spent: How many of the seconds are gone already.
        memory: How many bytes the process may take; looked at now and then, so that it may be a little more.
        spill: The folder in which the fast explorer has files for its rows when memory ends; None for nowhere.
        interruption: Whether the user has asked for the end.
    """

    configurations: int | None = 2_000_000
    seconds: float | None = None
    pending: int = MOST_PENDING
    spent: float = 0.0
    memory: int | None = None
    spill: str | None = None
    interruption: Interruption = field(default_factory=Interruption, compare=False, repr=False)


def limit_met(most: int) -> str:
    """Say that there are more configurations than were to be visited."""
    return f"the limit of {most:,} configurations"


def time_met(seconds: float) -> str:
    """Say that the time was over."""
    return f"the time limit of {seconds:g} s"


def end_met(limits: Limits, seconds: float, part: float = 1.0) -> str | None:
    """Return why exploring ends after so many seconds: the user wants that, or a part of the time is over."""
    if limits.interruption.is_due():
        return INTERRUPTION
    most = limits.seconds
    return time_met(most) if most is not None and seconds + limits.spent > part * most else None


def is_full(limits: Limits) -> bool:
    """Tell whether the process takes more memory than it may."""
    return memory_left(limits) < 0


def memory_left(limits: Limits) -> float:
    """Return how many bytes of memory the process may take besides what it takes now."""
    return math.inf if limits.memory is None else limits.memory - memory_taken()


def memory_taken() -> int:
    """Return how many bytes of memory the process takes now; its peak where the system doesn't tell.

    What is a file's is not counted: the system takes that back when it needs memory.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            resident, of_files = map(int, file.read().split()[1:3])
            return (resident - of_files) * resource.getpagesize()
    except OSError:
        unit = 1 if sys.platform == "darwin" else 1024
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def memory_met(limits: Limits) -> str:
    """Say that there was no more memory."""
    return f"the memory limit of {(limits.memory or 0) / 1e6:,.0f} MB"


OMITTING = "hash compaction"


def cut(bound: str) -> str:
    """Say what a bound has done."""
    return bound if bound.startswith(OMITTING) else f"stopped at {bound}: what lies beyond was not explored"


def omission_met(bits: int, chance: float) -> str:
    """Say that configurations may have been taken for others."""
    return f"{OMITTING} to {bits} bits: some were left out with a probability of at most {chance:.1g}"


def crowd_met(most: int) -> str:
    """Say that more is pending than is followed."""
    return f"more than {most} requests or messages of one agent pending"
