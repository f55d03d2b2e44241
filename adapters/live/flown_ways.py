"""Ways as vehicles fly them: the points to which a vehicle is sent, and its distance from the lines between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from physical import Geometry
from physical.line_foot import Foot, foot
from semantics.state.signature import Name

ACCEPTANCE: Final = 100.0
"""Metres from a waypoint within which a vehicle may turn towards the next one."""


@dataclass(frozen=True, slots=True)
class FlownWay:
    """The points to which a vehicle is sent, in order.

    Attributes:
        points: Where it began, its waypoints, and the point where it stays; this point alone once it has arrived.
        to: Its destination.
        passed: The number of points that are certainly behind it.
    """

    points: tuple[Geometry, ...]
    to: Name = ""
    passed: int = 1

    @property
    def end(self) -> Geometry:
        """The point where the vehicle stays."""
        return self.points[-1]

    def legs(self) -> Iterator[tuple[Geometry, Geometry]]:
        """Yield the lines of the way, the present one first, then the later and the earlier ones."""
        count = len(self.points)
        order = (*range(self.passed, count), *range(self.passed - 1, 0, -1))
        yield from ((self.points[i - 1], self.points[i]) for i in order)
        if count == 1:
            yield self.end, self.end

    def beside(self, at: Geometry, enough: float = 0.0) -> Foot:
        """Return a position's distance from the way; the first line nearer than `enough` decides.

        Raises:
            RegionError: A line is too long for its figures.
        """
        best: Foot | None = None
        for leg in self.legs():
            found = foot(at, *leg)
            if best is None or found.metres < best.metres:
                best = found
            if best.metres <= enough:
                break
        assert best is not None
        return best

    def progressed(self, at: Geometry, near: float = ACCEPTANCE) -> FlownWay:
        """Return the way after a sighting: a waypoint is behind if the vehicle is near it, and nearer to the next line.

        In doubt a waypoint stays ahead: the remaining way is then too long, never too short.
        """
        way = self
        while way.passed < len(way.points) - 1:
            before, here, after = way.points[way.passed - 1 : way.passed + 2]
            if (
                foot(at, here, here).metres > near
                or foot(at, here, after).metres > foot(at, before, here).metres
            ):
                break
            way = replace(way, passed=way.passed + 1)
        return way

    def remaining(self) -> tuple[Geometry, ...]:
        """Return the points that may still be ahead."""
        return self.points[min(self.passed, len(self.points) - 1) :]
