"""Watch the assumptions about ways: a vehicle keeps near the lines between its points, and in its band of altitudes."""

from __future__ import annotations

from adapters.live.assumptions import STRAYED
from adapters.live.fallbacks import answers_for, breaks
from adapters.live.flown_ways import ACCEPTANCE, FlownWay
from adapters.live.fresh_placements import Sighting
from adapters.live.seen_regions import margin_of, way_of
from adapters.live.turn_in_progress import Turning
from physical import Geometry, PhysicalError, band_contains, centroid
from semantics.state.physical_model import Placed
from semantics.state.signature import Name


def watch_ways(turning: Turning) -> None:
    """Compare the vehicles that are newly seen with their ways and their bands."""
    overridden = [each for each in turning.plan.vehicles if _is_overridden(turning, each)]
    if overridden:
        turning.commanded = turning.commanded.overridden(overridden)
        for entity in overridden:
            turning.watched = turning.watched.unwatched(entity)
    for entity in sorted(turning.plan.vehicles.keys() - set(overridden)):
        sighting = turning.sightings.newest.get(entity)
        if sighting is not None and sighting is not turning.before.sightings.newest.get(entity):
            _watch(turning, entity, sighting)


def _is_overridden(turning: Turning, entity: Name) -> bool:
    """Return whether others command a vehicle: a pilot, an operator, another station, or the mission's fallback."""
    return not answers_for(turning, entity) or turning.overrides.is_overridden(entity)


def _watch(turning: Turning, entity: Name, sighting: Sighting) -> None:
    at = turning.where_seen(entity)
    if not isinstance(at, Placed):
        return
    spot = centroid(at.geometry)
    try:
        if turning.plan.invariants or entity in turning.plan.first.setting.strays:
            near = max(ACCEPTANCE, margin_of(turning.plan, entity))
            turning.commanded = turning.commanded.progressed(entity, spot, near)
        _check_strays(turning, entity, spot)
    except PhysicalError as error:
        message = f"whether {entity} strays from its way is not watched: {error.message}"
        turning.find("trouble", entity, message, once=True)
    _check_band(turning, entity, sighting)


# --- strays


def _check_strays(turning: Turning, entity: Name, at: Geometry) -> None:
    most, way = turning.plan.first.setting.strays.get(entity), _watched_way(turning, entity)
    if most is None or way is None:
        return
    metres = way.beside(at, most).metres
    if metres <= most:
        turning.watched = turning.watched.on_way(entity)
    elif entity not in turning.watched.astray:
        turning.watched = turning.watched.off_way(entity)
        which = _described(turning, entity, way)
        message = f"{entity} is {metres:.0f} m from {which}; the mission says: it strays at most {most:g} m"
        breaks(turning, f"{message}: {STRAYED}", entity)


def _watched_way(turning: Turning, entity: Name) -> FlownWay | None:
    """Return the way to which a vehicle must keep; None while it is unknown whether it follows its command."""
    begin = turning.commanded.begins.get(entity)
    if begin is not None:
        return FlownWay((begin,))
    given = turning.commanded.flights.get(entity)
    if given is not None and not given.obeyed:
        return None
    return way_of(entity, turning.commanded, turning.overrides)


def _described(turning: Turning, entity: Name, way: FlownWay) -> str:
    if entity in turning.commanded.begins:
        return "the point at which the mission has it"
    if len(way.points) == 1:
        return f"the point around which it stays{f' in {way.to}' if way.to else ''}"
    return f"its way{f' to {way.to}' if way.to else ''}"


def keeps_near(turning: Turning, entity: Name, at: Geometry, end: Geometry) -> bool:
    """Return whether a vehicle is as near to its last point as the mission says: it has not arrived before."""
    most = turning.plan.first.setting.strays.get(entity)
    if most is None:
        return True
    try:
        return FlownWay((end,)).beside(centroid(at)).metres <= most
    except PhysicalError:
        return False


# --- bands


def _check_band(turning: Turning, entity: Name, sighting: Sighting) -> None:
    shape, seen = turning.shape(entity), sighting.property.altitude
    if shape is None or shape.altitude is None or seen is None:
        return
    if way_of(entity, turning.commanded, turning.overrides) is None:
        return
    if band_contains(shape.altitude, seen):
        turning.watched = turning.watched.in_band(entity)
    elif entity in turning.watched.levelled and entity not in turning.watched.off_level:
        turning.watched = turning.watched.out_of_band(entity)
        band = f"{shape.altitude.low:g} m to {shape.altitude.high:g} m"
        message = f"{entity} is at {seen.low:.0f} m above sea level; the mission has it at {band}"
        breaks(turning, f"{message}: {STRAYED}", entity)


def is_level(turning: Turning, entity: Name) -> bool:
    """Return whether a vehicle is seen in its band, or has none."""
    shape, sighting = turning.shape(entity), turning.sightings.newest.get(entity)
    return shape is None or sighting is None or band_contains(shape.altitude, sighting.property.altitude)
