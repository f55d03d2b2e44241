"""The zones of a fence on board: inclusion and exclusion polygons and circles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from adapters.mavlink.constants import Cmd
from adapters.mavlink.items import Items, OnboardItem
from physical import Geometry, PhysicalError, circle, polygon

_VERTICES: Final = (Cmd.FENCE_VERTEX_INCLUSION, Cmd.FENCE_VERTEX_EXCLUSION)
_CIRCLES: Final = (Cmd.FENCE_CIRCLE_INCLUSION, Cmd.FENCE_CIRCLE_EXCLUSION)
_WITHIN: Final = (Cmd.FENCE_VERTEX_INCLUSION, Cmd.FENCE_CIRCLE_INCLUSION)
_OUTSIDE: Final = (Cmd.FENCE_VERTEX_EXCLUSION, Cmd.FENCE_CIRCLE_EXCLUSION)

Key = tuple[int, tuple[tuple[int, int, int], ...]]


@dataclass(frozen=True, slots=True)
class Zone:
    """One polygon, circle or return point; `shape` is None if the items make none."""

    items: Items
    shape: Geometry | None

    @property
    def within(self) -> bool:
        """Whether it is an inclusion zone: a vehicle must stay in it."""
        return self.items[0].command in _WITHIN

    @property
    def outside(self) -> bool:
        """Whether it is an exclusion zone: a vehicle must stay out of it."""
        return self.items[0].command in _OUTSIDE

    @property
    def key(self) -> Key:
        """The identity of a zone: command, corners, and a circle's radius in centimetres."""
        radius = [_centimetres(item.parameters[0]) if _is_circle(item) else 0 for item in self.items]
        corners = ((item.x, item.y, size) for item, size in zip(self.items, radius, strict=True))
        return self.items[0].command, tuple(corners)

    def __str__(self) -> str:
        first = self.items[0]
        if first.command == Cmd.FENCE_RETURN_POINT:
            return "a return point"
        what = f"polygon of {len(self.items)} corners"
        if _is_circle(first):
            what = f"circle of {first.parameters[0]:g} m around {first.x / 1e7:.5f}, {first.y / 1e7:.5f}"
        return f"a {what} to stay {'in' if self.within else 'out of'}"


@lru_cache(maxsize=256)
def zones(items: Items) -> tuple[Zone, ...]:
    """Return the zones that fence items make."""
    return tuple(_zones(items))


def _zones(items: Items) -> Iterator[Zone]:
    at = 0
    while at < len(items):
        first = items[at]
        size = _corners(items, at) if first.command in _VERTICES else 1
        group = items[at : at + size]
        yield Zone(group, _shape(group))
        at += size


def _corners(items: Items, at: int) -> int:
    """Return how many items belong to the polygon that begins at an item; each item has the count."""
    first = items[at]
    wanted = first.parameters[0] if first.parameters[0] >= 1 else 1
    size = 1
    while size < wanted and at + size < len(items) and items[at + size].command == first.command:
        size += 1
    return size


def _shape(group: Items) -> Geometry | None:
    first = group[0]
    try:
        if _is_circle(first):
            return circle((first.x / 1e7, first.y / 1e7), first.parameters[0])
        return polygon([(item.x / 1e7, item.y / 1e7) for item in group])
    except PhysicalError:
        return None


def _is_circle(item: OnboardItem) -> bool:
    return item.command in _CIRCLES


def _centimetres(metres: float) -> int:
    return round(metres * 100) if abs(metres) < 1e9 else -1
