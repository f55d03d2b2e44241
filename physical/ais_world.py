"""Make a world from an AIS recording: the physical properties of the stations heard, as of a time."""

from collections.abc import Collection, Iterable

from physical.ais_recording import Recording
from physical.ais_reports import AisError, PositionReport
from physical.geometry import contains, point
from physical.mmsi import KINDS, entity_name, kind_of
from physical.physical_property import PhysicalProperty, Velocity
from physical.shape import Geometry

TIME_TO_LIVE = 600.0
"""How old a position may be, in seconds: what lies at anchor reports every three minutes."""

KNOT = 1852 / 3600
"""Metres a second."""


def world_at(
    recording: Recording,
    time: float | None = None,
    area: Geometry | None = None,
    kinds: Collection[str] | None = None,
    time_to_live: float = TIME_TO_LIVE,
) -> tuple[PhysicalProperty, ...]:
    """Return the newest position of every station, as of `time` (seconds since 1970), sorted by name.

    Without a time: as of the end. Positions older than `time_to_live` seconds are left out, and so is what is
    not inside `area`, or of none of `kinds`. A position to a tenth of a minute counts only where there is no
    better one. In a recording without times the last position to arrive is the newest, and none is too old.

    Raises AisError where a time is asked of a recording without times, and for an unknown kind.
    """
    _check_kinds(kinds)
    positions = recording.positions
    now = _end(positions) if time is None else time
    if time is not None and positions and _end(positions) is None:
        raise AisError(
            "ais-no-times", "the recording has no times", "leave the time out: its end is taken then"
        )
    newest = _newest(report for report in positions if now is None or _alive(report, now, time_to_live))
    found = (physical_property(report) for report in sorted(newest, key=lambda report: report.mmsi))
    return tuple(known for known in found if _wanted(known, area, kinds))


def physical_property(report: PositionReport) -> PhysicalProperty:
    """Turn one position into the physical property of its sender, named by its MMSI."""
    speed, course = report.sog_kn, report.cog_deg
    return PhysicalProperty(
        entity_name(report.mmsi),
        kind_of(report.mmsi, report.msg_type),
        point(report.lat, report.lon),
        time=report.time,
        source="ais",
        velocity=None if speed is None or course is None else Velocity(speed * KNOT, course),
    )


def _check_kinds(kinds: Collection[str] | None) -> None:
    unknown = sorted(set(kinds or ()) - set(KINDS))
    if unknown:
        raise AisError(
            "ais-kind", f"no AIS station is of kind {unknown[0]!r:.60}", f"the kinds are {', '.join(KINDS)}"
        )


def _end(positions: Iterable[PositionReport]) -> float | None:
    return max((report.time for report in positions if report.time is not None), default=None)


def _alive(report: PositionReport, now: float, time_to_live: float) -> bool:
    return report.time is not None and now - time_to_live <= report.time <= now


def _newest(positions: Iterable[PositionReport]) -> Iterable[PositionReport]:
    best: dict[int, PositionReport] = {}
    for report in positions:
        known = best.get(report.mmsi)
        if known is None or _rank(report) >= _rank(known):
            best[report.mmsi] = report
    return best.values()


def _rank(report: PositionReport) -> tuple[bool, float]:
    return not report.coarse, 0.0 if report.time is None else report.time


def _wanted(known: PhysicalProperty, area: Geometry | None, kinds: Collection[str] | None) -> bool:
    return (kinds is None or known.kind in kinds) and (area is None or contains(area, known.geometry))
