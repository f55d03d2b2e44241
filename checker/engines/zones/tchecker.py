"""Write the timed automaton of a mission for TChecker, as a second opinion."""

import re
from collections.abc import Iterator

from checker.engines.zones.automaton_export import (
    FIRST,
    WRONG,
    ExportedAutomaton,
    ExportedEdge,
    ExportedLocation,
)


def tchecker_text(model: ExportedAutomaton) -> str:
    """Return a model as text; with a property, the label `wrong` is reachable exactly if it is violated."""
    return "\n".join([*_lines(model), ""])


def _lines(model: ExportedAutomaton) -> Iterator[str]:
    yield f"system:{re.sub(r'[^A-Za-z0-9_]', '_', model.name)}"
    yield from (f"event:{each}" for each in dict.fromkeys(step.event for step in model.steps))
    yield "process:mission"
    yield from (f"clock:1:{clock}" for clock in model.clocks)
    yield f"location:mission:{FIRST}{{initial: : committed: }}"
    yield from map(_location, model.places)
    if model.asked is not None:
        yield f"location:mission:{WRONG}{{labels: {WRONG}}}"
    yield from map(_edge, model.steps)


def _location(place: ExportedLocation) -> str:
    invariant = f"invariant: {' && '.join(place.invariant)}" if place.invariant else ""
    return f"location:mission:{place.name}{{{'urgent:' if place.is_urgent else invariant}}}"


def _edge(step: ExportedEdge) -> str:
    guard = [f"provided: {' && '.join(step.guard)}"] if step.guard else []
    sets = [f"do: {'; '.join(f'{clock} = {to}' for clock, to in step.sets)}"] if step.sets else []
    return f"edge:mission:{step.source}:{step.target}:{step.event}{{{' : '.join([*guard, *sets])}}}"
