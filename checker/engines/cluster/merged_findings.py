"""Merging the workers' findings: the result equals that of one process, each finding with its nearest configuration."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from checker.engines.cluster.numbering import Places
from checker.engines.contract import Inspect
from checker.properties.findings import Collected, Finding
from checker.properties.inspections import Inspection, Invariant
from checker.properties.stance_questions import StanceQuestions
from checker.properties.visited_statements import Visited


def is_mergeable(inspection: Inspect) -> bool:
    """Return whether the results of an inspection can be merged from parts, one for each worker."""
    return isinstance(inspection, Visited | StanceQuestions | Inspection)


def merge(into: Inspect, parts: Sequence[Any], places: Places) -> None:
    """Merge the parts of an inspection, one for each worker."""
    if isinstance(into, Inspection):
        merge_collected(into.collected, [part.collected for part in parts], places)
    for part in parts:
        if isinstance(into, Visited | StanceQuestions):
            into.add(part)
        if isinstance(into, Invariant):
            into.valuations.add(part.valuations)


def merge_collected(into: Collected, parts: Sequence[Collected], places: Places) -> None:
    """Merge the workers' collections.

    Each worker keeps the first findings of each group, in order. The first ones overall are among them.
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
