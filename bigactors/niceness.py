"""How far a process yields the processor to others."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Final

AUTOGROUP: Final = Path("/proc/self/autogroup")
"""The niceness of a Linux session, among which Linux shares the processor first (sched(7)).

The niceness of a process counts only within its session.
"""


def give_way(niceness: int) -> None:
    """Yield to other processes; as the leader of a session, also to all other sessions."""
    told = os.nice(niceness)
    if os.getsid(0) == os.getpid():
        with suppress(OSError):  # only Linux has autogroups
            AUTOGROUP.write_text(str(told), encoding="ascii")
