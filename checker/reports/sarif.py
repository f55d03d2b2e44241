"""Reports as SARIF 2.1.0, the format of code scanners; docs/reference/sarif.schema.json has the parts used.

Source: https://docs.oasis-open.org/sarif/sarif/v2.1.0/sarif-v2.1.0.html; §s are its sections.
"""

import hashlib
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath
from typing import Any
from urllib.parse import quote

from checker.reports.results import CheckResult, Issue, Level, clean
from checker.reports.source_lines import step_lines
from checker.traces import Trace, print_step
from semantics.properties.kinds import PropertyKind

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"

RULES = {
    **{str(kind): kind.about.says for kind in PropertyKind},
    "exploration": "Everything reachable is visited.",
    "coverage": "Some run reaches each statement, takes each branch, and meets each clause of the environment.",
    "vacuity": "No property holds only because its cases never occur.",
}
"""The description of each kind of property, and of other findings."""

LEVELS = {Level.WRONG: "error", Level.WARNING: "warning"}
"""The levels of results; other issues are notifications."""

MISTAKE = "A mistake in the mission, or in how it is called."


def sarif_json(results: Iterable[CheckResult], version: str) -> dict[str, Any]:
    """Return results as plain data; errors and warnings are results, undecided properties notifications.

    The execution counts as successful (§3.20.14) exactly if everything was decided, so an incomplete one never reads
    as a success.
    """
    found = [(result, issue) for result in results for issue in result.issues()]
    wrong = [(result, issue) for result, issue in found if issue.level in LEVELS]
    rules = sorted({*RULES, *(issue.rule for _, issue in found)})
    notified = [_notification(*each, rules) for each in found if each[1].level not in LEVELS]
    done = not notified and not any(result.failures for result, _ in found)
    seen: Counter[str] = Counter()
    return {
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [
            {
                "tool": {
                    "driver": {
                        "name": "bigactors",
                        "version": version,
                        "rules": [_rule(rule) for rule in rules],
                    }
                },
                "columnKind": "unicodeCodePoints",
                "invocations": [{"executionSuccessful": done, "toolExecutionNotifications": notified}],
                "results": [_result(*each, rules, seen) for each in wrong],
            }
        ],
    }


def _rule(rule: str) -> dict[str, Any]:
    return {"id": clean(rule), "shortDescription": {"text": RULES.get(rule, MISTAKE)}}


def _result(result: CheckResult, issue: Issue, rules: list[str], seen: Counter[str]) -> dict[str, Any]:
    said: dict[str, Any] = {
        "ruleId": clean(issue.rule),
        "ruleIndex": rules.index(issue.rule),
        "level": LEVELS[issue.level],
        "message": _message("\n".join((f"{issue.title}: {issue.message}", *issue.details))),
        "locations": [_location(result.file, issue.line, issue)],
        "partialFingerprints": {"bigactorsIssue/v1": fingerprint(result, issue, seen)},
    }
    if issue.asked not in (0, issue.line):
        asked = {"id": 1, **_location(result.file, issue.asked), "message": _message("asked for here")}
        said["relatedLocations"] = [asked]
    if issue.trace is not None and issue.trace.steps:
        said["codeFlows"] = [{"threadFlows": [{"locations": _flow(result.file, issue.trace)}]}]
    return said


def _notification(result: CheckResult, issue: Issue, rules: list[str]) -> dict[str, Any]:
    return {
        "level": "error" if issue.level is Level.BUG else "note",
        "message": _message(f"{result.name}: {issue.title}: {issue.message}"),
        "locations": [_location(result.file, issue.line)],
        "associatedRule": {"id": clean(issue.rule), "index": rules.index(issue.rule)},
    }


def _flow(file: str, trace: Trace) -> list[dict[str, Any]]:
    return [
        {
            "location": {**_location(file, line), "message": _message(print_step(trace, number))},
            **({"importance": "essential"} if trace.role(number) else {}),
        }
        for number, line in enumerate(step_lines(trace), 1)
    ]


def fingerprint(result: CheckResult, issue: Issue, seen: Counter[str]) -> str:
    """Return a digest of an issue and its file, but not of its line (§3.27.17); `seen` distinguishes equal ones."""
    said = repr((PurePath(result.file).as_posix(), issue.rule, issue.identity))
    seen[said] += 1
    return hashlib.sha256(f"{said}{seen[said]}".encode()).hexdigest()[:32]


def _location(file: str, line: int, issue: Issue | None = None) -> dict[str, Any]:
    physical: dict[str, Any] = {"artifactLocation": artifact(file)}
    if line:
        ends = (issue.column, issue.end_line, issue.end_column) if issue else (0, 0, 0)
        region = zip(("startLine", "startColumn", "endLine", "endColumn"), (line, *ends), strict=True)
        physical["region"] = {key: number for key, number in region if number}
    return {"physicalLocation": physical}


def artifact(file: str) -> dict[str, str]:
    """Return a file as a URI: relative to the root of the sources where it is relative (§3.4).

    >>> artifact("sub/a b:c.mission")
    {'uri': 'sub/a%20b%3Ac.mission', 'uriBaseId': '%SRCROOT%'}
    """
    path = PurePath(file)
    said = re.sub("[\ud800-\udc7f\udd00-\udfff]", "\N{REPLACEMENT CHARACTER}", path.as_posix())
    name = said.encode("utf-8", "surrogateescape")  # the bytes of a name that is not UTF-8
    if path.is_absolute():
        return {"uri": f"file:///{quote(name.lstrip(b'/'), safe='/:')}"}
    return {"uri": quote(name), "uriBaseId": "%SRCROOT%"}


def _message(text: str) -> dict[str, str]:
    return {"text": clean(text)}
