"""The time line of a recording: its appended messages, the newest view, and the view at any earlier time.

Checkpoints keep the facts at some places. For an earlier time, reading starts at the nearest checkpoint before it.
"""

from __future__ import annotations

import time as clocks
from bisect import bisect_right
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from operator import is_ as _is
from pathlib import Path
from typing import Final, Protocol

from adapters.console.console_view import NOTHING, Json, View
from adapters.console.facts import Change, Facts, Opening
from adapters.console.fold import take, time_of
from adapters.console.sections import view_of
from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import McapReader, Message, Place, RecordingError
from adapters.recording.recording_reader import MOST_MESSAGES

MOST_CHECKPOINTS: Final = 256
"""Above this number, every second checkpoint is dropped, and the distance between later ones doubles."""

APART: Final = 1_000
"""The least effort of reading between two checkpoints, in messages."""

STEP: Final = 5
"""The effort of replaying one step, in other messages."""

OFTEN: Final = 0.5
"""Seconds after which a view is made anew even without messages: links and requests grow old."""


class Drawing(Protocol):
    """A background drawer of L; nothing here waits for its pictures."""

    def drawn(self, change: Change) -> str | None:
        """Return the picture of L after a change, empty if it cannot be drawn; None if it is not ready yet."""

    def begin(self, change: Change) -> bool:
        """Begin to draw it, and return whether it has begun; False while another picture is in progress."""


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """The facts up to a place in the recording."""

    place: Place
    facts: Facts


class History:
    """The content of a recording, from its beginning to its current end.

    Attributes:
        path: The recording.
        facts: The facts up to the newest message that was read.
        opening: Returns the rules of the mission that was flown.
        behind: Whether the last reading left messages unread.
        trouble: Why the recording cannot be read (any further); empty if it can be read or is not written yet.
    """

    def __init__(
        self, path: Path, opening: Opening, drawing: Drawing | None = None, *, live: bool = False
    ) -> None:
        """Begin with nothing read; `live`: time goes on even without new messages."""
        self.facts = Facts()
        self.path = path
        self._reader = McapReader(path, unread=(OTHERS,))
        self.opening = opening
        self._drawing = drawing
        self._live = live
        self.behind = True
        self.trouble = ""
        self._told_at = clocks.monotonic()
        self._messages = 0
        self._effort = 0
        self._apart = APART
        self._checkpoints: list[Checkpoint] = []
        self._display = self.display()

    @property
    def begin(self) -> float:
        """The time of its beginning."""
        return self.facts.time if self.facts.begin is None else self.facts.begin

    @property
    def head(self) -> float:
        """The time of its newest message."""
        return self.facts.time

    @property
    def now(self) -> float:
        """The current time of the run, which goes on even without new messages."""
        silent = clocks.monotonic() - self._told_at if self._live and self.ended is None else 0.0
        rate = 1.0 if self.facts.run is None else self.facts.run.rate or 1.0
        return self.facts.time + silent * rate

    @property
    def ended(self) -> str | None:
        """Why the run ended; None as long as it may go on."""
        return self.facts.ended

    @property
    def place(self) -> Place:
        """The end of the newest message that was read."""
        return self._reader.place

    def read_on(self, budget: float) -> bool:
        """Take in appended messages for at most `budget` seconds; return whether there may be more.

        Unreadable data ends a finished recording. In a live recording it is read again later.

        Raises:
            RecordingError: It is not the recording of a run. Later damage does not raise.
            OSError: The file cannot be opened. A live recording may still be missing.
        """
        if self.ended is not None:
            self.behind = False
            return False
        until = clocks.monotonic() + budget
        draft, more = self.facts.copy(), False
        try:
            for message in self._appended():
                take(draft, message, self.opening)
                draft = self._checked(draft, STEP if message.topic == "steps" else 1)
                if clocks.monotonic() >= until:
                    more = True
                    break
        except (RecordingError, OSError) as error:
            if draft.run is None and self._live and isinstance(error, FileNotFoundError):
                return False
            self.trouble = str(error)
            if draft.run is None:
                raise
            if not self._live:
                draft.end(f"the recording cannot be read any further: {error}")
        else:
            self.trouble = ""
        if self._reader.ended and not more:
            draft.end("the recording has ended")
        if draft.changed:
            self.facts, self._told_at = draft, clocks.monotonic()
        self.behind = more
        return more

    def end(self, reason: str) -> None:
        """Note that nothing follows, unless the recording has given a reason."""
        draft = self.facts.copy()
        draft.end(reason)
        self.facts = draft

    def newest(self) -> View:
        """Return the view at the newest moment."""
        return self._display.show(self.facts, self.now, self.facts)

    def at(self, time: float) -> Moment:
        """Return the moment at a time, from which the recording can be played."""
        return Moment(self, time)

    # --- for moments

    def checkpoint(self, time: float) -> Checkpoint | None:
        """Return the last checkpoint that is not after a time, else the first."""
        later = bisect_right(self._checkpoints, time, lo=min(1, len(self._checkpoints)), key=_time_of)
        return self._checkpoints[later - 1] if self._checkpoints else None

    def reader(self, place: Place) -> McapReader:
        """Return a reader of the recording from a place that was read."""
        return self._reader.going_on(place)

    def display(self) -> BrowserDisplay:
        """Return a display for another browser."""
        return BrowserDisplay(self._drawing)

    # --- reading on

    def _appended(self) -> Iterator[Message]:
        if self._reader.grows():
            for message in self._reader.messages():
                self._messages += 1
                if self._messages > MOST_MESSAGES:
                    raise RecordingError(f"it has more than {MOST_MESSAGES:,} messages")
                yield message

    def _checked(self, draft: Facts, effort: int) -> Facts:
        """Return the draft, or a copy after a checkpoint."""
        self._effort += effort
        if draft.run is None or (self._checkpoints and self._effort < self._apart):
            return draft
        self.facts = draft
        self._checkpoints.append(Checkpoint(self.place, draft))
        self._effort = 0
        if len(self._checkpoints) > MOST_CHECKPOINTS:
            del self._checkpoints[1::2]
            self._apart *= 2
        return draft.copy()


def _time_of(checkpoint: Checkpoint) -> float:
    return checkpoint.facts.time


class BrowserDisplay:
    """The view of one browser; unchanged values stay the same objects."""

    def __init__(self, drawing: Drawing | None) -> None:
        """Show nothing yet; without a drawer, L is never drawn."""
        self._drawing = drawing
        self._shown: tuple[Facts, Facts, Json] | None = None
        self._now = 0.0
        self._view = NOTHING
        self._picture: Json = {"svg": None, "drawn": None}
        self._pictured: Change | None = None
        self._begun: Change | None = None

    def show(self, facts: Facts, now: float, head: Facts) -> View:
        """Return the view of facts at a time; `head` are the newest facts."""
        picture = self._drawn(facts)
        shown = (facts, head, picture)
        same = self._shown is not None and all(map(_is, self._shown, shown))
        if not same or abs(now - self._now) >= OFTEN:
            self._view = view_of(facts, now, head, picture, self._view)
            self._shown, self._now = shown, now
        return self._view

    def _drawn(self, facts: Facts) -> Json:
        """Return the newest finished picture of L, and begin the next one."""
        if facts.standing is None or self._drawing is None:
            return self._picture
        change = facts.standing.change
        for each in (self._begun, change):
            if each is not None and each is not self._pictured:
                self._take(each, self._drawing)
        if change is not self._pictured and self._begun is None and self._drawing.begin(change):
            self._begun = change
        return self._picture

    def _take(self, change: Change, drawing: Drawing) -> None:
        """Show the picture after a change, if it is ready."""
        svg = drawing.drawn(change)
        if svg is not None:
            self._picture = {"svg": svg or None, "drawn": change.number}
            self._pictured, self._begun = change, None


class Moment:
    """A moment on the time line, from which the recording can be played."""

    def __init__(self, history: History, time: float) -> None:
        """Begin at a time."""
        self._history = history
        self._display = history.display()
        self._facts = Facts()
        self._reader = history.reader(Place())
        self._ahead: Message | None = None
        self.forward(time)

    def forward(self, time: float) -> View:
        """Return the view at a time, before or after the last one; going on from the last one is cheap."""
        self._jump(time)
        draft = self._facts.copy()
        for message in self._messages():
            if time_of(draft, message) > time:
                self._ahead = message
                break
            take(draft, message, self._history.opening)
        if draft.changed:
            self._facts = draft
        head = self._history.facts
        return self._display.show(self._facts, max(self._facts.time, min(time, head.time)), head)

    def _jump(self, time: float) -> None:
        """Go to the nearest checkpoint before a time, unless reading on from here is shorter."""
        near = self._history.checkpoint(time)
        if near is not None and (near.place > self._reader.place or time < self._facts.time):
            self._facts, self._ahead = near.facts, None
            self._reader = self._history.reader(near.place)

    def _messages(self) -> Iterator[Message]:
        """Yield the messages from here to the end of the history's reading."""
        if self._ahead is not None:
            ahead, self._ahead = self._ahead, None
            yield ahead
        if self._reader.place < self._history.place:
            messages = self._reader.messages()
            with suppress(RecordingError):  # the history reports it
                while self._reader.place < self._history.place and (message := next(messages, None)):
                    yield message
