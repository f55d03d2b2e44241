"""The traces of a report as files: text, JSON, pictures and pages."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from bigactors.checking import Checked
from bigactors.files import file_stem, make_folder, write_json, write_text
from bigactors.mission_lookup import digest_of, text_json
from bigactors.pages import MOST_PICTURES, Story, trace_page
from bigactors.picture_files import draw_run
from bigactors.pictures import RegionMarks, marks_of
from checker import Trace, print_trace, to_json
from checker.reports.causes import Cause
from checker.reports.trace_subject import TraceSubject
from physical.wordings import counted
from semantics.properties.kinds import PropertyKind
from semantics.state.printing import print_configuration
from specs.elaboration import ElaboratedMission


@dataclass(frozen=True, slots=True)
class Evidence:
    """A trace, as evidence of a verdict.

    Attributes:
        subject: The property, and its violation.
        stem: The name of its folder.
        trace: Its steps.
        telling: Whether each configuration is drawn: the trace ends in a violation, or in a wanted configuration.
        causes: The causes of the violation.
        marks: The regions that the property is about.
    """

    subject: TraceSubject
    stem: str
    trace: Trace
    telling: bool
    causes: tuple[Cause, ...] = ()
    marks: RegionMarks | None = None

    @property
    def violated(self) -> bool:
        """Whether the trace ends in a violation."""
        return self.subject.violation is not None

    @property
    def property(self) -> str:
        """The name of the property."""
        return self.subject.asked.name


def evidence_of(checked: Checked) -> Iterator[Evidence]:
    """Yield the trace of each violation and of each witness in a report."""
    initial = checked.mission.initial
    for verdict in checked.report.verdicts:
        name = verdict.property.name
        for violation in verdict.violations:
            subject = TraceSubject(verdict.property, violation)
            yield Evidence(
                subject,
                file_stem(f"{name}-{violation.kind}"),
                violation.trace,
                telling=True,
                causes=subject.causes(violation.trace),
                marks=marks_of(
                    initial, violation.trace.configurations[-1], [verdict.property], violated=True
                ),
            )
        if verdict.witness is not None:
            found = verdict.property.kind is PropertyKind.REACHABLE
            stem = file_stem(f"{name}-witness")
            last = verdict.witness.configurations[-1]
            marks = marks_of(initial, last, [verdict.property], violated=False)
            yield Evidence(TraceSubject(verdict.property), stem, verdict.witness, found, marks=marks)


def write_evidence(
    checked: Checked, folder: Path, sources: Mapping[str, Path] = MappingProxyType({})
) -> tuple[Path, ...]:
    """Write every trace of a report into a folder of its own: `trace.txt`, `trace.json`, `trace.svg`, `trace.html`.

    Each configuration of a violation, or of a witness of reachability, is drawn; of other traces only the last one, in
    the page. `sources` replaced files of the mission's world. Returns the folders.
    """
    written: list[Path] = []
    for each in evidence_of(checked):
        target = make_folder(str(_free(folder / each.stem, written)))
        write_text(str(target / "trace.txt"), "\n".join(_lines(checked, each)) + "\n")
        data = trace_json(each.trace, checked.name, checked.mission, sources) | each.subject.json()
        write_json(str(target / "trace.json"), data)
        title = f"{checked.mission.name}, {each.stem}:"
        draw_run(each.trace, target, title, each_step=each.telling, marks=each.marks)
        write_text(str(target / "trace.html"), trace_page(story_of(checked, each)))
        written.append(target)
    return tuple(written)


def trace_json(
    trace: Trace, file: str, mission: ElaboratedMission, sources: Mapping[str, Path]
) -> dict[str, Any]:
    """Return a trace as plain data, with its mission: `show` and `replay` read it in any folder."""
    setting = mission.setting
    variation = {"scheduler": setting.scheduler.value, "control": setting.control.value}
    return to_json(trace, file, digest_of(mission)) | text_json(mission, file, sources) | variation


def story_of(checked: Checked, evidence: Evidence) -> Story:
    """Return the contents of a trace's page."""
    return Story(
        checked.mission.name,
        evidence.subject.headline,
        evidence.violated,
        evidence.trace,
        len(evidence.trace) if evidence.violated else 0,
        evidence.causes,
        drawn=MOST_PICTURES if evidence.telling else 1,
        notes=(evidence.subject.about, *evidence.subject.details, f"{checked.name}, {checked.digest}"),
        marks=evidence.marks,
        properties=checked.mission.properties,
    )


def _free(path: Path, taken: list[Path]) -> Path:
    """Return a free path: two properties may differ in characters that file names cannot have."""
    number, free = 2, path
    while free in taken:
        free, number = path.with_name(f"{path.name}-{number}"), number + 1
    return free


def _lines(checked: Checked, evidence: Evidence) -> Iterator[str]:
    trace = evidence.trace
    yield f"{checked.name} ({checked.digest})"
    yield f"{evidence.subject.about}; {counted(len(trace), 'step')}"
    yield ""
    yield f"c0 = {print_configuration(trace.initial)}"
    yield from print_trace(trace)
    if trace.steps:
        yield f"c{len(trace)} = {print_configuration(trace.configurations[-1])}"
