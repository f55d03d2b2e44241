"""Write the timed automaton of a mission for UPPAAL, as a second opinion: XML of the document type flat-1_2."""

from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape, quoteattr

from checker.engines.zones.automaton_export import ExportedAutomaton
from checker.engines.zones.exported_process import WRONG, ExportedEdge, ExportedLocation

DOCUMENT_TYPE = (
    "<!DOCTYPE nta PUBLIC '-//Uppaal Team//DTD Flat System 1.2//EN' "
    "'http://www.it.uu.se/research/group/darts/uppaal/flat-1_2.dtd'>"
)


def uppaal_text(model: ExportedAutomaton) -> str:
    """Return a model of one process as text; with a property, its query is satisfied exactly if the property holds."""
    return "\n".join([*_lines(model), ""])


def _lines(model: ExportedAutomaton) -> Iterator[str]:
    (process,) = model.processes
    yield '<?xml version="1.0" encoding="utf-8"?>'
    yield DOCUMENT_TYPE
    yield "<nta>"
    yield _element("declaration", f"// {model.name}")
    yield "<template>"
    yield _element("name", "Mission")
    if process.clocks:
        yield _element("declaration", f"clock {', '.join(process.clocks)};")
    yield from map(_location, process.places)
    if model.asked is not None:
        yield f'<location id="{WRONG}">{_element("name", WRONG)}</location>'
    yield f'<init ref="{process.places[0].name}"/>'
    yield from map(_transition, process.steps)
    yield "</template>"
    yield _element("system", "mission = Mission();\nsystem mission;")
    if model.asked is not None:
        query = _element("formula", f"A[] not mission.{WRONG}") + _element("comment", model.asked.name)
        yield f"<queries><query>{query}</query></queries>"
    yield "</nta>"


def _location(place: ExportedLocation) -> str:
    parts = _element("name", place.name) + _label("invariant", " && ", place.invariant)
    return f'<location id="{place.name}">{parts}{"<urgent/>" if place.is_urgent else ""}</location>'


def _transition(step: ExportedEdge) -> str:
    ends = f'<source ref="{step.source}"/><target ref="{step.target}"/>'
    sets = [f"{clock} = 0" for clock in step.resets]
    words = [step.words] if step.words else []
    labels = (
        _label("guard", " && ", step.guard) + _label("assignment", ", ", sets) + _label("comments", "", words)
    )
    return f"<transition>{ends}{labels}</transition>"


def _label(kind: str, between: str, parts: Sequence[str]) -> str:
    return _element("label", between.join(parts), kind=kind) if parts else ""


def _element(tag: str, text: str, **attributes: str) -> str:
    said = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())
    return f"<{tag}{said}>{escape(text)}</{tag}>"
