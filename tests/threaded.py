"""An event loop beside a test: what is served there while the test drives a browser."""

import asyncio
import threading
from contextlib import contextmanager


@contextmanager
def loop_beside():
    """Run an event loop in a thread; yield what runs a coroutine there and returns its result."""
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    try:
        yield lambda each: asyncio.run_coroutine_threadsafe(each, loop).result(60)
    finally:
        asyncio.run_coroutine_threadsafe(_end_all(), loop).result(60)
        loop.call_soon_threadsafe(loop.stop)
        thread.join(60)
        loop.close()


async def _end_all():
    """End what still waits, as a connection that is kept alive does."""
    waiting = asyncio.all_tasks() - {asyncio.current_task()}
    for each in waiting:
        each.cancel()
    await asyncio.gather(*waiting, return_exceptions=True)


@contextmanager
def beside(serving):
    """Enter an asynchronous context in such a loop; yield what it gives."""
    with loop_beside() as run:
        yield run(serving.__aenter__())
        run(serving.__aexit__(None, None, None))
