"""The diagnostics of a mission for the command line: as a mistake, and as plain data."""

from bigactors.mistakes import Mistake
from specs import Diagnostic, MissionError, Source


def as_mistake(error: MissionError) -> Mistake:
    """Return the diagnostics of a mission as a mistake."""
    details = tuple(diagnostic_json(each, error.source) for each in error.diagnostics)
    return Mistake(
        error.diagnostics[0].message, place=error.source.name, rendered=str(error), details=details
    )


def diagnostic_json(diagnostic: Diagnostic, source: Source) -> dict[str, object]:
    """Return a diagnostic as plain data."""
    start, end = (min(at, len(source.text)) for at in (diagnostic.span.start, diagnostic.span.end))
    return {
        "code": diagnostic.code.number,
        "line": source.line(start),
        "column": source.column(start),
        "end_line": source.line(end),
        "end_column": source.column(end),
        "message": diagnostic.message,
        "hint": diagnostic.hint,
    }
