"""`bigactors say`: a message to a bigActor of a running mission."""

import asyncio
from argparse import Namespace
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

from adapters.live.operator_socket import NobodyListens
from adapters.live.operator_socket import say as send
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.sockets import only_socket
from bigactors.terminal import say
from physical import is_text


def run(options: Namespace) -> Exit:
    """Say it, and print what came of it."""
    if not (is_text(options.agent) and is_text(options.message)):
        raise Mistake("what is said has to be text in valid Unicode, of at most 2,000 characters")
    refusal = heard_at(options.socket, lambda path: send(path, options.agent, options.message))
    if refusal:
        raise Mistake(refusal, "the environment section of the mission says what may be said")
    say(f"said to {options.agent}: {options.message}")
    return Exit.HOLDS


def heard_at(socket: str | None, saying: Callable[[Path], Coroutine[Any, Any, str]]) -> str:
    """Say something to the mission that listens at a socket, or to the only one that runs; return its refusal."""
    path = only_socket(socket)
    try:
        return asyncio.run(saying(path))
    except NobodyListens as error:
        raise Mistake(str(error), "is the mission running?") from error
