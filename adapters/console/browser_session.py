"""The session of one browser: its play head, the frames sent to it, and its requests (docs/reference/console.md).

Each frame is the difference from the last view sent. It is computed when the socket has taken the last frame: a slow
browser gets fewer and larger steps, never a queue.
"""

from __future__ import annotations

import asyncio
import json
import time
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from adapters.console.access import Access, Role
from adapters.console.browser_requests import (
    PROTOCOL,
    Act,
    Hello,
    LiveRequest,
    Pause,
    Play,
    Request,
    Seek,
    Unreadable,
    read_request,
)
from adapters.console.console_view import View, difference
from adapters.console.history import History, Moment
from adapters.console.run_client import Performing
from adapters.live.operator_socket import Outcome
from adapters.rate_limit import Ration


@dataclass(frozen=True, slots=True)
class Playhead:
    """A browser's place on the time line.

    Attributes:
        at: The recording's time that was shown at `since`; None for the newest moment, even as new messages come.
        since: The time of a monotonic clock.
        playing: Whether the shown time goes on.
        speed: Seconds of the recording per second of wall time.
    """

    at: float | None = None
    since: float = 0.0
    playing: bool = False
    speed: float = 1.0

    @property
    def live(self) -> bool:
        """Whether the newest moment is shown."""
        return self.at is None

    def now(self, clock: float, newest: float) -> float:
        """Return the shown time, at most the newest.

        >>> Playhead(100.0, since=5.0, playing=True, speed=10.0).now(7.0, 1000.0)
        120.0
        """
        if self.at is None:
            return newest
        passed = (clock - self.since) * self.speed if self.playing else 0.0
        return min(newest, self.at + passed)

    def seek(self, time: float, clock: float, begin: float, newest: float) -> Playhead:
        """Return the play head at another time; a playing one goes on playing."""
        return replace(self, at=max(begin, min(newest, time)), since=clock)

    def play(self, speed: float, clock: float, newest: float) -> Playhead:
        """Return the play head playing from the shown time at a speed."""
        return Playhead(self.now(clock, newest), clock, playing=True, speed=speed)

    def pause(self, clock: float, newest: float) -> Playhead:
        """Return the play head paused at the shown time."""
        return Playhead(self.now(clock, newest), clock, speed=self.speed)

    def caught_up(self, clock: float, newest: float, *, ended: bool) -> Playhead:
        """Return the play head, live if it has played up to the newest moment; paused there if the run has ended."""
        if not self.playing or self.now(clock, newest) < newest:
            return self
        return self.pause(clock, newest) if ended else Playhead()


EVERY: Final = 0.1
"""Seconds between two frames to a browser."""

STALLED: Final = 30.0
"""Seconds after which a browser that takes no frame is disconnected."""

MOST_REQUESTS: Final = 50
"""Requests of one connection in a second."""

NO_ACTIONS: Final = "this console only watches: no run receives its actions"
WATCHING: Final = "this link only watches: open the one that may act"
NAMELESS: Final = "enter your name first: each action is recorded with a name"
NOT_BEGUN: Final = "the run has not begun to write its recording"


@dataclass(frozen=True, slots=True)
class Console:
    """The recording that a console serves, and its settings.

    Attributes:
        history: The recording.
        access: The tokens to watch and to act.
        version: The version of this program.
        perform: Passes actions to the run; None if there is no run to reach.
        live: Whether the recording is still being written.
        tiles: A PMTiles file for the map.
        recording: The name of the recording's file, for people; empty if the file is not kept.
    """

    history: History
    access: Access
    version: str
    perform: Performing | None = None
    live: bool = False
    tiles: Path | None = None
    recording: str = ""


@dataclass(slots=True)
class Looker:
    """One browser: the view that it has, and its requests."""

    console: Console
    socket: Any
    role: Role
    name: str
    playhead: Playhead = field(default_factory=Playhead)
    sent: View = field(default_factory=lambda: View({}))
    number: int = 0
    _moment: Moment | None = None
    _changed: asyncio.Event = field(default_factory=asyncio.Event)

    # --- sending

    async def show(self) -> None:
        """Send the welcome and a snapshot, then the changes, until the browser is gone."""
        mode = "live" if self.console.live else "replay"
        await self._send(
            {
                "type": "welcome",
                "protocol": PROTOCOL,
                "version": self.console.version,
                "role": self.role.value,
                "mode": mode,
                "tiles": self.console.tiles is not None,
                "recording": self.console.recording,
            }
        )
        told = ""
        while not (first := self.console.history.newest()).sections:
            why = self.console.history.trouble or NOT_BEGUN
            if why != told:
                told = why
                await self._send({"type": "waiting", "message": why})
            await asyncio.sleep(EVERY)
        if not self.console.live:
            self._begin()
            first = self._view()
        self.sent, self.number = self._with_clock(first), 1
        await self._send({"type": "snapshot", "n": 1, "state": self.sent.sections})
        while True:
            began = time.monotonic()
            await self._next_frame()
            took = time.monotonic() - began
            with suppress(TimeoutError):  # a seek is shown at once
                await asyncio.wait_for(self._changed.wait(), max(EVERY - took, took, 0.02))
            self._changed.clear()

    def _begin(self) -> None:
        """Start playing a replay from its beginning."""
        history = self.console.history
        self.playhead = Playhead(history.begin, time.monotonic(), playing=True)

    async def _next_frame(self) -> None:
        view = self._with_clock(self._view())
        changed, gone = difference(self.sent, view)
        if changed or gone:
            self.sent, self.number = view, self.number + 1
            await self._send({"type": "changes", "n": self.number, "set": changed, "gone": gone})

    def _view(self) -> View:
        """Return the view at the play head."""
        history, clock = self.console.history, time.monotonic()
        if not history.behind:
            ended = not self.console.live or history.ended is not None
            self.playhead = self.playhead.caught_up(clock, history.now, ended=ended)
        if self.playhead.live:
            self._moment = None
            return history.newest()
        now = self.playhead.now(clock, history.now)
        if self._moment is None:
            self._moment = history.at(now)
        return self._moment.forward(now)

    def _with_clock(self, view: View) -> View:
        """Return a view whose section `clock` includes the play head."""
        history = self.console.history
        head = self.playhead
        shown = {
            "now": head.now(time.monotonic(), history.now),
            "live": head.live,
            "playing": head.playing,
            "speed": head.speed,
            "unread": history.trouble or None,
        }
        return View({**view.sections, "clock": {**view.sections.get("clock", {}), **shown}})

    async def _send(self, frame: dict[str, Any]) -> None:
        text = json.dumps(frame, ensure_ascii=False, separators=(",", ":"), default=dict)
        async with asyncio.timeout(STALLED):
            await self.socket.send_str(text)

    # --- receiving

    async def hear(self) -> None:
        """Carry out the browser's requests, until it is gone or sends too many."""
        ration: Ration[str] = Ration(MOST_REQUESTS)
        async for message in self.socket:
            if not ration.takes("", time.monotonic()):
                await self.socket.close(code=4429, message=b"too many requests")
                return
            if not isinstance(message.data, str):
                await self._complain("only text frames are understood")
                continue
            try:
                await self._do(read_request(message.data))
            except Unreadable as error:
                await self._complain(str(error))

    async def _complain(self, why: str) -> None:
        await self._send({"type": "error", "message": why})

    async def _do(self, request: Request) -> None:
        history, clock = self.console.history, time.monotonic()
        match request:
            case Act(name):
                refusal, left_out, notes = await self._perform(request)
                told = {"refusal": refusal, "left_out": left_out, "notes": notes}
                await self._send({"type": "answer", "id": name, **told})
                return
            case Seek(at):
                self.playhead = self.playhead.seek(at, clock, history.begin, history.now)
            case Play(speed):
                self.playhead = self.playhead.play(speed, clock, history.now)
            case Pause():
                self.playhead = self.playhead.pause(clock, history.now)
            case LiveRequest():
                self.playhead = Playhead()
            case Hello():
                await self._complain("hello was sent already")
                return
        self._changed.set()

    async def _perform(self, act: Act) -> Outcome:
        if self.role is not Role.ACT:
            return Outcome(WATCHING)
        if self.console.perform is None or self.console.history.ended is not None:
            return Outcome(NO_ACTIONS)
        if not self.name:
            return Outcome(NAMELESS)
        if not self.playhead.live:
            return Outcome("an earlier moment is shown: go to the newest one to act")
        return await self.console.perform(act.action, self.name)
