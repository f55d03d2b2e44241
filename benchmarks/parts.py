"""Where the time of a live run goes, from a packet in a socket to the commit: by parts, each without those inside it.

Functions of the run are replaced by ones that take the processor time of the thread; the clock itself takes a few
percent. `python -m benchmarks.wire --parts` prints the table.
"""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from statistics import median
from typing import Any, Final
from unittest.mock import patch

import adapters.ais
import adapters.live.core
import adapters.mavlink.pilot
import adapters.transport
from adapters.ais import AisFeed
from adapters.live.loop import Inbox, LiveRun
from adapters.mavlink import Autopilot
from adapters.mavlink.codec import Decoder
from adapters.naming import NamingService
from adapters.recording.writing import Recorder
from bigactors.terminal import say

PARTS: Final = (
    ("read datagrams", adapters.transport._Datagrams, "read"),  # noqa: SLF001 - where sockets are read
    ("MAVLink: decode", Decoder, "feed"),
    ("MAVLink: fold into the vehicle", adapters.mavlink.pilot, "hear"),
    ("MAVLink: the rest of a packet", Autopilot, "_receive"),
    ("a pilot's look at the clock", adapters.mavlink.pilot, "tick"),
    ("AIS: decode", adapters.ais, "hear"),
    ("AIS: name", NamingService, "name"),
    ("AIS: the rest of a line", AisFeed, "_line"),
    ("check and queue a property", Inbox, "publish"),
    ("record a property", Recorder, "arrival"),
    ("record a report", Recorder, "report"),
    ("a turn: take in positions", adapters.live.core, "take_in"),
    ("a turn: agents and rules", adapters.live.core, "go_on"),
    ("a turn: record", Recorder, "turn"),
    ("a turn: the rest", LiveRun, "_turn"),
)
"""What is timed: its name, and where the function is."""


class Parts:
    """The processor time that each part has taken, call by call, without the parts that it called."""

    def __init__(self) -> None:
        self.spent: dict[str, list[float]] = defaultdict(list)
        self._within = [0.0]

    @contextmanager
    def watching(self) -> Iterator[Parts]:
        """Time all parts until left; what runs already is not replaced, so enter before sockets are opened."""
        replaced = [patch.object(owner, name, self._timed(part, owner, name)) for part, owner, name in PARTS]
        for each in replaced:
            each.start()
        try:
            yield self
        finally:
            for each in replaced:
                each.stop()

    def _timed(self, part: str, owner: Any, name: str) -> Callable[..., Any]:
        function = getattr(owner, name)

        def timed(*words: Any, **named: Any) -> Any:
            began = time.thread_time()
            self._within.append(0.0)
            try:
                found = function(*words, **named)
                return list(found) if isinstance(found, Iterator) else found
            finally:
                took = time.thread_time() - began
                self.spent[part].append(took - self._within.pop())
                self._within[-1] += took

        return timed

    def tell(self, seconds: float, busy: float) -> None:
        """Print how often each part ran, its median, and its part of all processor time."""
        say(f"  {'':<32} {'a second':>9} {'median µs':>9} {'of all':>7}")
        told = 0.0
        for part, _, _ in PARTS:
            spent = self.spent.get(part, [0.0])
            told += sum(spent)
            often, middle = len(spent) / seconds, median(spent) * 1e6
            say(f"  {part:<32} {often:9,.0f} {middle:9.0f} {sum(spent) / busy:7.1%}")
        say(f"  {'the loop: timers, tasks':<32} {'':>9} {'':>9} {1 - told / busy:7.1%}")
