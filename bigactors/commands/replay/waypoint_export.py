"""The files of a replay: waypoints for ground stations (paper, Example 1), and the report of a flight as a page."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from adapters.console.flight_report import flight_report
from adapters.console.history import History
from adapters.recording.recorded_tracks import recorded_tracks
from adapters.recording.recording_reader import is_recording
from bigactors.commands.console.recorded_history import rules_of
from bigactors.files import write_text
from bigactors.mistakes import Mistake, near_or_known
from bigactors.terminal import tell
from checker import Trace
from physical import Geometry, MobilityCommand, Waypoint, write_plan, write_waypoints
from physical.place_files import PLAN, WAYPOINTS
from semantics.brr_driver import mobility_commands
from semantics.control import Realisation, realisations
from semantics.state.configuration import Configuration
from semantics.state.physical_model import InTransit
from semantics.state.requests import CTR
from semantics.state.signature import Name

HEIGHT = 100.0
"""Metres above home: the travel height of a vehicle without a given altitude to a place without an altitude band."""

WRITERS = {PLAN: write_plan, WAYPOINTS: write_waypoints}


def write_route(trace: Trace, vehicle: Name, path: str) -> int:
    """Write the points to which a trace sends a vehicle; return their number; raises Mistake."""
    write = WRITERS.get(Path(path).suffix)
    if write is None:
        raise Mistake("a route is written as one of " + ", ".join(WRITERS), "name the file so", path)
    start = trace.initial
    if vehicle not in start.setting.kinds:
        hint = near_or_known(vehicle, start.setting.driven(), "vehicles")
        raise Mistake(f"the mission has no entity '{vehicle:.60}'", hint)
    told = [each for each in _told(trace) if isinstance(each, Waypoint) and each.entity == vehicle]
    if not told:
        raise Mistake(f"nothing sends '{vehicle}' anywhere in this trace", "name another vehicle")
    points, bands = [each.point for each in told], [each.altitude for each in told]
    write_text(path, write(points, HEIGHT, *_home(start, vehicle), bands))
    return len(told)


def _home(c: Configuration, vehicle: Name) -> tuple[Geometry | None, float]:
    """Return a vehicle's start, if it is a point, and its altitude, by default 0 m."""
    at = c.structure.physical.position(vehicle)
    altitude = 0.0 if at is None or at.altitude is None else at.altitude.low
    return at.geometry if at is not None and at.geometry.is_point else None, altitude


def _told(trace: Trace) -> Iterator[MobilityCommand]:
    """Yield the commands to vehicles in a trace: when a control is commanded, or actuated at once."""
    for (before, after), step in zip(pairwise(trace.configurations), trace.steps, strict=True):
        request = step.label.about
        if step.label.rule in ("command", "actuate") and isinstance(request, CTR):
            ways = realisations(before, request)
            found = next((way for way in ways if _led_to(way, after)), None)
            yield from () if found is None else mobility_commands(before, found)


def _led_to(way: Realisation, after: Configuration) -> bool:
    """Return whether a realisation of a control is the one that the trace took."""
    if all(after.read(cell) == value for cell, value in way.physical.items()):
        return True
    physical = after.structure.physical
    under_way = ((physical.placement(node), place) for node, place in way.flying)
    return bool(way.flying) and all(isinstance(at, InTransit) and at.to == to for at, to in under_way)


def write_report(path: str, output: str) -> None:
    """Write the report of a recording; raises Mistake for a trace."""
    if not is_recording(path):
        raise Mistake("a report is of a recorded flight", "run --record writes a recording", path)
    history = History(Path(path), rules_of)
    while history.read_on(1.0):
        pass
    facts = history.facts
    assert facts.run is not None, "it was replayed before"
    write_text(output, flight_report(facts, recorded_tracks(Path(path), facts.run.vehicles)))
    tell(f"report written to {output}")
