"""Strays: the greatest distances of vehicles from their ways, which regions assume."""

from __future__ import annotations

from collections.abc import Mapping

from semantics.timing.timing import Timing
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.names import Names
from specs.elaboration.vehicles import named_vehicles

FARTHEST = 100_000.0
"""The greatest distance of `strays` in metres."""


def elaborate_strays(mission: s.Mission, names: Names, timing: Timing | None) -> Mapping[str, float]:
    """Return the bound in metres of each vehicle that has one; a bound of one vehicle replaces that of its kind."""
    written = [
        each
        for section in mission.each(s.Environment)
        for each in section.clauses
        if isinstance(each, s.Strays)
    ]
    found: dict[str, float] = {}
    seen: set[str] = set()
    for each in sorted(written, key=lambda clause: clause.vehicle.text in names.kinds):
        name = each.vehicle.text
        if name in seen:
            message = f"'{name}' strays by two clauses"
            names.findings.add(Code.REPEATED_SETTING, each, message, "make one of the two")
        seen.add(name)
        vehicles = named_vehicles(names, each.vehicle, "strays")
        _check_length(each, names)
        for vehicle in vehicles:
            _check_circle(each, names, vehicle, timing)
            found[vehicle] = each.distance.metres
    return dict(sorted(found.items()))


def _check_length(clause: s.Strays, names: Names) -> None:
    if clause.distance.metres > FARTHEST:
        message = f"'{clause.vehicle.text}' strays at most {write(clause.distance)}"
        hint = f"give it at most {FARTHEST / 1000:g} km"
        names.findings.add(Code.BAD_RANGE, clause.distance, message, hint)


def _check_circle(clause: s.Strays, names: Names, vehicle: str, timing: Timing | None) -> None:
    """Report a bound that the circles of a vehicle exceed."""
    motion = None if timing is None else timing.motion(vehicle)
    if motion is not None and clause.distance.metres < motion.circle:
        circles = f"flies circles of {motion.circle:g} m across"
        message = f"'{vehicle}' {circles}, and strays at most {write(clause.distance)}"
        hint = f"give it at least the diameter of its circles: {vehicle} strays at most {motion.circle:g} m"
        names.findings.add(Code.BAD_RANGE, clause.distance, message, hint)
