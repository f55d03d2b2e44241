"""Write the timed automata of a mission for TChecker, as a second opinion.

Its algorithm of local time (`concur19`) misreads urgent locations, and clocks that are set to another value than 0. So
an invariant on one more clock, which is reset on entry, stops time in urgent locations.
"""

import re
from collections.abc import Iterator, Sequence
from typing import Final

from checker.engines.zones.automaton_export import ExportedAutomaton
from checker.engines.zones.exported_process import WRONG, ExportedEdge, ExportedLocation, ExportedProcess

STAY: Final = "stay"
"""The clock that stops time in the urgent locations of a process."""


def tchecker_text(model: ExportedAutomaton) -> str:
    """Return a model as text; with a property, the label `wrong` is reachable exactly if it is violated."""
    return "\n".join([*_lines(model), ""])


def _lines(model: ExportedAutomaton) -> Iterator[str]:
    names = [_identifier(each.name) for each in model.processes]
    wrong = [each for each in model.processes if each.can_be_wrong] or model.processes[:1]
    yield f"system:{_identifier(model.name)}"
    events = dict.fromkeys(step.event for process in model.processes for step in process.steps)
    yield from (f"event:{each}" for each in events)
    for name, process in zip(names, model.processes, strict=True):
        yield from _process(name, process, is_asked=model.asked is not None and process in wrong)
    for event, takes in model.shared:
        if event in events:
            yield f"sync:{':'.join(f'{names[each]}@{event}' for each in takes)}"


def _identifier(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_]", "_", name)


def _process(name: str, process: ExportedProcess, *, is_asked: bool) -> Iterator[str]:
    urgent = {place.name for place in process.places if place.is_urgent}
    stay = f"{STAY}_{name}"
    yield f"process:{name}"
    yield from (f"clock:1:{clock}" for clock in (*process.clocks, *([stay] if urgent else [])))
    for number, place in enumerate(process.places):
        yield _location(name, place, stay, is_first=not number)
    if is_asked:
        yield f"location:{name}:{WRONG}{{labels: {WRONG}}}"
    for step in process.steps:
        yield _edge(name, step, (*step.resets, stay) if step.target in urgent else step.resets)


def _location(process: str, place: ExportedLocation, stay: str, *, is_first: bool) -> str:
    invariant = (f"{stay} <= 0",) if place.is_urgent else place.invariant
    words = [*(["initial:"] if is_first else []), *_attribute("invariant", " && ", invariant)]
    return f"location:{process}:{place.name}{{{' : '.join(words)}}}"


def _edge(process: str, step: ExportedEdge, resets: tuple[str, ...]) -> str:
    sets = [f"{clock} = 0" for clock in resets]
    words = [*_attribute("provided", " && ", step.guard), *_attribute("do", "; ", sets)]
    return f"edge:{process}:{step.source}:{step.target}:{step.event}{{{' : '.join(words)}}}"


def _attribute(key: str, between: str, parts: Sequence[str]) -> Iterator[str]:
    if parts:
        yield f"{key}: {between.join(parts)}"
