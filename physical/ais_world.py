"""A world from an AIS recording: the physical properties of its stations at a given time."""

from collections import OrderedDict
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from typing import Final

from physical.ais_recording import AISRecording
from physical.ais_reports import HIGHEST_ALTITUDE, AisError, PositionReport
from physical.altitude import Band
from physical.file_account import Counting, Read
from physical.geometry import contains, point
from physical.mmsi import KINDS, entity_name, kind_of
from physical.physical_property import PhysicalProperty, Velocity
from physical.shape import Geometry
from physical.written_times import moment_text

TIME_TO_LIVE = 600.0
"""The maximum age of a position in seconds: a vessel at anchor reports every three minutes."""

KNOT = 1852 / 3600
"""Metres per second in a knot."""

COARSE: Final = "position to a tenth of a minute, of a station with a finer one"

HIGHEST_FLIGHT: Final = 20_000.0
"""Metres above which no aircraft with AIS flies."""

MOST_STATIONS: Final = 100_000
"""The largest number of remembered stations with fine positions."""


def world_at(
    recording: AISRecording,
    time: float | None = None,
    area: Geometry | None = None,
    kinds: Collection[str] | None = None,
    time_to_live: float = TIME_TO_LIVE,
) -> tuple[PhysicalProperty, ...]:
    """Return the newest position of every station at `time` (seconds since 1970), sorted by name.

    By default, `time` is the end of the recording. The result excludes positions older than `time_to_live` seconds,
    positions outside `area`, and stations of kinds other than `kinds`. A coarse position (a tenth of a minute) counts
    only for a station without a finer one. A position without a time takes the time of its neighbour. In a recording
    without times, the last position to arrive is the newest, and none is too old.

    Raises:
        AisError: If `time` is given for a recording without times, and for an unknown kind.
    """
    return seen_at(recording, time, area, kinds, time_to_live).properties


def seen_at(
    recording: AISRecording,
    time: float | None = None,
    area: Geometry | None = None,
    kinds: Collection[str] | None = None,
    time_to_live: float = TIME_TO_LIVE,
) -> Read:
    """Return the result of `world_at`, with the accounts of the recording and of its positions."""
    _check_kinds(kinds)
    positions = dated(recording.positions)
    now = _end(positions) if time is None else time
    if time is not None and positions and _end(positions) is None:
        raise AisError(
            "ais-no-times", "the recording has no times", "leave the time out: its end is taken then"
        )
    counting = Counting()
    newest = _newest(_alive(positions, now, time_to_live, counting), counting)
    found = [physical_property(report) for report in sorted(newest, key=lambda report: report.mmsi)]
    kept = tuple(known for known in found if _is_wanted(known, area, kinds, counting))
    counting.take("station", len(kept))
    if now is not None and (undated := sum(report.time is None for report in recording.positions)):
        counting.note(UNDATED, undated)
    return Read(kept, (recording.tally, counting.tally(len(positions), "position")))


UNDATED: Final = "position without a time: it counts as heard when its neighbour in the recording was"


def check_time(recording: AISRecording, time: float | None, time_to_live: float = TIME_TO_LIVE) -> None:
    """Raise AisError, with the recording's span, for a time at which no position of it counts."""
    times = [report.time for report in recording.positions if report.time is not None]
    if time is None or not times or min(times) <= time <= max(times) + time_to_live:
        return
    span = f"it runs from {moment_text(min(times))} to {moment_text(max(times))}"
    message = f"the recording has no position at {moment_text(time)}: {span}"
    hint = "choose a time in between, or leave it out: the end is taken then"
    raise AisError("ais-time", message, hint)


def dated(positions: Iterable[PositionReport]) -> tuple[PositionReport, ...]:
    """Return positions, in order of arrival, in which a missing time is that of a neighbour.

    It is the latest time before the position, else the first time after it; None if no position has a time.
    """
    known = tuple(positions)
    time = next((report.time for report in known if report.time is not None), None)
    found = []
    for report in known:
        time = report.time if report.time is not None else time
        found.append(report if report.time == time else replace(report, time=time))
    return tuple(found)


class Finest:
    """The stations with a recent fine position: a coarse position of such a station adds nothing.

    At most `MOST_STATIONS` are remembered, the latest ones.
    """

    def __init__(self, time_to_live: float = TIME_TO_LIVE) -> None:
        self._heard: OrderedDict[int, float] = OrderedDict()
        self._time_to_live = time_to_live

    def supersedes(self, report: PositionReport, time: float) -> bool:
        """Record a report at a time; return whether a finer one of its sender is still valid."""
        if report.coarse:
            known = self._heard.get(report.mmsi)
            return known is not None and time - known <= self._time_to_live
        self._heard[report.mmsi] = time
        self._heard.move_to_end(report.mmsi)
        if len(self._heard) > MOST_STATIONS:
            self._heard.popitem(last=False)
        return False


def physical_property(report: PositionReport) -> PhysicalProperty:
    """Return the physical property of a position's sender, named by its MMSI."""
    speed, course = report.sog_kn, report.cog_deg
    return PhysicalProperty(
        entity_name(report.mmsi),
        kind_of(report.mmsi, report.msg_type),
        point(report.lat, report.lon),
        _band(report.altitude),
        time=report.time,
        source="ais",
        velocity=None if speed is None or course is None else Velocity(speed * KNOT, course),
    )


def _band(altitude: float | None) -> Band | None:
    if altitude is None:
        return None
    return Band(altitude, HIGHEST_FLIGHT if altitude >= HIGHEST_ALTITUDE else altitude)


def _check_kinds(kinds: Collection[str] | None) -> None:
    unknown = sorted(set(kinds or ()) - set(KINDS))
    if unknown:
        raise AisError(
            "ais-kind", f"no AIS station is of kind {unknown[0]!r:.60}", f"the kinds are {', '.join(KINDS)}"
        )


def _end(positions: Iterable[PositionReport]) -> float | None:
    return max((report.time for report in positions if report.time is not None), default=None)


def _alive(
    positions: Iterable[PositionReport], now: float | None, time_to_live: float, counting: Counting
) -> Iterator[PositionReport]:
    for report in positions:
        if now is None or report.time is None:
            yield report
        elif report.time > now:
            counting.leave("position after the time")
        elif report.time < now - time_to_live:
            counting.leave(f"position older than {time_to_live:g} s")
        else:
            yield report


def _newest(positions: Iterable[PositionReport], counting: Counting) -> Iterable[PositionReport]:
    best: dict[int, PositionReport] = {}
    for report in positions:
        known = best.get(report.mmsi)
        if known is None or _rank(report) >= _rank(known):
            best[report.mmsi] = report
        if known is not None:
            coarse = report.coarse != known.coarse
            counting.leave(COARSE if coarse else "position of a station with a newer one")
    return best.values()


def _rank(report: PositionReport) -> tuple[bool, float]:
    return not report.coarse, 0.0 if report.time is None else report.time


def _is_wanted(
    known: PhysicalProperty, area: Geometry | None, kinds: Collection[str] | None, counting: Counting
) -> bool:
    if kinds is not None and known.kind not in kinds:
        counting.leave(f"{known.kind} not asked for")
    elif area is not None and not contains(area, known.geometry):
        counting.leave("station outside the area")
    else:
        return True
    return False
