"""The lines of a mission's text on a run, and the line of a violation."""

from collections import Counter
from collections.abc import Iterator

from checker.properties.inspections import is_stuck
from checker.traces import Trace
from checker.verdicts import Violation
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import REQUESTS, Request
from semantics.state.signature import Name
from semantics.successors import expand

Asked = dict[Request, int]
"""The line of the statement that made each request of a run."""


def step_lines(trace: Trace) -> tuple[int, ...]:
    """Return for each step the line of its statement, from 1; 0 for a step without one, such as the environment's."""
    return _walk(trace)[0]


def violation_line(violation: Violation) -> int:
    """Return the line of a violation's statement, from 1; 0 if there is no single one.

    It is the statement of the first request in its message, else the one at which an agent waits, or whose computation
    fails.
    """
    asked = _walk(violation.trace)[1]
    named = [(at, asked[each]) for each in asked if (at := violation.message.find(str(each))) >= 0]
    if named:
        return min(named)[1]
    last = violation.trace.configurations[-1]
    return next((line for a in _troubled(violation, last) if (line := _line_of(last, a))), 0)


def _walk(trace: Trace) -> tuple[tuple[int, ...], Asked]:
    asked: Asked = {}
    lines = []
    source = trace.initial
    for step in trace.steps:
        line = _line_of_step(source, step.label, asked)
        lines.append(line)
        asked.update((request, line) for request in _new_requests(source, step.target) if line)
        source = step.target
    return tuple(lines), asked


def _line_of_step(source: Configuration, label: Label, asked: Asked) -> int:
    if isinstance(label.about, REQUESTS) and label.about in asked:
        return asked[label.about]
    return 0 if label.agent is None else _line_of(source, label.agent)


def _new_requests(source: Configuration, target: Configuration) -> Iterator[Request]:
    before = Counter(each.request for each in source.eta.all())
    yield from (Counter(each.request for each in target.eta.all()) - before).keys()


def _line_of(c: Configuration, a: Name) -> int:
    """Return the line of an agent's next statement."""
    code, lines = c.alpha.code(a), c.setting.program.lines
    return lines[code[0]] if code and code[0] < len(lines) else 0


def _troubled(violation: Violation, c: Configuration) -> Iterator[Name]:
    """Yield the agents that a violation without requests is about, in the order of its message."""
    if violation.kind == "deadlock":
        yield from (a for a in c.alpha.names() if is_stuck(c, a))
    if violation.kind in ("fails", "diverges", "deadlock"):
        yield from (fault.agent for fault in expand(c).faults if _is_about(violation, fault.agent, fault))


def _is_about(violation: Violation, agent: Name, fault: Exception) -> bool:
    return violation.kind == "deadlock" or violation.message == f"{agent}: {fault}"
