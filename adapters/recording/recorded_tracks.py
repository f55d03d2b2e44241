"""The tracks of a recording, and their files: GeoJSON, GPX 1.1 and CSV."""

from __future__ import annotations

import csv
import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from io import StringIO
from pathlib import Path
from typing import Any, Final
from xml.sax.saxutils import escape

from adapters.recording.mcap_files import McapReader
from physical.frame import E7
from physical.geojson_tracks import PositionFix, Track, write_tracks
from physical.written_times import LATEST

_FORBIDDEN: Final = re.compile("[^\\t\\n\\x20-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]")

GPX: Final = '<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="bigactors" xmlns="http://www.topografix.com/GPX/1/1">\n'


def recorded_tracks(path: Path, names: Collection[str] | None = None) -> list[Track]:
    """Return the tracks of all recorded entities with point positions, or of those named.

    Raises:
        RecordingError: The file is no recording.
        OSError: It cannot be read.
    """
    kinds: dict[str, str] = {}
    found: defaultdict[str, list[PositionFix]] = defaultdict(list)
    for message in McapReader(path).messages():
        match message.data:
            case {"entity": str(entity), "ring": [[int(north), int(east)]], **more} if (
                message.topic == "arrivals"
                and (names is None or entity in names)
                and abs(north) <= 90 * E7
                and abs(east) <= 180 * E7
            ):
                kinds[entity] = str(more.get("kind") or "")
                found[entity].append(_fix(north, east, message.time, more))
    return [Track(name, kinds[name], tuple(fixes)) for name, fixes in sorted(found.items())]


def _fix(north: int, east: int, time: float, more: Mapping[Any, Any]) -> PositionFix:
    """Return a position, dated by its observation, or else by its arrival."""
    height = None
    match more.get("altitude"):
        case [int() | float() as low, int() | float() as high]:
            height = (low + high) / 2
    seen = more.get("time")
    return PositionFix((north, east), seen if isinstance(seen, int | float) else time, height)


def write_gpx(tracks: Iterable[Track]) -> str:
    """Return tracks as GPX 1.1, in which heights are above sea level."""
    return f"{GPX}{''.join(map(_gpx_track, tracks))}</gpx>\n"


def _gpx_track(track: Track) -> str:
    points = "".join(map(_gpx_point, track.fixes))
    name, kind = (escape(_legal(each)) for each in (track.name, track.kind))
    return f"<trk><name>{name}</name><type>{kind}</type><trkseg>\n{points}</trkseg></trk>\n"


def _gpx_point(fix: PositionFix) -> str:
    north, east = (f"{each / E7:.7f}" for each in fix.position)
    high = "" if fix.height is None else f"<ele>{fix.height:.1f}</ele>"
    time = f"<time>{at}</time>" if (at := _written(fix.time)) else ""
    return f'<trkpt lat="{north}" lon="{east}">{high}{time}</trkpt>\n'


def _legal(text: str) -> str:
    """Return a text without the characters that XML forbids."""
    return _FORBIDDEN.sub("", text)


def write_csv(tracks: Iterable[Track]) -> str:
    """Return tracks as a table of comma-separated values, a row for each position."""
    text = StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(("name", "kind", "time", "latitude", "longitude", "altitude"))
    for track in tracks:
        for (north, east), time, height in track.fixes:
            where = f"{north / E7:.7f}", f"{east / E7:.7f}", "" if height is None else f"{height:.1f}"
            table.writerow((_plain(track.name), _plain(track.kind), _written(time), *where))
    return text.getvalue()


def _plain(text: str) -> str:
    """Return a text that no spreadsheet reads as a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


def _written(time: float | None) -> str:
    if time is None or not 0 <= time <= LATEST:
        return ""
    return datetime.fromtimestamp(time, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


WRITERS: Final[Mapping[str, Callable[[Sequence[Track]], str]]] = {
    ".geojson": write_tracks,
    ".json": write_tracks,
    ".gpx": write_gpx,
    ".csv": write_csv,
}
"""The writer of each sort of file, by its suffix."""
