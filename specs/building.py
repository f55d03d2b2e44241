"""Functions for all builders of the syntax tree, which take apart the children of a grammar rule.

lark gives each rule all its children, tokens included, and None for each missing optional part. So a child's index
is its position in the grammar.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, TypeVar

from lark import Token

from bigraphs.errors import NotationError
from bigraphs.notation.paper import parse_rule
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.preprocessing import MAX_WORD
from specs.syntax import Member, Name, Node, RuleBody, Span, TextLiteral

MOST: Final = 1_000_000_000  # whole numbers are smaller than this
_ESCAPES: Final = {'"': '"', "\\": "\\", "n": "\n", "t": "\t"}
_NAMES: Final = frozenset({"NAME", "CHANNEL", "DROPPING"})

ANGLES: Final = "write 37°08'49\"N, 37°8.82'N or 37.147"
"""The ways to write an angle, for hints."""

SIXTY: Final = 60
_MARKS: Final = {"º": "°", "′": "'", "’": "'", "″": '"', "”": '"'}
_ANGLE_PART: Final = re.compile(r"([0-9.]+)([°'\"])")
_DECIMAL: Final = re.compile(r"[0-9]{1,6}(?:\.[0-9]{1,20})?")

Child: TypeAlias = Any  # a token, a node, a RuleResult or None, by the grammar rule
Children: TypeAlias = Sequence[Child]
N = TypeVar("N", bound=Node)


class BuildingMistake(Exception):
    """A mistake found while building; the parser adds the source."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic)


@dataclass(frozen=True, slots=True)
class RuleResult:
    """The result of a grammar rule that is no node: a block's statements, a number."""

    span: Span
    value: Any
    word: str = ""


def span_of(child: Child) -> Span:
    """Return the span of a child."""
    if isinstance(child, Token):
        return Span(int(child.start_pos or 0), int(child.end_pos or 0))
    span: Span = child.span
    return span


def cover(children: Children) -> Span:
    """Return the span from the first child that is not None to the last."""
    there = [child for child in children if child is not None]
    return span_of(there[0]).to(span_of(there[-1])) if there else Span(0, 0)


def nodes(children: Children) -> tuple[Any, ...]:
    """Return the nodes among the children."""
    return tuple(child for child in children if isinstance(child, Node))


def name(token: Token) -> Name:
    """Return a name; raises BuildingMistake for one over ten kilobytes."""
    span = span_of(token)
    if len(token) > MAX_WORD:
        raise BuildingMistake(
            Diagnostic(Code.WORD_TOO_LONG, span, f"a name of {len(token):,} characters", "shorten it")
        )
    return Name(str(token), span=span)


def names(children: Children) -> tuple[Name, ...]:
    """Return the names among the children."""
    return tuple(name(child) for child in children if isinstance(child, Token) and child.type in _NAMES)


def agent(child: Child) -> Name | Member:
    """Return a bigActor: a name, or a member of a family, which is already built."""
    return child if isinstance(child, Member) else name(child)


def optional(token: Token | None, make: Callable[[Token], N]) -> N | None:
    """Apply `make` to a token that may be missing."""
    return None if token is None else make(token)


def text(token: Token) -> TextLiteral:
    """Return a string with its escapes resolved; raises BuildingMistake for an unknown escape."""
    span, pieces = span_of(token), []
    inner = str(token)[1:-1]
    at = 0
    while (backslash := inner.find("\\", at)) >= 0:
        escaped = inner[backslash + 1]
        if escaped not in _ESCAPES:
            place = Span(span.start + 1 + backslash, span.start + 3 + backslash)
            hint = r"write \\ for a backslash; \n and \t are a line end and a tab"
            raise BuildingMistake(
                Diagnostic(Code.BAD_ESCAPE, place, f"'\\{escaped}' is no escape of strings", hint)
            )
        pieces += [inner[at:backslash], _ESCAPES[escaped]]
        at = backslash + 2
    return TextLiteral("".join([*pieces, inner[at:]]), span=span)


def whole(token: Token) -> int:
    """Return a whole number; raises BuildingMistake for any other number."""
    if token.isdecimal() and len(token) <= 10 and int(token) < MOST:
        return int(token)
    message = f"{_short(token)} is not a whole number below {MOST:,}"
    raise BuildingMistake(
        Diagnostic(
            Code.BAD_NUMBER, span_of(token), message, "decimal numbers stand in coordinates and lengths only"
        )
    )


def decimal(sign: Token | None, token: Token) -> float:
    """Return a finite number; raises BuildingMistake for one that is too large."""
    value = float(token)
    if not math.isfinite(value):
        raise BuildingMistake(
            Diagnostic(
                Code.BAD_NUMBER,
                span_of(token),
                f"{_short(token)} is too large a number",
                "write a finite one",
            )
        )
    return -value if sign and value else value


def degrees(token: Token) -> tuple[float, str]:
    """Return an angle in degrees from degrees, minutes and seconds, and its text; raises BuildingMistake."""
    text = "".join(_MARKS.get(mark, mark) for mark in str(token) if not mark.isspace()).replace("''", '"')
    parts = {mark: number for number, mark in _ANGLE_PART.findall(text)}
    if not all(map(_DECIMAL.fullmatch, parts.values())) or any(
        float(parts.get(mark, 0)) >= SIXTY for mark in "'\""
    ):
        message = f"'{_short(token)}' is no angle: minutes and seconds are numbers below {SIXTY}"
        raise BuildingMistake(Diagnostic(Code.BAD_COORDINATE, span_of(token), message, ANGLES))
    value = sum(float(parts.get(mark, 0)) / SIXTY**power for power, mark in enumerate("°'\""))
    return -value if text[-1] in "SW" else value, text


def check_hemispheres(latitude: RuleResult, longitude: RuleResult) -> None:
    """Raise BuildingMistake if a letter makes the first angle a longitude or the second a latitude."""
    if latitude.word[-1:] not in ("E", "W") and longitude.word[-1:] not in ("N", "S"):
        return
    found = latitude if latitude.word[-1:] in ("E", "W") else longitude
    which, place = ("longitude", "first") if found is latitude else ("latitude", "second")
    other = "latitude" if found is latitude else "longitude"
    message = f"{found.word} is a {which}, and the {other} stands {place}"
    hint = "write (latitude, longitude): exchange the two"
    raise BuildingMistake(Diagnostic(Code.BAD_COORDINATE, found.span, message, hint))


def once(clauses: Children, owner: Token) -> dict[str, RuleResult]:
    """Return the clauses by their first word; raises BuildingMistake for a repeated one."""
    found: dict[str, RuleResult] = {}
    for clause in clauses:
        if clause.word in found:
            message = f"'{_short(owner)}' has '{clause.word}' twice"
            hint = "write it once, behind its name; lists are separated by commas"
            raise BuildingMistake(Diagnostic(Code.REPEATED_CLAUSE, clause.span, message, hint))
        found[clause.word] = clause
    return found


def rule_body(token: Token) -> RuleBody:
    """Return a rule's body, still unparsed; raises BuildingMistake for one over ten kilobytes."""
    span = span_of(token)
    raw = str(token)[1:-1]
    if len(token) > MAX_WORD:
        raise BuildingMistake(
            Diagnostic(Code.WORD_TOO_LONG, span, f"a rule of {len(token):,} characters", "split it")
        )
    return RuleBody(" ".join(raw.split()), raw, span.start + 1, span=span)


def rule_mistake(body: RuleBody) -> Diagnostic | None:
    """Return the mistake in a rule's body, at its place in the mission; None for a correct one."""
    try:
        parse_rule(body.raw)
    except NotationError as error:
        start = min(body.raw_start + error.offset, body.span.end - 1)
        span = Span(start, max(start + 1, min(start + error.length, body.span.end)))
        arrow = body.raw.startswith("=>", error.offset)
        hint = error.hint or (
            "an arrow is written ->" if arrow else "write redex -> reactum: u[c] || b.$0 -> b.(u[c] | $0)"
        )
        return Diagnostic(Code.RULE_SYNTAX, span, error.message, hint)
    return None


def _short(token: str) -> str:
    return token if len(token) <= 40 else f"{token[:37]}..."
