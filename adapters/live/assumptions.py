"""The assumption monitor: compares the world with the mission's environment section.

A verdict depends on that section. Placements are compared by their relations in the current world. An entity may be
anywhere with the containers and contents of one of the mission's listed placements.
"""

from __future__ import annotations

from typing import Final, assert_never

from adapters.live.fresh_placements import Fences, contents
from adapters.live.plan import Plan
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placement
from semantics.state.signature import Name

Relations = tuple[frozenset[Name], frozenset[Name]]
"""The containers of an entity, and its contents."""


STRAYED: Final = "wind, or another operator"
"""The likely cause of a stray vehicle, if no take-over is known."""


def broken_by_place(
    plan: Plan, c: Configuration, entity: Name, seen: Placement | None, cause: str = STRAYED
) -> str:
    """Return the assumption that a sighting of an entity breaks, or an empty text; `cause` explains a stray vehicle."""
    before = c.structure.physical.placement(entity)
    if seen is None:
        allowed = _clause(plan, Vanishes, entity) is not None
        return "" if allowed else f"{entity} is not seen any more; the mission does not let it vanish"
    now = relations(c, entity, seen)
    if before is None:
        return _broken_by_appearing(plan, c, entity, now)
    drift = _clause(plan, Drifts, entity)
    listed = drift.placements if isinstance(drift, Drifts) else ()
    first = plan.first.structure.physical.placement(entity)
    if now in [relations(c, entity, place) for place in (before, first, *listed) if place is not None]:
        return ""
    where = f"{entity} is in {', '.join(sorted(now[0])) or 'none of the places'}"
    if now[1]:
        where += f" and contains {', '.join(sorted(now[1]))}"
    if isinstance(drift, Drifts):
        return f"{where}; the mission lets it drift among {', '.join(drift.names)}"
    if entity in plan.vehicles:
        return f"{where}; it was not sent there, and has left its place: {cause}"
    return f"{where}; the mission does not let it drift, and it was not sent there"


def is_missed(plan: Plan, entity: Name) -> bool:
    """Return whether an entity that is not seen any more is missed: the mission lets no other thing explain it.

    A vehicle is heard, not seen by a sensor.
    """
    missable = entity in plan.first.setting.missable and entity not in plan.vehicles
    return missable and _clause(plan, Vanishes, entity) is None


def _broken_by_appearing(plan: Plan, c: Configuration, entity: Name, now: Relations) -> str:
    where = ", ".join(sorted(now[0])) or "none of the places"
    clause = _clause(plan, Appears, entity)
    first = plan.first.structure.physical.placement(
        entity
    )  # an entity that is heard again may be at its first place
    places = (
        *([first] if first is not None else ()),
        *(clause.placements if isinstance(clause, Appears) else ()),
    )
    allowed = [relations(c, entity, place) for place in places]
    return "" if now in allowed else f"{entity} appears in {where}; the mission does not let it appear there"


def relations(c: Configuration, entity: Name, placement: Placement) -> Relations:
    """Return the containers and contents of an entity at a placement, in the current world."""
    physical = c.structure.physical
    around = Fences(c).holders(entity, c.setting.kind(entity), placement)
    return around, contents(physical, entity, placement)


def _clause(plan: Plan, sort: type[Clause], entity: Name) -> Clause | None:
    found = (clause for clause in plan.first.setting.environment if isinstance(clause, sort))
    return next((clause for clause in found if getattr(clause, "entity", None) == entity), None)


def clause_of_leaving(plan: Plan, entity: Name, channel: Name) -> Leaves | Drops | None:
    """Return the clause that lets an entity leave a channel and come back."""
    for clause in plan.first.setting.environment:
        match clause:
            case Leaves() if (clause.entity, clause.channel) == (entity, channel):
                return clause
            case Drops() if clause.channel == channel:
                return clause
            case Leaves() | Drops() | Drifts() | Appears() | Vanishes() | Says():
                pass
            case _:
                assert_never(clause)
    return None
