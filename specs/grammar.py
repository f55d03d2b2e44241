"""The grammar of missions for lark, built once and cached; and its reserved words."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Final, Protocol

from lark import Lark, Token
from lark.lexer import PatternRE, PatternStr, TerminalDef

from semantics.properties.property import Asked, asked_by
from specs.build_behaviour import BuildBehaviour
from specs.build_world import BuildWorld
from specs.syntax import Mission

SECTIONS: Final = frozenset(
    [
        "mission",
        "signature",
        "world",
        "believes",
        "rule",
        "def",
        "BigActor",
        "environment",
        "scheduler",
        "check",
        "live",
    ]
)
STATEMENTS: Final = frozenset(
    [
        "observe",
        "control",
        "react",
        "send",
        "migrate",
        "spawn",
        "display",
        "let",
        "if",
        "loop",
        "while",
        "for",
        "match",
        "choose",
        "skip",
    ]
)
OPERATION_WORDS: Final = frozenset(["in", "not", "and", "or", "of", "true", "false", "HOST", "SELF"])
QUERY_WORDS: Final = frozenset(
    [
        "ALL",
        "PARENT",
        "CHILDREN",
        "LINKED_TO",
        "HOSTED_AT",
        "PARENT_HOST",
        "CHILDREN_HOST",
        "LINKED_TO_HOST",
        "HOSTED_AT_HOST",
    ]
)
ACTION_WORDS: Final = frozenset(
    ["MOVE_HOST_TO", "MOVE", "TO", "VIA", "CONNECT_HOST_TO", "DISCONNECT_HOST_FROM", "HAND", "PUT", "IN"]
)
RESERVED: Final = (
    SECTIONS
    | STATEMENTS
    | OPERATION_WORDS
    | QUERY_WORDS
    | ACTION_WORDS
    | frozenset(["case", "else", "hosted_at", "with_behavior", "to", "at", "says", "someone"])
)


class _Build(BuildWorld, BuildBehaviour):
    """Both halves of the builder."""


def grammar_text() -> str:
    """Return the grammar as it is written in mission.lark, with the properties that have a name."""
    standard = " | ".join(f'"{kind}"' for kind in asked_by(Asked.BY_DEFAULT, Asked.BY_NAME))
    text = Path(__file__).with_name("mission.lark").read_text(encoding="utf-8")
    return text.replace("STANDARD", standard)


@cache
def grammar() -> Lark:
    """Return the parser, which builds the syntax tree as it goes, so that depth costs no recursion."""
    reserved = "|".join(sorted(RESERVED))
    return Lark(
        grammar_text().replace("RESERVED", f"(?:{reserved})"),
        parser="lalr",
        lexer="contextual",
        start="mission",
        keep_all_tokens=True,
        maybe_placeholders=True,
        transformer=_Build(),
        edit_terminals=_match_whole_words,
    )


class Run(Protocol):
    """A parse under way; lark's interactive parser, as far as it is used here."""

    def exhaust_lexer(self) -> list[Token]:
        """Parse to the end of the text, not included, and return what was read."""

    def feed_eof(self, last_token: Token | None) -> Mission:
        """Tell that the text has ended, and return what it says."""

    def accepts(self) -> set[str]:
        """Return the grammar's names of what could come next."""


def start(text: str) -> Run:
    """Begin to parse a prepared text."""
    run: Run = grammar().parse_interactive(text)
    return run


@cache
def spellings() -> dict[str, str]:
    """Return what the user writes for each terminal of the grammar that is one word or symbol."""
    return {
        terminal.name: terminal.pattern.value.removesuffix(_WORD_END)
        if isinstance(terminal.pattern, PatternStr) or terminal.pattern.value.endswith(_WORD_END)
        else ""
        for terminal in grammar().terminals
    }


@cache
def keywords() -> frozenset[str]:
    """Return all words of the language."""
    return frozenset(word for word in spellings().values() if re.fullmatch(r"\w\w+", word))


_WORD_END: Final = r"(?!\w)"


def _match_whole_words(terminal: TerminalDef) -> None:
    """Make a keyword match as a whole word, before any name; lark would match the `let` of `letter`."""
    if isinstance(terminal.pattern, PatternStr) and re.fullmatch(r"\w+", terminal.pattern.value):
        terminal.pattern = PatternRE(terminal.pattern.value + _WORD_END)
        terminal.priority = 2
    elif terminal.name == "DROPPING":
        terminal.priority = 1
