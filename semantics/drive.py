"""`drive(P, m(R'))`: make a reactum physically true, where possible."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from physical import Geometry, band_contains, centroid, nearest_placement, translate_to
from semantics.behaviours.reaction_rules import Match, Reaction, moved, relinked
from semantics.state.cell_values import Cells, Changes, Written
from semantics.state.logical_model import LogicalModel
from semantics.state.physical_model import Carried, PhysicalModel, Placed, Placement, encloses
from semantics.state.signature import REGION, Name
from semantics.state.structure import Structure

if TYPE_CHECKING:
    from semantics.state.setting import Setting


@dataclass(frozen=True, slots=True)
class Driven:
    """The physical effect of a reaction: the writes of P', and the nodes that have to fly, with their destinations."""

    changes: Changes
    flying: tuple[tuple[Name, Name], ...]


Reach = Callable[[PhysicalModel, Name, Name], Placement | None]
"""The placement of a node after its travel to a place: computed, or observed."""


def drive(
    cells: Cells, setting: "Setting", reaction: Reaction, match: Match, observed: Reach | None = None
) -> Driven | None:
    """Return the P' in which m(R') is true, None where there is none.

    - A node with a new parent goes to the point nearest the new parent's centroid (the paper's waypoint) at which A(P')
      gives exactly that parent. Its cargo goes along.
    - A node whose new parent is a carrier is carried.
    - A carrier's cargo may be put down at the carrier's position, without travel.
    - A node with new links gets new channels.

    If `observed` is given, it places the travelling nodes: in a live mission, P' is the observed world.
    """
    travel = observed or reach
    changes: Changes = {}
    flying: list[tuple[Name, Name]] = []
    for node, place in moved(reaction, match):
        before = PhysicalModel(Written(cells, changes), setting)
        for way in (_put_down, travel):
            placement = way(before, node, place)
            if placement is not None and _arrives(before, node, place, placement):
                changes |= before.placing(node, placement)
                flying += [(node, place)] if way is travel else []
                break
        else:
            return None
    for node, lost, gained in relinked(reaction, match, LogicalModel(cells, setting)):
        physical = PhysicalModel(Written(cells, changes), setting)
        changes |= physical.joining(node, (frozenset(physical.channels(node)) - lost) | gained)
    after = Structure(Written(cells, changes), setting)
    if not after.consistent(match.relations(reaction.reactum), match.nodes(reaction.reactum)):
        return None
    return Driven(changes, tuple(flying))


def _arrives(before: PhysicalModel, node: Name, place: Name, placement: Placement) -> bool:
    """Whether A(P') gives a node with this placement exactly this parent."""
    after = PhysicalModel(Written(before.cells, before.placing(node, placement)), before.sorting)
    return after.abstract_parent(node) == place


def _put_down(physical: PhysicalModel, node: Name, place: Name) -> Placed | Carried | None:
    """Return the placement of cargo put down at its carrier's position, or into another carrier there."""
    by = physical.carrier(node)
    if by is None or place in (REGION, node):
        return None
    carried = physical.placement(node)
    here, there = physical.position(by), physical.position(place)
    if here is None or there is None or not isinstance(carried, Carried) or physical.transit(by) is not None:
        return None
    if physical.sorting.carries(place, node):
        together = place in physical.carriers(by) or by == place or physical.abstract_parent(place) == by
        return Carried(place, carried.shape) if together else None
    at = unloaded(carried, here)
    return at if encloses(there, at) else None


def unloaded(carried: Carried, here: Placed) -> Placed:
    """Return the placement of cargo once it is unloaded at its carrier's position."""
    shape = carried.shape
    return Placed(translate_to(shape.geometry, centroid(here.geometry)), shape.altitude)


def reach(physical: PhysicalModel, node: Name, place: Name) -> Placed | Carried | None:
    """Return the placement of a driven node inside a place, or aboard a carrier; None where there is none."""
    setting = physical.sorting
    origin, target = physical.position(node), None if place == REGION else physical.position(place)
    if origin is None or target is None or not setting.signature[setting.kind(node)].driven:
        return None
    if node in physical.carriers(place):
        return None  # a node can't enter its own cargo
    shape = _shape(physical, node, origin)
    if setting.carries(place, node):
        return Carried(place, shape)
    if not setting.signature[setting.kind(place)].may_contain(setting.kind(node)):
        return None
    holes = _holes(physical.before(node, place, target), shape)
    spot = nearest_placement(shape.geometry, target.geometry, holes)
    return None if spot is None else Placed(spot, shape.altitude)


def _shape(physical: PhysicalModel, node: Name, origin: Placed) -> Placed:
    placement = physical.placement(node)
    return placement.shape if isinstance(placement, Carried) else origin


def _holes(before: tuple[Placed, ...], shape: Placed) -> tuple[Geometry, ...]:
    """Return the geometries of the places that A(P) tries before a node's target place, at the node's altitude."""
    return tuple(sorted({at.geometry for at in before if band_contains(at.altitude, shape.altitude)}))
