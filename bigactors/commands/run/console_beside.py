"""The console of a run: a separate process that reads the run's recording."""

from __future__ import annotations

import subprocess
import sys
import threading
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from subprocess import PIPE
from tempfile import TemporaryDirectory
from typing import Final

from bigactors.commands.console import LAST
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

PATIENCE: Final = 5.0
"""Seconds that a console has to end before it is killed."""

STARTING: Final = 120.0
"""Seconds that a console has to print its links. Nothing is commanded before."""


@contextmanager
def recorded(options: Namespace) -> Iterator[Path | None]:
    """Yield the recording's path: the given one; for a console alone, one in a temporary folder; else None."""
    if options.record is not None:
        yield Path(options.record)
    elif options.console is None:
        yield None
    else:
        with TemporaryDirectory(prefix="bigactors-") as folder:
            yield Path(folder) / "run.mcap"


@contextmanager
def console_beside(options: Namespace, recording: Path | None, socket: Path) -> Iterator[None]:
    """Run a console beside the run, if one is requested. If the console ends, the run goes on."""
    if options.console is None or recording is None:
        yield
        return
    say("console: it starts beside the run; its links follow")
    sys.stdout.flush()
    process = subprocess.Popen(
        _line(options, recording, socket), stdin=PIPE, stdout=PIPE, start_new_session=True
    )
    links, leaving = SimpleQueue[bool](), threading.Event()
    threading.Thread(target=_relay, args=(process, links), daemon=True).start()
    if not _has_started(links):
        _end(process, 0)
        hint = "its own message gives the reason; nothing has been commanded. Correct that, or leave --console out"
        raise Mistake("the console does not start", hint)
    threading.Thread(target=_watch, args=(process, leaving), daemon=True).start()
    try:
        yield
    finally:
        leaving.set()
        _end(process, PATIENCE)


def _end(process: subprocess.Popen[bytes], patience: float) -> None:
    """Close a console's input, which ends it; kill it after the timeout."""
    assert process.stdin is not None
    with suppress(OSError):
        process.stdin.close()
    try:
        process.wait(patience)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _line(options: Namespace, recording: Path, socket: Path) -> list[str]:
    """Return the command line of the console."""
    kept = "unkept" if options.record is None else "kept"
    line = [sys.executable, "-m", "bigactors", "console", str(recording), "--follow", "--beside", kept]
    line += ["--socket", str(socket)]
    if options.console is not True:
        host, port = options.console
        line += ["--listen", f"[{host}]:{port}" if ":" in host else f"{host}:{port}"]
    line += [] if options.tiles is None else ["--tiles", options.tiles]
    line += [] if options.tls is None else ["--tls", *options.tls]
    return line + (["--insecure"] if options.insecure else [])


def _has_started(links: SimpleQueue[bool]) -> bool:
    with suppress(Empty):
        return links.get(timeout=STARTING)
    return False


def _relay(process: subprocess.Popen[bytes], links: SimpleQueue[bool]) -> None:
    """Print the lines of a console. Report True at its last link, and False at the end of its output."""
    assert process.stdout is not None
    with process.stdout:
        for line in process.stdout:
            say(line.decode(errors="replace").rstrip())
            sys.stdout.flush()
            if line.startswith(LAST.encode()):
                links.put(True)
    links.put(False)  # a console that prints no links closes its output before its process ends


def _watch(process: subprocess.Popen[bytes], leaving: threading.Event) -> None:
    """Report a console that ends before its run."""
    code = process.wait()
    if not leaving.is_set():
        tell(f"the console has ended with code {code}; the run goes on without it")
