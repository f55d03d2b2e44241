"""The sockets of running missions, in a folder that only their user may open, and calls to them."""

from __future__ import annotations

import asyncio
import os
import stat
from collections.abc import Callable, Coroutine
from getpass import getuser
from pathlib import Path
from typing import Any, TypeVar

from adapters.live.operator_socket import NobodyListens
from bigactors.files import file_stem
from bigactors.mistakes import Mistake
from physical import is_text, is_word

Heard = TypeVar("Heard")

LONGEST = 100
"""The most bytes of a socket's path; systems refuse longer ones."""


def folder() -> Path:
    """Return the folder of this user's sockets, made if missing; raises Mistake if it is another user's."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    path = Path(runtime) / "bigactors" if runtime else Path(f"/tmp/bigactors-{os.getuid()}")
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = path.lstat()
    except OSError as error:
        raise Mistake(error.strerror or str(error), "give a path with --socket", str(path)) from error
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or stat.S_IMODE(found.st_mode) & 0o077:
        raise Mistake("the folder is not this user's alone", "give a path with --socket", str(path))
    return path


def socket_of(mission: str, given: str | None) -> Path:
    """Return the path of a mission's socket."""
    path = Path(given) if given is not None else folder() / f"{file_stem(mission)}.sock"
    if len(os.fsencode(path.absolute())) > LONGEST:
        raise Mistake(
            f"the path of a socket has at most {LONGEST} bytes", "give a shorter one: --socket", str(path)
        )
    return path


def only_socket(given: str | None) -> Path:
    """Return the given socket, else that of the only running mission; raises Mistake."""
    if given is not None:
        return Path(given)
    found = sorted(path for path in folder().iterdir() if path.suffix == ".sock")
    if len(found) == 1:
        return found[0]
    if not found:
        raise Mistake("no mission runs here", "start one with `bigactors run`, or give its --socket")
    names = ", ".join(map(str, found))
    raise Mistake(f"{len(found)} missions run here: {names}", "choose one: --socket FILE")


def check_texts(what: str, name: str, by: str, *more: str) -> None:
    """Raise Mistake for invalid texts, and for a speaker's name that cannot be printed."""
    if not all(map(is_text, (name, *more))):
        raise Mistake(f"{what} has to be text in valid Unicode, of at most 2,000 characters")
    if by and not is_word(by):
        raise Mistake("--by has to be a name of 1 to 200 characters that can be printed")


def speaker(by: str | None) -> str:
    """Return the name of the user who speaks: the given one, else the login; empty if it is unknown."""
    try:
        return getuser() if by is None else by
    except (OSError, KeyError):
        return ""


def heard_at(socket: str | None, saying: Callable[[Path], Coroutine[Any, Any, Heard]]) -> Heard:
    """Call a running mission, at the given socket or the only one; return its answer."""
    path = only_socket(socket)
    try:
        return asyncio.run(saying(path))
    except NobodyListens as error:
        raise Mistake(str(error), "is the mission running?") from error
