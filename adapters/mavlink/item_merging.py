"""Merge an upload with the items on board: fences stay side by side, a landing sequence follows the mission.

An upload replaces all items of its kind. So the items on board are read first, and those that the vehicle still needs
are uploaded again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from adapters.mavlink.constants import Cmd, MissionType
from adapters.mavlink.download import MAX_ITEMS
from adapters.mavlink.items import Items, OnboardItem, alike, is_home, same
from adapters.mavlink.telemetry import Telemetry
from adapters.mavlink.zones import Zone, zones

UNION: Final = 2
"""The bit of ArduPilot's FENCE_OPTIONS with which one inclusion zone is enough; PX4 always works so."""

RETURNS_BY_LANDING: Final = (1.0, 2.0)
"""ArduPlane's values of RTL_AUTOLAND with which a return continues with the landing sequence, in AUTO."""

OnBoard = Mapping[MissionType, Items]
"""Items read back that have not changed since, as far as we know; a kind without an entry is unknown."""

_LANDINGS: Final = (Cmd.LAND, Cmd.VTOL_LAND)
_STARTS: Final = (Cmd.DO_LAND_START, Cmd.DO_RETURN_PATH_START)


@dataclass(frozen=True, slots=True)
class Unconfirmed:
    """An upload that is not confirmed: it may have replaced a part of the items that were there.

    ArduPilot replaces item by item. Then an upload that is broken off leaves the first items of the new mission and
    the rest of the one before: what was to be kept of that one must not be looked for in the mixture.
    """

    before: Items
    attempts: tuple[Items, ...] = ()

    def explains(self, found: Items) -> bool:
        """Return whether each item found is of the mission before, or of an upload that was begun."""
        lists = (self.before, *self.attempts)
        home = any(
            items and is_home(items[0]) for items in self.attempts
        )  # the vehicle's own, which arming moves
        return len(found) <= max(map(len, lists)) and all(
            any(index < len(items) and alike(items[index], item) for items in lists)
            for index, item in list(enumerate(found))[int(home) :]
        )


def before_upload(found: Items, begun: Unconfirmed | None) -> Items:
    """Return the items that were on board before our upload was broken off, else the items found."""
    return begun.before if begun is not None and begun.explains(found) else found


def merged(ours: Items, found: Items, kind: MissionType, known: Telemetry) -> Items:
    """Return the items that must be on board: ours, and those found there that are kept."""
    if kind is MissionType.FENCE:
        return (*ours, *(item for zone in kept_zones(ours, found, known) for item in zone.items))
    if kind is MissionType.MISSION:
        return (*ours, *_renumbered(landing(found, known), len(found), len(ours)))
    return ours


def is_on_board(wanted: Items, found: Items, kind: MissionType) -> bool:
    """Return whether the items on board are exactly the wanted ones; the order of zones has no meaning."""
    if kind is MissionType.FENCE:
        here, there = (sorted(zone.key for zone in zones(items)) for items in (wanted, found))
        return here == there
    return same(wanted, found, kind)


def kept_zones(ours: Items, found: Items, known: Telemetry) -> tuple[Zone, ...]:
    """Return the zones on board that are not ours and stay: all zones that do not widen our fence."""
    own = {zone.key for zone in zones(ours)}
    foreign = (zone for zone in zones(found) if zone.key not in own)
    return tuple(zone for zone in foreign if not (zone.within and widens(known)))


def widens(known: Telemetry) -> bool:
    """Return whether another inclusion zone lets a vehicle leave ours."""
    return known.dialect.unites or bool(int(known.parameters.get("FENCE_OPTIONS", 0)) & UNION)


def landing(found: Items, known: Telemetry) -> Items:
    """Return the landing sequence of a mission on board, by which the vehicle returns; empty without one.

    It begins at the first marker of such a sequence. PX4 needs no marker before a landing.
    """
    if known.parameters.get("RTL_AUTOLAND") == 0.0:  # the vehicle cannot be armed with such a sequence
        return ()
    marked = next((at for at, item in enumerate(found) if item.command in _STARTS), None)
    if marked is None and not known.dialect.marks_landing:
        marked = next((at for at, item in enumerate(found) if item.command in _LANDINGS), None)
    return () if marked is None else found[marked:]


def may_be_landing(known: Telemetry, on_board: OnBoard) -> bool:
    """Return whether a vehicle that was told to return may fly its landing sequence, in the mode of a mission.

    It may as long as its mission was not read again: a second order to return would end its approach.
    """
    profile, found = known.profile, on_board.get(MissionType.MISSION)
    asked = known.parameters.get("RTL_AUTOLAND") in RETURNS_BY_LANDING
    if profile is None or not asked or known.mode != profile.auto:
        return False
    if found is None or known.current is None:
        return True
    tail = landing(found, known)
    return bool(tail) and known.current >= len(found) - len(tail)


def is_cut(found: Items, known: Telemetry) -> bool:
    """Return whether the landing sequence on board has a start and no landing: an upload was broken off."""
    tail = landing(found, known)
    starts = any(item.command == Cmd.DO_LAND_START for item in tail)
    return starts and not any(item.command in _LANDINGS for item in tail)


def jumps_out(found: Items, known: Telemetry) -> int | None:
    """Return the target of the first jump out of the landing sequence on board, or None."""
    tail = landing(found, known)
    first = len(found) - len(tail)
    targets = (item.parameters[0] for item in tail if item.command == Cmd.DO_JUMP)
    return next((_whole(to) for to in targets if not first <= to < len(found)), None)


def _renumbered(tail: Items, before: int, ahead: int) -> Items:
    """Renumber the jumps of a landing sequence, the last of `before` items, that now follows `ahead` items."""
    shift = ahead - (before - len(tail))
    return tuple(_shifted(item, shift) if item.command == Cmd.DO_JUMP else item for item in tail)


def _shifted(jump: OnboardItem, shift: int) -> OnboardItem:
    first, *rest = jump.parameters
    parameters = (first + shift, rest[0], rest[1], rest[2])
    return replace(jump, parameters=parameters) if shift else jump


def _whole(number: float) -> int:
    return round(number) if abs(number) <= MAX_ITEMS else -1
