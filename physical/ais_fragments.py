"""Assembly of multi-part AIS messages: a bounded table as an immutable value.

Parts belong together if talker, sequence number, channel, total and the tag block's group agree, and if they arrive
close to each other. They may arrive in any order, and repeatedly.
"""

from dataclasses import dataclass, replace

from physical.nmea import Fragment

FRAGMENT_SECONDS = 5.0
"""Seconds after the first part of a message in which its other parts count, if lines have times."""

FRAGMENT_LINES = 100
"""The number of parts, of any message, after which an incomplete message expires."""

FRAGMENT_TABLE = 64
"""The largest number of incomplete messages; a new one replaces the oldest."""

Key = tuple[str, bytes, bytes, int, str | None]


@dataclass(frozen=True, slots=True)
class Incomplete:
    """An incomplete message: `time` is the time of its first part, `heard` the count of parts received before it.

    `sentences` counts the sentences that brought its parts, repetitions included.
    """

    key: Key
    parts: tuple[Fragment, ...]
    time: float | None
    heard: int
    sentences: int = 1


@dataclass(frozen=True, slots=True)
class Fragments:
    """The incomplete messages, oldest first, and the number of parts received in all."""

    waiting: tuple[Incomplete, ...] = ()
    heard: int = 0


EMPTY = Fragments()


@dataclass(frozen=True, slots=True)
class Joined:
    """The effect of one part: the new table, the completed message, if any, and the expired messages."""

    fragments: Fragments
    complete: Incomplete | None
    lost: tuple[Incomplete, ...]


def join(fragments: Fragments, part: Fragment, time: float | None, group: str | None = None) -> Joined:
    """Add a part to its message, or start a new message."""
    key = (part.talker, part.sequence, part.channel, part.total, group)
    recent = tuple(entry for entry in fragments.waiting if fragments.heard - entry.heard < FRAGMENT_LINES)
    mine = next((entry for entry in recent if entry.key == key and _together(entry, part, time)), None)
    others = tuple(entry for entry in recent if entry.key != key)
    grown = Incomplete(key, (part,), time, fragments.heard) if mine is None else _with(mine, part)
    done = len(grown.parts) == part.total
    waiting = others if done else (*others, grown)[-FRAGMENT_TABLE:]
    # each message ends once: completed, still waiting, or lost
    kept = {id(entry) for entry in waiting}
    lost = tuple(entry for entry in fragments.waiting if entry is not mine and id(entry) not in kept)
    return Joined(Fragments(waiting, fragments.heard + 1), grown if done else None, lost)


def _together(entry: Incomplete, part: Fragment, time: float | None) -> bool:
    """Whether a part may belong to a message: near in time, and without a conflicting part of the same number."""
    if entry.time is not None and time is not None and abs(time - entry.time) > FRAGMENT_SECONDS:
        return False
    return all(part.number != other.number or part.payload == other.payload for other in entry.parts)


def _with(entry: Incomplete, part: Fragment) -> Incomplete:
    entry = replace(entry, sentences=entry.sentences + 1)
    if any(part.number == other.number for other in entry.parts):
        return entry
    return replace(entry, parts=tuple(sorted((*entry.parts, part), key=lambda one: one.number)))
