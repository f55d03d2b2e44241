"""The colours of missions: semantic tokens for names, and a TextMate grammar, generated from the parser's grammar."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from bigactors.lsp.edited_mission import Reading
from semantics.behaviours.commands import COMMAND_WORDS
from semantics.properties.kinds import PropertyKind
from specs.elaboration.expressions import FUNCTIONS
from specs.grammar import OPERATION_WORDS, QUERY_WORDS, SECTIONS, STATEMENTS, keywords
from specs.syntax import Span

SCOPE: Final = "source.mission"
_NAME: Final = r"[^\W\d_]\w*"
_NEW_NAMES: Final = {
    "BigActor": "entity.name.class",
    "def": "entity.name.function",
    "kind": "entity.name.type",
    "rule": "entity.name.function",
    "mission": "entity.name.section",
}
"""The scope of the name after each word."""


def textmate_grammar() -> str:
    """Return the grammar as the text of its file."""
    properties = {kind.value for kind in PropertyKind} & keywords()
    constants = {"true", "false", "HOST", "SELF", "ALL"}
    known = SECTIONS | STATEMENTS | OPERATION_WORDS | QUERY_WORDS | COMMAND_WORDS | properties
    patterns = [
        _rule("comment.line", r"(?://|#).*$"),
        _rule("string.quoted.double", r'"(?:[^"\\]|\\.)*"', {"constant.character.escape": r"\\."}),
        _rule("variable.other.channel", r"\b[^\W\d]\w*(?::\w+)+"),
        *(_new_name(word, scope) for word, scope in sorted(_NEW_NAMES.items())),
        _rule("constant.numeric", r"\b\d+(?:\.\d+)?(?:[eE][+\-]?\d+)?\b"),
        _rule("constant.language", _any(constants)),
        _rule("storage.type", _any(SECTIONS)),
        _rule("keyword.control", _any(STATEMENTS | {"else", "case"})),
        _rule("support.function.query", _any(QUERY_WORDS - constants)),
        _rule("support.function.command", _any(COMMAND_WORDS)),
        _rule("support.constant.property", _any(properties)),
        _rule("keyword.operator.word", _any(OPERATION_WORDS - constants)),
        _rule("support.function", rf"{_any(FUNCTIONS)}(?=\s*\()"),
        _rule("entity.name.type", rf"(?<=:)\s*{_NAME}"),
        _rule("keyword.other", rf"{_any(keywords() - known - {'case', 'else'})}(?!\s*:)"),
        _rule("keyword.operator", r"=>|==|!=|<=|>=|<->|->|<>|\[\]|\|\||&&|[=<>!+\-|]"),
    ]
    grammar = {
        "name": "bigactors mission",
        "scopeName": SCOPE,
        "fileTypes": ["mission"],
        "patterns": patterns,
    }
    return json.dumps(grammar, indent=2, ensure_ascii=False) + "\n"


def _any(words: Iterable[str]) -> str:
    return rf"\b(?:{'|'.join(sorted(words))})\b"


def _rule(scope: str, match: str, inner: dict[str, str] | None = None) -> dict[str, object]:
    rule: dict[str, object] = {"name": f"{scope}.mission", "match": match}
    if inner:
        rule["captures"] = {"0": {"patterns": [_rule(name, each) for name, each in inner.items()]}}
    return rule


def _new_name(word: str, scope: str) -> dict[str, object]:
    captures = {"1": {"name": "storage.type.mission"}, "2": {"name": f"{scope}.mission"}}
    return {"match": rf"\b({word})\s+(?!hosted_at\b)({_NAME})", "captures": captures}


TYPES: Final[Mapping[str, str]] = {
    "type": "kind",
    "class": "agent",
    "enumMember": "entity",
    "event": "channel",
    "macro": "rule",
    "function": "behaviour",
    "variable": "variable",
}
"""The protocol's types of tokens, and our sorts of names."""

MODIFIERS: Final = ("declaration",)
_NUMBERS: Final = {sort: number for number, sort in enumerate(TYPES.values())}


@dataclass(frozen=True, slots=True)
class NameToken:
    """A name, with the number of its type in `TYPES`."""

    span: Span
    type: int
    modifiers: int


def tokens(reading: Reading) -> Iterator[NameToken]:
    """Yield the names of a mission by position."""
    for each in reading.occurrences.all:
        yield NameToken(each.span, _NUMBERS[each.symbol.sort], int(each.declares))
