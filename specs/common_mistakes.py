"""Common syntax mistakes, recognised by the word found and the words expected.

lark's `match_examples` compares the parser's state with the states of a table of bad snippets. It misses the same
mistake one state further on (`if x = y`, `if f(x) = y`). The words expected there identify both. The table of bad
snippets is in the tests.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Final

from bigraphs.notation.spelling import did_you_mean, nearest
from semantics.behaviours.commands import COMMAND_WORDS, COMMANDS, VIA, WAY
from semantics.behaviours.durations import UNITS
from semantics.behaviours.observations import QueryOperator
from specs.autopilot_words import called_with_a_unit, ordered
from specs.building import ANGLES
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.distance_mistakes import DISTANCE_MISTAKES
from specs.foreign_words import ASKED, DONE, foreign_form, foreign_operator, foreign_word, operator_first
from specs.grammar import (
    PROPERTY_WORDS,
    QUERY_WORDS,
    RESERVED,
    SECTIONS,
    STATEMENTS,
    first_words,
    grammar_text,
)
from specs.parse_error import (
    LINE_NUMBERS,
    ParsePoint,
    Word,
    is_keyword,
    line_of,
    open_brackets,
    word_at,
    word_before,
)
from specs.syntax.nodes import Span
from specs.syntax.timing import METRES_PER_SECOND
from specs.timing_mistakes import TIMING_MISTAKES

_GEOMETRIES: Final = frozenset({"point", "box", "polygon", "circle"})
_QUOTES: Final = "'`\u2018\u2019\u201c\u201d\u201e\u00ab\u00bb"
_ANGLE_MARKS: Final = tuple("°º'′’\"″”")
_COMPARISONS: Final = frozenset({"==", "!=", "<", "<=", ">", ">=", "in", "not"})
_UNITS: Final = (("m", "km"), tuple(reversed(UNITS)), tuple(METRES_PER_SECOND))
_HEADER: Final = re.compile(r"^\s*mission\b", re.MULTILINE)
_DROP: Final = re.compile(r"(\w+(?:[:.\-]\w+)*)\s+(drop\w*|loses?|lost|fails?)(?!\w)")
_CHANNELS: Final = re.compile(r"\blinked\s+\w[\w:.\-]*(?:\s*,\s*\w[\w:.\-]*)*\s+\Z")
"""The channels of an entity, up to a word without a comma before it."""
_LINKS: Final = frozenset({"drops"})
_CALLED: Final = frozenset({"observe", "control", "migrate", "display", "spawn", *QueryOperator})
_THROUGH: Final = re.compile(r"\b((?:for|choose)\s+\w+)\s+in\s+([^{}\[\]]*)")
_SHORT: Final = 5
"""The length up to which a word resembles others by chance."""

_ONLY_FIRST: Final = frozenset({"always", "eventually", "race", "races", "deadlock", "deadlocks"})
_DECIMAL: Final = re.compile(r"[(,]\s*-?(\d+(?:\.\d+)?)\s*\Z")
_TITLE: Final = re.compile(r"[^\n:\"{}]*\w(?=\s*:)")
_FALLBACKS: Final = frozenset({"hold", "return", "continue"})
_QUANTIFIERS: Final = frozenset({"forall", "exists"})
_NAMES_AFTER: Final = re.compile(r"\b(\w+)\s+((?:\w+\s*,\s*)*\w+)\s*\Z")
_MOST_NAMES: Final = 200
"""The number of characters searched for the names of a quantifier."""
_GUARDS: Final = frozenset({"and", "or", "&&", "||", "when", "where", "with"})
_WHERE: Final = re.compile(r"\b(?:in|within|inside|at|on|to|of)\s+([^\W\d]\w*)")
_SYMBOL: Final = re.compile(r"[\w\s\"()\[\]{},;:.=<>!&|+\-]")

FAMILY: Final = "a family is written BigActor patrol[i] for u in UAV hosted_at u with_behavior { ... }"


def flown(at: ParsePoint) -> Diagnostic | None:
    """`control(LAND)`, `wait(10 min)`, `takeoff(50 m)`."""
    return ordered(at) or called_with_a_unit(at, DONE)


def misplaced_header(at: ParsePoint) -> Diagnostic | None:
    """`mission` anywhere but at the beginning."""
    if at.found.text == "mission" and "mission" not in at.accepted and "NAME" not in at.sorts:
        again = len(_HEADER.findall(at.prepared.text)) > 1
        hint = "leave it out here" if again else "move it to the beginning"
        return at.mistake(Code.REPEATED_HEADER, "'mission' stands once, before all declarations", hint)
    return None


def unknown_character(at: ParsePoint) -> Diagnostic | None:
    """A character without a meaning."""
    if at.found.text and not _SYMBOL.match(at.found.text):
        quote = at.found.text in _QUOTES
        hint = 'strings take straight double quotes: "handover"' if quote else "leave it out"
        return at.mistake(Code.UNKNOWN_CHARACTER, f"{at.found.shown} has no meaning here", hint)
    return None


def bad_angle(at: ParsePoint) -> Diagnostic | None:
    """`(37°08'49", 8°35')`, `(37 08 49, 8 35 0)`, `(37,147, -8,58)`."""
    behind = at.before.is_number and at.accepted in ({","}, {")"})
    if behind and at.found.text == "," and at.accepted == {")"}:
        if at.following.text == ")":
            return None
        hint = "a decimal number has a point, 37.147; each corner has brackets; a height is written altitude 90 m"
        return at.mistake(Code.BAD_COORDINATE, "a coordinate has two numbers, and here is a third", hint)
    if behind and at.found.text[:1] in _ANGLE_MARKS:
        message = "an angle in degrees, minutes and seconds ends with its letter: N, S, E or W"
        return at.mistake(Code.BAD_COORDINATE, message, ANGLES)
    if behind and at.found.is_number:
        hint = f"separate latitude and longitude; degrees and minutes have their marks: {ANGLES}"
        return at.mistake(Code.MISSING_COMMA, f"expected ',' before {at.found.shown}", hint)
    if (
        behind
        and at.found.text in tuple("NSEW")
        and (number := _DECIMAL.search(at.prepared.text, 0, at.found.span.start))
    ):
        sign = "-" if at.found.text in "SW" else ""
        hint = f"write {sign}{number[1]}: south and west are negative"
        return at.mistake(Code.BAD_COORDINATE, f"a decimal number has no letter {at.found.shown}", hint)
    if behind and at.found.text in tuple(":NSEW"):
        message = (
            f"{at.found.shown} is not part of a number; degrees and minutes are written with their marks"
        )
        return at.mistake(Code.BAD_COORDINATE, message, ANGLES)
    if "DEGREES" in at.sorts and at.found.text[:1] in "NSEW" and at.found.text[1:2].isdecimal():
        return at.mistake(Code.BAD_COORDINATE, "the letter of an angle stands behind it", ANGLES)
    return None


def single_equals(at: ParsePoint) -> Diagnostic | None:
    """`if x = y`."""
    if at.found.text == "=" and "=>" in at.accepted and at.following.text in STATEMENTS:
        return missing_arrow(at)
    if at.found.text == "=" and (at.in_expression or "==" in at.accepted):
        hint = "write == to compare; an assignment is a statement of its own"
        return at.mistake(Code.SINGLE_EQUALS, "'=' does not compare", hint)
    return None


def unclosed_section(at: ParsePoint) -> Diagnostic | None:
    """A section that begins within another, or within a behaviour."""
    if at.found.text not in SECTIONS or at.at_declaration or not at.is_first:
        return None
    waiting = open_brackets(at.prepared.text, at.found.span.start)
    if not waiting:
        return None
    opening = waiting[-1]
    message = f"'{at.prepared.text[opening]}' is not closed before {at.found.shown}"
    hint = f"close it before line {line_of(at.prepared.text, at.found.span.start)}"
    return Diagnostic(Code.UNCLOSED_BRACKET, Span(opening, opening + 1), message, hint)


def begins_property(word: str, *, first: bool) -> bool:
    """Return whether a word is a property's kind, or meant as one; the `first` word of a line may begin a formula."""
    meant = word in PROPERTY_WORDS or bool(len(word) > _SHORT and nearest(word, PROPERTY_WORDS))
    return meant or (word in ASKED and (first or word not in _ONLY_FIRST))


def misspelt_word(at: ParsePoint) -> Diagnostic | None:
    """`enviroment { ... }`: a misspelling of a word expected here."""
    return _misspelt(at.found, at.accepted | (_LINKS if _in_environment(at) else frozenset()))


def _in_environment(at: ParsePoint) -> bool:
    return {"appears", "arrives"} <= at.accepted


def misspelt_word_before(at: ParsePoint) -> Diagnostic | None:
    """`raect { ... }`: a name is possible there, but the next word fits no name."""
    if at.accepted == {"=", "("}:
        return _misspelt(at.before, STATEMENTS | {"case", "after"})
    if at.accepted == {")"} and at.found.text == "(":
        return _misspelt(at.before, QUERY_WORDS) or _unknown_query(at)
    if at.accepted == {"("}:
        return _misspelt(at.before, COMMAND_WORDS) or _unknown_command(at)
    if at.accepted == {":"}:
        return _misspelt(at.before, {"channel", "from", "linked", "carried", "absent", "altitude"})
    if _in_environment(at):
        return _misspelt(at.before, {"someone", "says"}) or _channel(at)
    if {"directly", "hosted_at"} <= at.accepted:
        return _misspelt(at.before, first_words("_claim")) or _claim(at)
    return None


def _unknown_query(at: ParsePoint) -> Diagnostic | None:
    """`observe(NEIGHBOURS(base))`."""
    opening = word_before(at.prepared.text, at.before.span.start)
    asked = word_before(at.prepared.text, opening.span.start).text
    if opening.text != "(" or asked not in QUERY_WORDS | {"observe"}:
        return None
    message = f"{at.before.shown} is no query"
    hint = f"queries are {', '.join(f'{word}(...)' for word in QueryOperator)}, HOST and ALL"
    return Diagnostic(Code.MISSPELT_KEYWORD, at.before.span, message, hint)


def _unknown_command(at: ParsePoint) -> Diagnostic | None:
    """`control(FLY_TO west0)`."""
    opening = word_before(at.prepared.text, at.before.span.start)
    if word_before(at.prepared.text, opening.span.start).text != "control":
        return None
    parts = set(at.before.text.upper().split("_"))
    forms = [each.form for each in COMMANDS.values() if parts & set("_".join(each.words).split("_"))]
    hint = f"control actions are {', '.join(forms or [each.form for each in COMMANDS.values()])}"
    message = f"{at.before.shown} is no control action"
    return Diagnostic(Code.MISSPELT_KEYWORD, at.before.span, message, hint)


def _channel(at: ParsePoint) -> Diagnostic | None:
    """`wifi:land drop`: the parser reads the name of a channel only together with `drops`."""
    found = _DROP.match(at.prepared.text, at.before.span.start)
    if found is None:
        return None
    message = f"'{found[2]}' is not a word of the language here"
    return Diagnostic(Code.MISSPELT_KEYWORD, Span(*found.span(2)), message, "did you mean 'drops'?")


def _claim(at: ParsePoint) -> Diagnostic | None:
    """`a ended`."""
    if at.found.text not in first_words("_claim"):
        return None
    message = f"{at.found.shown} stands before its name"
    return at.mistake(Code.UNEXPECTED, message, f"write {at.found.text} {at.before.text}")


def misplaced_command(at: ParsePoint) -> Diagnostic | None:
    """`contol(MOVE_HOST_TO r0)`, or `MOVE_HOST_TO r0` as a statement."""
    if (
        at.found.text not in COMMANDS
        or at.found.text in at.accepted
        or not (at.at_expression or at.at_statement)
    ):
        return None
    form = COMMANDS[at.found.text].form
    called = word_before(at.prepared.text, at.before.span.start) if at.before.text == "(" else at.found
    if called is at.found or not called.is_name:
        return at.mistake(Code.UNEXPECTED, "a control action is requested", f"write control({form})")
    message = f"{called.shown} requests no control action"
    return Diagnostic(Code.MISSPELT_KEYWORD, called.span, message, f"write control({form})")


def misplaced_query(at: ParsePoint) -> Diagnostic | None:
    """`if r0 in CHILDREN(HOST) { ... }`."""
    if at.found.text not in QUERY_WORDS or not at.at_expression:
        return None
    if at.before.text in COMMAND_WORDS and at.found.text.startswith(QueryOperator.PARENT):
        opened = word_at(at.prepared.text, at.following.span.end)
        who = opened.text if at.following.text == "(" and opened.is_name else "HOST"
        where = f"control({at.before.text} parent({who}, obs))"
        hint = (
            f"go where it was seen: observe(ALL) react {{ case obs: Observation if {who} in obs => {where} }}"
        )
        return at.mistake(Code.UNEXPECTED, "a query is observed, it has no value of its own", hint)
    hint = f"write observe({at.found.text}...), and test the answer: react {{ case obs if x in obs => ... }}"
    return at.mistake(Code.UNEXPECTED, "a query is observed, it has no value of its own", hint)


def dotted_query(at: ParsePoint) -> Diagnostic | None:
    """`observe(HOST.parent)`."""
    opening = word_before(at.prepared.text, at.before.span.start)
    asks = word_before(at.prepared.text, opening.span.start).text in {"observe", *QueryOperator}
    if at.found.text != "." or at.accepted != {")"} or not asks:
        return None
    relation = at.following.text.upper()
    if relation not in set(QueryOperator):
        relation = QueryOperator.PARENT
    hint = f"write {relation}({at.before.text})"
    return at.mistake(Code.UNEXPECTED, "a query names its relation first", hint)


def missing_parenthesis(at: ParsePoint) -> Diagnostic | None:
    """`observe HOST`, `CHILDREN HOST`, `PARENT()`, `box (37.0, -8.5 (36.9, -8.6)`."""
    if at.accepted == {"("} and at.before.text in _CALLED:
        message = f"expected '(' behind {at.before.shown}, found {at.found.shown}"
        return at.mistake(Code.UNEXPECTED, message, f"write {at.before.text}(...)")
    if at.found.text == ")" and at.before.text == "(" and at.accepted >= {"ALL", "HOST"}:
        name = word_before(at.prepared.text, at.before.span.start).text
        return at.mistake(
            Code.UNEXPECTED, "expected a query, found ')'", f"write {name}(HOST), or {name}(place0)"
        )
    if at.found.text == "(" and at.sorts == {"NAME"} and at.before.text in first_words("_claim"):
        hint = f"write {at.before.text} {at.following.text}, without brackets"
        return at.mistake(Code.UNEXPECTED, "expected a name, found '('", hint)
    waiting = open_brackets(at.prepared.text, at.found.span.start)
    named = "NAME" in at.sorts and at.found.text in RESERVED
    alone = at.accepted == {")"} and at.found.text not in (",", ";", ".") and not named
    over = ")" in at.accepted and at.is_first and at.found.text in STATEMENTS | {"}", "case"}
    if (alone or over) and waiting:
        opening, message = waiting[-1], f"'(' is not closed before {at.found.shown}"
        return Diagnostic(Code.UNCLOSED_BRACKET, Span(opening, opening + 1), message, "close it with ')'")
    if at.found.text == "[" and "(" in at.accepted:
        return at.mistake(Code.UNEXPECTED, "expected '(', found '['", "write ( ... )")
    return None


def spare_separator(at: ParsePoint) -> Diagnostic | None:
    """`(a, b,)`, `(a,, b)`, `(a; b)`, `display(a,)`, `scheduler: fcfs`, `react {; ... }`."""
    if "," in (at.found.text, at.before.text) and (at.found.text in (",", ")", "}") or at.found.text == ";"):
        comma = at.before if at.before.text == "," else at.found
        message = (
            f"nothing follows {comma.shown}"
            if comma is at.before
            else f"{comma.shown} stands behind the last item"
        )
        return Diagnostic(Code.UNEXPECTED, comma.span, message, "leave it out")
    if at.found.text == ";" and "," in at.accepted:
        return at.mistake(Code.MISSING_COMMA, "expected ',', found ';'", "separate items by commas")
    if at.found.text in (":", ";") or (at.found.text == "=" and "NUMBER" in at.sorts):
        return at.mistake(Code.UNEXPECTED, f"{at.found.shown} has no meaning here", "leave it out")
    return None


def missing_quotes(at: ParsePoint) -> Diagnostic | None:
    """`invariant never: ...`."""
    if at.sorts == {"STRING"} and (at.found.is_name or at.found.is_number):
        title = _TITLE.match(at.prepared.text, at.found.span.start)
        hint = f'write it in double quotes: "{at.found.text if title is None else title[0]}"'
        return at.mistake(Code.UNEXPECTED, f"expected a string, found {at.found.shown}", hint)
    return None


def missing_word(at: ParsePoint) -> Diagnostic | None:
    """`carried vessel0`, `circle (37.0, -8.5) 400 m`, `invariant "x" true`: only one word is possible here."""
    if len(at.accepted) == 1 == len(at.sorts) and "for" not in at.accepted and at.found.text != ";":
        (word,) = at.accepted
        if at.instead and word.isalpha() and not at.is_first:
            return at.mistake(
                Code.UNEXPECTED, f"expected '{word}', found {at.found.shown}", _instead(at, word)
            )
        if word.startswith(at.found.text) and word not in "([{":
            return at.mistake(Code.UNEXPECTED, f"expected '{word}', found {at.found.shown}", f"write {word}")
        if word not in "([{":
            message = f"expected '{word}' before {at.found.shown}"
            return at.mistake(Code.UNEXPECTED, message, f"write {word} before it")
    return None


def _instead(at: ParsePoint, word: str) -> str:
    """`vhf drops and comes back`, `boat appears in sea`."""
    more = at.following.text if at.following.is_name and word == "returns" else ""
    return f"write {word} instead of {at.found.text} {more}".rstrip()


def misplaced_statement(at: ParsePoint) -> Diagnostic | None:
    """A statement outside all behaviours, or in a section of another sort."""
    control = at.found.text == "(" and at.before.text == "control" and at.accepted == frozenset()
    section = at.at_declaration or bool(at.accepted & {"channel", "says", "invariant", "kind"})
    statement = at.found.text in STATEMENTS and section and not at.in_expression
    if not (control or statement):
        return None
    word = at.before if control else at.found
    hint = "write it into BigActor ... with_behavior { ... } or def name() = { ... }"
    return Diagnostic(Code.MISPLACED_STATEMENT, word.span, f"{word.shown} stands outside a behaviour", hint)


def missing_destination(at: ParsePoint) -> Diagnostic | None:
    """`control(MOVE uav0)`."""
    for word in sorted(COMMAND_WORDS & at.accepted - COMMANDS.keys() - {VIA}):
        forms = [command.form for command in COMMANDS.values() if word in command.words]
        message = f"expected '{word}', found {at.found.shown}"
        return at.mistake(Code.MISSING_DESTINATION, message, f"control actions are {', '.join(forms)}")
    if at.before.text in COMMAND_WORDS and at.at_expression and at.found.text in (")", VIA):
        return at.mistake(Code.MISSING_DESTINATION, f"'{at.before.text}' needs a name behind it", "say which")
    return None


def misplaced_via(at: ParsePoint) -> Diagnostic | None:
    """`control(CONNECT_HOST_TO gcs0 VIA gate0)`, or VIA twice."""
    if at.found.text != VIA:
        return None
    forms = [command.write(command.operands, WAY) for command in COMMANDS.values() if command.travels]
    hint = f"write {', or '.join(forms)}"
    return at.mistake(Code.MISPLACED_VIA, "'VIA' stands without a move, or behind another 'VIA'", hint)


def missing_arrow(at: ParsePoint) -> Diagnostic | None:
    """`case obs: Observation display(obs)`."""
    typed = at.before.text == ":" and at.found.text in STATEMENTS and at.sorts == {"NAME"}
    if "=>" not in at.accepted and not typed:
        return None
    word = at.before if typed else at.found
    guard = at.found.text in _COMPARISONS | _GUARDS and "if" in at.accepted
    hint = "a condition stands behind if: case pattern if condition => statements"
    instead = word.text in ("=", ":", "->", "-")
    where = f"'=>', found {word.shown}" if instead else f"'=>' before {word.shown}"
    waits = at.before.text in UNITS
    form = "write after 10 min => statements" if waits else "write case pattern => statements"
    shown = hint if guard else form
    return Diagnostic(Code.MISSING_ARROW, word.span, f"expected {where}", shown)


def chained_comparison(at: ParsePoint) -> Diagnostic | None:
    """`a < b < c`."""
    if at.found.text in _COMPARISONS and at.in_expression:
        return at.mistake(
            Code.CHAINED_COMPARISON, "comparisons do not chain", "join two comparisons with and"
        )
    return None


def missing_unit(at: ParsePoint) -> Diagnostic | None:
    """`radius 400`, `after 10`, or `at 10 to 12 m/s`."""
    for units in _UNITS:
        if set(units) <= at.accepted:
            both = f"write the unit behind both numbers: {at.before.text} {units[0]} to ..."
            each = f"write {_either(f'{at.before.text} {unit}' for unit in units)}"
            hint = both if at.found.text == "to" else each
            message = f"expected {_either(map(repr, units))} behind {at.before.shown}"
            return Diagnostic(Code.MISSING_UNIT, at.before.span, message, hint)
    return None


def _either(words: Iterable[str]) -> str:
    *first, last = words
    return f"{', '.join(first)} or {last}"


_STEPS: Final = {
    "send": "write snd, its delivery; or req_snd, its request",
    "observe": "write sense, its answer; or req_obs, its request",
    "control": "write actuate, or command and commit for flights; or req_ctr, its request",
    "react": "write rcv_obs or rcv_msg, what it receives",
    "after": "write timeout",
}


def reserved_word(at: ParsePoint) -> Diagnostic | None:
    """`let if = 3`."""
    if at.found.text == "for" and "forall" in at.accepted:
        hint = "write forall u: Kind . formula"
        return at.mistake(Code.MISSPELT_KEYWORD, "'for' is not a word of the language here", hint)
    meant = _STEPS.get(at.found.text) if "environment" in at.accepted else None
    if at.found.text == "to" and at.before.text == "linked":
        meant = f"write linked {at.following.text}"
    if at.found.text == "if" and "forall" in at.accepted:
        meant = "an implication is written F -> G"
    if at.found.text == "control" and at.before.text == "linked" and at.following.is_name:
        meant = f"a control authority is written control:{at.following.text}"
    if at.found.text == "timing" and at.before.text == "control":
        meant = "write control timed"
    if meant:
        return at.mistake(
            Code.MISSPELT_KEYWORD, f"{at.found.shown} is not a word of the language here", meant
        )
    if (
        at.found.text in RESERVED
        and at.sorts & {"NAME", "CHANNEL"}
        and not at.at_statement
        and not at.at_expression
    ):
        message = f"{at.found.shown} is a word of the language and cannot be a name"
        return at.mistake(Code.RESERVED_WORD, message, "choose another name")
    return None


def missing_host(at: ParsePoint) -> Diagnostic | None:
    """`BigActor a { ... }`."""
    if at.accepted in ({"hosted_at"}, {"hosted_at", "["}):
        message = f"expected 'hosted_at' and a host, found {at.found.shown}"
        one = "write BigActor name hosted_at host with_behavior { ... }"
        return at.mistake(Code.MISSING_HOST, message, FAMILY if at.found.text in ("for", "[") else one)
    if "hosted_at" in at.accepted and not at.accepted & {"directly", "with_behavior"} and at.found.is_name:
        message = f"expected 'hosted_at' and a host, found {at.found.shown}"
        return at.mistake(Code.MISSING_HOST, message, FAMILY)
    return None


def unseparated_channel(at: ParsePoint) -> Diagnostic | None:
    """`linked control:gcs0 wifi`: read as the name of the next entity."""
    start = at.before.span.start
    line = at.prepared.text[at.prepared.text.rfind("\n", 0, start) + 1 : start]
    if at.accepted != {":"} or not _CHANNELS.search(line):
        return None
    message = f"expected ',' before {at.before.shown}"
    return Diagnostic(Code.MISSING_COMMA, at.before.span, message, "separate channels by commas")


def missing_comma(at: ParsePoint) -> Diagnostic | None:
    """`visit(a b)` or `(37.0 -8.5)`."""
    starts = at.found.is_name or at.found.is_number or at.found.text[:1] in {'"', "(", "-"}
    if (
        _in_environment(at) and at.found.text == "(" and at.before.text in _GEOMETRIES
    ):  # the parser read it as the name of a clause
        message = f"expected ',' before {at.before.shown}"
        return Diagnostic(Code.MISSING_COMMA, at.before.span, message, "separate items by commas")
    if at.found.text == "and" and "," in at.accepted:
        return at.mistake(Code.MISSING_COMMA, "expected ',', found 'and'", "separate items by commas")
    if "," in at.accepted and starts and ("]" in at.accepted or ")" in at.accepted or at.accepted == {","}):
        return at.mistake(
            Code.MISSING_COMMA, f"expected ',' before {at.found.shown}", "separate items by commas"
        )
    return None


def unbracketed_route(at: ParsePoint) -> Diagnostic | None:
    """`for c in a, b { ... }`."""
    line = at.prepared.text[at.prepared.text.rfind("\n", 0, at.found.span.start) + 1 :].splitlines()[0]
    found = _THROUGH.search(line) if at.found.text == "," and "{" in at.accepted else None
    if found is None:
        return None
    hint = f"write {found[1]} in [{found[2].strip()}] {{ ... }}"
    return at.mistake(Code.UNEXPECTED, "the collection of a 'for' stands in brackets", hint)


def missing_brace(at: ParsePoint) -> Diagnostic | None:
    """`loop observe(HOST)`."""
    opens = "{" in at.accepted and not at.at_expression
    if at.found.text == "=" and at.before.text == "=":
        return None
    if opens or ("RULE_BODY" in at.sorts and at.before.text != "("):
        return at.mistake(
            Code.MISSING_BRACE, f"expected '{{' before {at.found.shown}", "open the block with {"
        )
    return None


def missing_equals(at: ParsePoint) -> Diagnostic | None:
    """`def visit(place) { ... }`, or `uav0: UAV point (37.0, -8.5)`."""
    if {"=", "absent"} <= at.accepted and at.found.text == "(":
        hint = "write name: Kind = point (37.08, -8.55)"
        return at.mistake(Code.MISSING_EQUALS, "expected '=' and a geometry before '('", hint)
    if at.accepted == {"="} or ("=" in at.accepted and at.found.text in _GEOMETRIES):
        return at.mistake(Code.MISSING_EQUALS, f"expected '=' before {at.found.shown}", "put = before it")
    return None


def missing_kind_word(at: ParsePoint) -> Diagnostic | None:
    """`signature { UAV driven }`, `kind Location contains UAV; Station`."""
    if "kind" not in at.accepted or not at.found.is_name or is_keyword(at.found):
        return None
    if "," in at.accepted and not at.is_first:
        return at.mistake(
            Code.MISSING_COMMA, f"expected ',' before {at.found.shown}", "separate items by commas"
        )
    hint = f"write kind {at.found.text}; in a list, kinds are separated by commas"
    return at.mistake(Code.UNEXPECTED, f"expected 'kind' before {at.found.shown}", hint)


def missing_geometry(at: ParsePoint) -> Diagnostic | None:
    """`uav0: UAV = (37.0, -8.5)`, `box (37.0, -8.5), (36.9, -8.6)`."""
    if at.accepted >= _GEOMETRIES and (at.found.text in ("(", "-") or at.found.is_number):
        hint = "write point (latitude, longitude), or a box, a polygon or a circle"
        return at.mistake(Code.BAD_COORDINATE, f"expected a geometry before {at.found.shown}", hint)
    if at.accepted == {"("} and at.found.text == "," and at.before.text == ")":
        return at.mistake(Code.BAD_COORDINATE, "corners are not separated by commas", "leave it out")
    return None


def missing_recipient(at: ParsePoint) -> Diagnostic | None:
    """`send b "yours"`, `emit ("found", place) to b`."""
    if at.found.text == "to" and at.at_statement:
        return at.mistake(Code.UNEXPECTED, "'to' stands behind the message", "write send message to bigActor")
    if "to" in at.accepted and (at.found.is_name or at.found.text[:1] in ('"', "(")) and at.before.is_name:
        words = f"expected 'to' before {at.found.shown}"
        return at.mistake(Code.MISSING_RECIPIENT, words, "write send message to bigActor")
    return None


def several_sent(at: ParsePoint) -> Diagnostic | None:
    """`send "found", spill to desk`."""
    if at.found.text != "," or "to" not in at.accepted:
        return None
    text, start = at.prepared.text, at.found.span.start
    begun = text.rfind("send", max(0, start - _MOST_NAMES), start)
    if begun < 0:
        return None
    first, rest = text[begun + len("send") : start].strip(), text[at.found.span.end :].partition("\n")[0]
    others, found, receiver = rest.partition(" to ")
    to = receiver.split()[0] if found and receiver.split() else "bigActor"
    more = others.strip() if found else "..."
    message = "a message is one value, and here are several"
    return at.mistake(Code.UNEXPECTED, message, f"write send ({first}, {more}) to {to}, in brackets")


def someone_says(at: ParsePoint) -> Diagnostic | None:
    """`operator says "go"`."""
    if at.found.text != "says" or not _in_environment(at) or not at.before.is_name:
        return None
    message = f"expected 'someone' before 'says', found {at.before.shown}"
    hint = 'write someone says "go": operators and other people have no names'
    return Diagnostic(Code.UNEXPECTED, at.before.span, message, hint)


def hyphenated(at: ParsePoint) -> Diagnostic | None:
    """`uav-1: UAV`, `BigActor desk-1 hosted_at ...`."""
    joined = at.before.is_name and at.before.span.end == at.found.span.start == at.following.span.start - 1
    ends = at.following.is_number or at.following.is_name
    if at.found.text != "-" or not joined or not ends or at.in_expression or "-" in at.accepted:
        return None
    whole = at.before.span.to(at.following.span)
    written = f"{at.before.text}-{at.following.text}"
    hint = f"write {at.before.text}_{at.following.text}"
    return Diagnostic(
        Code.UNKNOWN_CHARACTER, whole, f"'{written}' is no name: '-' is not part of names", hint
    )


def missing_value(at: ParsePoint) -> Diagnostic | None:
    """`match { case ... }`."""
    if at.found.text == "case" and at.before.text == "{" and at.at_expression:
        before = word_before(at.prepared.text, at.before.span.start)
        hint = "write match value { case ... }; react { case ... } distinguishes received values"
        return Diagnostic(Code.UNEXPECTED, before.span, f"{before.shown} needs a value to look at", hint)
    return None


def missing_at_most(at: ParsePoint) -> Diagnostic | None:
    """`says "handover" once`."""
    if _in_environment(at) and at.before.text in ("once", "times", "twice"):
        message = f"expected 'at most' before {at.before.shown}"
        return Diagnostic(Code.UNEXPECTED, at.before.span, message, "write at most once, or at most 3 times")
    return None


def missing_dot(at: ParsePoint) -> Diagnostic | None:
    """`forall u: UAV u in base`, `exists u: UAV: u in base`, `forall u in UAV . u in base`."""
    quantifier, variables = _quantified(at.prepared.text, at.before.span.end)
    if at.accepted == {":", ","} and quantifier in _QUANTIFIERS:
        kind = at.following.text if at.found.text in ("in", "of") else "Kind"
        if at.following.text == ":":
            variables += f", {at.found.text}"
        elif at.found.is_name and not is_keyword(at.found):  # the kind before the name, as in Java
            kind, variables = at.before.text, at.found.text
        hint = f"write {quantifier} {variables}: {kind} . formula"
        return at.mistake(Code.MISSING_KIND, f"expected ':' and a kind, found {at.found.shown}", hint)
    if not {".", "with_behavior", "hosted_at"} <= at.accepted:
        return None
    start = at.prepared.text.rfind(":", 0, at.found.span.start)
    quantifier, variables = _quantified(at.prepared.text, start)
    among = at.prepared.text[start + 1 : at.before.span.end].strip()
    hint = f"write {quantifier} {variables}: {among} . formula"
    return at.mistake(Code.UNEXPECTED, f"expected '.', found {at.found.shown}", hint)


def _quantified(text: str, end: int) -> tuple[str, str]:
    """Return the quantifier and its comma-separated names that end at an offset."""
    found = _NAMES_AFTER.search(text, max(0, end - _MOST_NAMES), end)
    return (found[1], " ".join(found[2].split())) if found else ("", "")


def equals_of_places(at: ParsePoint) -> Diagnostic | None:
    """`actually uav = boat`."""
    if at.found.text not in ("=", "==", "!=") or at.accepted != {"directly", "in", "linked"}:
        return None
    message = f"{at.found.shown} does not compare entities"
    hint = f"ask where it is: {at.before.text} in place, or of its links: {at.before.text} linked channel"
    return at.mistake(Code.UNEXPECTED, message, hint)


def drift_without_spot(at: ParsePoint) -> Diagnostic | None:
    """`uav drifts to sea`, `spill drifts 3 km in sea`."""
    if at.accepted != {"among", "within"}:
        return None
    if at.found.is_number:
        line = at.prepared.text[at.found.span.start :].partition("\n")[0]
        named = _WHERE.search(line)
        where = named[1] if named else "place"
        hint = f"write drifts within {where}, for any position in it, or drifts among {where}, others"
        return at.mistake(Code.UNEXPECTED, "a drift has no distance and no direction", hint)
    where = at.following.text if at.following.is_name else "place"
    hint = f"write drifts within {where}, or drifts among {where}, others"
    return at.mistake(Code.UNEXPECTED, f"expected 'among' or 'within', found {at.found.shown}", hint)


def missing_kind(at: ParsePoint) -> Diagnostic | None:
    """`uav0 = point (37.0, -8.5)`."""
    if at.accepted == {":"} and at.before.text in _GEOMETRIES:
        message = f"expected '=' before {at.before.shown}"
        return Diagnostic(
            Code.MISSING_EQUALS, at.before.span, message, "write name: Kind = point (37.08, -8.55)"
        )
    if at.accepted == {":"} and at.found.text in _FALLBACKS:
        message = f"expected ':' before {at.found.shown}"
        return at.mistake(Code.UNEXPECTED, message, f"write {at.before.text}: {at.found.text}")
    if at.accepted == {":"} and at.before.is_name:
        message = f"expected ':' and a kind behind {at.before.shown}, found {at.found.shown}"
        return at.mistake(Code.MISSING_KIND, message, "write name: Kind")
    return None


def bad_number(at: ParsePoint) -> Diagnostic | None:
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


def bad_coordinate(at: ParsePoint) -> Diagnostic | None:
    """`point 37.0, -8.5`, or `point (37.0)`."""
    opening = at.accepted == {"("} and (at.before.text in _GEOMETRIES or at.before.text == ")")
    if opening or (at.accepted == {","} and at.found.text == ")"):
        message = (
            f"expected a coordinate, found {at.found.shown}" if opening else "a coordinate has two numbers"
        )
        return at.mistake(Code.BAD_COORDINATE, message, "write (latitude, longitude) in degrees")
    return None


def loose_number(at: ParsePoint) -> Diagnostic | None:
    """A line number that does not continue those before, or that precedes a misspelt `BigActor`."""
    if at.at_declaration and at.found.is_number:
        hint = f"write BigActor for {at.following.shown}: from there on, the numbers of printed lines are left out"
        return at.mistake(Code.UNEXPECTED, f"expected a declaration, found {at.found.shown}", hint)
    if at.at_statement and at.found.is_number:
        return at.mistake(Code.UNEXPECTED, f"expected a statement, found {at.found.shown}", LINE_NUMBERS)
    return None


def misspelt_word_after_all(at: ParsePoint) -> Diagnostic | None:
    """`weak fairness of env nad ...`: the word before is a misspelling of one expected here."""
    return _misspelt(at.before, at.accepted)


def _misspelt(word: Word, candidates: Iterable[str]) -> Diagnostic | None:
    if not word.is_name or is_keyword(word):
        return None
    possible = {each for each in candidates if len(each) > 1 and each.isidentifier()}
    phrase = word.text.replace("_", '" "')
    if phrase != word.text and f'"{phrase}"' in grammar_text():  # carried_by
        meant = f"write {word.text.replace('_', ' ')}"
    else:
        meant = did_you_mean(word.text, possible)
    if not meant:
        return None
    message = f"{word.shown} is not a word of the language here"
    return Diagnostic(Code.MISSPELT_KEYWORD, word.span, message, meant)


MISTAKES: Final[tuple[Callable[[ParsePoint], Diagnostic | None], ...]] = (
    bad_angle,
    foreign_operator,
    unknown_character,
    unclosed_section,
    misplaced_header,
    equals_of_places,
    single_equals,
    *DISTANCE_MISTAKES,
    *TIMING_MISTAKES,
    flown,
    unseparated_channel,
    hyphenated,
    bad_number,
    foreign_word,
    foreign_form,
    missing_dot,
    several_sent,
    misspelt_word,
    missing_at_most,
    misspelt_word_before,
    someone_says,
    misplaced_statement,
    misplaced_command,
    misplaced_query,
    missing_destination,
    misplaced_via,
    missing_arrow,
    chained_comparison,
    missing_unit,
    missing_host,
    missing_geometry,
    missing_value,
    dotted_query,
    missing_parenthesis,
    bad_coordinate,
    operator_first,
    missing_recipient,
    missing_comma,
    unbracketed_route,
    missing_kind_word,
    missing_brace,
    missing_equals,
    missing_kind,
    drift_without_spot,
    missing_quotes,
    missing_word,
    reserved_word,
    loose_number,
    spare_separator,
    misspelt_word_after_all,
)
