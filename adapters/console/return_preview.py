"""The side effects of an order to return, which operators see before they give it.

A vehicle that flies home leaves the place where it stands. The run compares every position with the mission's
environment section, even for a vehicle that an operator has sent home. It falls back if they differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from adapters.console.alerts import STOPPING, fallen_back
from adapters.console.facts import Facts, Position, Rules
from adapters.live.assumptions import broken_by_place
from adapters.live.fresh_placements import Fences
from adapters.live.plan import Plan
from physical import Geometry, point
from physical.frame import E7
from semantics.live_policy import Fallback
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed
from semantics.state.signature import Name

STEPS: Final = 32
"""The number of tested points on the way home."""


def of_return(facts: Facts, name: Name) -> str | None:
    """Return the side effect of an order to return, in words; None if none is known."""
    if facts.standing is None or facts.run is None or fallen_back(facts):
        return None
    home: Position | None = facts.status.get(name, {}).get("home")
    if home is None:
        return None
    standing = facts.standing
    left = _leaves(standing.rules, standing.change.after, frozenset(facts.run.vehicles), name, tuple(home))
    return (
        None
        if left is None
        else f"takes it out of {left}, which breaks an assumption of the mission: {_then(standing.rules)}"
    )


def _then(rules: Rules) -> str:
    if rules.on_broken is Fallback.CONTINUE:
        return "this is reported, and the mission goes on"
    told = STOPPING[rules.on_broken.value]
    return f"all vehicles are commanded to {told}, and the mission sends no more commands"


@lru_cache(maxsize=256)
def _leaves(
    rules: Rules, c: Configuration, vehicles: frozenset[Name], name: Name, home: Position
) -> str | None:
    """Return the places that a vehicle leaves on its way home; None if the way breaks no assumption."""
    here = c.structure.physical.placement(name)
    if not isinstance(here, Placed) or not here.geometry.is_point:
        return None
    plan = Plan(rules.initial, dict.fromkeys(vehicles, ""))
    way = (Placed(at, here.altitude) for at in _way(here.geometry, home))
    if not any(broken_by_place(plan, c, name, at) for at in way):
        return None
    around = sorted(Fences(c).holders(name, c.setting.kind(name), here))
    return ", ".join(around) or "the open, into a place"


def _way(start: Geometry, home: Position) -> Iterator[Geometry]:
    """Yield points of the straight way from the start to home, from home backwards."""
    north, east = (each / E7 for each in start.ring[0])
    across = (home[1] - east + 180.0) % 360.0 - 180.0
    for step in range(STEPS, 0, -1):
        part = step / STEPS
        longitude = (east + across * part + 180.0) % 360.0 - 180.0
        yield point(north + (home[0] - north) * part, longitude)
