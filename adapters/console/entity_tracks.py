"""The plugins' sightings: positions, areas, the trails of vehicles, and the times of their last messages."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

from adapters.console.console_view import Json
from adapters.console.facts import Facts, Link, Position, SeenEntity, Shape, Trail
from adapters.console.parsing import band, number, position, ring, text, texts
from adapters.console.station_list import obeys
from adapters.live.command_planning import is_authority

MOST_ENTITIES: Final = 5_000
MOST_SHAPES: Final = 500

CHUNK: Final = 32
"""Positions in a piece of a trail."""

MOST_CHUNKS: Final = 64

EVERY: Final = 1.0
"""Seconds between two positions of a trail, before it is thinned out."""


def take_arrival(draft: Facts, time: float, data: Any) -> None:
    """Take in a sighting of a plugin; a position older than the known one is dropped."""
    entity, said = data.get("entity"), data.get("ring")
    if not isinstance(entity, str) or _is_anothers(draft, entity, data.get("plugin")):
        return
    if data.get("gone") is True:
        draft.seen.pop(entity, None)
        draft.shapes.pop(entity, None)
    elif isinstance(said, list) and len(said) == 1:
        _see(draft, entity, time, data)
    elif (shape := ring(said)) and (entity in draft.shapes or len(draft.shapes) < MOST_SHAPES):
        draft.shapes[entity] = Shape(text(data.get("kind")), shape, band(data.get("altitude")))


def _is_anothers(draft: Facts, entity: str, plugin: Any) -> bool:
    """Return whether a plugin reports a vehicle of another plugin.

    With stations every plugin may report a vehicle: several stations hear it over several links.
    """
    run = draft.run
    owner = None if run is None or run.station else run.vehicles.get(entity)
    return owner is not None and owner != plugin


def _see(draft: Facts, entity: str, time: float, data: Any) -> None:
    at, stamp, known = position(data["ring"][0]), number(data.get("time")), draft.seen.get(entity)
    stamp = time if stamp is None else stamp
    if at is None or (known is not None and stamp < known.time) or not _has_room(draft, entity, time):
        return
    speed, course = _velocity(data.get("velocity"))
    lives = number(data.get("time_to_live"))
    until = math.inf if lives is None else stamp + lives
    channels = tuple(texts(data.get("channels")))
    source = text(data.get("plugin"))
    said = band(data.get("altitude"))
    altitude = None if said is None else sum(said) / 2
    draft.seen[entity] = SeenEntity(
        text(data.get("kind")), at, course, speed, stamp, until, source, channels, altitude
    )
    if draft.run is not None and entity in draft.run.vehicles:
        draft.trails[entity] = extended(draft.trails.get(entity), at, stamp)
        draft.links[entity] = Link(stamp, draft.links.get(entity, _UNHEARD).lost)
        if not draft.status.get(entity, {}).get("authority"):  # the vehicle's own status is newer
            obeys(draft, stamp, entity, _authority(channels))


_UNHEARD: Final = Link()


def _authority(channels: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(each.partition(":")[2] for each in channels if is_authority(each))


def _velocity(value: Any) -> tuple[float | None, float | None]:
    match value:
        case [speed, course]:
            return number(speed), number(course)
    return None, None


def _has_room(draft: Facts, entity: str, time: float) -> bool:
    """Return whether an entity is known or may be added; expired sightings are dropped when the table is full."""
    if entity in draft.seen or len(draft.seen) < MOST_ENTITIES:
        return True
    for old in [name for name, seen in draft.seen.items() if seen.until < time]:
        del draft.seen[old]
    return len(draft.seen) < MOST_ENTITIES


# --- trails -------------------------------------------------------------------------------------------


def extended(trail: Trail | None, at: Position, time: float) -> Trail:
    """Return a trail with one more position, unless that repeats the last one or comes too soon after it."""
    if trail is None:
        return Trail(((at,),), time, EVERY)
    *before, last = trail.chunks
    if at == last[-1] or time < trail.time + trail.every:
        return trail
    pieces = (*before, (*last, at)) if len(last) < CHUNK else (*trail.chunks, (last[-1], at))
    if len(pieces) <= MOST_CHUNKS:
        return Trail(pieces, time, trail.every)
    return Trail(tuple(_pieces(_positions(pieces)[::-2][::-1])), time, 2 * trail.every)


def _positions(pieces: tuple[tuple[Position, ...], ...]) -> tuple[Position, ...]:
    return (pieces[0][0], *(at for piece in pieces for at in piece[1:]))


def _pieces(positions: tuple[Position, ...]) -> Iterator[tuple[Position, ...]]:
    for first in range(0, max(1, len(positions) - 1), CHUNK - 1):
        yield positions[first : first + CHUNK]


def tracks(facts: Facts) -> dict[str, Json]:
    """Return the section `tracks`: the pieces of all trails."""
    pieces = ((name, enumerate(trail.chunks)) for name, trail in facts.trails.items())
    return {f"{name}#{rank}": piece for name, numbered in pieces for rank, piece in numbered}
