"""Read a recording: its run, its steps as a trace, and its other messages, in written order."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import MAGIC, McapReader, Message, RecordingError
from physical import open_file

VERSION = 1
"""The version of the schemas of messages."""

MOST_MESSAGES = 20_000_000


@dataclass(frozen=True, slots=True)
class Recording:
    """The content of a recording.

    Attributes:
        run: The flown mission, with its settings.
        messages: All other messages, in the order written; arrivals only on request, and no messages for other
            programs.
        torn: Whether it has no end: the run was killed.
        until: The time of its last message of any kind.
    """

    run: dict[str, Any]
    messages: tuple[Message, ...]
    torn: bool
    until: float = 0.0

    def of(self, topic: str) -> tuple[Message, ...]:
        """Return the messages of a topic."""
        return tuple(message for message in self.messages if message.topic == topic)

    @property
    def left_out(self) -> int:
        """The number of arrivals that were not recorded."""
        counts = (message.data.get("arrivals") for message in self.of("left_out"))
        return sum(count for count in counts if type(count) is int)

    def trace(self, schema: str) -> dict[str, Any]:
        """Return the steps as a trace, in the step schema."""
        steps = [{**message.data, "changes": [], "time": message.time} for message in self.of("steps")]
        known = {"schema": schema, "mission": self.run["mission"], "digest": self.run["digest"]}
        return {**known, "monitored": False, "steps": steps, "in_turn": self.in_turn}

    @property
    def in_turn(self) -> bool:
        """Whether requests were served in the turn of `fcfs`, since the verdict was for `fcfs` only."""
        return self.run.get("strict") is True


def is_recording(path: str) -> bool:
    """Return whether a file is MCAP, by its first bytes."""
    try:
        with open_file(path) as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):
        return False


def read_recording(path: Path, *, arrivals: bool = False) -> Recording:
    """Return the content of a file; raises RecordingError if it is no recording of a run, OSError."""
    reader = McapReader(path)
    run: dict[str, Any] | None = None
    kept: list[Message] = []
    until = 0.0
    for number, message in enumerate(reader.messages()):
        if number > MOST_MESSAGES:
            raise RecordingError(f"it has more than {MOST_MESSAGES:,} messages")
        if not isinstance(message.data, dict):
            raise RecordingError(f"a message of '{message.topic:.40}' is no object")
        until = max(until, message.time)
        if message.topic == "run" and run is None:
            run = message.data
        elif (arrivals or message.topic != "arrivals") and not message.topic.startswith(OTHERS):
            kept.append(message)
    return Recording(checked_run(run), tuple(kept), not reader.ended, until)


def checked_run(run: dict[str, Any] | None) -> dict[str, Any]:
    """Return a valid description of the flown mission; raises RecordingError."""
    if run is None:
        raise RecordingError("it records no run of a mission")
    if run.get("schema") != f"bigactors.run/{VERSION}":
        raise RecordingError(f"its schema is {run.get('schema')!r:.60}, not 'bigactors.run/{VERSION}'")
    if not all(isinstance(run.get(key), str) for key in ("mission", "text", "digest")):
        raise RecordingError("its run lacks the mission's name, text or digest")
    return run
