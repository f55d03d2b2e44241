"""Merge the workers' findings: the same as one process finds, each with its nearest configuration."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from checker.engines.cluster.numbering import Places
from checker.engines.contract import Inspect
from checker.properties.findings import Collected, Finding
from checker.properties.inspections import (
    Computation,
    DeadlockFreedom,
    Invariant,
    LocalConsistency,
    Reachability,
)
from checker.properties.races import ControlRaces, StaleObservationRaces
from checker.properties.visited import Visited

Collector = Computation | ControlRaces | LocalConsistency | Reachability | StaleObservationRaces


def is_mergeable(inspection: Inspect) -> bool:
    """Tell whether workers may each have found a part of what an inspection finds."""
    return isinstance(inspection, Visited | DeadlockFreedom | Invariant | Collector)


def merge(into: Inspect, parts: Sequence[Any], places: Places) -> None:
    """Let an inspection have found what parts of it have found, one for each worker."""
    match into:
        case Visited():
            _merge_visited(into, parts)
        case DeadlockFreedom():
            merge_collected(into.collected, [part.collected for part in parts], places)
            merge_collected(into.arrival, [part.arrival for part in parts], places)
        case Invariant():
            merge_collected(into.collected, [part.collected for part in parts], places)
            _merge_valuations(into, parts)
        case _ if isinstance(into, Collector):
            merge_collected(into.collected, [part.collected for part in parts], places)


def _merge_visited(into: Visited, parts: Sequence[Visited]) -> None:
    for part in parts:
        for agent, codes in part.codes.items():
            into.codes.setdefault(agent, set()).update(codes)
        into.moments |= part.moments
        into.passed |= part.passed
        into.happened |= part.happened
        into.known |= part.known


def _merge_valuations(into: Invariant, parts: Sequence[Invariant]) -> None:
    begun = [part.valuations for part in parts if part.valuations.begun]
    into.valuations.begun = bool(begun)
    into.valuations.still = {} if begun and all(each.still is not None for each in begun) else None
    for each in begun:
        into.valuations.met |= each.met


def merge_collected(into: Collected, parts: Sequence[Collected], places: Places) -> None:
    """Collect what workers have collected.

    Each keeps the first so many of each kind; those that are first of all are among them, in the same order.
    """
    into.count = sum(part.count for part in parts)
    into.examined = sum(part.examined for part in parts)
    for finding in sorted(_found(parts, places), key=lambda each: each.at):
        key = (finding.kind, finding.subject)
        kept = sum(kind == finding.kind for kind, _ in into.first)
        if key not in into.first and kept < into.most:
            into.first[key] = finding
    for part in parts:
        into.different |= part.different
    examples = [
        (places.number(worker, part.example), part.example_by)
        for worker, part in enumerate(parts)
        if part.example is not None
    ]
    if examples:
        into.example, into.example_by = min(examples, key=lambda each: each[0])


def _found(parts: Sequence[Collected], places: Places) -> Iterator[Finding]:
    for worker, part in enumerate(parts):
        for finding in part.first.values():
            yield replace(finding, at=places.number(worker, finding.at))
