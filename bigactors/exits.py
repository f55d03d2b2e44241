"""Exit codes."""

from collections.abc import Iterable
from enum import IntEnum


class Exit(IntEnum):
    """The exit codes; anything but 0 is no success."""

    HOLDS = 0
    VIOLATED = 1
    MISTAKE = 2
    INCOMPLETE = 3
    BUG = 4


_WORST_FIRST = (Exit.BUG, Exit.MISTAKE, Exit.VIOLATED, Exit.INCOMPLETE)


def worst(codes: Iterable[int]) -> Exit:
    """Return the exit code of several missions: a bug, then a mistake, a violation, a bound that was reached.

    >>> worst([0, 3, 1])
    <Exit.VIOLATED: 1>
    """
    found = set(codes)
    return next((code for code in _WORST_FIRST if code in found), Exit.HOLDS)
