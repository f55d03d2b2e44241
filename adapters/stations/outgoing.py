"""A turn's entries for the other stations: parcels left and entered, flights, and the hosts of agents."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from adapters.live.turn_result import LiveStep, Turn
from adapters.stations.entries import Believed, Broke, Content, Hosted, Posted, Took, VehicleSent
from adapters.stations.merge import Merge
from semantics.state.canonical import written
from semantics.state.cell_values import Cell
from semantics.state.configuration import Configuration
from semantics.state.parcel_serialization import parcel_json
from semantics.state.station_partition import Passage, is_here

A_MOMENT = 1e-6
"""The least seconds between the time stamps of two entries on an agent, for any clocks."""


def told(turn: Turn, vehicles: Collection[str], known: Mapping[str, int]) -> Iterator[Content]:
    """Yield the entries of a turn; those that others need before a parcel enters come before it.

    Args:
        turn: The turn.
        vehicles: The vehicles that may be sent somewhere.
        known: The last numbers received from the other stations.
    """
    for step in turn.steps:
        before, after = step.source.structure.physical, step.transition.target.structure.physical
        if step.transition.label.rule in ("command", "commit"):
            for vehicle in sorted(vehicles):
                if before.going_to(vehicle) != after.going_to(vehicle):
                    yield VehicleSent(vehicle, after.going_to(vehicle), step.time)
    for finding in turn.findings:
        if finding.kind == "broken assumption" and not finding.elsewhere:
            yield Broke(finding.message, finding.time)
    yield from (Took(station, number) for station, number in entered(turn).items())
    for each in turn.parcels:
        knows = {name: number for name, number in sorted(known.items()) if name != each.station}
        yield Posted(each.station, each.number, parcel_json(each.parcel), knows, turn.steps[-1].time)


def believed(turn: Turn, merge: Merge) -> Iterator[Believed]:
    """Yield a turn's writes to L, each with a later time stamp than the previous write."""
    steps: dict[Cell, LiveStep] = {}
    for step in turn.steps:
        if step.transition.label.rule in ("sense", "actuate", "commit"):
            cells = written(step.source, step.transition.target)
            steps |= dict.fromkeys((cell for cell in cells if cell[0] in ("parent", "links")), step)
    for (slot, node), step in sorted(steps.items(), key=lambda item: item[0]):
        last, logical = merge.belief(slot, node), step.transition.target.structure.logical
        parent = logical.parent(node)
        nested = () if parent is None else (parent,)
        after = last.content.time + A_MOMENT if last and isinstance(last.content, Believed) else step.time
        yield Believed(node, slot, nested if slot == "parent" else logical.links(node), max(step.time, after))


def entered(turn: Turn) -> dict[str, int]:
    """Return the index up to which all parcels of each station have entered with a turn."""
    seen = (step.sight for step in turn.steps)
    passed = [each for each in seen if isinstance(each, Passage) and each.parcel is not None]
    return {each.station: each.number for each in passed}


def moved(c: Configuration, merge: Merge, now: float) -> Iterator[Hosted]:
    """Yield the hosts of agents that run here, if the stations know other ones.

    A station with an agent has received all earlier entries on it from the agent's sender, so its entry is the latest.
    """
    for agent in c.alpha.names():
        home = merge.home(agent)
        known = home.content if home is not None else None
        host = c.alpha.host(agent)
        if is_here(c, agent) and not (isinstance(known, Hosted) and known.host == host):
            after = known.time + A_MOMENT if isinstance(known, Hosted) else now
            yield Hosted(agent, host, max(now, after))
