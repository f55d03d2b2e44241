"""Parse a mission's text to its syntax tree, or to its mistakes."""

from __future__ import annotations

from itertools import islice
from typing import Final

from lark import UnexpectedInput

from specs.building import Mistake, rule_mistake
from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source
from specs.grammar import start
from specs.preprocessing import Prepared, decode, prepare
from specs.syntax import Mission, Node, RuleBody, Span, parts, walk
from specs.syntax_errors import explain_syntax_error

MAX_DEPTH: Final = 200
MAX_REPORTED: Final = 50  # mistakes in rule bodies


def parse(source: Source) -> Mission:
    """Return the syntax tree of a mission; raises MissionError.

    Linear in the text and free of recursion; the tree is at most 200 deep. A syntax error is reported alone, with
    no search for others; mistakes in the bodies of rules are reported together.
    """
    mission = build(prepare(source), source)
    bodies = (node for node in walk(mission) if isinstance(node, RuleBody) and node.term is None)
    mistakes = [mistake for body in islice(bodies, MAX_REPORTED) if (mistake := rule_mistake(body))]
    if mistakes:
        raise MissionError(source, mistakes)
    return mission


def parse_bytes(name: str, data: bytes) -> tuple[Source, Mission]:
    """Return a file's source and its syntax tree; raises MissionError."""
    source = decode(name, data)
    return source, parse(source)


def build(prepared: Prepared, source: Source) -> Mission:
    """Return the tree of a prepared text, the bodies of its rules not looked at; raises MissionError."""
    run = start(prepared.text)
    try:
        read = run.exhaust_lexer()
        mission = run.feed_eof(read[-1] if read else None)
    except Mistake as mistake:
        raise MissionError(source, [mistake.diagnostic]) from None
    except UnexpectedInput as found:
        raise MissionError(source, [explain_syntax_error(found, run, prepared)]) from None
    deepest = _too_deep(mission)
    if deepest:
        message = f"nested more than {MAX_DEPTH} deep"
        hint = "define behaviours with def and name values with let"
        raise MissionError(source, [Diagnostic(Code.NESTED_TOO_DEEPLY, deepest, message, hint)])
    return mission


def _too_deep(mission: Mission) -> Span | None:
    layer: list[Node] = [mission]
    for _ in range(MAX_DEPTH):
        layer = [part for node in layer for part in parts(node)]
        if not layer:
            return None
    return min(node.span for node in layer)
