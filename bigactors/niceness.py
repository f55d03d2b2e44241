"""How much a process gives way to the others that want the processor."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Final

AUTOGROUP: Final = Path("/proc/self/autogroup")
"""Linux shares the processor among sessions first: this is a session's niceness, that of a process counts within it
alone (sched(7))."""


def give_way(niceness: int) -> None:
    """Give way to other processes, and as the first of a session to those of all other sessions."""
    told = os.nice(niceness)
    if os.getsid(0) == os.getpid():
        with suppress(OSError):  # not every system shares so
            AUTOGROUP.write_text(str(told), encoding="ascii")
