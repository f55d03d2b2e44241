"""Compute the facts that regions need, once, from a mission's text and its initial configuration."""

from collections.abc import Iterable

from physical import EntityMotion
from physical.place_nesting import Place
from semantics.environment import Appears, Drifts, Vanishes
from semantics.fixpoints import closure
from semantics.regions.possible_moves import PossibleMove, possible_moves
from semantics.regions.region_facts import RegionFacts
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, Placed, Placement
from semantics.state.setting import Setting
from semantics.state.signature import Name


def region_facts(c: Configuration) -> RegionFacts:
    """Return the facts of a mission, from its initial configuration."""
    gathering = _Gathering(c)
    names = sorted(c.setting.kinds)
    return RegionFacts(
        {name: gathering.motion(name) for name in names}, {name: gathering.movers(name) for name in names}
    )


class _Gathering:
    """The facts of a mission under computation.

    Attributes:
        moves: For each entity, the moves that a control may request of it.
        carriers: For each entity, the entities that may carry it.
        bearers: For each entity, itself and all that may carry it, at any depth.
        vanishing: The entities that vanish by a clause of their own.
    """

    def __init__(self, c: Configuration) -> None:
        self.c = c
        self.setting = c.setting
        requested = {name: list[PossibleMove]() for name in c.setting.kinds}
        for move in possible_moves(c):
            requested[move.entity].append(move)
        self.carriers = {name: self._carriers(name, moves) for name, moves in requested.items()}
        self.moves = {name: moves if self._may_move(name) else [] for name, moves in requested.items()}
        self.bearers = {name: closure([name], self.carriers.__getitem__) for name in requested}
        self.vanishing = frozenset(e.entity for e in self.setting.environment if isinstance(e, Vanishes))

    def _carriers(self, name: Name, moves: Iterable[PossibleMove]) -> frozenset[Name]:
        into = (move.place for move in moves if self.setting.carries(move.place, name))
        given = (at.by for at in _given(self.c, name) if isinstance(at, Carried))
        return frozenset([*into, *given])

    def _may_move(self, name: Name) -> bool:
        """Whether a control can move an entity: it is driven, or a carrier may put it down."""
        return self.setting.signature[self.setting.kind(name)].driven or bool(self.carriers[name])

    def _vanishes(self, name: Name) -> bool:
        return not self.vanishing.isdisjoint(self.bearers[name])

    def movers(self, name: Name) -> tuple[Name, ...]:
        """Return the agents whose flights may move an entity; none if its placement determines these flights.

        It does not if the flight may lead through a VIA, begin or end aboard a carrier, or outlive its entity.
        """
        moves = self.moves[name]
        needed = self._vanishes(name) or bool(self.carriers[name]) or any(move.via for move in moves)
        return tuple(sorted({move.agent for move in moves})) if needed else ()

    def motion(self, name: Name) -> EntityMotion:
        """Return all facts of the text about the positions of an entity."""
        c, setting, moves = self.c, self.setting, self.moves[name]
        given = tuple(_given(c, name))
        drift = next((each for each in _drifts(setting, name) if each.within), None)
        return EntityMotion(
            name,
            placements=_sorted(at for each in given if (at := _standing(each)) is not None),
            loads=_sorted(_place(at.shape) for at in given if isinstance(at, Carried)),
            targets=frozenset(move.place for move in moves),
            via=frozenset(via for move in moves for via in move.via),
            carriers=self.carriers[name],
            containers=frozenset(setting.containers(setting.kind(name))) - {name},
            may_be_absent=self._vanishes(name) or name not in c.structure.physical,
            strays=setting.strays.get(name),
            circle=_circle(setting, name),
            drift=None if drift is None else drift.arrangement,
        )


def _given(c: Configuration, name: Name) -> Iterable[Placement]:
    """Yield the placements that the mission or a clause gives an entity, faces of a drift within a place excepted."""
    first = c.structure.physical.placement(name)
    if first is not None:
        yield first
    for each in c.setting.environment:
        is_face = isinstance(each, Drifts) and each.within
        if isinstance(each, Drifts | Appears) and each.entity == name and not is_face:
            yield from each.placements


def _drifts(setting: Setting, name: Name) -> Iterable[Drifts]:
    return (each for each in setting.environment if isinstance(each, Drifts) and each.entity == name)


def _circle(setting: Setting, name: Name) -> float:
    motion = None if setting.timing is None else setting.timing.motion(name)
    return 0.0 if motion is None else motion.circle


def _standing(at: Placement) -> Place | None:
    """Return where a placement puts an entity; None for a carried one."""
    match at:
        case Placed():
            return _place(at)
        case InTransit(origin):
            return _place(origin)
        case _:
            return None


def _place(at: Placed) -> Place:
    return Place(at.geometry, at.altitude)


def _sorted(places: Iterable[Place]) -> tuple[Place, ...]:
    return tuple(sorted(set(places), key=_place_key))


def _place_key(place: Place) -> tuple[object, ...]:
    return (
        place.geometry.order(),
        () if place.altitude is None else (place.altitude.low, place.altitude.high),
    )
