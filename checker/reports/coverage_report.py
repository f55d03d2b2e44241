"""Coverage as text, in the form of compiler warnings, and as plain data."""

from collections.abc import Iterator
from typing import Any, Final

from checker.properties.coverage import Coverage, Gap

WIDEST: Final = 100
"""Columns of a line of the mission that are quoted."""


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
