"""Reports as JUnit XML: a suite for each mission, a case for each property.

There is no standard; this is the common subset of Jenkins, GitLab and GitHub's actions. One exploration decides all
properties of a mission, so only suites have times.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence

from checker.reports.results import CheckResult, Issue, Level, clean, placed_text, result_text
from checker.verdicts import Verdict


def junit_text(results: Iterable[CheckResult]) -> str:
    """Return results as an XML document; only cases of properties that hold pass."""
    suites = [_suite(result) for result in results]
    root = ET.Element("testsuites", {"name": "bigactors"})
    root.extend(suites)
    for key in ("tests", "failures", "errors"):
        root.set(key, str(sum(int(suite.get(key, "0")) for suite in suites)))
    root.set("time", f"{sum(float(suite.get('time', '0')) for suite in suites):.3f}")
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _suite(result: CheckResult) -> ET.Element:
    cases = _cases(result)
    suite = _element("testsuite", name=result.name, tests=str(len(cases)))
    suite.set("failures", str(sum(case.find("failure") is not None for case in cases)))
    suite.set("errors", str(sum(case.find("error") is not None for case in cases)))
    suite.set("skipped", "0")
    suite.set("time", f"{result.report.seconds if result.report else 0:.3f}")
    suite.extend(cases)
    if said := result_text(result):
        ET.SubElement(suite, "system-out").text = clean(said)
    return suite


def _cases(result: CheckResult) -> list[ET.Element]:
    decided = [
        _property_case(result, verdict) for verdict in (result.report.verdicts if result.report else ())
    ]
    others = result.undecided() if result.report else result.failures
    return [*decided, *(_case(result, _name(issue), issue.line, [issue]) for issue in others)]


def _property_case(result: CheckResult, verdict: Verdict) -> ET.Element:
    return _case(result, verdict.property.name, result.line_of(verdict), list(result.issues_of(verdict)))


def _case(result: CheckResult, name: str, line: int, issues: Sequence[Issue]) -> ET.Element:
    """Return a case with all its issues in one element, since some readers take the first only."""
    case = _element("testcase", name=name, classname=result.name, file=result.file)
    if line:
        case.set("line", str(line))
    if issues:
        first = issues[0]
        failed = first.level is Level.WRONG and result.report is not None
        sort = "incomplete" if first.level is Level.INCOMPLETE else _kind(first)
        problem = _element("failure" if failed else "error", type=sort, message=first.message)
        problem.text = clean("\n\n".join(placed_text(result, issue) for issue in issues))
        case.append(problem)
    return case


def _name(issue: Issue) -> str:
    return f"{issue.title} at {issue.line}:{issue.column}" if issue.column else issue.title


def _kind(issue: Issue) -> str:
    return issue.identity[2] if issue.trace is not None else issue.rule


def _element(tag: str, **attributes: str) -> ET.Element:
    return ET.Element(tag, {key: clean(value) for key, value in attributes.items()})
