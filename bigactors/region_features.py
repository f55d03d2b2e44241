"""The regions of missions as a feature collection of GeoJSON: over all runs, and those of violated properties."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from bigactors.checking import Checked, FailedMission
from bigactors.pictures import marks_of
from checker.properties.corridors import SeenPart
from checker.verdicts import Verdict
from physical.region_geojson import line_geometry, part_geometry, place_geometry, polygon_geometry
from semantics.properties.property import Property, instantiated_region_atoms
from semantics.properties.region_atoms import operands
from semantics.state.physical_model import Placed
from semantics.state.setting import Control
from semantics.state.signature import Name

Feature = dict[str, Any]


def features_json(results: Iterable[Checked | FailedMission]) -> dict[str, Any]:
    """Return the feature collection of all missions that were explored, with notes on what it lacks."""
    features: list[Feature] = []
    notes: list[str] = []
    for result in results:
        if isinstance(result, Checked):
            features += features_of(result)
        notes += (f"{result.name}: {note}" for note in lacking(result))
    return {"type": "FeatureCollection", "features": features, "complete": not notes, "notes": notes}


def lacking(result: Checked | FailedMission) -> Iterator[str]:
    """Yield the reasons why regions of a mission are missing."""
    if isinstance(result, FailedMission):
        yield result.message
        return
    report = result.report
    yield from (bound.effect for bound in report.bounds)
    if report.corridors is not None:
        yield from report.corridors.notes
    elif result.mission.setting.control is Control.ATOMIC:
        yield "with 'control atomic' nothing is under way"
    else:
        yield f"reduced by {' and '.join(report.reduced)}, the check has left configurations out"


def features_of(checked: Checked) -> Iterator[Feature]:
    """Yield the features of a mission: regions, the places that properties name, and violations."""
    corridors, mission = checked.report.corridors, checked.mission.name
    for part in () if corridors is None else corridors.parts:
        yield _region(mission, part)
    yield from _places(checked)
    for verdict in checked.report.verdicts:
        yield from _violations(checked, verdict)


def _feature(mission: str, sort: str, geometry: dict[str, Any], **properties: object) -> Feature:
    return {
        "type": "Feature",
        "geometry": geometry,
        "properties": {"mission": mission, "feature": sort, **properties},
    }


def _region(mission: str, seen: SeenPart) -> Feature:
    part = seen.part
    way = f" from {seen.between[0]} to {seen.between[-1]}" if seen.between else ""
    return _feature(
        mission,
        "region",
        part_geometry(part),
        name=f"{seen.entity}{way}",
        entity=seen.entity,
        kind=part.kind.value,
        between=list(seen.between),
        altitude=None if part.altitude is None else [part.altitude.low, part.altitude.high],
        margin_m=part.margin,
    )


def _places(checked: Checked) -> Iterator[Feature]:
    """Yield the places that properties about regions name."""
    setting, physical = checked.mission.setting, checked.mission.initial.structure.physical
    naming: dict[Name, list[str]] = {}
    for verdict in checked.report.verdicts:
        for name in sorted(_named(verdict.property)):
            naming.setdefault(name, []).append(verdict.property.name)
    for name, properties in sorted(naming.items()):
        at = physical.placement(name)
        if isinstance(at, Placed) and not setting.signature[setting.kind(name)].driven:
            band = None if at.altitude is None else [at.altitude.low, at.altitude.high]
            known = {"entity": name, "kind": setting.kind(name), "altitude": band, "properties": properties}
            yield _feature(checked.mission.name, "place", place_geometry(at.geometry), name=name, **known)


def _named(asked: Property) -> frozenset[Name]:
    return frozenset(name for atom in instantiated_region_atoms([asked]) for name in operands(atom))


def _violations(checked: Checked, verdict: Verdict) -> Iterator[Feature]:
    """Yield the regions, the breach and the lines in the configuration in which a property fails."""
    mission, asked = checked.mission, verdict.property
    for number, violation in enumerate(verdict.violations):
        last = violation.trace.configurations[-1]
        marks = marks_of(mission.initial, last, [asked], violated=True)
        if marks is None:
            continue
        ways = marks.ways(last)
        known = {"property": asked.name, "violation": number, "step": len(violation.trace)}
        for region in ways.regions:
            if region.polygons:
                shape = polygon_geometry(region.polygons)
                yield _feature(mission.name, "violating region", shape, name=region.name, **known)
        for sort, polygons in (("breach", ways.breaches), ("range", ways.limits)):
            for rings in polygons:
                yield _feature(
                    mission.name, sort, polygon_geometry((rings,)), name=f"{asked.name}: {sort}", **known
                )
        for span in ways.spans:
            line = line_geometry(span.first, span.second)
            yield _feature(mission.name, "nearest points", line, name=span.text, broken=span.broken, **known)
