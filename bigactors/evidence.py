"""The traces of a report as files: as text, as JSON and as pictures."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from bigactors.checking import Checked
from bigactors.drawings import draw_run
from bigactors.files import file_stem, make_folder, write_json, write_text
from checker import Trace, print_trace, to_json
from semantics.printing import print_configuration


@dataclass(frozen=True, slots=True)
class Evidence:
    """A trace and what it is evidence of: the words of the violation, or `a witness`."""

    stem: str
    about: str
    trace: Trace


def evidence_of(checked: Checked) -> Iterator[Evidence]:
    """Yield the trace of each violation and of each witness of a report."""
    for verdict in checked.report.verdicts:
        name = verdict.property.name
        for violation in verdict.violations:
            stem = file_stem(f"{name}-{violation.kind}")
            yield Evidence(stem, f"{name} violated: {violation.kind}: {violation.message}", violation.trace)
        if verdict.witness is not None:
            yield Evidence(file_stem(f"{name}-witness"), f"{name} holds: a witness", verdict.witness)


def write_evidence(checked: Checked, folder: str) -> list[Path]:
    """Write all traces of a report into a folder; return the paths without their endings."""
    found = list(evidence_of(checked))
    directory = make_folder(folder) if found else Path(folder)
    written: list[Path] = []
    for each in found:
        path = _free(directory / each.stem, written)
        write_text(f"{path}.txt", "\n".join(_lines(checked, each)) + "\n")
        write_json(f"{path}.json", to_json(each.trace, checked.name, checked.digest))
        draw_run(each.trace, f"{path}.svg", title=f"{checked.mission.name}: {each.about}")
        written.append(path)
    return written


def _free(path: Path, taken: list[Path]) -> Path:
    """Return a path that is not taken: two properties may differ in signs that file names lack."""
    number, free = 2, path
    while free in taken:
        free, number = path.with_name(f"{path.name}-{number}"), number + 1
    return free


def _lines(checked: Checked, evidence: Evidence) -> Iterator[str]:
    trace = evidence.trace
    yield f"{checked.name} ({checked.digest})"
    yield f"{evidence.about}; {len(trace)} steps"
    yield ""
    yield f"c0 = {print_configuration(trace.initial)}"
    yield from print_trace(trace)
    if trace.steps:
        yield f"c{len(trace)} = {print_configuration(trace.configurations[-1])}"
