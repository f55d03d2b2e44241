"""Parse a mission's text to its syntax tree, or to its mistakes."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from typing import Final

from specs.building import rule_mistake
from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source
from specs.preprocessing import Prepared, decode, prepare
from specs.recovery import Recovered, recover
from specs.syntax import Mission, Node, RuleBody, Span, parts, walk

MAX_DEPTH: Final = 200
MAX_REPORTED: Final = 50  # the most mistakes reported in rule bodies


def parse(source: Source) -> Mission:
    """Return the syntax tree of a mission; raises MissionError with all mistakes found.

    It takes linear time without recursion; the tree is at most 200 deep.
    """
    return _sound(read(source), source)


def parse_bytes(name: str, data: bytes) -> tuple[Source, Mission]:
    """Return a file's source and its syntax tree; raises MissionError."""
    source = decode(name, data)
    return source, parse(source)


def read(source: Source) -> Recovered:
    """Return the parts of a mission that parse, and its mistakes; raises MissionError beyond the limits."""
    found = _bounded(recover(prepare(source)), source)
    bodies = (node for node in walk(found.mission) if isinstance(node, RuleBody) and node.term is None)
    in_bodies = [mistake for body in islice(bodies, MAX_REPORTED) if (mistake := rule_mistake(body))]
    return replace(found, mistakes=(*found.mistakes, *in_bodies))


def build(prepared: Prepared, source: Source) -> Mission:
    """Return the tree of a prepared text with unchecked rule bodies; raises MissionError."""
    return _sound(_bounded(recover(prepared), source), source)


def _sound(found: Recovered, source: Source) -> Mission:
    if found.mistakes:
        raise MissionError(source, found.mistakes)
    return found.mission


def _bounded(found: Recovered, source: Source) -> Recovered:
    deepest = _too_deep(found.mission)
    if deepest:
        message = f"nested more than {MAX_DEPTH} deep"
        hint = "define behaviours with def and name values with let"
        raise MissionError(source, [Diagnostic(Code.NESTED_TOO_DEEPLY, deepest, message, hint)])
    return found


def _too_deep(mission: Mission) -> Span | None:
    layer: list[Node] = [mission]
    for _ in range(MAX_DEPTH):
        layer = [part for node in layer for part in parts(node)]
        if not layer:
            return None
    return min(node.span for node in layer)
