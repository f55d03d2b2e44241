"""Reports as text for people and as plain data for machines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

from checker.properties.coverage import Coverage, Gap
from checker.reports.corridors_table import corridors_json, corridors_text
from checker.reports.times import times_json, times_text
from checker.traces import Trace, print_length, print_parts, print_trace, to_json
from checker.verdicts import Outcome, Report, Verdict, Violation
from physical.wordings import counted
from semantics.properties.kinds import PropertyKind
from semantics.state.setting import Control
from semantics.successors import rules_of

if TYPE_CHECKING:
    from checker.properties.critical_path import Leg

SCHEMA = "bigactors.report/1"
"""The version of the report's schema (docs/reference/json.md)."""

SCREEN: Final = 40
"""The lines of a report that fit a screen."""

LEAST, MOST_TOLD = 6, 8
"""On a screen: the least lines of a trace, and the most details of a violation."""

MARKS = {Outcome.HOLDS: "✓", Outcome.VIOLATED: "✗", Outcome.INCOMPLETE: "?"}


def report_text(
    name: str, report: Report, *, traces: bool = True, screen: int | None = None
) -> Iterator[str]:
    """Yield a report line by line.

    With `screen`, it has about so many lines: a property has one trace, of which the steps are left out that do not
    fit, and says how to see the rest.
    """
    show = partial(_violation, traces=traces)
    if screen is None or not traces:
        yield from _lines(name, report, lambda verdict: chain.from_iterable(map(show, verdict.violations)))
        return
    others = sum(1 for _ in _lines(name, report, partial(_folded, room=0)))
    room = (screen - others) // max(sum(bool(verdict.violations) for verdict in report.verdicts), 1)
    yield from _lines(name, report, partial(_folded, room=max(room, LEAST)))


def _lines(name: str, report: Report, show: Callable[[Verdict], Iterable[str]]) -> Iterator[str]:
    """Yield a report line by line; `show` prints the violations of a property."""
    yield f"{name}: {size_text(report)}, {report.seconds:.2f} s"
    for bound in report.bounds:
        yield f"  {bound.effect}"
    width = max((len(verdict.property.name) for verdict in report.verdicts), default=0)
    for verdict in report.verdicts:
        yield f"  {MARKS[verdict.outcome]} {verdict.property.name:<{width}}  {verdict_text(verdict)}"
        yield from show(verdict)
    if report.schedule is not None:
        yield from times_text(report.schedule)
    if report.corridors is not None:
        yield from corridors_text(report.corridors)
    yield "  rules: " + (", ".join(f"{rule} {count:,}" for rule, count in report.rules.items()) or "none")
    yield from (f"  note: {note}" for note in report.notes)


def size_text(report: Report) -> str:
    """Return the size of the exploration as text."""
    size = f"{counted(report.configurations, 'configuration')}, {_followed(report)}, depth {report.depth}"
    searched = f", reduced by {' and '.join(report.reduced)}" if report.reduced else ""
    return f"{size}, {'complete' if report.complete else 'INCOMPLETE'}{searched}"


def _followed(report: Report) -> str:
    if not report.reduced:
        return counted(report.transitions, "transition")
    return f"{report.transitions:,} of {counted(report.allowed, 'transition')}"


def verdict_text(verdict: Verdict) -> str:
    """Return the word of a verdict, with its note, remarks and counts."""
    return "; ".join(filter(None, [verdict.outcome.value, verdict.note, *verdict.remarks, *_sizes(verdict)]))


def _sizes(verdict: Verdict) -> Iterator[str]:
    if verdict.outcome is Outcome.VIOLATED:
        if verdict.violations and verdict.property.kind.about.counted:
            yield _found(verdict)
    elif verdict.witness is not None and verdict.examined:
        yield f"{_examined(verdict)}, a witness of {counted(len(verdict.witness), 'step')}"
    elif verdict.outcome is Outcome.INCOMPLETE:
        yield (
            "not found so far"
            if verdict.property.kind is PropertyKind.REACHABLE
            else "nothing against it so far"
        )
    elif verdict.examined and verdict.property.kind.about.counted:
        yield _examined(verdict)  # no witness was searched, but subjects were examined
    elif verdict.property.kind.about.nothing:
        yield verdict.property.kind.about.nothing


def _found(verdict: Verdict) -> str:
    shown = len(verdict.violations)
    if verdict.count == 1:
        return "found once"
    times = f"found {counted(verdict.count, 'time')}"
    if verdict.different <= 1:
        return times
    if verdict.different == shown:
        return f"{times}, {shown} different"
    return f"{times}, {verdict.different:,} different, of which {shown} {'is' if shown == 1 else 'are'} shown"


def _examined(verdict: Verdict) -> str:
    one, many = verdict.property.kind.about.examined
    return f"examined {counted(verdict.examined, one, many) if one else f'{verdict.examined:,}'}"


def _violation(violation: Violation, *, traces: bool) -> Iterator[str]:
    yield f"      {violation.kind}: {violation.message}"
    yield from (f"        {detail}" for detail in violation.told)
    yield f"      {print_length(violation.trace)}{':' if traces else ''}"
    if traces:
        yield from (f"        {line}" for line in print_trace(violation.trace))


def _folded(verdict: Verdict, *, room: int) -> Iterator[str]:
    """Yield the violations of a property in brief: the first with the steps that fit so many lines."""
    for violation in verdict.violations[:1]:
        yield f"      {violation.kind}: {violation.message}"
        told = violation.told
        yield from (f"        {line}" for line in told[:MOST_TOLD])
        if len(told) > MOST_TOLD:
            yield f"        ... {counted(len(told) - MOST_TOLD, 'line')} more: --all"
        yield f"      {print_length(violation.trace)}:"
        if room:
            yield from (f"        {line}" for line in print_parts(violation.trace, room))
    for violation in verdict.violations[1:]:
        yield f"      {violation.kind}: {violation.message}"
        yield f"      {print_length(violation.trace)}: --all"


def report_json(name: str, digest: str, report: Report, control: Control) -> dict[str, Any]:
    """Return a report as plain data; the schema is documented in docs/reference/json.md."""
    silent = [rule.__name__ for rule in rules_of(control) if rule.__name__ not in report.rules]
    return {
        "schema": SCHEMA,
        "mission": name,
        "digest": digest,
        "complete": report.complete,
        "bounds": list(map(str, report.bounds)),
        "configurations": report.configurations,
        "transitions": report.transitions,
        "depth": report.depth,
        "reduced": list(report.reduced),
        "transitions_allowed": report.allowed,
        "exit_code": report.exit_code,
        "properties": [_property_json(name, digest, verdict) for verdict in report.verdicts],
        "rules": dict(report.rules),
        "rules_never_used": silent,
        "coverage": None if report.coverage is None else coverage_json(report.coverage),
        "notes": list(report.notes),
        "times": None if report.schedule is None else times_json(report.schedule),
        "ways": None if report.corridors is None else corridors_json(report.corridors),
        "seconds": round(report.seconds, 3),
    }


def _property_json(name: str, digest: str, verdict: Verdict) -> dict[str, Any]:
    def trace(run: Trace | None) -> dict[str, Any] | None:
        return None if run is None else to_json(run, name, digest)

    return {
        "name": verdict.property.name,
        "kind": verdict.property.kind,
        "line": verdict.property.line,
        "verdict": verdict.outcome.value,
        "trace": trace(verdict.violations[0].trace if verdict.violations else None),
        "violations": [
            {
                "kind": v.kind,
                "subject": v.subject,
                "message": v.message,
                "details": list(v.details),
                "critical_path": [_leg_json(leg) for leg in v.path],
                "alike": v.alike,
                "shortest": v.trace.shortest,
                "trace": trace(v.trace),
            }
            for v in verdict.violations
        ],
        "different": verdict.different,
        "count": verdict.count,
        "examined": verdict.examined,
        "witness": trace(verdict.witness),
        "note": verdict.note,
        "remarks": list(verdict.remarks),
    }


def _leg_json(leg: Leg) -> dict[str, Any]:
    """Return one stretch of a critical path, its times in seconds."""
    least, most = leg.interval.lo, leg.interval.hi
    return {
        "from": leg.begin * leg.tick / 1000,
        "to": leg.end * leg.tick / 1000,
        "label": str(leg.label),
        "at_least": least * leg.tick / 1000,
        "at_most": None if most is None else most * leg.tick / 1000,
        "bound": leg.bound.words,
        "line": leg.bound.line,
        "going_on": leg.going_on,
    }


WIDEST: Final = 100
"""The most columns of a quoted line of the mission."""


def coverage_text(name: str, covered: Coverage, text: str) -> Iterator[str]:
    """Yield coverage line by line, each gap with its line of the mission's text, like compiler warnings."""
    tallies = (
        (covered.statements, "statement", "statements"),
        (covered.branches, "branch", "branches"),
        (covered.rules, "rule", "rules"),
        (covered.clauses, "clause of the environment", "clauses of the environment"),
    )
    counts = ", ".join(
        f"{tally.reached:,} of {tally.of:,} {one if tally.of == 1 else many}"
        for tally, one, many in tallies
        if tally.of
    )
    yield f"  coverage{'' if covered.complete else ' so far'}: {counts or 'there is nothing to reach'}"
    if covered.complete:
        for gap in covered.gaps:
            yield from _gap_text(name, gap, line_text(text, gap.line))


def line_text(text: str, line: int) -> str:
    """Return a line of a text, from 1, or an empty text."""
    lines = text.split("\n")
    return lines[line - 1] if 0 < line <= len(lines) else ""


def _gap_text(name: str, gap: Gap, line: str) -> Iterator[str]:
    yield f"  {name}:{gap.line}: warning: {gap.message}" if gap.line else f"  {name}: warning: {gap.message}"
    if line:
        yield f"    {gap.line} | {_quoted(line)}"


def _quoted(line: str) -> str:
    shown = "".join(sign if sign.isprintable() else " " for sign in line.expandtabs(4)).rstrip()
    return shown if len(shown) <= WIDEST else f"{shown[: WIDEST - 1]}…"


def coverage_json(covered: Coverage) -> dict[str, Any]:
    """Return coverage as plain data."""
    tallies = {
        "statements": covered.statements,
        "branches": covered.branches,
        "rules": covered.rules,
        "clauses": covered.clauses,
    }
    return {
        "complete": covered.complete,
        **{name: {"reached": tally.reached, "of": tally.of} for name, tally in tallies.items()},
        "lines_reached": list(covered.lines),
        "lines_not_reached": list(covered.unreached),
        "gaps": [{"line": gap.line, "sort": gap.sort, "message": gap.message} for gap in covered.gaps],
    }
