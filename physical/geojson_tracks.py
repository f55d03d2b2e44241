"""Tracks as GeoJSON: a LineString for each, with the time of each position in `coordTimes`, as in GPX."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any, NamedTuple

from physical.frame import E7, TURN, PositionE7
from physical.written_times import LATEST


class PositionFix(NamedTuple):
    """A position in 1e-7 degree, with its time (seconds since 1970 UTC) and its height in metres, if known."""

    position: PositionE7
    time: float | None = None
    height: float | None = None


class Track(NamedTuple):
    """The positions of one entity, in order of time."""

    name: str
    kind: str
    fixes: tuple[PositionFix, ...]


def write_tracks(tracks: Iterable[Track]) -> str:
    """Return a feature collection of tracks; a track of one position is a Point.

    A track is cut at the antimeridian (RFC 7946 §3.1.9). Its heights are written if all are known.
    """
    features = [_feature(track) for track in tracks]
    return json.dumps({"type": "FeatureCollection", "features": features}, ensure_ascii=False) + "\n"


def _feature(track: Track) -> dict[str, Any]:
    parts = list(_parts(track.fixes))
    high = all(fix.height is not None for fix in track.fixes)
    lines = [[_coordinates(fix, high=high) for fix in part] for part in parts]
    times = [[_text(fix.time) for fix in part] for part in parts]
    kind: str
    coordinates: Any
    told: Any
    if len(track.fixes) == 1:
        kind, coordinates, told = "Point", lines[0][0], times[0][0]
    elif len(parts) == 1:
        kind, coordinates, told = "LineString", lines[0], times[0]
    else:
        kind, coordinates, told = "MultiLineString", lines, times
    known = all(fix.time is not None for fix in track.fixes)
    timed = {"coordTimes" if len(track.fixes) > 1 else "time": told} if known else {}
    properties = {"name": track.name, "kind": track.kind, **timed}
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": kind, "coordinates": coordinates},
    }


def _parts(fixes: Sequence[PositionFix]) -> Iterator[list[PositionFix]]:
    """Yield the parts of a track, split where it crosses the antimeridian."""
    part = list(fixes[:1])
    for before, here in pairwise(fixes):
        if abs(here.position[1] - before.position[1]) > TURN // 2:
            leaving, entering = _crossing(before, here)
            yield [*part, leaving]
            part = [entering]
        part.append(here)
    yield part


def _crossing(before: PositionFix, after: PositionFix) -> tuple[PositionFix, PositionFix]:
    """Return the points where a track leaves one side of the antimeridian and enters the other."""
    side = TURN // 2 if before.position[1] > 0 else -TURN // 2
    to_side, from_side = abs(side - before.position[1]), abs(after.position[1] + side)
    share = to_side / (to_side + from_side) if to_side + from_side else 0.0
    north = round(before.position[0] + share * (after.position[0] - before.position[0]))
    at = before._replace(position=(north, side), time=_between(before.time, after.time, share))
    at = at._replace(height=_between(before.height, after.height, share))
    return at, at._replace(position=(north, -side))


def _between(a: float | None, b: float | None, share: float) -> float | None:
    return None if a is None or b is None else a + share * (b - a)


def _coordinates(fix: PositionFix, *, high: bool) -> list[float | None]:
    north, east = fix.position
    return [east / E7, north / E7, *([fix.height] if high else [])]


def _text(time: float | None) -> str | None:
    if time is None:
        return None
    moment = datetime.fromtimestamp(min(max(time, 0.0), LATEST), UTC)
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")
