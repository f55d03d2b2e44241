"""Common syntax mistakes, recognised by the word found and the words expected.

lark's `match_examples` compares the state of the parser with those of a table of bad snippets, and misses the
same mistake one state further on (`if x = y`, `if f(x) = y`); asking what could have stood there doesn't. The
table of bad snippets is in the tests.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable
from typing import Final

from semantics.behaviours.commands import COMMAND_WORDS, COMMANDS, VIA, WAY
from semantics.behaviours.statements import UNITS
from specs.building import ANGLES
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.grammar import QUERY_WORDS, RESERVED, SECTIONS, STATEMENTS
from specs.parse_error import Situation, Word, is_keyword, line_of, open_brackets
from specs.syntax.nodes import Span

_GEOMETRIES: Final = frozenset({"point", "box", "polygon", "circle"})
_QUOTES: Final = "'`\u2018\u2019\u201c\u201d\u201e\u00ab\u00bb"
_ANGLE_MARKS: Final = tuple("°º'′’\"″”")
_COMPARISONS: Final = frozenset({"==", "!=", "<", "<=", ">", ">=", "in", "not"})
_UNITS: Final = (
    (("m", "km"), "write 400 m or 1.5 km"),
    (tuple(reversed(UNITS)), "write 90 s, 10 min or 1.5 h"),
)
_SYMBOL: Final = re.compile(r"[\w\s\"()\[\]{},;:.=<>!&|+\-]")
_CLOSE: Final = 0.7

FAMILY: Final = "a family is written BigActor patrol[i] for u in UAV hosted_at u with_behavior { ... }"


LINE_NUMBERS: Final = "printed line numbers must count on from the line of BigActor"
"""The hint at a line number that does not: where one is wrong, the others are too."""


def misplaced_header(at: Situation) -> Diagnostic | None:
    """`mission` anywhere but at the beginning."""
    if at.found.text == "mission" and "mission" not in at.accepted and "NAME" not in at.sorts:
        return at.mistake(
            Code.REPEATED_HEADER, "'mission' stands once, before all declarations", "remove it here"
        )
    return None


def unknown_character(at: Situation) -> Diagnostic | None:
    """A character without a meaning."""
    if at.found.text and not _SYMBOL.match(at.found.text):
        quote = at.found.text in _QUOTES
        hint = 'strings take straight double quotes: "handover"' if quote else "remove it"
        return at.mistake(Code.UNKNOWN_CHARACTER, f"{at.found.shown} has no meaning here", hint)
    return None


def bad_angle(at: Situation) -> Diagnostic | None:
    """`(37°08'49", 8°35')`, `(37 08 49, 8 35 0)`, `(37,147, -8,58)`."""
    behind = at.before.is_number and at.accepted in ({","}, {")"})
    if behind and at.found.text == "," and at.accepted == {")"}:
        hint = "a decimal number has a point, 37.147; a height stands behind: altitude 90 m"
        return at.mistake(Code.BAD_COORDINATE, "a coordinate has two numbers, and here is a third", hint)
    if behind and at.found.text[:1] in _ANGLE_MARKS:
        message = "an angle in degrees, minutes and seconds ends with its letter: N, S, E or W"
        return at.mistake(Code.BAD_COORDINATE, message, ANGLES)
    if behind and at.found.is_number:
        hint = f"separate latitude and longitude; degrees and minutes have their marks: {ANGLES}"
        return at.mistake(Code.MISSING_COMMA, f"expected ',' before {at.found.shown}", hint)
    if behind and at.found.text in tuple(":NSEW"):
        message = (
            f"{at.found.shown} is not part of a number; degrees and minutes are written with their marks"
        )
        return at.mistake(Code.BAD_COORDINATE, message, ANGLES)
    if "DEGREES" in at.sorts and at.found.text[:1] in "NSEW" and at.found.text[1:2].isdecimal():
        return at.mistake(Code.BAD_COORDINATE, "the letter of an angle stands behind it", ANGLES)
    return None


def single_equals(at: Situation) -> Diagnostic | None:
    """`if x = y`."""
    if at.found.text == "=" and (at.in_expression or "==" in at.accepted):
        hint = "write == to compare; an assignment is a statement of its own"
        return at.mistake(Code.SINGLE_EQUALS, "'=' does not compare", hint)
    return None


def unclosed_section(at: Situation) -> Diagnostic | None:
    """A section that begins within another, or within a behaviour."""
    line_start = at.prepared.text.rfind("\n", 0, at.found.span.start) + 1
    first = not at.prepared.text[line_start : at.found.span.start].strip()
    if at.found.text not in SECTIONS or at.at_declaration or not first:
        return None
    waiting = open_brackets(at.prepared.text, at.found.span.start)
    if not waiting:
        return None
    opening = waiting[-1]
    message = f"'{at.prepared.text[opening]}' is not closed before {at.found.shown}"
    hint = f"close it before line {line_of(at.prepared.text, at.found.span.start)}"
    return Diagnostic(Code.UNCLOSED_BRACKET, Span(opening, opening + 1), message, hint)


def misspelt_word(at: Situation) -> Diagnostic | None:
    """`enviroment { ... }`: nearly one of the words that could have stood here."""
    return _misspelt(at.found, at.accepted)


def misspelt_word_before(at: Situation) -> Diagnostic | None:
    """`raect { ... }`: a name could stand there, but what follows fits no name."""
    if at.accepted == {"=", "("}:
        return _misspelt(at.before, STATEMENTS | {"case", "after"})
    if at.accepted == {")"} and at.found.text == "(":
        return _misspelt(at.before, QUERY_WORDS)
    if at.accepted == {"("}:
        return _misspelt(at.before, COMMAND_WORDS)
    if at.accepted == {":"}:
        return _misspelt(at.before, {"channel", "from"})
    if "drifts" in at.accepted:
        return _misspelt(at.before, {"someone", "says"})
    return None


def misplaced_statement(at: Situation) -> Diagnostic | None:
    """A statement in the middle of nowhere, or of another section."""
    control = at.found.text == "(" and at.before.text == "control" and at.accepted == frozenset()
    section = at.at_declaration or bool(at.accepted & {"channel", "says", "invariant", "kind"})
    statement = at.found.text in STATEMENTS and section and not at.in_expression
    if not (control or statement):
        return None
    word = at.before if control else at.found
    hint = "write it into BigActor ... with_behavior { ... } or def name() = { ... }"
    return Diagnostic(Code.MISPLACED_STATEMENT, word.span, f"{word.shown} stands outside a behaviour", hint)


def missing_destination(at: Situation) -> Diagnostic | None:
    """`control(MOVE uav0)`."""
    for word in sorted(COMMAND_WORDS & at.accepted - COMMANDS.keys() - {VIA}):
        forms = [command.form for command in COMMANDS.values() if word in command.words]
        message = f"expected '{word}', found {at.found.shown}"
        return at.mistake(Code.MISSING_DESTINATION, message, f"control actions are {', '.join(forms)}")
    if at.before.text in COMMAND_WORDS and at.at_expression and at.found.text in (")", VIA):
        return at.mistake(Code.MISSING_DESTINATION, f"'{at.before.text}' needs a name behind it", "say which")
    return None


def misplaced_via(at: Situation) -> Diagnostic | None:
    """`control(CONNECT_HOST_TO gcs0 VIA gate0)`, or VIA twice."""
    if at.found.text != VIA:
        return None
    forms = [command.write(command.operands, WAY) for command in COMMANDS.values() if command.travels]
    hint = f"write {', or '.join(forms)}"
    return at.mistake(Code.MISPLACED_VIA, "'VIA' stands where nothing travels, or has its way already", hint)


def missing_arrow(at: Situation) -> Diagnostic | None:
    """`case obs: Observation display(obs)`."""
    if "=>" in at.accepted:
        waits = at.before.text in UNITS
        hint = "write after 10 min => statements" if waits else "write case pattern => statements"
        return at.mistake(Code.MISSING_ARROW, f"expected '=>' before {at.found.shown}", hint)
    return None


def chained_comparison(at: Situation) -> Diagnostic | None:
    """`a < b < c`."""
    if at.found.text in _COMPARISONS and at.in_expression:
        return at.mistake(
            Code.CHAINED_COMPARISON, "comparisons do not chain", "join two comparisons with and"
        )
    return None


def missing_unit(at: Situation) -> Diagnostic | None:
    """`radius 400`, or `after 10`."""
    for units, hint in _UNITS:
        if set(units) <= at.accepted:
            message = f"expected {', '.join(map(repr, units[:-1]))} or '{units[-1]}', found {at.found.shown}"
            return at.mistake(Code.MISSING_UNIT, message, hint)
    return None


def reserved_word(at: Situation) -> Diagnostic | None:
    """`let if = 3`."""
    if (
        at.found.text in RESERVED
        and at.sorts & {"NAME", "CHANNEL"}
        and not at.at_statement
        and not at.at_expression
    ):
        message = f"{at.found.shown} is a word of the language and cannot be a name"
        return at.mistake(Code.RESERVED_WORD, message, "choose another name")
    return None


def missing_host(at: Situation) -> Diagnostic | None:
    """`BigActor a { ... }`."""
    if at.accepted in ({"hosted_at"}, {"hosted_at", "["}):
        message = f"expected 'hosted_at' and a host, found {at.found.shown}"
        one = "write BigActor name hosted_at host with_behavior { ... }"
        return at.mistake(Code.MISSING_HOST, message, FAMILY if at.found.text in ("for", "[") else one)
    return None


def missing_comma(at: Situation) -> Diagnostic | None:
    """`visit(a b)` or `(37.0 -8.5)`."""
    starts = at.found.is_name or at.found.is_number or at.found.text[:1] in {'"', "(", "-"}
    if "," in at.accepted and starts and ("]" in at.accepted or ")" in at.accepted or at.accepted == {","}):
        return at.mistake(
            Code.MISSING_COMMA, f"expected ',' before {at.found.shown}", "separate items by commas"
        )
    return None


def missing_brace(at: Situation) -> Diagnostic | None:
    """`loop observe(HOST)`."""
    opens = "{" in at.accepted and not at.at_expression
    if opens or ("RULE_BODY" in at.sorts and at.before.text != "("):
        return at.mistake(
            Code.MISSING_BRACE, f"expected '{{' before {at.found.shown}", "open the block with {"
        )
    return None


def missing_equals(at: Situation) -> Diagnostic | None:
    """`def visit(place) { ... }`, or `uav0: UAV point (37.0, -8.5)`."""
    if at.accepted == {"="} or ("=" in at.accepted and at.found.text in _GEOMETRIES):
        return at.mistake(Code.MISSING_EQUALS, f"expected '=' before {at.found.shown}", "put = before it")
    return None


def missing_kind(at: Situation) -> Diagnostic | None:
    """`uav0 = point (37.0, -8.5)`."""
    if at.accepted == {":"} and at.before.text in _GEOMETRIES:
        message = f"expected '=' before {at.before.shown}"
        return Diagnostic(Code.MISSING_EQUALS, at.before.span, message, "write name: Kind = where it is")
    if at.accepted == {":"} and at.before.is_name:
        message = f"expected ':' and a kind behind {at.before.shown}, found {at.found.shown}"
        return at.mistake(Code.MISSING_KIND, message, "write name: Kind")
    return None


def bad_number(at: Situation) -> Diagnostic | None:
    """`point (NaN, 3)`, `37.`, `.5`."""
    if at.found.text == "." and (at.before.is_number or "NUMBER" in at.sorts):
        return at.mistake(
            Code.BAD_NUMBER, "a number has digits on both sides of its '.'", "write 37.0 or 0.5"
        )
    if "NUMBER" in at.sorts and "STRING" not in at.sorts and at.found.is_name:
        return at.mistake(
            Code.BAD_NUMBER, f"expected a number, found {at.found.shown}", "write one such as 37.04"
        )
    return None


def bad_coordinate(at: Situation) -> Diagnostic | None:
    """`point 37.0, -8.5`, or `point (37.0)`."""
    opening = at.accepted == {"("} and (at.before.text in _GEOMETRIES or at.before.text == ")")
    if opening or (at.accepted == {","} and at.found.text == ")"):
        message = (
            f"expected a coordinate, found {at.found.shown}" if opening else "a coordinate has two numbers"
        )
        return at.mistake(Code.BAD_COORDINATE, message, "write (latitude, longitude) in degrees")
    return None


def loose_number(at: Situation) -> Diagnostic | None:
    """A line number that does not count on from the line before."""
    if at.at_statement and at.found.is_number:
        return at.mistake(Code.UNEXPECTED, f"expected a statement, found {at.found.shown}", LINE_NUMBERS)
    return None


MISTAKES: Final[tuple[Callable[[Situation], Diagnostic | None], ...]] = (
    bad_angle,
    unknown_character,
    unclosed_section,
    misplaced_header,
    single_equals,
    bad_number,
    misspelt_word,
    misspelt_word_before,
    misplaced_statement,
    missing_destination,
    misplaced_via,
    missing_arrow,
    chained_comparison,
    missing_unit,
    missing_host,
    bad_coordinate,
    missing_comma,
    missing_brace,
    missing_equals,
    missing_kind,
    reserved_word,
    loose_number,
)


def _misspelt(word: Word, candidates: Iterable[str]) -> Diagnostic | None:
    if not word.is_name or is_keyword(word):
        return None
    possible = sorted(
        candidate for candidate in candidates if len(candidate) > 1 and candidate.isidentifier()
    )
    nearest = difflib.get_close_matches(word.text[:40], possible, n=1, cutoff=_CLOSE)
    if not nearest:
        nearest = [candidate for candidate in possible if candidate.lower() == word.text.lower()][:1]
    if not nearest:
        return None
    message = f"{word.shown} is not a word of the language here"
    return Diagnostic(Code.MISSPELT_KEYWORD, word.span, message, f"did you mean '{nearest[0]}'?")
