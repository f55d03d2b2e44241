"""Assemble multi-part AIS messages: a bounded table as an immutable value.

Parts belong together when talker, sequence number, channel, total and the tag block's group agree, and when
they are heard near each other. They may come in any order, and twice.
"""

from dataclasses import dataclass, replace

from physical.nmea import Part

FRAGMENT_SECONDS = 5.0
"""How long after the first part of a message the others count, where lines have times."""

FRAGMENT_LINES = 100
"""How many parts of any message may be heard meanwhile."""

FRAGMENT_TABLE = 64
"""How many incomplete messages are held; the oldest gives way."""

Key = tuple[str, bytes, bytes, int, str | None]


@dataclass(frozen=True, slots=True)
class Incomplete:
    """A message some of whose parts are missing: `time` is its first part's, `heard` that part's number.

    `sentences` is how many sentences brought its parts: one may be repeated.
    """

    key: Key
    parts: tuple[Part, ...]
    time: float | None
    heard: int
    sentences: int = 1


@dataclass(frozen=True, slots=True)
class Fragments:
    """The incomplete messages, oldest first, and how many parts were heard in all."""

    waiting: tuple[Incomplete, ...] = ()
    heard: int = 0


EMPTY = Fragments()


@dataclass(frozen=True, slots=True)
class Joined:
    """What one part led to: the new table, the message it completed, if any, and those that were given up."""

    fragments: Fragments
    complete: Incomplete | None
    lost: tuple[Incomplete, ...]


def join(fragments: Fragments, part: Part, time: float | None, group: str | None = None) -> Joined:
    """Add a part to the message that it belongs to, or let it begin one."""
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


def _together(entry: Incomplete, part: Part, time: float | None) -> bool:
    """Whether a part can be of this message: near in time, and no other text under a number already heard."""
    if entry.time is not None and time is not None and abs(time - entry.time) > FRAGMENT_SECONDS:
        return False
    return all(part.number != other.number or part.payload == other.payload for other in entry.parts)


def _with(entry: Incomplete, part: Part) -> Incomplete:
    entry = replace(entry, sentences=entry.sentences + 1)
    if any(part.number == other.number for other in entry.parts):
        return entry
    return replace(entry, parts=tuple(sorted((*entry.parts, part), key=lambda one: one.number)))
