"""The text in Markdown that an editor shows for a name or a construct."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from textwrap import dedent
from typing import Any, Final, TypeVar

from bigactors.lsp.edited_mission import Reading
from bigactors.lsp.name_resolution import Symbol
from physical.geometry_measures import area
from semantics import bigactor_rules, rules
from semantics.behaviours.commands import COMMANDS
from semantics.properties.kinds import ABOUT, PropertyKind
from specs import explain
from specs import syntax as s
from specs.construct_text import write
from specs.elaboration.geometry import elaborate_geometry
from specs.elaboration.mission_mistakes import Findings
from specs.standard_signature import STANDARD

N = TypeVar("N", bound=s.Node)

SERVED_BY: Final[Mapping[type[s.Node], tuple[Callable[..., Any], ...]]] = {
    s.Observe: (rules.req_obs, rules.sense),
    s.Control: (rules.req_ctr, rules.actuate, rules.command, rules.commit),
    s.Command: (rules.req_ctr, rules.actuate),
    s.ApplyRule: (rules.req_ctr, rules.actuate),
    s.React: (rules.rcv_obs, bigactor_rules.rcv_msg),
    s.Send: (bigactor_rules.req_snd, bigactor_rules.snd),
    s.Migrate: (bigactor_rules.req_mgr, bigactor_rules.migrate),
    s.Spawn: (bigactor_rules.spawn,),
    s.Says: (bigactor_rules.say,),
    s.Misses: (rules.sense,),
    **dict.fromkeys(
        (s.Display, s.Let, s.Assign, s.If, s.Loop, s.While, s.For, s.Match, s.Call), (rules.fun,)
    ),
    **dict.fromkeys((s.DriftsAmong, s.DriftsWithin, s.Drops, s.Leaves, s.Appears, s.Vanishes), (rules.env,)),
}
"""The inference rules by which each construct takes its steps."""


@dataclass(frozen=True, slots=True)
class Hover:
    """A text in Markdown, and the span that it is about."""

    span: s.Span
    text: str


def hover(reading: Reading, offset: int) -> Hover | None:
    """Return the description of the name or construct at an offset."""
    found = reading.occurrences.at(offset)
    if found is not None:
        span, parts = found.span, [_symbol(reading, found.symbol)]
    else:
        node = _innermost(reading.mission, offset)
        if node is None or reading.text[offset : offset + 1].isspace():
            return _explained(reading, offset)
        span, parts = node.span, list(_construct(node, reading))
    mistakes = _explained(reading, offset)
    if mistakes is not None:
        parts.append(mistakes.text)
    return Hover(span, "\n\n---\n\n".join(parts)) if parts else None


def _explained(reading: Reading, offset: int) -> Hover | None:
    """Return the explanations of the mistakes at an offset, as of `bigactors explain`."""
    found = [
        each
        for each in (*reading.diagnosis.mistakes, *reading.diagnosis.warnings)
        if each.span.start <= offset < max(each.span.end, each.span.start + 1)
    ]
    if not found:
        return None
    return Hover(
        found[0].span, "\n\n".join(explain(code) for code in dict.fromkeys(each.code for each in found))
    )


def _innermost(mission: s.Mission, offset: int) -> s.Node | None:
    """Return the smallest construct around an offset that is not the mission."""
    around = (
        node for node in s.walk(mission) if node.span.start <= offset < node.span.end and node is not mission
    )
    return min(around, key=lambda node: node.span.end - node.span.start, default=None)


# --- constructs


def _construct(node: s.Node, reading: Reading) -> Iterator[str]:
    if isinstance(node, s.StandardProperty):
        yield f"`{node.name}`: {ABOUT[PropertyKind(node.name)].says}"
    elif isinstance(node, s.Command):
        command = COMMANDS[node.name]
        yield f"`{command.form}`: {inspect.getdoc(command.sides) or ''}"
    else:
        shown, _, _ = (inspect.getdoc(type(node)) or "").partition("\n\nAttributes:")
        yield shown
    if isinstance(node, s.Placement | s.Box | s.Circle | s.Polygon | s.Coordinate):
        yield from _size(node, reading)
    for rule in SERVED_BY.get(type(node), ()):
        summary, _, printed = dedent(inspect.getdoc(rule) or "").partition("\n\n")
        yield f"**{rule.__name__}**: {summary}\n\n```text\n{printed.strip()}\n```"


def _size(node: s.Node, reading: Reading) -> Iterator[str]:
    geometry = node.geometry if isinstance(node, s.Placement) else node
    if isinstance(geometry, s.Box | s.Circle | s.Polygon):
        shape = elaborate_geometry(geometry, Findings(reading.source))
        if shape is not None:
            yield f"area: {area_text(area(shape))}"


def area_text(square_metres: float) -> str:
    """Return an area with its unit.

    >>> area_text(1538.2), area_text(2_540_000.0), area_text(262_800_000.0)
    ('1,538 m²', '2.54 km²', '263 km²')
    """
    if square_metres < 100_000:
        return f"{square_metres:,.0f} m²"
    digits = max(0, 2 - len(str(int(square_metres / 1e6))) + 1)
    return f"{square_metres / 1e6:,.{digits}f} km²"


# --- names


def _symbol(reading: Reading, symbol: Symbol) -> str:
    word = "bigActor" if symbol.sort == "agent" else symbol.sort
    return "\n\n".join([f"**{word}** `{symbol.name}`", *_SAID[symbol.sort](reading, symbol)])


def _named(reading: Reading, sort: type[N], symbol: Symbol) -> Iterator[N]:
    for node in s.walk(reading.mission):
        if isinstance(node, sort) and getattr(node, "name", None) == s.Name(symbol.name):
            yield node


def _entity(reading: Reading, symbol: Symbol) -> Iterator[str]:
    for entity in _named(reading, s.Entity, symbol):
        yield _code(reading.written(entity))
        if entity.placement is not None:
            yield from _size(entity.placement, reading)


def _kind(reading: Reading, symbol: Symbol) -> Iterator[str]:
    for kind in _named(reading, s.Kind, symbol):
        yield _code(reading.written(kind))
    if any(section.standard for section in reading.mission.each(s.Signature)):
        yield from (
            _code(line.strip()) for line in STANDARD.splitlines() if f"kind {symbol.name} " in f"{line} "
        )
    entities = (node for node in s.walk(reading.mission) if isinstance(node, s.Entity))
    members = [node.name.text for node in entities if node.kind.text == symbol.name]
    if members:
        yield f"{len(members)} of it: {', '.join(members[:10])}{', ...' if len(members) > 10 else ''}"


def _channel(reading: Reading, symbol: Symbol) -> Iterator[str]:
    members = [
        node.name.text
        for node in s.walk(reading.mission)
        if isinstance(node, s.Entity) and symbol.name in {channel.text for channel in node.channels}
    ]
    yield f"links {', '.join(members)}" if members else "links nothing at first"


def _agent(reading: Reading, symbol: Symbol) -> Iterator[str]:
    for actor in _named(reading, s.BigActor, symbol):
        yield _code(f"BigActor {symbol.name} hosted_at {actor.host.text}")
    for family in _named(reading, s.Family, symbol):
        each = f"{symbol.name}[{family.index.text}] for {family.variable.text} in {write(family.range)}"
        yield _code(f"BigActor {each} hosted_at {family.host.text}")
    for spawned in _named(reading, s.Spawn, symbol):
        yield _code(reading.written(spawned))


def _behaviour(reading: Reading, symbol: Symbol) -> Iterator[str]:
    for definition in _named(reading, s.Definition, symbol):
        yield _code(f"def {symbol.name}({', '.join(parameter.text for parameter in definition.parameters)})")


def _rule(reading: Reading, symbol: Symbol) -> Iterator[str]:
    for rule in _named(reading, s.Rule, symbol):
        yield _code(reading.text[rule.span.start : rule.span.end])


def _variable(reading: Reading, symbol: Symbol) -> Iterator[str]:
    lines = sorted(
        {reading.source.line(each.span.start) for each in reading.occurrences.of(symbol) if each.declares}
    )
    yield f"bound in line {', '.join(map(str, lines))}"


def _code(text: str) -> str:
    return f"```mission\n{text}\n```"


_SAID: Final[Mapping[str, Callable[[Reading, Symbol], Iterator[str]]]] = {
    "entity": _entity,
    "agent": _agent,
    "kind": _kind,
    "channel": _channel,
    "rule": _rule,
    "behaviour": _behaviour,
    "variable": _variable,
}
