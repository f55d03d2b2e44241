"""`bigactors console`: a recording, or a run, in the browser."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from contextlib import AsyncExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

from bigactors import __version__
from bigactors.arguments.options import SERVING
from bigactors.exits import Exit
from bigactors.mistakes import Mistake, unreadable
from bigactors.terminal import say, tell

if TYPE_CHECKING:
    import ssl

    from adapters.console.browser_session import Console
    from adapters.console.history import History

DESCRIPTION: Final = """\
Serve the operator's console of a recording: the map beside the bigraph, a card for each vehicle, the findings, and a
time line that plays the recording. `bigactors run --console` serves the console of a run, in which operators can act.

The command prints a link with a token, and ends with Ctrl-C. docs/how-to/console.md shows the console."""

EXAMPLES: Final = (
    "bigactors console run.mcap",
    "bigactors console run.mcap --follow",
    "bigactors console run.mcap --listen 0.0.0.0:8765 --tls cert.pem key.pem --tiles portimao.pmtiles",
)

ARGUMENTS: Final = f"""\
  recording RECORDING  a recording (run --record writes it)
  --listen [HOST:]PORT  the address and port of the console (default: this machine only, port 8765 or a free one)
  --follow  show the newest moment of a recording that a run is still writing
  --socket FILE  the run's socket, so that operators can act; needs --follow (default: they only watch)
  --beside {{kept,unkept}}
{SERVING}"""
"""`--beside`, of which the help is silent, is for `run --console`: whether the run keeps its recording."""


AUTOGROUP: Final = Path("/proc/self/autogroup")
"""The niceness of a Linux session, among which Linux shares the processor first (sched(7)).

The niceness of a process counts only within its session.
"""

PORT: Final = 8765
"""The default port of a console."""

NICENESS: Final = 5
"""How far a console yields to the run beside it: on a shared core it gets a quarter."""

LAST: Final = "console, to watch:"
"""The beginning of the last line that a console prints at its start."""

PARTING: Final = 0.5
"""Seconds between the end of a run and the end of its console."""

READING: Final = 2.0
"""Seconds to read the last records of a run after its end."""

KILLED: Final = (
    "the run ended without a message: it was killed, or has crashed; vehicles go on with their last command"
)

UNKNOWN: Final = "the run has ended for an unknown reason: the recording cannot be read any further"

PMTILES: Final = b"PMTiles"


def run(options: Namespace) -> Exit:
    """Serve until interrupted."""
    import asyncio

    from bigactors.commands.console.recorded_history import history_of

    _check(options)
    _look_into(options)
    if options.beside:
        _give_way(NICENESS)
    with history_of(Path(options.recording), live=options.follow) as history, suppress(KeyboardInterrupt):
        asyncio.run(_serve(options, history))
    return Exit.HOLDS


def _check(options: Namespace) -> None:
    """Refuse impossible or unsafe options; raises Mistake."""
    from adapters.addresses import LOOPBACK
    from adapters.console.console_server import lacks_parts
    from physical import open_file

    if lacks_parts():
        raise Mistake(
            "the console's page is not whole: npm has not fetched its parts", "run `make parts` in the clone"
        )
    if options.socket is not None and not options.follow:
        raise Mistake("a recording that has ended receives no actions", "give --follow with --socket")
    host = LOOPBACK if options.listen is None else options.listen[0]
    if not (_is_near(host) or options.tls or options.insecure):
        hint = "give --tls CERT KEY, or listen on this machine only and come by ssh -L; or --insecure"
        raise Mistake(f"others on the network could read the token of a console at {host}", hint)
    if options.tiles is not None:
        try:
            with open_file(options.tiles) as file:
                begins = file.read(len(PMTILES))
        except OSError as error:
            raise unreadable(options.tiles, error) from error
        if begins != PMTILES:
            raise Mistake(
                "this is no map in PMTiles", "the pmtiles program makes one of MBTiles", options.tiles
            )


def _is_near(host: str) -> bool:
    from ipaddress import ip_address

    if host == "localhost":
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _give_way(niceness: int) -> None:
    """Yield to other processes; as the leader of a session, also to all other sessions."""
    told = os.nice(niceness)
    if os.getsid(0) == os.getpid():
        with suppress(OSError):  # only Linux has autogroups
            AUTOGROUP.write_text(str(told), encoding="ascii")


def _look_into(options: Namespace) -> None:
    """Read the beginning, so that a file that is no recording is refused at once; raises Mistake."""
    from adapters.recording.mcap_files import McapReader, RecordingError
    from adapters.recording.recording_reader import checked_run

    path = options.recording
    try:
        first = next(McapReader(Path(path)).messages(), None)
        if first is None and not options.follow:
            raise Mistake("it records no run of a mission", "a run that begins is shown with --follow", path)
        if first is not None:
            checked_run(first.data if first.topic == "run" and isinstance(first.data, dict) else None)
    except RecordingError as error:
        raise Mistake(str(error), "give a recording that run --record wrote", path) from error
    except OSError as error:
        if not (options.follow and isinstance(error, FileNotFoundError)):
            raise unreadable(path, error) from error
        tell(f"{path} is not there yet: the console waits for the run that writes it")


async def _serve(options: Namespace, history: History) -> None:
    import asyncio

    from adapters.console.access import Access
    from adapters.console.browser_session import Console
    from adapters.console.run_client import performing

    access = Access()
    perform = None if options.socket is None else performing(Path(options.socket))
    tiles = None if options.tiles is None else Path(options.tiles)
    kept = "" if options.beside == "unkept" else options.recording
    console = Console(history, access, __version__, perform, options.follow, tiles, kept)
    tls = None if options.tls is None else _tls(*options.tls)
    async with AsyncExitStack() as stack:
        host, port = await _listen(stack, console, options.listen, tls)
        address = f"{'http' if tls is None else 'https'}://{f'[{host}]' if ':' in host else host}:{port}"
        if perform is not None:
            say(f"console, to act:   {address}/#token={access.act}")
        say(f"{LAST} {address}/#token={access.watch}")
        sys.stdout.flush()
        await (_until_left(history) if options.beside else asyncio.Event().wait())


async def _listen(
    stack: AsyncExitStack, console: Console, listen: tuple[str, int] | None, tls: ssl.SSLContext | None
) -> tuple[str, int]:
    """Listen at the given address, else at the usual port or a free one; raises Mistake."""
    from adapters.addresses import LOOPBACK
    from adapters.console.console_server import Site, serving

    host, port = listen or (LOOPBACK, PORT)
    try:
        return host, await stack.enter_async_context(serving(console, Site(port, host, tls)))
    except OSError as error:
        if listen is not None:
            raise Mistake(
                error.strerror or str(error), "give another place with --listen", f"{host}:{port}"
            ) from error
    tell(f"port {port} is taken: the console listens at another one")
    return host, await stack.enter_async_context(serving(console, Site(0, host, tls)))


def _tls(certificate: str, key: str) -> ssl.SSLContext:
    import ssl

    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    try:
        context.load_cert_chain(certificate, key)
    except (OSError, ValueError) as error:
        raise Mistake(
            f"this is no certificate with its key: {error}", "give both as PEM", certificate
        ) from error
    return context


async def _until_left(history: History) -> None:
    """Wait until the run beside this console ends, which closes its end of the pipe."""
    import asyncio

    loop, closed, pipe = asyncio.get_running_loop(), asyncio.Event(), sys.stdin.fileno()
    loop.add_reader(pipe, lambda: None if os.read(pipe, 4096) else closed.set())
    await closed.wait()
    loop.remove_reader(pipe)
    with suppress(TimeoutError):
        async with asyncio.timeout(READING):
            while history.ended is None and history.read_on(0.0):
                await asyncio.sleep(0)
    history.end(f"{UNKNOWN}: {history.trouble}" if history.trouble else KILLED)
    await asyncio.sleep(PARTING)  # time for all browsers to show the end
