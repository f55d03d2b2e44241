"""The progress of a robot's order, by its positions: pure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from adapters.plugin import Follow, GoTo
from physical import Geometry, contains, distance, point, standing, waypoint

NEARER: Final = 10.0
"""Metres of approach that prove a robot to be on its way: more than a receiver's error."""


@dataclass(frozen=True, slots=True)
class Errand:
    """An order and its progress.

    Attributes:
        order: The order.
        began: Time of its first sending.
        sent: Time of its last sending; None if it was never sent.
        passed: The number of its places in which the robot has been.
        farthest: The greatest distance to the next place since it was taken on.
        followed: Whether the robot is on its way, or there.
    """

    order: GoTo | Follow
    began: float = 0.0
    sent: float | None = None
    passed: int = 0
    farthest: float = 0.0
    followed: bool = False

    @property
    def places(self) -> tuple[Geometry, ...]:
        """The places on its way; the last is the goal."""
        return self.order.path if isinstance(self.order, Follow) else (self.order.place,)

    @property
    def done(self) -> bool:
        """Whether the robot has been in all its places."""
        return self.passed == len(self.places)


def waypoints(order: GoTo | Follow) -> tuple[tuple[float, float], ...]:
    """Return the latitude and longitude of each waypoint."""
    passed, last = (order.path[:-1], order.path[-1]) if isinstance(order, Follow) else ((), order.place)
    stays = standing(order.shape or point(0, 0), last, order.around, 0.0) or last
    return tuple(waypoint(place).vertices[0] for place in (*passed, stays))


def seen(errand: Errand, at: Geometry) -> Errand:
    """Return an errand after a sighting of its robot."""
    passed = errand.passed
    while passed < len(errand.places) and contains(errand.places[passed], at):
        passed += 1
    if passed > errand.passed or errand.done:
        return replace(errand, passed=passed, farthest=0.0, followed=True)
    left = distance(at, waypoint(errand.places[passed]))
    farthest = max(errand.farthest, left)
    return replace(errand, farthest=farthest, followed=errand.followed or farthest - left >= NEARER)


def moved(errand: Errand, order: GoTo | Follow) -> Errand:
    """Return an errand whose places have moved; it is sent again."""
    return replace(errand, order=order, sent=None, farthest=0.0)
