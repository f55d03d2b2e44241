"""The times of a mission as a table and as plain data: of each flight, and of each `time` property."""

import math
from collections.abc import Iterator
from typing import Any, Final

from checker.properties.critical_path import interval_text
from checker.properties.schedule import EventDates, Milestone, PossibleFlight, Schedule

HEAD: Final = ("times", "takes", "begins", "ends, is true")


def times_text(schedule: Schedule) -> Iterator[str]:
    """Yield the times line by line: the duration and the dates of each flight, from the earliest to the latest."""
    first, *others = times_rows(schedule)
    rows = [first, *((f"  {name}", *cells) for name, *cells in others)]
    if not others:
        yield "  times: none; the mission has no flight and no property of times"
        return
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield f"  {'   '.join(cells)}".rstrip()


def times_rows(schedule: Schedule) -> Iterator[tuple[str, str, str, str]]:
    """Yield the table row by row, its head first."""
    yield HEAD
    for flight in schedule.flights:
        takes = interval_text(flight.takes, schedule.tick)
        begins, ends = (_between(schedule, each) for each in (flight.begins, flight.ends))
        yield name_of(flight), takes, begins, ends
    for milestone in schedule.milestones:
        yield milestone.name, "", "", _between(schedule, milestone.moments)


def name_of(flight: PossibleFlight) -> str:
    """Return the words for a flight."""
    return f"{flight.vehicle} from {flight.origin} to {flight.destination}, by {flight.agent}"


def _between(schedule: Schedule, moments: EventDates) -> str:
    if moments.is_never:
        return "never" if schedule.complete else "never so far"
    earliest = schedule.clock(moments.earliest)
    never = ", if at all" if moments.may_never else ""
    if not schedule.complete:
        return f"{earliest} or earlier"
    if math.isinf(moments.latest):
        return f"{earliest} or later{never}"
    latest = schedule.clock(moments.latest)
    return (f"{earliest} to {latest}" if latest != earliest else earliest) + never


def times_json(schedule: Schedule) -> dict[str, Any]:
    """Return the times as plain data, in seconds."""
    return {
        "flights": [_flight_json(schedule, each) for each in schedule.flights],
        "properties": [_milestone_json(schedule, each) for each in schedule.milestones],
    }


def _flight_json(schedule: Schedule, flight: PossibleFlight) -> dict[str, Any]:
    return {
        "vehicle": flight.vehicle,
        "agent": flight.agent,
        "from": flight.origin,
        "to": flight.destination,
        "takes": {
            "at_least": schedule.seconds(flight.takes.lo),
            "at_most": schedule.seconds(flight.takes.hi),
        },
        "begins": _moments_json(schedule, flight.begins),
        "ends": _moments_json(schedule, flight.ends),
        "bound": flight.bound.words,
        "line": flight.bound.line,
    }


def _milestone_json(schedule: Schedule, milestone: Milestone) -> dict[str, Any]:
    moments = _moments_json(schedule, milestone.moments)
    return {"name": milestone.name, "may_never": milestone.moments.may_never, **moments}


def _moments_json(schedule: Schedule, moments: EventDates) -> dict[str, Any]:
    latest = schedule.seconds(moments.latest) if schedule.complete else None
    return {"earliest": schedule.seconds(moments.earliest), "latest": latest}
