"""The time line of a recording: read on, the newest view, and the view at any earlier time.

What was told up to some messages is kept (checkpoints); from the nearest one before a time the recording is read again.
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

from adapters.console.facts import Change, Facts, Opening
from adapters.console.fold import take, time_of
from adapters.console.mutable_facts import Draft
from adapters.console.sections import view_of
from adapters.console.view import NOTHING, Json, View
from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import McapReader, Message, Place, RecordingError
from adapters.recording.reading import MOST_MESSAGES

MOST_CHECKPOINTS: Final = 256
"""Of more, every second one is dropped, and later ones are so much further apart."""

APART: Final = 1_000
"""The least effort between two checkpoints, in messages."""

STEP: Final = 5
"""How many other messages take as long to read again as one step."""

OFTEN: Final = 0.5
"""Seconds after which a view is made anew although nothing was told: links and requests grow old."""


class Drawing(Protocol):
    """What draws L, elsewhere: nothing here waits for it."""

    def drawn(self, change: Change) -> str | None:
        """Return the picture of L after a change, empty where it cannot be drawn; None if it is not drawn yet."""

    def begin(self, change: Change) -> bool:
        """Begin to draw it, and tell whether it is begun; not while another one is being drawn."""


class Undrawn:
    """Draws nothing."""

    def drawn(self, _change: Change) -> str | None:
        """Return nothing."""
        return None

    def begin(self, _change: Change) -> bool:
        """Begin nothing."""
        return False


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """What was told up to a place in the recording."""

    place: Place
    facts: Facts


class History:
    """All that a recording tells, from its beginning to where it is written now.

    Attributes:
        facts: What it has told up to the newest message that was read.
        opening: Returns the rules of what was flown.
        behind: Whether more of the recording was there to be read when it was read last.
        trouble: Why it cannot be read, or not any further; empty where it can, or is not written yet.
    """

    def __init__(
        self, path: Path, opening: Opening, drawing: Drawing | None = None, *, live: bool = False
    ) -> None:
        """Begin with nothing read; `live`: time goes on although nothing is written."""
        self.facts = Facts()
        self._reader = McapReader(path, unread=(OTHERS,))
        self.opening = opening
        self._drawing: Drawing = Undrawn() if drawing is None else drawing
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
        """The time at which it begins."""
        return self.facts.time if self.facts.begin is None else self.facts.begin

    @property
    def head(self) -> float:
        """The newest time that it tells of."""
        return self.facts.time

    @property
    def now(self) -> float:
        """The time at which it is, which goes on although nothing is written."""
        silent = clocks.monotonic() - self._told_at if self._live and self.ended is None else 0.0
        rate = 1.0 if self.facts.run is None else self.facts.run.rate or 1.0
        return self.facts.time + silent * rate

    @property
    def ended(self) -> str | None:
        """Why the run ended; None as long as it may go on."""
        return self.facts.ended

    @property
    def place(self) -> Place:
        """Where the newest message that was read ends."""
        return self._reader.place

    def read_on(self, budget: float) -> bool:
        """Take in what was appended, for at most `budget` seconds; tell whether there may be more.

        What cannot be read ends a recording, but no run that is still to write it: it is tried again.

        Raises:
            RecordingError: It is no recording of a run. What is damaged later ends it.
            OSError: It cannot be opened; where it is still to be written, it need not be there yet.
        """
        if self.ended is not None:
            self.behind = False
            return False
        until = clocks.monotonic() + budget
        draft, more = Draft(self.facts), False
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
            self.facts, self._told_at = draft.facts(), clocks.monotonic()
        self.behind = more
        return more

    def end(self, reason: str) -> None:
        """Note that nothing follows, unless the recording has told why."""
        draft = Draft(self.facts)
        draft.end(reason)
        self.facts = draft.facts()

    def newest(self) -> View:
        """Return the view at the newest moment."""
        return self._display.show(self.facts, self.now, self.facts)

    def at(self, time: float) -> Moment:
        """Return the moment at a time, from which the recording can be told on."""
        return Moment(self, time)

    # --- for moments

    def checkpoint(self, time: float) -> Checkpoint | None:
        """Return the last checkpoint that is not after a time, else the first."""
        later = bisect_right(self._checkpoints, time, lo=min(1, len(self._checkpoints)), key=_time_of)
        return self._checkpoints[later - 1] if self._checkpoints else None

    def reader(self, place: Place) -> McapReader:
        """Return a reader of the recording from a place that was read."""
        return self._reader.going_on(place)

    def display(self) -> Display:
        """Return what another looker is shown."""
        return Display(self._drawing)

    # --- reading on

    def _appended(self) -> Iterator[Message]:
        if self._reader.grows():
            for message in self._reader.messages():
                self._messages += 1
                if self._messages > MOST_MESSAGES:
                    raise RecordingError(f"it has more than {MOST_MESSAGES:,} messages")
                yield message

    def _checked(self, draft: Draft, effort: int) -> Draft:
        """Return the draft, or another one after a checkpoint."""
        self._effort += effort
        if draft.run is None or (self._checkpoints and self._effort < self._apart):
            return draft
        self.facts = facts = draft.facts()
        self._checkpoints.append(Checkpoint(self.place, facts))
        self._effort = 0
        if len(self._checkpoints) > MOST_CHECKPOINTS:
            del self._checkpoints[1::2]
            self._apart *= 2
        return Draft(facts)


def _time_of(checkpoint: Checkpoint) -> float:
    return checkpoint.facts.time


class Display:
    """What one looker is shown: what stays as it was stays the same object."""

    def __init__(self, drawing: Drawing) -> None:
        """Show nothing yet."""
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
        """Return the newest picture of L that there is, and have the next one begun."""
        if facts.standing is None:
            return self._picture
        change = facts.standing.change
        for each in (self._begun, change):
            if each is not None and each is not self._pictured:
                self._take(each)
        if change is not self._pictured and self._begun is None and self._drawing.begin(change):
            self._begun = change
        return self._picture

    def _take(self, change: Change) -> None:
        """Show the picture after a change, if it is drawn."""
        svg = self._drawing.drawn(change)
        if svg is not None:
            self._picture = {"svg": svg or None, "drawn": change.number}
            self._pictured, self._begun = change, None


class Moment:
    """A place on the time line, from which the recording is told on."""

    def __init__(self, history: History, time: float) -> None:
        """Begin at a time."""
        self._history = history
        self._display = history.display()
        self._facts = Facts()
        self._reader = history.reader(Place())
        self._ahead: Message | None = None
        self.forward(time)

    def forward(self, time: float) -> View:
        """Return the view at a time: a later one than before, or any other."""
        self._jump(time)
        draft = Draft(self._facts)
        for message in self._messages():
            if time_of(draft, message) > time:
                self._ahead = message
                break
            take(draft, message, self._history.opening)
        if draft.changed:
            self._facts = draft.facts()
        head = self._history.facts
        return self._display.show(self._facts, max(self._facts.time, min(time, head.time)), head)

    def _jump(self, time: float) -> None:
        """Go to the nearest checkpoint before a time, unless less has to be read from here."""
        near = self._history.checkpoint(time)
        if near is not None and (near.place > self._reader.place or time < self._facts.time):
            self._facts, self._ahead = near.facts, None
            self._reader = self._history.reader(near.place)

    def _messages(self) -> Iterator[Message]:
        """Yield the messages that the history has read, from here on."""
        if self._ahead is not None:
            ahead, self._ahead = self._ahead, None
            yield ahead
        if self._reader.place < self._history.place:
            messages = self._reader.messages()
            with suppress(RecordingError):  # which the history has told
                while self._reader.place < self._history.place and (message := next(messages, None)):
                    yield message
