"""Pictures and tables of values in notebooks: self-contained, and readable on light and on dark pages.

`import bigactors` registers these formatters in a running IPython. Each element has its own colours: notebooks are also
shown on sites that remove style sheets and scripts.
"""

from collections.abc import Iterator
from typing import Any, Final

from bigactors.pages.markup import element, text
from bigactors.pictures import draw_configuration, shown_names
from checker import Outcome, Report, Trace, Verdict, Violation
from checker.reports.lanes import LaneStep, lanes_of_trace
from checker.reports.report import MARKS, size_text, verdict_text
from checker.traces import print_length
from physical.wordings import counted
from semantics.state.configuration import Configuration

MOST_ENTITIES: Final = 200
"""The most entities of a configuration with a picture."""

MOST_STEPS: Final = 200
"""The most steps shown of a trace."""

COLOURS: Final = {Outcome.HOLDS: "#2e9e5b", Outcome.VIOLATED: "#e0453a", Outcome.INCOMPLETE: "#c58a00"}
CELL: Final = "text-align:left;vertical-align:top;padding:2px 10px 2px 0"
QUIET: Final = "opacity:.7"
SERVES: Final = "#4fa672"
AROUND: Final = "#d08a3c"
OWN: Final = "#4f86c6"


def configuration_svg(c: Configuration) -> str | None:
    """Return the picture of a configuration, the bigraph beside the map; None for a configuration that is too large."""
    if len(shown_names(c)) > MOST_ENTITIES:
        return None
    return draw_configuration(c)._repr_svg_()


def trace_html(trace: Trace) -> str:
    """Return a trace as a table, with a column for each agent and one for the changes."""
    lanes = lanes_of_trace(trace)
    heads = (element("th", text(name), style=CELL) for name in ("", *lanes.names, "changes"))
    shown = [step for step in lanes.steps if step.number <= MOST_STEPS or step.role]
    rows = (_row(step, len(lanes.names)) for step in shown)
    left_out = len(lanes.steps) - len(shown)
    more = [f"not shown: {counted(left_out, 'more step')}"] if left_out > 0 else []
    return element(
        "div",
        element("p", text(print_length(trace))),
        element("table", element("tr", *heads), *rows),
        *(element("p", text(line), style=QUIET) for line in (*more, *filter(None, [lanes.end]))),
    )


def _row(step: LaneStep, lanes: int) -> str:
    colour = SERVES if step.serves else AROUND if step.label.agent is None else OWN
    role = (
        element("b", text(f"[{step.role}] "), style=f"color:{COLOURS[Outcome.VIOLATED]}") if step.role else ""
    )
    said = role + element("b", text(step.label.rule), style=f"color:{colour}") + f" {text(step.about)}"
    cells = (element("td", said if lane == step.lane else "", style=CELL) for lane in range(lanes))
    changes = "<br>".join(text(change) for change in step.changes)
    number = element("td", f"c{step.number}", style=f"{CELL};{QUIET}")
    return element("tr", number, *cells, element("td", changes, style=CELL))


def report_html(report: Report) -> str:
    """Return a report as a table of verdicts, with a fold-out trace for each violation."""
    notes = (*(bound.effect for bound in report.bounds), *report.notes)
    return element(
        "div",
        element("p", text(size_text(report))),
        *(element("p", text(note), style=QUIET) for note in notes),
        element("table", *(row for verdict in report.verdicts for row in _rows(verdict))),
    )


def verdict_html(verdict: Verdict) -> str:
    """Return a verdict as one table, in the form that reports use."""
    return element("table", *_rows(verdict))


def _rows(verdict: Verdict) -> Iterator[str]:
    mark = element("b", MARKS[verdict.outcome], style=f"color:{COLOURS[verdict.outcome]}")
    words = (mark, element("b", text(verdict.property.name)), text(verdict_text(verdict)))
    yield element("tr", *(element("td", each, style=CELL) for each in words))
    for violation in verdict.violations:
        yield element("tr", element("td"), element("td", _violation(violation), colspan=2, style=CELL))


def _violation(violation: Violation) -> str:
    summary = element("summary", element("b", text(violation.kind)), f": {text(violation.message)}")
    details = (element("div", text(line), style=QUIET) for line in violation.details)
    return element("details", summary, *details, trace_html(violation.trace))


def register(display: Any) -> None:
    """Register the formatters of these values in an `IPython.core.formatters.DisplayFormatter`."""
    display.formatters["image/svg+xml"].for_type(Configuration, configuration_svg)
    html = display.formatters["text/html"]
    html.for_type(Trace, trace_html)
    html.for_type(Report, report_html)
    html.for_type(Verdict, verdict_html)
