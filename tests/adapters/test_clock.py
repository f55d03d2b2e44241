"""Event loops with a faster clock: time waits for the process."""

import asyncio
import itertools
import time

import pytest

from adapters.simulated import run

PERIOD = 0.1


async def ticking(ticks, blocks=0.0):
    """Return the times at which a periodic task ran; something else blocks the process once."""
    loop, seen = asyncio.get_running_loop(), []
    loop.call_later(0.5, time.sleep, blocks)
    while len(seen) < ticks:
        await asyncio.sleep(PERIOD)
        seen.append(loop.time())
    return seen


@pytest.mark.parametrize("speed", [10.0, 100.0, None])
def test_a_process_that_is_kept_from_running_misses_no_moment_of_simulated_time(speed):
    seen = run(ticking(30, blocks=0.3), speed)
    steps = [after - before for before, after in itertools.pairwise(seen)]
    assert max(steps) < 1.5 * PERIOD


def test_a_faster_clock_keeps_its_pace():
    began = time.monotonic()
    seen = run(ticking(100), 20.0)
    assert seen[-1] == pytest.approx(100 * PERIOD, rel=0.2)
    assert time.monotonic() - began >= 0.45


def test_a_faster_clock_goes_on_while_nothing_but_sockets_is_waited_for():
    async def waiting():
        server = await asyncio.start_server(lambda *_: None, "127.0.0.1", 0)
        loop, began = asyncio.get_running_loop(), asyncio.get_running_loop().time()
        await loop.run_in_executor(None, time.sleep, 0.2)
        server.close()
        return loop.time() - began

    assert run(waiting(), 10.0) >= 0.4
