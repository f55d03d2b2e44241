"""The tracks of a recording or a trace: the dated positions of each entity, as GeoJSON, GPX or CSV."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from adapters.recording.mcap_files import RecordingError
from adapters.recording.recorded_tracks import WRITERS, recorded_tracks
from bigactors.files import write_text
from bigactors.mistakes import Mistake, unreadable
from checker import Trace
from physical.geojson_tracks import PositionFix, Track
from physical.shape import Geometry
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed


def write_recorded(path: str, output: str) -> int:
    """Write the tracks of all recorded entities with point positions; return their number; raises Mistake."""
    try:
        found = recorded_tracks(Path(path))
    except RecordingError as error:
        raise Mistake(str(error), place=path) from error
    except OSError as error:
        raise unreadable(path, error) from error
    return _write(found, output)


def write_traced(trace: Trace, times: Sequence[float], output: str) -> int:
    """Write the tracks of the points that a trace moves; return their number; raises Mistake."""
    kinds = trace.initial.setting.kinds
    found = ((name, tuple(_stands(trace.configurations, times, name))) for name in sorted(kinds))
    return _write([Track(name, kinds[name], fixes) for name, fixes in found if len(fixes) > 1], output)


def _stands(
    configurations: Iterable[Configuration], times: Sequence[float], name: str
) -> Iterator[PositionFix]:
    """Yield each new position of a point. The first is dated by the first step."""
    before: Geometry | None = None
    for number, each in enumerate(configurations):
        at = each.structure.physical.placement(name)
        if isinstance(at, Placed) and at.geometry.is_point and at.geometry is not before:
            before = at.geometry
            time = times[max(number - 1, 0)] if times else None
            yield PositionFix(
                before.ring[0],
                time,
                None if at.altitude is None else (at.altitude.low + at.altitude.high) / 2,
            )


def _write(tracks: Sequence[Track], output: str) -> int:
    if not tracks:
        raise Mistake(
            "nothing in it moves: there are no tracks to be written", "draw it: --output FILE.svg", output
        )
    write_text(output, WRITERS[Path(output).suffix.lower()](tracks))
    return len(tracks)
