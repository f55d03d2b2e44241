"""Atoms about regions: `possibly x in p`, `surely x in p`, `x at least D from y`, `x within D of y`."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from semantics.properties.region_atoms import ApartFrom, PossiblyIn, RegionAtom, SurelyIn, WithinRangeOf
from semantics.state.setting import Control
from semantics.state.signature import NO_ENTITIES
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.names import Names

RegionClaim = s.PossiblyIn | s.SurelyIn | s.ApartFrom | s.WithinRangeOf


@dataclass(frozen=True, slots=True)
class RegionContext:
    """The conditions of claims about ways.

    Attributes:
        control: The kind of control; with `atomic` nothing is under way.
        places: The entities that have an area, at first or later.
    """

    control: Control
    places: frozenset[str]


def region_atom(
    node: RegionClaim,
    names: Names,
    ways: RegionContext,
    bound: Collection[str],
    entity: Callable[[s.Agent], str],
) -> RegionAtom:
    """Return the atom of a claim; reports its mistakes.

    Args:
        node: The claim.
        names: The names of the mission.
        ways: The conditions of such claims.
        bound: The quantified names.
        entity: The function from a written name to the entity; it reports a name that denotes none.
    """
    if ways.control is Control.ATOMIC:
        message = "this is about ways, and with 'control atomic' nothing is under way there"
        names.findings.add(Code.NOT_UNDER_WAY, node, message, "write: control timed")
    match node:
        case s.PossiblyIn(who):
            return PossiblyIn(entity(who), _place(node, names, ways, bound, entity))
        case s.SurelyIn(who):
            return SurelyIn(entity(who), _place(node, names, ways, bound, entity))
        case s.ApartFrom(who, other, distance, height):
            up = None if height is None else _metres(height, names)
            return ApartFrom(entity(who), entity(other), _metres(distance, names), up)
        case s.WithinRangeOf(who, other, distance):
            return WithinRangeOf(entity(who), entity(other), _metres(distance, names))


def _place(
    node: s.PossiblyIn | s.SurelyIn,
    names: Names,
    ways: RegionContext,
    bound: Collection[str],
    entity: Callable[[s.Agent], str],
) -> str:
    written = node.place.text
    if written in NO_ENTITIES and written not in bound:
        names.findings.add(Code.NOT_A_PLACE, node.place, f"'{written}' has no border", "name a place")
        return written
    place, kind = entity(node.place), names.kinds.get(written)
    has_inside = written in ways.places or (kind is not None and bool(names.signature[kind].carries))
    if kind is not None and written not in bound and not has_inside:
        message = f"'{written}' is a point: nothing is in it"
        hint = f"name a place, or ask for a distance: {node.entity.text} at least 50 m from {written}"
        names.findings.add(Code.NOT_A_PLACE, node.place, message, hint)
    return place


def _metres(length: s.Length, names: Names) -> float:
    if length.metres <= 0:
        message = f"a distance of {write(length)}"
        names.findings.add(Code.BAD_RANGE, length, message, "a distance is above 0 m, such as 50 m or 1.5 km")
    return length.metres
