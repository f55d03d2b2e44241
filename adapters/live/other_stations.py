"""Input from other stations: parcels, vehicles under way, hosts of agents, broken assumptions."""

from __future__ import annotations

from dataclasses import replace

from adapters.live.fallbacks import answers_for, breaks
from adapters.live.step_taking import check_times, observe, take
from adapters.live.turn_in_progress import Turning
from adapters.plugin import Believes, Broken, Delivered, Hosts, StationReport, Underway
from semantics.observed_steps import Sight, happening
from semantics.state.parcel_serialization import parcel_of
from semantics.state.physical_model import InTransit, Placed, placement_cell
from semantics.state.signature import REGION, Name
from semantics.state.station_partition import (
    Belief,
    HostReport,
    Passage,
    believe,
    enter,
    learn,
    objection,
    took_cell,
)


def take_station_report(turning: Turning, report: StationReport) -> None:
    """Take in a report of another station; its steps carry the other station's times."""
    turning.done = report.done if isinstance(report, Delivered | Underway) else None
    match report:
        case Delivered():
            _take_in(turning, report)
        case Underway(entity, _, to, _):
            _fly(turning, entity, to)
        case Hosts(agent, _, host):
            for found in learn(turning.c, agent, host):
                take(turning, found, (found,), HostReport(agent, host))
        case Believes(node, _, slot, names):
            belief = Belief(node, slot, names)
            for found in believe(turning.c, belief):
                take(turning, found, (found,), belief)
        case Broken(station, _, assumption):
            count = len(turning.results.findings)
            breaks(turning, f"at {station}: {assumption}", station)
            turning.results.findings[count:] = [
                replace(each, elsewhere=True) for each in turning.results.findings[count:]
            ]
    if turning.done is not None:
        check_times(turning)  # delayed reports may be late: check at once
    turning.done = None


def _take_in(turning: Turning, delivered: Delivered) -> None:
    """Let a parcel enter if it is the next of its station; skip those that have entered already."""
    station, number = delivered.station, delivered.number
    if turning.c.read(took_cell(station)) != number - 1:
        return
    try:
        parcel = parcel_of(delivered.parcel)
    except ValueError as error:
        _refuse(turning, station, number, str(error))
        return
    found = tuple(enter(turning.c, station, number, parcel))
    if found:
        turning.agents = turning.agents.woken([parcel.agent])
        take(turning, found[0], found, Passage(parcel.agent, station, number, parcel))
    else:
        _refuse(turning, station, number, objection(turning.c, parcel))


def _refuse(turning: Turning, station: str, number: int, why: str) -> None:
    message = f"parcel {number} of {station} cannot enter, nor any later one: {why}"
    turning.find("trouble", station, message, once=True)


def _fly(turning: Turning, entity: Name, to: Name) -> None:
    """Record that another station has sent a vehicle, or that this vehicle has arrived.

    In between it is in transit here too, so no agent observes it on its way.
    """
    here = turning.c.structure.physical.placement(entity)
    if entity in turning.commanded.flights or entity not in turning.plan.vehicles:
        return
    if to and answers_for(turning, entity):
        message = f"another station reports that it has sent {entity} to {to}, but {entity} obeys this one"
        turning.find("trouble", entity, message, once=True)
        return
    if _may_hold(turning, to, entity) and isinstance(here, Placed | InTransit):
        going = InTransit(here if isinstance(here, Placed) else here.origin, to)
        sight = Sight(f"{entity} is sent to {to}", {placement_cell(entity): going})
    elif not to and isinstance(here, InTransit):
        at = turning.where_seen(entity) or here.origin
        around = sorted(turning.around(entity, turning.c.setting.kind(entity), at))
        sight = Sight(f"{entity} is seen in {', '.join(around) or REGION}", {placement_cell(entity): at})
    else:
        return
    observe(turning, sight, happening(turning.c, sight))


def _may_hold(turning: Turning, place: Name, entity: Name) -> bool:
    setting = turning.c.setting
    known = place in setting.kinds
    return known and setting.signature[setting.kind(place)].may_contain(setting.kind(entity))
