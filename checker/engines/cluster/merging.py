"""Merge the workers' findings: the same as one process finds, each with its nearest configuration."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from checker.engines.cluster.numbering import Places
from checker.engines.contract import Inspect
from checker.properties.findings import Collected, Finding
from checker.properties.inspections import Inspection, Invariant
from checker.properties.visited import Visited


def is_mergeable(inspection: Inspect) -> bool:
    """Tell whether workers may each have found a part of what an inspection finds."""
    return isinstance(inspection, Visited | Inspection)


def merge(into: Inspect, parts: Sequence[Any], places: Places) -> None:
    """Let an inspection have found what parts of it have found, one for each worker."""
    if isinstance(into, Inspection):
        merge_collected(into.collected, [part.collected for part in parts], places)
    for part in parts:
        if isinstance(into, Visited):
            into.add(part)
        if isinstance(into, Invariant):
            into.valuations.add(part.valuations)


def merge_collected(into: Collected, parts: Sequence[Collected], places: Places) -> None:
    """Collect what workers have collected.

    Each keeps the first so many of each kind; those that are first of all are among them, in the same order.
    """
    into.count = sum(part.count for part in parts)
    into.examined = sum(part.examined for part in parts)
    for finding in sorted(_found(parts, places), key=lambda each: each.at):
        if finding.group not in into.groups:
            into.groups[finding.group] = set()
            into.keep(finding)
    for part in parts:
        into.met |= part.met
        for group, keys in part.groups.items():
            into.groups.setdefault(group, set()).update(keys)
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
