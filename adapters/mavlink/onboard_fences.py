"""A vehicle's own fences beside the given polygon: a circle around home, a ceiling, and zones on board."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from adapters.mavlink.constants import Fence, FenceAction, MissionType
from adapters.mavlink.item_merging import OnBoard, kept_zones, widens
from adapters.mavlink.items import fence as polygon_items
from adapters.mavlink.profiles import ARDUPILOT_DIALECT, Dialect
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.zones import Zone, zones
from physical import Geometry, circle, contains, distance, point, share_interior
from physical.corridor import corridor
from physical.wordings import counted

EACH_BY_ITSELF: Final = (4, 6)
"""The first ArduPilot version that can switch on one fence without the others."""


AFTER_TAKEOFF: Final = 1
"""ArduPilot's FENCE_AUTOENABLE that switches fences on after a take-off, and off while disarmed."""

LEG_WIDTH: Final = 20.0
"""Width in metres of the corridor around a straight leg that should be clear of a zone."""

REMEDY: Final = "if that is no longer meant, remove it with a ground station"


@dataclass(frozen=True, slots=True)
class OwnFences:
    """A vehicle's own fences: metres around home and above it, None for a fence that is off."""

    circle: float | None = None
    ceiling: float | None = None
    dialect: Dialect = ARDUPILOT_DIALECT

    def __str__(self) -> str:
        circle, ceiling = self.dialect.fence_circle, self.dialect.fence_ceiling
        around = [] if self.circle is None else [f"within {self.circle:g} m around home ({circle})"]
        below = [] if self.ceiling is None else [f"below {self.ceiling:g} m above home ({ceiling})"]
        return " and ".join([*around, *below])

    def remedy(self, name: str) -> str:
        """Return the remedy for the fence whose parameter is `name`."""
        if self.dialect.fence_action:
            return f"set {name} to more, or to 0 for none"
        return f"set FENCE_TYPE to 4 (the polygon alone), or {name} to more"


def own_fences(known: Telemetry, *, given: bool) -> OwnFences:
    """Return the fences that are on, or come on with a `given` polygon."""
    told, dialect = known.parameters, known.dialect
    if dialect.fence_action:
        circle, ceiling = (told.get(name) or None for name in (dialect.fence_circle, dialect.fence_ceiling))
        return OwnFences(circle, ceiling, dialect) if _acts(known) else OwnFences(dialect=dialect)
    by_itself = told.get("FENCE_ENABLE") or told.get("FENCE_AUTOENABLE")
    with_ours = given and (known.version is None or known.version < EACH_BY_ITSELF)
    if not by_itself and not with_ours:
        return OwnFences()
    configured = _configured(known)
    return OwnFences(
        told.get("FENCE_RADIUS") if Fence.CIRCLE in configured else None,
        told.get("FENCE_ALT_MAX") if Fence.ALT_MAX in configured else None,
    )


def _configured(known: Telemetry) -> Fence:
    return Fence(int(known.parameters.get("FENCE_TYPE", 0)) & 15)


def _acts(known: Telemetry) -> bool:
    """Return whether a vehicle whose fences need no switch acts at them, as far as its parameters are known."""
    return known.parameters.get(known.dialect.fence_action, FenceAction.HOLD) > FenceAction.WARN


def keeps_no_polygon(known: Telemetry) -> str | None:
    """Return the reason why a vehicle would not obey a given polygon, or None."""
    action, told = known.dialect.fence_action, known.parameters
    if action:
        remedy = "set it to 2 (hold) or 3 (return)"
        return None if _acts(known) else _no_polygon(action, told.get(action, 0), remedy)
    if told.get("FENCE_ACTION") == 0:
        return _no_polygon("FENCE_ACTION", 0, "it only reports; set it to 1 (return)")
    if told.get("FENCE_AUTOENABLE") == AFTER_TAKEOFF:
        return _no_polygon(
            "FENCE_AUTOENABLE", 1, "before take-off it switches its fences off; set it to 0 or 3"
        )
    if "FENCE_TYPE" not in told or Fence.POLYGON in _configured(known):
        return None
    return _no_polygon("FENCE_TYPE", told["FENCE_TYPE"], "add 4 to that")


def _no_polygon(name: str, value: float, remedy: str) -> str:
    return f"it keeps within no polygon: its {name} is {value:g}; {remedy}, or fly with --fence none"


def fence_on_board(fence: Geometry | None, on_board: OnBoard) -> str:
    """Return the zones that were read back from a vehicle, compared with the given polygon, in words."""
    found = on_board.get(MissionType.FENCE)
    if found is None:
        return "not read back"
    ours = {zone.key for zone in zones(() if fence is None else polygon_items(fence))}
    keys = [zone.key for zone in zones(found)]
    others = counted(sum(key not in ours for key in keys), "other zone")
    if not ours:
        return f"{counted(len(keys), 'zone')} on board, none given" if keys else "none"
    given = "as given" if ours <= set(keys) else "not on board: it is sent before the first flight"
    return given if ours >= set(keys) else f"{given}; {others} on board"


def zones_beside(fence: Geometry | None, known: Telemetry, on_board: OnBoard) -> tuple[Zone, ...]:
    """Return the zones on board that are in force beside the given polygon."""
    found, ours = on_board.get(MissionType.FENCE, ()), () if fence is None else polygon_items(fence)
    if fence is not None:
        return kept_zones(ours, found, known)
    dialect, told = known.dialect, known.parameters
    by_itself = told.get("FENCE_ENABLE") or told.get("FENCE_AUTOENABLE")
    in_force = _acts(known) if dialect.fence_action else by_itself and Fence.POLYGON in _configured(known)
    return zones(found) if in_force else ()


def widened(fence: Geometry, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Yield the reason why the inclusion zones on board can be neither kept nor replaced."""
    foreign = [zone for zone in zones(on_board.get(MissionType.FENCE, ())) if zone.within]
    own = {zone.key for zone in zones(polygon_items(fence))}
    foreign = [zone for zone in foreign if zone.key not in own]
    if not foreign or not widens(known):
        return
    if not any(zone.shape is not None and contains(zone.shape, fence) for zone in foreign):
        yield (
            f"the fence of the mission leaves {foreign[0]}, which is on board: with both it could fly in either, so "
            f"one must go; {REMEDY}, or give a fence inside of it (--fence PLACE)"
        )


def barred(zone: Zone, at: Geometry, room: float, name: str) -> str:
    """Return the reason why a zone forbids a circle around a point, or an empty text."""
    if zone.shape is None:
        return ""
    around = circle(at.vertices[0], room) if room else at
    inside = contains(zone.shape, around)
    meets = inside or share_interior(zone.shape, around) or contains(around, zone.shape)
    if zone.within and not inside:
        return f"{name} is not inside {zone}, which is on board: {REMEDY}"
    return f"{name} is not clear of {zone}, which is on board: {REMEDY}" if zone.outside and meets else ""


def crossed(zone: Zone, start: Geometry, end: Geometry, name: str) -> str:
    """Return an objection if the straight line to a point crosses an exclusion zone, else an empty text."""
    if zone.shape is None or not zone.outside or distance(start, end) < LEG_WIDTH:
        return ""
    if not share_interior(zone.shape, corridor((start.vertices[0], end.vertices[0]), LEG_WIDTH)):
        return ""
    return f"the straight way to {name} crosses {zone}, which is on board: go round it by VIA, or {REMEDY}"


def beyond(
    own: OwnFences, known: Telemetry, at: Geometry, room: float, height: float | None, name: str
) -> Iterator[str]:
    """Yield the reasons why a vehicle's own fences forbid a circle around a point."""
    if own.circle is not None and known.home is not None:
        away = distance(point(*known.home), at) + room
        if away > own.circle:
            yield (
                f"its circle fence of {own.circle:g} m around home does not hold {name}, which takes {away:.0f} m: "
                f"it would stop there, or not go; {own.remedy(own.dialect.fence_circle)}"
            )
    if own.ceiling is not None and height is not None and height >= own.ceiling:
        yield (
            f"its altitude fence of {own.ceiling:g} m does not hold a flight at {height:g} m above home: "
            f"{own.remedy(own.dialect.fence_ceiling)}"
        )
