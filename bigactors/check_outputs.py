"""The documents that `check` writes for other programs: their formats, and the writing."""

import os
from argparse import Namespace
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from bigactors import __version__
from bigactors.checking import Checked, FailedMission, results_json
from bigactors.diagnostic_output import diagnostic_json
from bigactors.exits import Exit
from bigactors.files import check_writable, json_text, write_text
from bigactors.mission_lookup import locate
from bigactors.mistakes import Mistake
from bigactors.terminal import say_text
from checker import Report
from checker.properties.coverage import Coverage
from checker.reports.results import CheckResult, Issue, Level
from specs import parse_bytes
from specs.codes import Code
from specs.elaboration import ElaboratedMission
from specs.syntax import Check

STANDARD_OUTPUT: Final = "-"


@dataclass(frozen=True, slots=True)
class Output:
    """A requested document: its format, and its file or `-`."""

    format: str
    file: str

    @property
    def to_standard_output(self) -> bool:
        """Whether it replaces the text report on the standard output."""
        return self.file == STANDARD_OUTPUT


def outputs_of(options: Namespace) -> tuple[Output, ...]:
    """Return the documents that `--json` and `--output` request; raises Mistake for an unwritable one."""
    asked = [("json", options.json)] if options.json is not None else []
    outputs = tuple(Output(*each) for each in (*asked, *options.output))
    taken: dict[str, Output] = {}
    for output in outputs:
        place = output.file if output.to_standard_output else os.path.realpath(_checked(output.file))
        if other := taken.get(place):
            where = "the standard output" if output.to_standard_output else output.file
            raise Mistake(f"{other.format} and {output.format} cannot both go to {where}", "give one a file")
        taken[place] = output
    return outputs


def _checked(file: str) -> str:
    try:
        check_writable(file)
    except ValueError as error:  # the path has a zero byte
        raise Mistake("this is no path of a file", place=repr(file)) from error
    return file


def write_outputs(outputs: Iterable[Output], results: Sequence[Checked | FailedMission], code: Exit) -> None:
    """Write every document to its place."""
    for output in outputs:
        text = FORMATS[output.format](results, code)
        if not output.to_standard_output:
            write_text(output.file, text)
        elif output.format == "junit":  # ASCII: a substituted character could be markup
            say_text(
                text.encode("ascii", "xmlcharrefreplace").decode("ascii").replace("UTF-8", "US-ASCII", 1)
            )
        else:
            say_text(text)


# --- formats --------------------------------------------------------------------------------------------------


def _json(results: Sequence[Checked | FailedMission], code: Exit) -> str:
    return _escaped(json_text(results_json(list(results), code)))


def _escaped(text: str) -> str:
    """Return a text with the parts of names escaped that are not UTF-8."""
    return text.encode("utf-8", "backslashreplace").decode()


def _junit(results: Sequence[Checked | FailedMission], _: Exit) -> str:
    from checker.reports.junit import junit_text  # noqa: PLC0415 - each format is loaded on request

    return junit_text(map(result_of, results))


def _sarif(results: Sequence[Checked | FailedMission], _: Exit) -> str:
    from checker.reports.sarif import sarif_json  # noqa: PLC0415

    return json_text(sarif_json(map(result_of, results), __version__))


def _github(results: Sequence[Checked | FailedMission], _: Exit) -> str:
    from checker.reports.annotations import annotations  # noqa: PLC0415

    return "".join(f"{line}\n" for line in annotations(map(result_of, results)))


def _geojson(results: Sequence[Checked | FailedMission], _: Exit) -> str:
    from bigactors.region_features import features_json  # noqa: PLC0415

    return _escaped(json_text(features_json(results)))


FORMATS: Final[dict[str, Callable[[Sequence[Checked | FailedMission], Exit], str]]] = {
    "json": _json,
    "junit": _junit,
    "sarif": _sarif,
    "github": _github,
    "geojson": _geojson,
}
"""The writer of each format. The names are those of `arguments.FORMATS`."""


# --- results --------------------------------------------------------------------------------------------------


def result_of(checked: Checked | FailedMission) -> CheckResult:
    """Return a mission's result in the common shape of the formats."""
    if isinstance(checked, Checked):
        return result_on(checked.mission, checked.name, checked.report)
    return CheckResult(checked.name, file_of(checked.name), failures=tuple(_failures(checked)))


def result_on(mission: ElaboratedMission, name: str, report: Report) -> CheckResult:
    """Return the report on a mission together with line numbers in its text."""
    cautions = cautions_of(mission, report)
    covered = None if report.coverage is None else unexplained(report.coverage, cautions)
    return CheckResult(
        name,
        file_of(name),
        replace(report, coverage=covered),
        check_line=check_line(mission),
        text=mission.source.text,
        cautions=cautions,
    )


def file_of(name: str) -> str:
    """Return the file of a mission, relative to the working directory if it lies inside."""
    try:
        path = Path(os.path.abspath(locate(name)))
    except Mistake:
        return name
    here = Path.cwd()
    return str(path.relative_to(here) if path.is_relative_to(here) else path)


def check_line(mission: ElaboratedMission) -> int:
    """Return the line of a mission's first `check` section; 1 without one."""
    source, tree = parse_bytes(mission.source.name, mission.source.text.encode())
    return next((source.line(section.span.start) for section in tree.each(Check)), 1)


def cautions_of(mission: ElaboratedMission, report: Report) -> tuple[Issue, ...]:
    """Return the warnings on a mission's text that its report does not refute."""
    said = (diagnostic_json(each, mission.source) for each in mission.warnings_after(report.suspected))
    return tuple(_of_text(each, Level.WARNING) for each in said)


CAUSES_OF_GAPS: Final = frozenset(
    code.number
    for code in (
        Code.NOTHING_QUANTIFIED,
        Code.TWO_TYPES,
        Code.ALWAYS_THE_SAME,
        Code.NEVER_INSIDE,
        Code.HIDES_AN_ENTITY,
    )
)
"""The codes of warnings that are the cause of a gap of coverage in the same line."""


def unexplained(covered: Coverage, cautions: Iterable[Issue]) -> Coverage:
    """Return coverage without the gaps that a warning on the text explains: one cause gives one warning."""
    told = {caution.line for caution in cautions if caution.rule in CAUSES_OF_GAPS}
    return replace(covered, gaps=tuple(gap for gap in covered.gaps if gap.line not in told))


def _failures(failed: FailedMission) -> Iterable[Issue]:
    if failed.exit is Exit.MISTAKE:
        yield from (_of_text(each, Level.WRONG) for each in failed.details)
        return
    level = Level.BUG if failed.exit is Exit.BUG else Level.INCOMPLETE
    yield Issue(level, "exploration", level.value, failed.message, identity=(level.value,))


def _of_text(said: dict[str, object], level: Level) -> Issue:
    line, column, end_line, end_column = (
        int(str(said.get(key, 0))) for key in ("line", "column", "end_line", "end_column")
    )
    rule, message, hint = str(said.get("code", "mistake")), str(said["message"]), str(said.get("hint", ""))
    details = (f"hint: {hint}",) if hint else ()
    return Issue(
        level, rule, rule, message, line, column, end_line, end_column,
        identity=(rule, message), details=details,
    )  # fmt: skip
