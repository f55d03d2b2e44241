"""Exit codes."""

from collections.abc import Iterable
from enum import IntEnum


class Exit(IntEnum):
    """The exit codes; only 0 is a success."""

    HOLDS = 0
    VIOLATED = 1
    MISTAKE = 2
    INCOMPLETE = 3
    BUG = 4


_WORST_FIRST = (Exit.BUG, Exit.MISTAKE, Exit.VIOLATED, Exit.INCOMPLETE)


def worst(codes: Iterable[int]) -> Exit:
    """Return the worst exit code of several missions: bug, then mistake, then violation, then incomplete.

    >>> worst([0, 3, 1])
    <Exit.VIOLATED: 1>
    """
    found = set(codes)
    return next((code for code in _WORST_FIRST if code in found), Exit.HOLDS)
