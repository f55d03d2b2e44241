"""`bigactors studio`: write, check and watch a mission in the browser."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable
from contextlib import AsyncExitStack, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say

if TYPE_CHECKING:
    from adapters.console.console_server import Site
    from bigactors.studio.studio_server import StudioService

DESCRIPTION: Final = """\
Write a mission in the browser, beside its verdicts, its map, its bigraph and its runs. Each pause in typing checks the
text. Without FILE, the page offers the template of `bigactors new` and the missions that ship.

The command serves this machine only, prints a link with a token, opens it, and ends with Ctrl-C.
docs/how-to/studio.md shows the page."""

EXAMPLES: Final = (
    "bigactors studio",
    "bigactors studio patrol.mission",
    "bigactors studio patrol.mission --trace run.mcap",
    "bigactors studio patrol.mission --no-browser",
)

PORT: Final = 8766
"""The default port of a studio."""

ARGUMENTS: Final = f"""\
  file [FILE]  the mission's file; a name of no file begins a new one, that of a shipped mission begins with its text
  --trace FILE  begin with this run of the mission: a trace in JSON (check --trace and simulate write it), or a
      recording (run --record writes it)
  --port PORT  the port (default: {PORT}, or a free one)
  --no-browser  print the link, and leave the browser to you"""


def run(options: Namespace) -> Exit:
    """Serve until interrupted."""
    import asyncio
    from importlib.util import find_spec

    from bigactors.studio.studio_server import lacks_parts
    from physical.wordings import install_extra

    if lacks_parts():
        hint = "run `make parts` in the clone"
        raise Mistake("the studio's page is not whole: npm has not made its parts", hint)
    if find_spec("pygls") is None:
        raise Mistake("the editor is served by pygls, which is not installed", install_extra("lsp"))
    file = Path(options.file or "mission")
    if file.is_dir():
        raise Mistake("this is a folder, not a mission", "name a file in it", options.file)
    if not file.parent.is_dir():
        raise Mistake(
            "there is no such folder", "make it first, or name a file in another one", str(file.parent)
        )
    if options.trace is not None and not file.is_file():
        hint = f"bigactors studio FILE --trace {options.trace}"
        raise Mistake("a run is shown of the mission in a file", hint, str(file))
    if options.trace is not None and not Path(options.trace).is_file():
        raise Mistake("there is no such file", place=options.trace)
    with suppress(KeyboardInterrupt):
        asyncio.run(_serve(file, options))
    return Exit.HOLDS


async def _serve(file: Path, options: Namespace) -> None:
    import asyncio

    from adapters.addresses import LOOPBACK
    from adapters.console.access import Access
    from bigactors.browser_launch import opened_in_browser
    from bigactors.studio.studio_server import StudioService

    access = Access()
    async with AsyncExitStack() as stack:
        trace = None if options.trace is None else Path(options.trace)
        port = await _listen(stack, partial(StudioService, access, file=file, run=trace), options.port)
        link = f"http://{LOOPBACK}:{port}/#token={access.act}"
        say(f"studio: {link}")
        sys.stdout.flush()
        if not options.no_browser:
            await asyncio.to_thread(stack.enter_context, opened_in_browser(link))
        await asyncio.Event().wait()


async def _listen(stack: AsyncExitStack, service: Callable[[Site], StudioService], asked: int | None) -> int:
    """Listen at the port that is asked for, else at the usual one or a free one; raises Mistake."""
    from adapters.console.console_server import Site, listening

    for port in (PORT, 0) if asked is None else (asked,):
        site = Site(port)
        try:
            return await stack.enter_async_context(listening(service(site), site))
        except OSError as error:
            if asked is not None:
                hint = "give another one with --port"
                raise Mistake(error.strerror or str(error), hint, f"port {port}") from error
    raise Mistake("there is no free port", "end some programs that listen")
