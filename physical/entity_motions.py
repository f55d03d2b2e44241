"""Facts about an entity's position: from a mission's text, a configuration's placements and its flights.

`physical.mission_regions` computes regions from these plain data.
"""

from __future__ import annotations

from dataclasses import dataclass

from physical.face_covers import DriftWithin
from physical.place_nesting import Place


@dataclass(frozen=True, slots=True)
class EntityMotion:
    """The facts in a mission's text about the possible positions of one entity.

    Attributes:
        name: The entity.
        placements: Each geometry with its altitudes that the mission or a clause gives it: its first placement, those
            of `drifts among` and `appears`. The faces of a drift within a place are not listed.
        loads: Its shapes and altitudes where the mission puts it aboard a carrier; their positions have no meaning.
        targets: The places and carriers to which a control may send it; any that fits, where the text names none.
        via: The places by which a control may send it.
        carriers: The entities that may carry it: at first, by a clause or by a control.
        containers: The places of kinds that may contain its kind.
        may_be_absent: Whether it may be absent from P: at first, or since it vanishes.
        strays: The metres of `strays at most`; None without this clause.
        circle: The diameter in metres of its circle, 0 if it hovers or this is unknown.
        drift: Its drift within a place, if it has one.
    """

    name: str
    placements: tuple[Place, ...] = ()
    loads: tuple[Place, ...] = ()
    targets: frozenset[str] = frozenset()
    via: frozenset[str] = frozenset()
    carriers: frozenset[str] = frozenset()
    containers: frozenset[str] = frozenset()
    may_be_absent: bool = False
    strays: float | None = None
    circle: float = 0.0
    drift: DriftWithin | None = None

    @property
    def margin(self) -> float:
        """The metres r by which its regions are grown: those of `strays at most`, else its circle."""
        return self.circle if self.strays is None else self.strays

    @property
    def forms(self) -> tuple[Place, ...]:
        """All its shapes and altitudes."""
        return self.placements + self.loads


@dataclass(frozen=True, slots=True)
class Transit:
    """A placement in transit: P's origin and destination."""

    origin: Place
    to: str


@dataclass(frozen=True, slots=True)
class CarriedBy:
    """A placement aboard another entity."""

    carrier: str


Standpoint = Place | Transit | CarriedBy | None
"""The placement of an entity in P; None if it is absent."""


@dataclass(frozen=True, slots=True, order=True)
class FlightPlan:
    """A FLY that moves an entity.

    Attributes:
        to: Its destination.
        via: The places of its VIA, in order.
        start: The parent that it leaves, as m(R) has it: a carrier's altitudes belong to the flight.
    """

    to: str
    via: tuple[str, ...] = ()
    start: str = ""

    @property
    def stops(self) -> tuple[str, ...]:
        """All places to which it leads, in order."""
        return (*self.via, self.to)
