"""Remarks to the operator on the items on board before a flight: kept and replaced items, and the points of return."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.item_merging import RETURNS_BY_LANDING, OnBoard, landing
from adapters.mavlink.items import Items
from adapters.mavlink.items import fence as polygon_items
from adapters.mavlink.onboard_fences import zones_beside
from adapters.mavlink.refuges import rally_points
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.vehicle_identities import Craft
from adapters.mavlink.zones import zones

_OURS = (Cmd.WAYPOINT, Cmd.LOITER_UNLIMITED, Cmd.TAKEOFF)


def remarks_on_board(
    craft: Craft, known: Telemetry, on_board: OnBoard, unread: Collection[MissionType]
) -> Iterator[str]:
    """Yield remarks on the items on board a vehicle; `unread` kinds could not be read."""
    missing = [kind.name.lower() for kind in unread if kind not in on_board]
    if missing:
        yield f"does not report its contents on board: {', '.join(missing)}"
    yield from _of_mission(on_board.get(MissionType.MISSION, ()), known)
    yield from _of_fence(craft, known, on_board)
    rally = rally_points(on_board)
    if rally:
        yield f"has rally points on board, {len(rally)}: it returns to the nearest, not to its home"


def _of_mission(found: Items, known: Telemetry) -> Iterator[str]:
    kept = landing(found, known)
    first = known.profile is not None and known.profile.dialect.home_is_item
    rest = found[int(first) : len(found) - len(kept)]
    if any(item.command not in _OURS for item in rest):
        yield f"has a mission of {len(found) - int(first)} items on board, which the flights of this mission replace"
    if kept:
        yield f"keeps its landing sequence: each upload ends with the last {len(kept)} items of the mission on board"
    if known.parameters.get("RTL_AUTOLAND") in RETURNS_BY_LANDING and not kept:
        yield "has no landing sequence on board, which its RTL_AUTOLAND needs: when it returns, it circles"


def _of_fence(craft: Craft, known: Telemetry, on_board: OnBoard) -> Iterator[str]:
    found = zones(on_board.get(MissionType.FENCE, ()))
    kept = zones_beside(craft.fence, known, on_board)
    for zone in kept:
        yield f"keeps {zone}, too: it is on board"
    if craft.fence is None:
        return
    own = {zone.key for zone in zones(polygon_items(craft.fence))}
    for zone in found:
        if zone not in kept and zone.key not in own:
            yield f"loses {zone}, which is on board: the fence of the mission replaces it"
