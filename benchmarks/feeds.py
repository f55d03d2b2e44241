"""Measure the cost of AIS: from sentences on a real socket to physical properties, the sender included.

`python -m benchmarks.feeds`: the recording that ships, again and again.
"""

import asyncio
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from adapters.ais import AisFeed
from adapters.plugin import Published, Report
from physical.ais_recording import read_recording

RECORDING = Path(__file__).parents[1] / "specs" / "missions" / "harbour_watch.nmea"
ROUNDS = 100
PORT = 15_872


@dataclass
class Counting:
    """A world that counts."""

    count: int = 0

    def publish(self, published: Published) -> None:
        """Count it."""
        self.count += published is not None

    def report(self, report: Report) -> None:
        """Pass over what can't be heard."""

    def now(self) -> float:
        """Return the time."""
        return time.time()


async def measured() -> tuple[int, int, float]:
    """Return lines, positions and seconds of a core."""
    lines = [
        line[line.find(b"!") :] + b"\r\n" for line in RECORDING.read_bytes().splitlines() if b"!" in line
    ]
    world, feed = Counting(), AisFeed("ais", f"tcp:127.0.0.1:{PORT}")
    done = asyncio.Event()

    async def receiver(_reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        for _ in range(ROUNDS):
            writer.write(b"".join(lines))  # without their times: those are long past
            await writer.drain()
        writer.close()
        done.set()

    async with await asyncio.start_server(receiver, "127.0.0.1", PORT):
        start = time.process_time()
        task = asyncio.ensure_future(feed.run(world))
        await done.wait()
        await asyncio.sleep(1.5)  # what has been sent is still to be heard
        spent = time.process_time() - start
        task.cancel()
    return ROUNDS * len(lines), world.count, spent


def main() -> None:
    """Measure and say."""
    lines, positions, spent = asyncio.run(measured())
    assert positions == ROUNDS * len(read_recording(RECORDING).positions), (
        "datagrams were lost: the machine is busy"
    )
    sys.stdout.write(
        f"{lines} lines with {positions} positions: {spent / lines * 1e6:.0f} µs a line, "
        f"{spent / lines * 1000:.1%} of a core for 1,000 lines a second\n"
    )


if __name__ == "__main__":
    main()
