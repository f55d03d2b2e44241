"""Reg(u) of a mission's entities, from their placements and flights.

`Ways` takes what the mission's text says of each entity (`EntityMotion`) once. A region then depends on the placement
of the entity's outermost carrier (or of itself) and on the flights that move it, and on nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from physical.drift import Aboard, Places
from physical.place_nesting import Place
from physical.regions import Region
from physical.shape import Geometry


@dataclass(frozen=True, slots=True)
class DriftWithin:
    """The arguments of `physical.drift_faces` for an entity that drifts within a place."""

    mover: Geometry
    within: Geometry
    places: Places
    aboard: Aboard = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class EntityMotion:
    """All that a mission's text says about the possible positions of one entity.

    Attributes:
        name: The entity.
        placements: Each geometry with its altitudes that the mission or a clause gives it: its first placement, those
            of `drifts among` and `appears`. The faces of a drift within a place are not listed.
        loads: Its shapes and altitudes where the mission puts it aboard a carrier; their positions have no meaning.
        targets: The places and carriers to which a control may send it; any that fits, where the text names none.
        via: The places by which a control may send it.
        carriers: The entities that may carry it: at first, by a clause or by a control.
        containers: The places whose kinds may contain its kind.
        may_be_absent: Whether it may be absent from P: at first, or since it vanishes.
        strays: The metres of `strays at most`; None if the mission does not say it.
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


@dataclass(frozen=True, slots=True)
class FlightPlan:
    """A FLY that moves an entity.

    Attributes:
        to: Its destination.
        via: The places of its VIA, in order.
        start: The parent that it leaves, as m(R) has it; a carrier's altitudes then belong to the flight's.
    """

    to: str
    via: tuple[str, ...] = ()
    start: str = ""


@dataclass(frozen=True, slots=True)
class Located:
    """An entity in a configuration: its region, and its carriers, the innermost first."""

    entity: str
    region: Region
    carriers: tuple[str, ...] = ()

    @property
    def bearer(self) -> str:
        """Return the outermost carrier, or the entity itself if nothing carries it."""
        return self.carriers[-1] if self.carriers else self.entity


class Ways:
    """The regions of a mission's entities; immutable, and its answers are cached."""

    def __init__(self, motions: Iterable[EntityMotion]) -> None:
        raise NotImplementedError

    def is_fixed(self, entity: str) -> bool:
        """Whether an entity has one geometry in all configurations (W of ways.md has one element)."""
        raise NotImplementedError

    def region(
        self, entity: str, at: Place | Transit | None, flights: frozenset[FlightPlan] = frozenset()
    ) -> Region:
        """Return Reg(u) of an entity that nothing carries.

        Raises:
            RegionError: If it reaches over 1,000 km from its middle, or covers a pole.
        """
        raise NotImplementedError

    def located(
        self,
        entity: str,
        placement_of: Callable[[str], Standpoint],
        flights_of: Callable[[str], frozenset[FlightPlan]],
    ) -> Located:
        """Return an entity with its region; reads the placements of it and its carriers, and the bearer's flights."""
        raise NotImplementedError

    def check(self) -> None:
        """Raise RegionError if some possible region of the mission is too large, or covers a pole."""
        raise NotImplementedError
