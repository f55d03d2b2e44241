"""The console's view of a recording: its steps replayed by the mission's rules, and drawings of L."""

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
from adapters.recording.recording_reader import Recording
from bigactors.mistakes import Mistake
from bigactors.pictures import Look, logical_picture, look_of
from bigactors.recordings import mission_of, parting_of
from bigraphs.bigraph import Bigraph
from checker import ReplayError
from checker.traces import follow
from semantics.state.configuration import Configuration, Label
from semantics.state.station_partition import parted

EVERY: Final = 1.0
"""Seconds between the beginnings of two drawings."""

MOST_PICTURES: Final = 64

MOST_STEPS: Final = 1 << 12
"""The size of the step cache: a run that observes in a loop repeats the same steps."""


@contextmanager
def history_of(path: Path, *, live: bool = False) -> Iterator[History]:
    """Yield the unread history of a recording; `live` for a recording that is still being written."""
    drawer = Drawer()
    try:
        yield History(path, rules_of, drawer, live=live)
    finally:
        drawer.close()


# --- steps --------------------------------------------------------------------------------------------


def rules_of(run: Mapping[str, Any]) -> Rules:
    """Return the rules of a recorded run; raises Unreplayable."""
    recording = Recording(dict(run), (), torn=True)
    try:
        mission, parting = mission_of(recording), parting_of(recording)
    except Mistake as mistake:
        raise Unreplayable(f"its mission cannot be read: {mistake}") from mistake
    first = mission.initial if parting is None else parted(mission.initial, parting)
    live = mission.precautions
    replayed = remembering(in_turn=recording.in_turn)
    return Rules(first, mission.fixed, live.limits, live.on_broken, replayed)


def remembering(*, in_turn: bool) -> Callable[[Configuration, Any], tuple[Label, Configuration]]:
    """Return the function that replays recorded steps, in the turn of `fcfs` or out of it, with a cache."""
    known: dict[tuple[Configuration, str, int, str], tuple[Label, Configuration]] = {}

    def taken(before: Configuration, said: Any) -> tuple[Label, Configuration]:
        match said:
            case {"label": str(label), "choice": int(choice), "digest": str(wrote)} if "observed" not in said:
                key = (before, label, choice, wrote)
                if key not in known:
                    known[key] = _taken(before, said, in_turn=in_turn)
                    if len(known) > MOST_STEPS:
                        del known[next(iter(known))]
                return known[key]
        return _taken(before, said, in_turn=in_turn)

    return taken


def _taken(before: Configuration, said: Any, *, in_turn: bool) -> tuple[Label, Configuration]:
    try:
        step = follow(before, said["number"], said, in_turn=in_turn)
    except (ReplayError, ValueError) as error:
        raise Unreplayable(str(error).partition("\n")[0]) from error
    return step.label, step.target


# --- pictures -----------------------------------------------------------------------------------------

Scene = tuple[Bigraph, Look]
"""The contents of a picture of L."""


class Drawer:
    """Draws L in a separate process, one picture at a time, at most one a second."""

    def __init__(self) -> None:
        """Make a drawer; the process starts with the first drawing."""
        self._pictures: dict[object, str] = {}
        self._process: SpawnProcess | None = None
        self._line: Connection | None = None
        self._drawing: object = None
        self._began = -EVERY

    def drawn(self, change: Change) -> str | None:
        """Return the picture of L after a change: empty if it cannot be drawn, None if it is not drawn yet."""
        self._look()
        return self._pictures.get(_key(change))

    def begin(self, change: Change) -> bool:
        """Begin to draw L after a change, unless a drawing is under way or began less than a second ago."""
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
        """Store the finished picture, if any. If the process fails, store an empty one, which is never retried."""
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
    """Return the contents of a picture: L, the parts that the change touched, and the parts where L and P disagree."""
    before = None if change.before == change.after else change.before
    return change.after.structure.logical.bigraph(), look_of(change.after, before)


def _draw(line: Connection) -> None:
    """Draw each scene received on the line until it closes: the main function of the drawing process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(5)
    while True:
        try:
            bigraph, look, title = line.recv()
            line.send(logical_picture(bigraph, look, title).svg)
        except (EOFError, OSError):
            return
