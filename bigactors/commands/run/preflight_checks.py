"""Checks before take-off for parts of a mission that no vehicle here can carry out.

A control commits when a report confirms it. Vehicles report their positions and their controlling stations. No report
confirms that a vehicle is aboard another, that a load was put down, or that a channel was joined.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress

from adapters.live.command_planning import is_authority
from adapters.live.core import obeying
from adapters.live.ground_formulas import MOST_PARTS, about_ways
from adapters.live.loop import LiveRun
from adapters.live.plan import Plan
from adapters.live.surroundings import spots
from adapters.plugin import Plugin, Preflight, circling, preflights
from bigactors.commands.run.geofence import placements_of
from bigactors.mistakes import Mistake
from bigactors.terminal import tell
from semantics.analysis.control_instances import first_instances
from semantics.analysis.overapproximation import Overapproximation
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.reaction_rules import CONTROL_AUTHORITY, LinkTerm, NodeTerm, PlaceTerm, Reaction
from semantics.behaviours.statements import ControlBy
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

PATIENCE = 15.0
"""Seconds that a vehicle has to report its parameters."""

Objection = Callable[[Reaction], str]
"""Returns the objection to a control; empty if there is none."""


def check_idle(live: LiveRun, *, takes_over: bool) -> None:
    """Refuse to command vehicles that fly a mission of another operator; raises Mistake."""
    if takes_over:
        return
    said = live.inbox.statuses
    for name in sorted(obeying(live.plan, live.state)):
        if name in said and said[name].follows:
            found = f"{name} is under way already, in {said[name].mode}"
            message = f"{found}: it flies a mission that this run did not send"
            hint = "land it, or take it over: --take-over; a run that was interrupted goes on with --resume"
            raise Mistake(message, hint)


def check_flyable(mission: ElaboratedMission) -> None:
    """Refuse controls that no report can confirm, and warn of controls that may be such; raises Mistake."""
    _judge(mission, lambda reaction: next(_unshown(reaction, mission), ""))


def check_places(mission: ElaboratedMission, plugins: tuple[Plugin, ...]) -> None:
    """Refuse places too small for a vehicle, now that its kind is known, or outside one of its fences.

    Raises Mistake.
    """
    pilots = preflights(plugins)
    for remark in (remark for plugin in pilots for remark in plugin.remarks()):
        tell(f"warning: {remark}")

    def objection(reaction: Reaction) -> str:
        reasons = (
            reason
            for vehicle, place in reaction.moves
            for plugin in pilots
            if isinstance(vehicle, str) and plugin.owns(vehicle)
            for reason in (
                *_bars(plugin, vehicle, reaction, mission),
                *_objections(plugin, vehicle, place, mission),
            )
        )
        return next((f"it cannot: {reason}" for reason in reasons if reason), "")

    _judge(mission, objection)


def _bars(
    plugin: Preflight, vehicle: Name, reaction: Reaction, mission: ElaboratedMission
) -> Iterator[str | None]:
    """Yield the reasons why a vehicle can't pass the places on its way."""
    for via in (each for each in reaction.via if isinstance(each, str)):
        yield from (plugin.bar(vehicle, geometry, via) for geometry in placements_of(via, mission))


def _objections(
    plugin: Preflight, vehicle: Name, place: PlaceTerm, mission: ElaboratedMission
) -> Iterator[str | None]:
    """Yield the reasons why a vehicle can't stay at some position of its destination, beside the entities there."""
    if not isinstance(place, str):
        return
    for geometry, around in spots(mission.initial, vehicle, place):
        yield plugin.objection(vehicle, geometry, place, around)


async def get_to_know(plugins: tuple[Plugin, ...], vehicles: Iterable[Name]) -> None:
    """Wait until vehicles have reported their circles and fences, or until the timeout."""
    asked = [plugin for plugin in preflights(plugins) if any(map(plugin.owns, vehicles))]
    with suppress(TimeoutError):
        async with asyncio.timeout(PATIENCE):
            while not all(plugin.is_known() for plugin in asked):
                await asyncio.sleep(0.1)


def _judge(mission: ElaboratedMission, objection: Objection) -> None:
    """Raise Mistake for a control that is always impossible, and warn of one that may be impossible."""
    for agent, line, reactions in _controls(mission):
        reasons = {str(reaction): objection(reaction) for reaction in reactions}
        bad = [f"{control}: {reason}" for control, reason in reasons.items() if reason]
        if bad and len(bad) == len(reasons):
            hint = "nothing has been commanded; change the mission, or its vehicles"
            raise Mistake(
                f"{agent} would request an impossible flight: {bad[0]}", hint, _place(mission, line)
            )
        if bad:
            tell(f"{_place(mission, line)}: warning: {agent} may request an impossible flight: {bad[0]}")


def _place(mission: ElaboratedMission, line: int) -> str:
    return f"{mission.source.name}:{line}" if line else mission.source.name


def _controls(mission: ElaboratedMission) -> Iterator[tuple[Name, int, tuple[Reaction, ...]]]:
    """Yield the controls of each agent, with their lines and all possible arguments."""
    flow = ValueFlow(mission.setting, Overapproximation(mission.initial))
    for agent in flow.agents:
        for number in sorted(flow[agent].statements):
            statement = flow.program.statements[number]
            if isinstance(statement, ControlBy):
                found = first_instances(flow.program, statement.name, flow.names_of(agent, statement))
                possible = tuple(each for each in found if _may_take(mission, each))
                yield agent, flow.program.line(number), possible


def _may_take(mission: ElaboratedMission, reaction: Reaction) -> bool:
    """Return whether a reaction's movers may be at its destinations and waypoints, and those all differ."""
    ways = ((node, place) for node, to in reaction.moves for place in (*reaction.via, to))
    each_once = all(len({*reaction.via, to}) == len(reaction.via) + 1 for _, to in reaction.moves)
    return each_once and all(_may_be(mission, *way) for way in ways)


def _may_be(mission: ElaboratedMission, node: NodeTerm, place: PlaceTerm) -> bool:
    """Return whether a place may hold a node at all."""
    of, holder = _kind(mission, node), _kind(mission, place)
    unknown = of is None or holder is None
    return node != place and (unknown or mission.setting.signature[str(holder)].may_contain(str(of)))


def _unshown(reaction: Reaction, mission: ElaboratedMission) -> Iterator[str]:
    signature = mission.setting.signature
    for node, place in reaction.moves:
        of, holder = _kind(mission, node), _kind(mission, place)
        if of is not None and not signature[of].driven:
            yield f"no report can confirm that {node} is put into {place}"
        elif of is not None and holder is not None and of in signature[holder].carries:
            yield f"no report can confirm that {node} is aboard {place}"
    for node, links in _links(reaction):
        of = _kind(mission, node)
        if (
            reaction.moves
            or any(_is_other(link) for link in links)
            or (of is not None and not signature[of].driven)
        ):
            which = sorted(link if isinstance(link, str) else "a channel" for link in links)
            yield f"no report can confirm that {node} joins or leaves {' and '.join(dict.fromkeys(which))}"


def _links(reaction: Reaction) -> Iterator[tuple[NodeTerm, frozenset[LinkTerm]]]:
    """Yield the nodes whose links a reaction changes, with the changed links."""
    changed = set(reaction.redex.links) ^ set(reaction.reactum.links)
    for node in dict.fromkeys(node for _, node in (*reaction.redex.links, *reaction.reactum.links)):
        links = frozenset(link for link, point in changed if point == node)
        if links:
            yield node, links


def _is_other(link: LinkTerm) -> bool:
    """Return whether a link is certainly no control authority."""
    if isinstance(link, str):
        return not is_authority(link)
    return link.but == CONTROL_AUTHORITY or link.kind not in (None, CONTROL_AUTHORITY)


def _kind(mission: ElaboratedMission, term: NodeTerm | PlaceTerm) -> str | None:
    if isinstance(term, str):
        return mission.setting.kinds.get(term)
    return getattr(term, "kind", None)


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
