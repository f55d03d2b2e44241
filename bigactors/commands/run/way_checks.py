"""Checks before take-off of the assumptions and invariants about ways: circles, and unwatched claims."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from adapters.live.ground_formulas import MOST_PARTS, about_ways
from adapters.live.plan import Plan
from adapters.plugin import Plugin, circling
from bigactors.mistakes import Mistake
from bigactors.terminal import tell
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, asks_of_regions
from semantics.properties.propositions import (
    Ended,
    Exists,
    HasPending,
    HostedAt,
    IsBound,
    VariableIs,
    Waiting,
    atoms_of,
)
from semantics.properties.region_atoms import RegionAtom, operands
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.state.station_partition import is_parted
from specs.elaboration import ElaboratedMission

OF_AGENTS = (Ended, Exists, HasPending, HostedAt, IsBound, VariableIs, Waiting)
"""Atoms about agents, which may run at another station."""


def watchable(mission: ElaboratedMission, first: Configuration) -> tuple[Property, ...]:
    """Return the invariants about ways that a run can watch from its first configuration."""
    return tuple(each for each in about_ways(*mission.properties) if not _reads_elsewhere(each, first))


def _reads_elsewhere(asked: Property, first: Configuration) -> bool:
    """Return whether a property asks about agents, of which another station may have some."""
    return is_parted(first) and any(isinstance(atom, OF_AGENTS) for atom in atoms_of(asked.formula))


def check_ways(
    plan: Plan, mission: ElaboratedMission, plugins: tuple[Plugin, ...], seen: Collection[Name]
) -> None:
    """Refuse vehicles whose circles are wider than they may stray, and name all that is not watched; raises Mistake."""
    for vehicle, most in mission.setting.strays.items():
        for plugin in circling(plugins):
            across = plugin.circle(vehicle) if plugin.owns(vehicle) else 0.0
            if across > most:
                message = f"{vehicle} strays at most {most:g} m, and flies circles of {across:g} m across"
                hint = "nothing has been commanded; give the mission a wider bound, or the vehicle a smaller circle"
                raise Mistake(message, hint, mission.source.name)
    for line in (*unwatched(plan, mission), *unseen(plan, seen)):
        tell(f"warning: {line}")


def unwatched(plan: Plan, mission: ElaboratedMission) -> Iterator[str]:
    """Yield the mission's assumptions and properties about ways that a run does not watch."""
    for vehicle in sorted(mission.setting.strays.keys() - plan.vehicles.keys()):
        yield f"nothing watches that {vehicle} keeps to its way: give --vehicle {vehicle}=..."
    watched = {each.name for each in plan.invariants}
    for each in mission.properties:
        if not asks_of_regions((each,)) or each.kind is PropertyKind.REACHABLE or each.name in watched:
            continue
        if each.kind is PropertyKind.INVARIANT and is_parted(plan.first):
            yield f"'{each.name}' is not watched at this station: it is about agents that other stations may run"
        elif each.kind is PropertyKind.INVARIANT:
            yield f"'{each.name}' is not watched: it compares more than {MOST_PARTS:,} pairs"
        else:
            yield f"'{each.name}' is not watched: of properties about ways, a run watches invariants only"
    if is_parted(plan.first) and plan.invariants:
        yield "the ways of other stations' vehicles count as straight lines to their destinations"


def unseen(plan: Plan, seen: Collection[Name]) -> Iterator[str]:
    """Yield the entities of watched invariants that move and that nothing has reported: they may be anywhere."""
    for each in plan.invariants:
        atoms = (atom for atom in atoms_of(each.formula) if isinstance(atom, RegionAtom))
        names = {name for atom in atoms for name in operands(atom)}
        for name in sorted(names - plan.fixed - frozenset(seen)):
            yield f"nothing has reported {name}: until it is seen it may be anywhere, and '{each.name}' counts so"
