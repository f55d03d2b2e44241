"""`bigactors say`: send a message to a bigActor of a running mission."""

import asyncio
from argparse import Namespace
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, TypeVar

from adapters.live.operator_socket import NobodyListens
from adapters.live.operator_socket import say as send
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.sockets import only_socket
from bigactors.terminal import say
from physical import is_text, is_word

Heard = TypeVar("Heard")


def run(options: Namespace) -> Exit:
    """Send the message, and print the answer."""
    check_texts("what is said", options.agent, options.by, options.message)
    refusal = heard_at(options.socket, lambda path: send(path, options.agent, options.message, options.by))
    if refusal:
        raise Mistake(refusal, "the environment section of the mission says what may be said")
    say(f"said to {options.agent}: {options.message}")
    return Exit.HOLDS


def check_texts(what: str, name: str, by: str, *more: str) -> None:
    """Raise Mistake for invalid texts, and for a speaker's name that cannot be printed."""
    if not all(map(is_text, (name, *more))):
        raise Mistake(f"{what} has to be text in valid Unicode, of at most 2,000 characters")
    if by and not is_word(by):
        raise Mistake("--by has to be a name of 1 to 200 characters that can be printed")


def heard_at(socket: str | None, saying: Callable[[Path], Coroutine[Any, Any, Heard]]) -> Heard:
    """Call a running mission, at the given socket or the only one; return its answer."""
    path = only_socket(socket)
    try:
        return asyncio.run(saying(path))
    except NobodyListens as error:
        raise Mistake(str(error), "is the mission running?") from error
