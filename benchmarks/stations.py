"""Measure stations: from publications at one to the other's world, over loopback.

`python -m benchmarks.stations --rate 1000 --seconds 10`: two stations in one process, logs on disk, no TLS.
"""

from __future__ import annotations

import argparse
import asyncio
import socket
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from adapters.plugin import Aged, Command, Published, Refused, Report, World
from adapters.stations.journal import Journal
from adapters.stations.peers import peers_of
from adapters.stations.sharing import Sharing
from physical import PhysicalProperty, point

NAMES = ("gcs0", "gcs1")
BATCHES = 20
"""How often a second positions come in, several at once."""


class Run:
    """The world of a station: notes how old each position is when it comes."""

    def __init__(self) -> None:
        self.ages: list[float] = []

    def publish(self, published: Published) -> None:
        """Take what is known of an entity now."""
        if isinstance(published, Aged) and published.property.time is not None:
            self.ages.append(self.now() - published.property.time)

    def now(self) -> float:
        """Return the time."""
        return time.time()

    def report(self, report: Report) -> None:
        """Print what went wrong."""
        print(report, file=sys.stderr)  # noqa: T201 - a script


class Feed:
    """The plugin that speaks."""

    name = "feed"

    def owns(self, entity: str) -> bool:  # noqa: ARG002 - a plugin's interface
        """Nobody takes commands from it."""
        return False

    async def run(self, world: World) -> None:
        """Nothing: the benchmark speaks."""

    async def command(self, command: Command) -> None:
        """Refuse."""
        raise Refused(command.entity)


async def measure(rate: int, seconds: float, folder: Path) -> tuple[list[float], float]:
    """Return the ages of positions at the other station, and the processor time that it took."""
    table = {name: {"connect": [f"tcp/127.0.0.1:{_free_port()}"]} for name in NAMES}
    sharings = []
    for name in NAMES:
        journal = Journal(folder / f"{name}.log", name, "benchmark")
        sharings.append(Sharing(peers_of(table, name, folder), journal, "benchmark", "benchmark", {}))
    worlds = [Run() for _ in NAMES]
    tasks = [asyncio.ensure_future(each.run(world)) for each, world in zip(sharings, worlds, strict=True)]
    await asyncio.sleep(2.0)
    worlds[1].ages.clear()
    began = time.process_time()
    await _speak(sharings[0], worlds[0], rate, seconds)
    used = time.process_time() - began
    for task in tasks:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task
    return sorted(worlds[1].ages), used


async def _speak(sharing: Sharing, world: Run, rate: int, seconds: float) -> None:
    loop, feed = asyncio.get_running_loop(), Feed()
    began, count = loop.time(), 0
    while loop.time() < began + seconds:
        while count < (loop.time() - began) * rate:
            at = point(37.0 + count % 997 * 1e-4, -8.6)
            said = PhysicalProperty(f"vessel{count % rate}", "Vessel", at, time=world.now())
            sharing.publish(feed, world, Aged(said, 600.0))
            count += 1
        await asyncio.sleep(1 / BATCHES)
    await asyncio.sleep(0.5)


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port: int = found.getsockname()[1]
        return port


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rate", type=int, default=1_000, help="positions a second (default %(default)s)")
    parser.add_argument("--seconds", type=float, default=10.0, help="default %(default)s")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        ages, used = asyncio.run(measure(options.rate, options.seconds, Path(folder)))
    median, late = ages[len(ages) // 2], ages[int(len(ages) * 0.99)]
    print(  # noqa: T201 - a script
        f"{len(ages):,} positions in {options.seconds:g} s: median {1e3 * median:.0f} ms, 99th percentile "
        f"{1e3 * late:.0f} ms; {used / options.seconds:.2f} s of processor time a second, for both stations"
    )


if __name__ == "__main__":
    main()
