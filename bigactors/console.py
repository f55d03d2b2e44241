"""What a console shows of a recording: its steps taken again by the mission's rules, and L drawn."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Any, Final

from adapters.console.facts import Change, Rules, Unreplayable
from adapters.console.history import History
from adapters.recording.reading import Recording
from bigactors.mistakes import Mistake
from bigactors.pictures import Look, logical_svg, look_of
from bigactors.recordings import mission_of, parting_of
from bigraphs.bigraph import Bigraph
from checker import ReplayError
from checker.traces import follow
from semantics.state.configuration import Configuration, Label
from semantics.state.partition import parted

EVERY: Final = 1.0
"""Seconds from the beginning of one drawing to that of the next."""

MOST_PICTURES: Final = 64

MOST_STEPS: Final = 1 << 12
"""Steps that are remembered: a run that observes in a loop takes the same ones over and over."""


@contextmanager
def history_of(path: Path, *, live: bool = False) -> Iterator[History]:
    """Yield the history of a recording of which nothing is read yet; `live`: it is still being written."""
    drawer = Drawer()
    try:
        yield History(path, rules_of, drawer, live=live)
    finally:
        drawer.close()


# --- steps --------------------------------------------------------------------------------------------


def rules_of(run: Mapping[str, Any]) -> Rules:
    """Return the rules of what a recording's run says was flown; raises Unreplayable."""
    recording = Recording(dict(run), (), torn=True)
    try:
        mission, parting = mission_of(recording), parting_of(recording)
    except Mistake as mistake:
        raise Unreplayable(f"its mission cannot be read: {mistake}") from mistake
    first = mission.initial if parting is None else parted(mission.initial, parting)
    live = mission.precautions
    return Rules(first, mission.fixed, live.limits, live.on_broken, remembering())


def remembering() -> Callable[[Configuration, Any], tuple[Label, Configuration]]:
    """Return what takes recorded steps again, those that it remembers without asking the rules."""
    known: dict[tuple[Configuration, str, int, str], tuple[Label, Configuration]] = {}

    def taken(before: Configuration, said: Any) -> tuple[Label, Configuration]:
        match said:
            case {"label": str(label), "choice": int(choice), "digest": str(wrote)} if "observed" not in said:
                key = (before, label, choice, wrote)
                if key not in known:
                    known[key] = _taken(before, said)
                    if len(known) > MOST_STEPS:
                        del known[next(iter(known))]
                return known[key]
        return _taken(before, said)

    return taken


def _taken(before: Configuration, said: Any) -> tuple[Label, Configuration]:
    try:
        step = follow(before, said["number"], said)
    except (ReplayError, ValueError) as error:
        raise Unreplayable(str(error).partition("\n")[0]) from error
    return step.label, step.target


# --- pictures -----------------------------------------------------------------------------------------

Scene = tuple[Bigraph, Look]
"""What a picture of L shows."""


class Drawer:
    """Draws L in a process of its own, one picture after the other, and at most one a second."""

    def __init__(self) -> None:
        """Begin no process yet."""
        self._pictures: dict[object, str] = {}
        self._process: SpawnProcess | None = None
        self._line: Connection | None = None
        self._drawing: object = None
        self._began = -EVERY

    def drawn(self, change: Change) -> str | None:
        """Return the picture of L after a change, empty where it cannot be drawn; None if it is not drawn yet."""
        self._look()
        return self._pictures.get(_key(change))

    def begin(self, change: Change) -> bool:
        """Begin to draw L after a change, unless another drawing has begun less than a second ago."""
        self._look()
        if self._drawing is not None or time.monotonic() < self._began + EVERY:
            return False
        if self._line is None:
            self._start()
        assert self._line is not None
        self._began, self._drawing = time.monotonic(), _key(change)
        try:
            self._line.send((*_scene(change), f"L after step {change.number}"))
        except OSError:
            self._fail()
        return True

    def close(self) -> None:
        """End the process."""
        if self._process is not None and self._line is not None:
            self._process.kill()
            self._process.join()
            self._process.close()
            self._line.close()
        self._process = self._line = None

    def _start(self) -> None:
        context = get_context("spawn")
        self._line, there = context.Pipe()
        self._process = context.Process(target=_draw, args=(there,), daemon=True)
        self._process.start()
        there.close()

    def _look(self) -> None:
        """Take the picture that is ready, if one is; what ends the process is not drawn again."""
        try:
            if self._line is not None and self._drawing is not None and self._line.poll():
                self._keep(self._line.recv())
        except (OSError, EOFError):
            self._fail()

    def _fail(self) -> None:
        self._keep("")
        self.close()

    def _keep(self, svg: str) -> None:
        self._pictures[self._drawing] = svg
        self._drawing = None
        if len(self._pictures) > MOST_PICTURES:
            del self._pictures[next(iter(self._pictures))]


def _key(change: Change) -> object:
    bigraph, look = _scene(change)
    return bigraph, look.glowing, look.marked


@lru_cache(maxsize=MOST_PICTURES)
def _scene(change: Change) -> Scene:
    """Return what a picture shows: L, what the change has changed, and what L and P say different things of."""
    before = None if change.before == change.after else change.before
    return change.after.structure.logical.bigraph(), look_of(change.after, before)


def _draw(line: Connection) -> None:
    """Draw what comes over the line, until it is closed: what this process is for."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(5)
    while True:
        try:
            bigraph, look, title = line.recv()
            line.send(logical_svg(bigraph, look, title))
        except (EOFError, OSError):
            return
