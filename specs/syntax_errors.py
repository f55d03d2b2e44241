"""Explain a stopped parse by a diagnostic."""

from __future__ import annotations

from typing import Final

from lark import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from semantics.behaviours.commands import COMMAND_WORDS, COMMANDS
from semantics.properties.kinds import Asked, asked_by
from specs.codes import Code
from specs.common_mistakes import FAMILY, MISTAKES
from specs.diagnostics import Diagnostic
from specs.grammar import QUERY_WORDS, SECTIONS, STATEMENTS, Run, first_words
from specs.parse_error import Situation, line_of, situation
from specs.preprocessing import Prepared

# Groups of words that the user knows by one name: a word only they have, that name, their words and sorts.
_EXPRESSION: Final = frozenset(["SELF", "HOST", "true", "false", "not", "!", "-", "(", "{", "["])
_OPERATORS: Final = frozenset(
    ["of", "==", "!=", "<", "<=", ">", ">=", "in", "not", "+", "-", "or", "||", "and", "&&"]
)
_PATHS: Final = frozenset(["[]", "<>", "always", "eventually", "next", "infinitely"])
_FORMULA: Final = first_words("_claim") | _PATHS | {"forall", "exists", "not", "!", "false", "("}
_CONNECTIVES: Final = frozenset(["and", "&&", "or", "||", "->", "<->", "U", "R", "W", "until", "leads"])
_STANDARD: Final = frozenset(asked_by(Asked.BY_DEFAULT, Asked.BY_NAME))
_HAPPENINGS: Final = frozenset(["appears", "arrives", "drifts", "leaves", "vanishes"])
_GROUPS: Final[tuple[tuple[str, str, frozenset[str], frozenset[str]], ...]] = (
    ("observe", "a statement", STATEMENTS, frozenset({"NAME"})),
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
        "vanishes",
        "what happens (appears, arrives, drifts, drops, leaves, vanishes)",
        _HAPPENINGS,
        frozenset(),
    ),
)
_SORTS: Final = {
    "NAME": "a name",
    "CHANNEL": "a channel",
    "NUMBER": "a number",
    "STRING": "a string",
    "RULE_BODY": "a rule body in braces",
    "$END": "the end of the file",
}
_MOST: Final = 8


def explain_syntax_error(found: UnexpectedInput, run: Run, prepared: Prepared) -> Diagnostic:
    """Return why a parse stopped: a bracket, the end, a common mistake, or what was expected."""
    at = situation(prepared, offset_of(found, prepared), frozenset(run.accepts()))
    if prepared.unmatched and at.found.span.start >= prepared.unmatched[0]:
        return prepared.unmatched[1]
    if not at.found.text:
        return _early_end(at)
    return next((named for rule in MISTAKES if (named := rule(at))), None) or _unexpected(at)


def expected(at: Situation) -> str:
    """Return what could stand there in the user's words: `a statement or '}'`."""
    words, sorts, groups = set(at.accepted) - {";"}, set(at.sorts), []
    words -= {"["} if len(words) > 1 else set()  # a name could be that of a family: nobody misses that
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


def offset_of(found: UnexpectedInput, prepared: Prepared) -> int:
    """Return where a parse stopped."""
    if isinstance(found, UnexpectedToken):
        return len(prepared.text) if found.token.type == "$END" else int(found.token.start_pos or 0)
    if isinstance(found, UnexpectedCharacters):
        return found.pos_in_stream or 0
    return len(prepared.text)


def _early_end(at: Situation) -> Diagnostic:
    message = f"the file ends here, expected {expected(at)}"
    if not at.prepared.open_at_end:
        return at.mistake(Code.UNEXPECTED_END, message, "write the rest of it")
    opening = at.prepared.open_at_end[-1]
    line = line_of(at.prepared.text, opening)
    column = opening - at.prepared.text.rfind("\n", 0, opening)
    hint = f"the '{at.prepared.text[opening]}' of line {line}, column {column} is still open"
    return at.mistake(Code.UNEXPECTED_END, message, hint)


def _unexpected(at: Situation) -> Diagnostic:
    return at.mistake(Code.UNEXPECTED, f"expected {expected(at)}, found {at.found.shown}", _hint(at))


def _hint(at: Situation) -> str:
    if at.accepted == {"for"} or (at.before.text == "[" and at.sorts == {"NAME"}):
        return FAMILY
    if "with_behavior" in at.accepted and "." not in at.accepted:
        return "write hosted_at host with_behavior { ... }"
    if at.found.text == "}" and at.at_expression:
        return f"something is missing behind {at.before.shown}" if at.before.text else ""
    return ""
