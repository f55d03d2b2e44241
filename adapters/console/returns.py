"""What an order to return brings about beside the return: operators are told before they give it.

A vehicle that stands in a place and flies home leaves that place. The run compares each position with the mission's
environment section, also of a vehicle that an operator has sent home, and falls back where they differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from adapters.console.alerts import STOPPING, fallen_back
from adapters.console.facts import Facts, Position, Rules
from adapters.live.assumptions import broken_by_place
from adapters.live.sightings import Fences
from adapters.live.state import Plan
from physical import Geometry, point
from physical.frame import E7
from semantics.live_policy import Fallback
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Placed
from semantics.state.signature import Name

STEPS: Final = 32
"""How many points of the way home are tried."""


def of_return(facts: Facts, name: Name) -> str | None:
    """Return what follows when a vehicle is ordered to return, None where nothing is known to follow."""
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
        else f"takes it out of {left}, which breaks what the mission assumes: {_then(standing.rules)}"
    )


def _then(rules: Rules) -> str:
    if rules.on_broken is Fallback.CONTINUE:
        return "that is reported, and the mission goes on"
    told = STOPPING[rules.on_broken.value]
    return f"all vehicles are told to {told}, and the mission commands nothing any more"


@lru_cache(maxsize=256)
def _leaves(
    rules: Rules, c: Configuration, vehicles: frozenset[Name], name: Name, home: Position
) -> str | None:
    """Return what a vehicle leaves on its way home, None if nothing on that way breaks an assumption."""
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
    """Yield points of the way from one to the other, as the crow flies, the last one first."""
    north, east = (each / E7 for each in start.ring[0])
    across = (home[1] - east + 180.0) % 360.0 - 180.0
    for step in range(STEPS, 0, -1):
        part = step / STEPS
        longitude = (east + across * part + 180.0) % 360.0 - 180.0
        yield point(north + (home[0] - north) * part, longitude)
