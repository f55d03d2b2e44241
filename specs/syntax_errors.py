"""Explain why a parse stopped, by a diagnostic."""

from __future__ import annotations

import re
from typing import Final

from lark import UnexpectedInput

from semantics.behaviours.commands import COMMAND_WORDS, COMMANDS
from specs.codes import Code
from specs.common_mistakes import FAMILY, MISTAKES
from specs.diagnostics import Diagnostic
from specs.grammar import NAMED_PROPERTIES, QUERY_WORDS, SECTIONS, STATEMENTS, ParserRun, first_words
from specs.parse_error import ParsePoint, line_of, offset_of, situation
from specs.preprocessing import Prepared

# Groups of words with a common name: a word that only the group has, the name, the words and the sorts.
_EXPRESSION: Final = frozenset(["SELF", "HOST", "true", "false", "not", "!", "-", "(", "{", "["])
_OPERATORS: Final = frozenset(
    ["of", "==", "!=", "<", "<=", ">", ">=", "in", "not", "+", "-", "or", "||", "and", "&&"]
)
_PATHS: Final = frozenset(["[]", "<>", "always", "eventually", "next", "infinitely"])
_FORMULA: Final = first_words("_claim") | _PATHS | {"forall", "exists", "not", "!", "false", "("}
_CONNECTIVES: Final = frozenset(["and", "&&", "or", "||", "->", "<->", "U", "R", "W", "until", "leads"])
_STANDARD: Final = frozenset(map(str, NAMED_PROPERTIES))
_HAPPENINGS: Final = frozenset(["appears", "arrives", "drifts", "leaves", "vanishes"])
_TAKING: Final = _HAPPENINGS | {"flies", "lasts", "within", "take", "takes"}
_GROUPS: Final[tuple[tuple[str, str, frozenset[str], frozenset[str]], ...]] = (
    ("skip", "a statement", STATEMENTS, frozenset({"NAME"})),
    ("signature", "a declaration", SECTIONS | {"control"}, frozenset()),
    ("SELF", "an expression", _EXPRESSION, frozenset({"NAME", "STRING", "NUMBER"})),
    ("actually", "a formula", _FORMULA, frozenset({"NAME"})),
    (next(iter(COMMANDS)), "a control action", COMMAND_WORDS, frozenset({"NAME", "RULE_BODY"})),
    ("ALL", "a query", QUERY_WORDS | {"HOST"}, frozenset({"NAME"})),
    (
        "_",
        "a pattern",
        frozenset({"_", "-", "=", "(", "true", "false"}),
        frozenset({"NAME", "STRING", "NUMBER"}),
    ),
    ("polygon", "a geometry", frozenset({"point", "box", "polygon", "circle"}), frozenset()),
    ("of", "an operator", _OPERATORS, frozenset()),
    ("<->", "a connective", _CONNECTIVES, frozenset()),
    ("invariant", "a property", first_words("_property") | _STANDARD, frozenset()),
    (
        "flies",
        "a verb of time (flies, lasts, within, takes, drifts, leaves, appears, vanishes)",
        _TAKING,
        frozenset(),
    ),
    (
        "arrives",
        "an event (appears, arrives, drifts, drops, leaves, vanishes)",
        _HAPPENINGS,
        frozenset(),
    ),
)
_FORMS: Final = (
    (
        frozenset({"directly", "linked"}),
        "a claim is written uav0 in place0, uav0 linked wifi, uav0 at least 50 m from uav1 or a.x == 3",
    ),
    (
        frozenset({"arrives"}),
        "an event is written wifi drops, uav0 leaves wifi, boat0 drifts within place0, boat0 appears at place0",
    ),
    (frozenset({"weak", "strong"}), "write under weak fairness of environment, or of the name of a bigActor"),
    (
        frozenset({"<->"}),
        "join formulas by and, or, -> or <->; a property begins with its kind: invariant, ltl",
    ),
    (frozenset({"(", "="}), "a behaviour is called by name(...), a variable is given a value by name = ..."),
    (frozenset({"case", "after"}), "write case pattern => statements, or after 10 min => statements"),
    (
        frozenset({"flies"}),
        "a bound is written UAV flies at 18 m/s to 25 m/s, uav0 lasts 45 min, restored in base0, or HAND within 10 s",
    ),
    (
        frozenset({"tick"}),
        "a bound is written agents react within 1 s, sense within 5 s, messages over wifi take 1 s to 3 s",
    ),
    (frozenset({"react", "take"}), "write agents react within 1 s, or agents take 1 s to 2 s"),
    (frozenset({"within", "takes"}), "write within 5 s, takes 1 s to 3 s or takes at least 2 s"),
    (frozenset({"over", "on"}), "write messages over wifi, or messages on one host"),
    (
        frozenset({"at", "and"}),
        "write wifi drops at most every 30 min, returns within 5 min, or wifi drops and returns within 5 min",
    ),
    (frozenset({"polygon"}), "geometries are point, box, circle and polygon"),
    (
        frozenset({"invariant"}),
        'write invariant "name": formula, or reachable, ltl, ctl, deadlock_freedom; of times: within 5 min, endurance',
    ),
)
"""The expected forms in some situations, for mistakes without a better explanation."""

_SORTS: Final = {
    "NAME": "a name",
    "CHANNEL": "a channel",
    "NUMBER": "a number",
    "STRING": "a string",
    "RULE_BODY": "a rule body in braces",
    "$END": "the end of the file",
}
_MOST: Final = 8


_SPELT: Final = re.compile(r'"[^\W\d]\w*"')
"""A text that is spelled like a name."""


def explain_syntax_error(found: UnexpectedInput, run: ParserRun, prepared: Prepared) -> Diagnostic:
    """Return the diagnostic of a stopped parse: a bracket, the end, a common mistake, or the words expected."""
    at = situation(prepared, offset_of(found, prepared), run)
    if prepared.unmatched and at.found.span.start >= prepared.unmatched[0]:
        return prepared.unmatched[1]
    if not at.found.text:
        return _early_end(at)
    return next((named for rule in MISTAKES if (named := rule(at))), None) or _unexpected(at)


def expected(at: ParsePoint) -> str:
    """Return the expected words in the user's terms: `a statement or '}'`."""
    words, sorts, groups = set(at.accepted) - {";"}, set(at.sorts), []
    words -= {"["} if len(words) > 1 else set()  # a `[` would make a family: hardly meant
    for first, title, members, also in _GROUPS:
        if first in at.accepted:
            groups.append(title)
            words -= members
            sorts -= also
    groups += [title for sort, title in _SORTS.items() if sort in sorts]
    groups += [f"'{word}'" for word in sorted(words)]
    if len(groups) > _MOST:
        groups = [*groups[:_MOST], "another word"]
    return groups[0] if len(groups) == 1 else f"{', '.join(groups[:-1])} or {groups[-1]}"


def _early_end(at: ParsePoint) -> Diagnostic:
    message = f"the file ends here, expected {expected(at)}"
    if not at.prepared.open_at_end:
        return at.mistake(Code.UNEXPECTED_END, message, "write the rest of it")
    opening = at.prepared.open_at_end[-1]
    line = line_of(at.prepared.text, opening)
    column = opening - at.prepared.text.rfind("\n", 0, opening)
    hint = f"the '{at.prepared.text[opening]}' of line {line}, column {column} is still open"
    return at.mistake(Code.UNEXPECTED_END, message, hint)


def _unexpected(at: ParsePoint) -> Diagnostic:
    return at.mistake(Code.UNEXPECTED, f"expected {expected(at)}, found {at.found.shown}", _hint(at))


def _hint(at: ParsePoint) -> str:
    if at.accepted == {"for"} or (at.before.text == "[" and at.sorts == {"NAME"}):
        return FAMILY
    if "with_behavior" in at.accepted and "." not in at.accepted:
        return "write hosted_at host with_behavior { ... }"
    if at.found.text == "}" and at.at_expression:
        return f"something is missing behind {at.before.shown}" if at.before.text else ""
    form = next((form for words, form in _FORMS if words <= at.accepted), "")
    return form or _unquoted(at)


def _unquoted(at: ParsePoint) -> str:
    is_spelt = "NAME" in at.sorts and _SPELT.fullmatch(at.found.text)
    return f"write the name without quotes: {at.found.text[1:-1]}" if is_spelt else ""
