"""The points to which a vehicle returns, its home or a rally point on board, and other needs for items on board."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.item_merging import OnBoard
from adapters.mavlink.items import Items
from adapters.mavlink.telemetry import Telemetry
from physical import Geometry, PhysicalError, contains, distance, point

ARMING_ITEMS: Final = "ARMING_MIS_ITEMS"
"""ArduPilot's parameter for the items without which it cannot be armed."""

_RALLY: Final = 32
_NEEDED: Final[Mapping[int, tuple[Cmd, str]]] = {
    1: (Cmd.LAND, "a landing"),
    2: (Cmd.VTOL_LAND, "a landing of a VTOL"),
    4: (Cmd.DO_LAND_START, "the start of a landing sequence"),
    8: (Cmd.TAKEOFF, "a take-off"),
    16: (Cmd.VTOL_TAKEOFF, "a take-off of a VTOL"),
    64: (Cmd.RETURN_TO_LAUNCH, "a return"),
}
"""The bits of ARMING_MIS_ITEMS (AP_Arming/AP_Arming.cpp), except that of rally points."""


def refuges(known: Telemetry, on_board: OnBoard) -> tuple[Geometry, ...]:
    """Return the possible points of return from a vehicle's position."""
    home = () if known.home is None else (point(*known.home),)
    rally = tuple(at for at in rally_points(on_board) if _is_near(at, known))
    only = known.profile is not None and known.profile.dialect.home_is_item
    if rally and only and not known.parameters.get("RALLY_INCL_HOME"):
        return rally
    return (*rally, *home)


def rally_points(on_board: OnBoard) -> tuple[Geometry, ...]:
    """Return the rally points on board."""
    return tuple(_points(on_board.get(MissionType.RALLY, ())))


def _points(items: Items) -> Iterator[Geometry]:
    for item in items:
        try:
            yield point(item.x / 1e7, item.y / 1e7)
        except PhysicalError:
            continue


def _is_near(rally: Geometry, known: Telemetry) -> bool:
    """Return whether a rally point is near enough to be used."""
    limit = known.parameters.get("RALLY_LIMIT_KM", 0.0)
    if known.position is None or limit <= 0.0:
        return True
    here = point(known.position.latitude, known.position.longitude)
    return distance(here, rally) <= 1000.0 * limit


def beyond_fence(fence: Geometry, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Yield the rally points that would lead a returning vehicle out of its fence."""
    limit = 1000.0 * known.parameters.get("RALLY_LIMIT_KM", 0.0)
    for number, at in enumerate(rally_points(on_board), 1):
        away = distance(fence, at)
        if not contains(fence, at) and (limit <= 0.0 or away <= limit):
            yield (
                f"its rally point {number} lies {away:.0f} m outside the fence, and it returns to the nearest: "
                "remove it with a ground station, or fly with --fence none"
            )


def missing_items(mission: Items, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    """Yield the items that a vehicle requires on board before it is armed, and that `mission` lacks."""
    asked = known.parameters.get(ARMING_ITEMS, 0.0)
    bits = int(asked) if 0 <= asked < 1e6 else 0
    there = {item.command for item in mission}
    lacking = [what for bit, (command, what) in _NEEDED.items() if bits & bit and command not in there]
    if bits & _RALLY and not rally_points(on_board):
        lacking.append("a rally point")
    if lacking:
        yield (
            f"its {ARMING_ITEMS} is {bits}, so it is not armed without {' and '.join(lacking)} on board, which it "
            f"will not have: set {ARMING_ITEMS} to what the mission has, or to 0"
        )
