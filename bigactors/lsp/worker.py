"""Check the text of an editor in a separate process that can be ended at any time.

It reads the mission and the limits from the standard input, and writes the verdicts to the standard output. Without a
folder for the pages of traces, it writes the whole report instead of pages.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from bigactors.check_outputs import cautions_of, unexplained
from bigactors.checking import Checked
from bigactors.files import make_folder, write_text
from bigactors.mission_lookup import digest_of
from bigactors.pages import trace_page
from bigactors.trace_files import evidence_of, story_of
from checker import Limits, check
from checker.verdicts import Verdict
from specs import MissionError, Source
from specs.diagnostics import render_all
from specs.elaboration import diagnose, require_bigactor
from specs.parser import read


def main() -> None:
    """Check the mission on the standard input."""
    asked = json.load(sys.stdin)
    source = Source(asked["name"], asked["text"])
    limits = Limits(asked["configurations"], asked["seconds"])
    try:
        result = checked(source, Path(asked["directory"]), limits)
        found = verdicts(result, Path(asked["folder"])) if "folder" in asked else {"report": _report(result)}
    except MissionError as error:
        found = {"refused": render_all(error.diagnostics, error.source)}
    json.dump(found, sys.stdout)


def checked(source: Source, directory: Path, limits: Limits) -> Checked:
    """Return a text's mission and its report; raises MissionError."""
    diagnosis = diagnose(read(source), source, directory)
    mission = diagnosis.elaborated
    if mission is None:
        raise MissionError(source, diagnosis.mistakes)
    require_bigactor(mission)
    report = check(mission, limits=limits, suspected=mission.suspicions)
    return Checked(source.name, mission, digest_of(mission), report, False)


def _report(result: Checked) -> dict[str, Any]:
    """Return the report without the gaps that a warning explains, which the editor shows in the same line."""
    report = result.report
    if report.coverage is None:
        return result.as_json()
    covered = unexplained(report.coverage, cautions_of(result.mission, report))
    return replace(result, report=replace(report, coverage=covered)).as_json()


def verdicts(result: Checked, folder: Path) -> dict[str, Any]:
    """Return the verdicts by property, with the pages of their traces."""
    report, pages = result.report, _pages(result, folder)
    return {
        "verdicts": {verdict.property.name: _verdict(verdict, pages) for verdict in report.verdicts},
        "configurations": report.configurations,
        "complete": report.complete,
    }


def _verdict(verdict: Verdict, pages: dict[str, str]) -> dict[str, Any]:
    message = verdict.violations[0].message if verdict.violations else verdict.note
    return {
        "outcome": verdict.outcome.value,
        "message": message,
        "trace": pages.get(verdict.property.name, ""),
    }


def _pages(result: Checked, folder: Path) -> dict[str, str]:
    """Write the page of the first trace of each property; return their paths by property."""
    found: dict[str, str] = {}
    for each in evidence_of(result):
        if each.property not in found:
            path = Path(make_folder(str(folder))) / f"{each.stem}.html"
            write_text(str(path), trace_page(story_of(result, each)))
            found[each.property] = str(path)
    return found


if __name__ == "__main__":
    main()
