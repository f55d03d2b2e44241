"""The outline of a mission for editors, and the titles of its properties."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from bigactors.lsp.edited_mission import Reading
from specs import syntax as s
from specs.construct_text import write


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a mission; `name` is the span of its name or its first word."""

    title: str
    sort: str
    span: s.Span
    name: s.Span
    detail: str = ""
    parts: tuple[Part, ...] = ()


def outline(reading: Reading) -> tuple[Part, ...]:
    """Return the declarations of a mission with their parts."""
    return tuple(_declaration(each, reading) for each in reading.mission.declarations)


def _declaration(node: s.Declaration, reading: Reading) -> Part:
    match node:
        case s.Signature(kinds):
            return _section(node, "signature", (_named(kind, "kind") for kind in kinds))
        case s.World(entries):
            return _section(node, "world", map(_entry, entries))
        case s.Check(properties):
            return _section(node, "check", map(_property, properties))
        case s.Environment(clauses):
            return _section(node, "environment", _lines(clauses, reading))
        case s.Believes(beliefs):
            return _section(node, "believes", _lines(beliefs, reading))
        case s.Timing(bounds):
            return _section(node, "timing", _lines(bounds, reading))
        case s.Live(precautions):
            return _section(node, "live", _lines(precautions, reading))
        case s.Rule():
            return _named(node, "rule")
        case s.Definition():
            return _named(node, "behaviour")
        case s.BigActor(name, host):
            named = name or host
            title = name.text if name else "BigActor"
            return Part(title, "agent", node.span, named.span, f"hosted_at {host.text}")
        case s.Family(name, _, variable, among, host):
            each = f"for {variable.text} in {write(among)} hosted_at {host.text}"
            return Part(name.text, "agent", node.span, name.span, each)
        case _:
            return Part(reading.written(node), "setting", node.span, node.span)


def _section(node: s.Node, word: str, parts: Iterator[Part]) -> Part:
    begin = s.Span(node.span.start, node.span.start + len(word))
    return Part(word, "section", node.span, begin, "", tuple(parts))


def _entry(node: s.WorldEntry) -> Part:
    match node:
        case s.Entity(name, kind):
            return Part(name.text, "entity", node.span, name.span, kind.text)
        case s.ChannelDeclaration(name):
            return Part(name.text, "channel", node.span, name.span)
        case s.FromSource(file):
            return Part(file.value or "from", "file", node.span, file.span)


def _property(node: s.Property) -> Part:
    return Part(title_of(node), "property", node.span, node.span)


def title_of(node: s.Property) -> str:
    """Return the name of a property in reports."""
    if isinstance(node, s.StandardProperty):
        return node.name
    return node.label.value if node.label is not None else "progress"


def _named(node: s.Kind | s.Rule | s.Definition, sort: str) -> Part:
    return Part(node.name.text, sort, node.span, node.name.span)


def _lines(nodes: Iterable[s.Node], reading: Reading) -> Iterator[Part]:
    return (Part(reading.written(node), "clause", node.span, node.span) for node in nodes)
