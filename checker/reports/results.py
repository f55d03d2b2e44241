"""The results of several missions in the common shape of other programs' formats."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from checker.properties.coverage import Gap
from checker.reports.report import coverage_text, line_text, report_text
from checker.reports.source_lines import violation_line
from checker.traces import Trace, print_length, print_trace
from checker.verdicts import Outcome, Report, Verdict, Violation


class Level(Enum):
    """The severity of an issue: an error, a suspicion, an undecided property, or a failure of bigactors itself."""

    WRONG = "wrong"
    WARNING = "warning"
    INCOMPLETE = "incomplete"
    BUG = "internal error"


@dataclass(frozen=True, slots=True)
class Issue:
    """One issue of a mission, at its place.

    Attributes:
        level: Its severity.
        rule: The kind of a property, or the code of a mistake.
        title: A few words.
        message: A sentence.
        line: Its line in the mission, from 1; 0 if unknown. The same for the column and the ends.
        asked: The line of the property, if there is one.
        identity: A text that identifies it in another run, even if lines have moved.
        details: More lines.
        trace: A run that ends in it.
    """

    level: Level
    rule: str
    title: str
    message: str
    line: int = 0
    column: int = 0
    end_line: int = 0
    end_column: int = 0
    asked: int = 0
    identity: tuple[str, ...] = ()
    details: tuple[str, ...] = ()
    trace: Trace | None = None


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The result of one mission.

    Attributes:
        name: The mission as the user gave it.
        file: Its file, relative to the working directory if it is inside.
        report: Its report; None if it was not explored.
        failures: The reasons why it was not explored.
        check_line: The line of its `check` section, 1 without one: the place of implicit properties.
        text: The mission's text, to quote its lines.
        cautions: Warnings on its text.
    """

    name: str
    file: str
    report: Report | None = None
    failures: tuple[Issue, ...] = ()
    check_line: int = 1
    text: str = ""
    cautions: tuple[Issue, ...] = ()

    def issues(self) -> tuple[Issue, ...]:
        """Return all issues, in the mission's order."""
        if self.report is None:
            return self.failures
        decided = (issue for verdict in self.report.verdicts for issue in self.issues_of(verdict))
        return (*decided, *self.undecided(), *self.warnings())

    def issues_of(self, verdict: Verdict) -> Iterator[Issue]:
        """Yield the issues of a property: none exactly if it holds."""
        if verdict.outcome is Outcome.VIOLATED:
            yield from (self._violation(verdict, each) for each in verdict.violations)
            if not verdict.violations:
                yield self._without_trace(verdict, Level.WRONG, verdict.note or "nothing satisfies it")
        elif verdict.outcome is Outcome.INCOMPLETE:
            yield self._without_trace(verdict, Level.INCOMPLETE, self._cut_off())

    def undecided(self) -> Iterator[Issue]:
        """Yield an issue for a met limit, unless a verdict reports it: an incomplete check never reads as a success."""
        if self.report is None or self.report.complete:
            return
        if all(verdict.outcome is Outcome.HOLDS for verdict in self.report.verdicts):
            rule, title = "exploration", "exploration incomplete"
            yield Issue(
                Level.INCOMPLETE, rule, title, self._cut_off(), self.check_line, identity=("incomplete",)
            )

    def warnings(self) -> Iterator[Issue]:
        """Yield warnings about the text, about weak verdicts, and about parts that no run reaches."""
        if self.report is None:
            return
        yield from self.cautions
        for verdict in self.report.verdicts:
            yield from self.remarks_of(verdict)
        yield from self.gaps()

    def remarks_of(self, verdict: Verdict) -> Iterator[Issue]:
        """Yield warnings about a vacuous or weak verdict."""
        for remark in verdict.remarks:
            yield self._remark(verdict, remark)

    def gaps(self) -> Iterator[Issue]:
        """Yield warnings about parts that no run reaches."""
        covered = self.report.coverage if self.report else None
        for gap in covered.gaps if covered is not None and covered.complete else ():
            yield self._gap(gap)

    def line_of(self, verdict: Verdict) -> int:
        """Return the line that asks for a property."""
        return verdict.property.line or self.check_line

    def _cut_off(self) -> str:
        bounds = (bound.effect for bound in (self.report.bounds if self.report else ()))
        return "; ".join(["not decided", *bounds])

    def _violation(self, verdict: Verdict, violation: Violation) -> Issue:
        asked = verdict.property
        return Issue(
            Level.WRONG,
            asked.kind,
            f"{asked.name} violated: {violation.kind}",
            violation.message,
            violation_line(violation) or self.line_of(verdict),
            asked=self.line_of(verdict),
            identity=(asked.kind, asked.name, violation.kind, *filter(None, [violation.subject])),
            details=violation.told,
            trace=violation.trace,
        )

    def _remark(self, verdict: Verdict, remark: str) -> Issue:
        asked, line = verdict.property, self.line_of(verdict)
        identity = (asked.kind, asked.name, remark)
        return Issue(Level.WARNING, "vacuity", f"{asked.name} holds", remark, line, identity=identity)

    def _gap(self, gap: Gap) -> Issue:
        quoted = line_text(self.text, gap.line).strip()
        identity = (gap.sort, gap.message, quoted)
        details = (quoted,) if quoted else ()
        return Issue(
            Level.WARNING,
            "coverage",
            "not covered",
            gap.message,
            gap.line,
            identity=identity,
            details=details,
        )

    def _without_trace(self, verdict: Verdict, level: Level, message: str) -> Issue:
        asked, line = verdict.property, self.line_of(verdict)
        title = f"{asked.name} {verdict.outcome.value}"
        identity = (asked.kind, asked.name, verdict.outcome.value)
        return Issue(level, asked.kind, title, message, line, asked=line, identity=identity)


def issue_text(issue: Issue) -> str:
    """Return an issue with its details and its trace as lines of text."""
    lines = [issue.message, *(f"  {detail}" for detail in issue.details)]
    if issue.trace is not None:
        lines.append(f"{print_length(issue.trace)}:")
        lines += [f"  {line}" for line in print_trace(issue.trace)]
    return "\n".join(lines)


def placed_text(result: CheckResult, issue: Issue) -> str:
    """Return an issue as text, after its place in the mission."""
    place = ":".join(str(part) for part in (result.file, issue.line, issue.column) if part)
    return f"{place}: {issue.title}\n{issue_text(issue)}"


def caution_text(name: str, caution: Issue) -> Iterator[str]:
    """Yield a warning on a mission's text, which a report prints first: it may explain an unexpected verdict."""
    yield f"{name}:{caution.line}: warning: {caution.rule}: {caution.message}"
    yield from (f"  {detail}" for detail in caution.details)


def result_text(result: CheckResult) -> str:
    """Return the report of a result without its traces; empty where there is none."""
    if result.report is None:
        return ""
    lines = [
        *(line for caution in result.cautions for line in caution_text(result.name, caution)),
        *report_text(result.name, result.report, traces=False),
    ]
    if result.report.coverage is not None:
        lines += coverage_text(result.name, result.report.coverage, result.text)
    return "\n".join(lines)


def clean(text: str) -> str:
    r"""Replace characters that XML 1.0 forbids, other control characters and lone surrogates by U+FFFD.

    >>> clean("a\x1b[31m\tb\n\ud800")
    'a�[31m\tb\n�'
    """
    return re.sub(
        "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", "\N{REPLACEMENT CHARACTER}", text
    )
