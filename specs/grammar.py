"""The grammar of missions for lark, and its reserved words."""

from __future__ import annotations

import re
from copy import copy
from functools import cache
from pathlib import Path
from typing import Any, Final, Protocol

from lark import Lark, Token, UnexpectedInput
from lark.lexer import PatternRE, PatternStr, TerminalDef

from bigraphs.notation.parse_tables import parser_with_tables
from semantics.behaviours.commands import COMMAND_WORDS, COMMANDS, Command
from semantics.behaviours.observations import QueryOperator
from semantics.properties.kinds import RequestMode, asked_by
from specs.build_behaviour import BuildBehaviour
from specs.build_world import BuildWorld
from specs.syntax import Mission

NAMED_PROPERTIES: Final = asked_by(RequestMode.BY_DEFAULT, RequestMode.BY_NAME, RequestMode.OF_TIMED_MISSIONS)
"""The properties that a mission requests by their names."""


@cache
def grammar_text() -> str:
    """Return the grammar of mission.lark, with the query operators, the commands and the named properties."""
    text = Path(__file__).with_name("mission.lark").read_text(encoding="utf-8")
    text = text.replace("RELATIONS_OF_HOST", " | ".join(f'"{word}_HOST"' for word in QueryOperator))
    text = text.replace("RELATIONS", " | ".join(f'"{word}"' for word in QueryOperator))
    text = text.replace("STANDARD", " | ".join(f'"{kind}"' for kind in NAMED_PROPERTIES))
    text = text.replace("COMMAND_NAMES", " | ".join(f'"{name}"' for name in COMMANDS))
    return text.replace("COMMANDS", "\n       | ".join(map(_rule, COMMANDS.values())))


def _rule(command: Command) -> str:
    """Return the grammar rule of a command."""
    parts = (f'"{part}"' if part in command.words else "expression" for part in command.parts)
    return " ".join([*parts, *(["[via]"] if command.travels else [])])


def first_words(rule: str) -> frozenset[str]:
    """Return the words of the language with which the alternatives of a rule begin, or may begin."""
    (alternatives,) = re.findall(rf"^{rule}:(.+(?:\n +.+)*)", grammar_text(), re.MULTILINE)
    names = "|".join(re.findall(r"\w+", alternatives))
    return frozenset(re.findall(rf'^(?:{names}): \[?"(\w+)"', grammar_text(), re.MULTILINE))


STATEMENTS: Final = first_words("_statement")
PROPERTY_WORDS: Final = frozenset([*first_words("_property"), "ltl", "ctl", *map(str, NAMED_PROPERTIES)])
SECTIONS: Final = first_words("_declaration") - STATEMENTS | {"mission"}
OPERATION_WORDS: Final = frozenset(["in", "not", "and", "or", "of", "true", "false", "HOST", "SELF"])
QUERY_WORDS: Final = frozenset(["ALL", *QueryOperator, *(f"{word}_HOST" for word in QueryOperator)])
RESERVED: Final = (
    SECTIONS
    | STATEMENTS
    | OPERATION_WORDS
    | QUERY_WORDS
    | COMMAND_WORDS
    | frozenset(["case", "after", "else", "hosted_at", "with_behavior", "to", "at", "says", "someone"])
)


class Build(BuildWorld, BuildBehaviour):
    """Both halves of the builder."""


TABLES: Final = Path(__file__).with_name("mission.tables.json")


@cache
def grammar() -> Lark:
    """Return the parser, which builds the syntax tree while it parses, so that depth costs no recursion."""
    made_from = grammar_text() + Path(__file__).read_text(encoding="utf-8")
    return parser_with_tables(TABLES, made_from, make_parser, callbacks())


def make_parser() -> Lark:
    """Return a parser with newly computed tables."""
    return Lark(
        grammar_text(),
        parser="lalr",
        lexer="contextual",
        start="mission",
        keep_all_tokens=True,
        maybe_placeholders=True,
        edit_terminals=_match_whole_words,
        **callbacks(),
    )


def callbacks() -> dict[str, Any]:
    """Return the parser's options with functions: those that build the tree, and those that classify words."""
    return {"transformer": Build(), "lexer_callbacks": {"NAME": _no_reserved, "CHANNEL": _no_reserved}}


def _no_reserved(word: Token) -> Token:
    """Reclassify a reserved word; patterns that exclude those words would be compiled again for each parser state."""
    return word.update(type="RESERVED") if word in RESERVED else word


class ParserRun(Protocol):
    """A parse under way: the used part of lark's interactive parser, typed.

    Attributes:
        parser_state: The stacks of states and values.
        lexer_thread: The position of the parse in the text.
    """

    parser_state: Any
    lexer_thread: Any

    def feed_token(self, token: Token) -> Mission | None:
        """Parse one more word; return the mission at its end."""

    def accepts(self) -> set[str]:
        """Return the grammar's names of the words that may come next."""

    def copy(self, deepcopy_values: bool = True) -> ParserRun:
        """Return an independent copy of the parse."""


def start(text: str) -> ParserRun:
    """Begin to parse a prepared text."""
    run: ParserRun = grammar().parse_interactive(text)
    return run


@cache
def spellings() -> dict[str, str]:
    """Return the spelling of each terminal of the grammar that is one word or symbol; empty for the others."""
    return {
        terminal.name: terminal.pattern.value.removesuffix(_WORD_END)
        if isinstance(terminal.pattern, PatternStr) or terminal.pattern.value.endswith(_WORD_END)
        else ""
        for terminal in grammar().terminals
    }


@cache
def terminals() -> dict[str, str]:
    """Return the terminal's name of each word and sign."""
    return {word: name for name, word in spellings().items() if word}


def terminal(word: str) -> str:
    """Return the terminal's name of a word or sign."""
    return terminals()[word]


def may_follow(run: ParserRun, *sorts: str) -> bool:
    """Return whether words of these sorts may come next, in this order; nothing is built of them."""
    trial = run.copy(deepcopy_values=False)
    trial.parser_state.parse_conf = copy(trial.parser_state.parse_conf)
    trial.parser_state.parse_conf.callbacks = {}
    try:
        for sort in sorts:
            trial.feed_token(Token(sort, ""))
    except UnexpectedInput:
        return False
    return True


@cache
def keywords() -> frozenset[str]:
    """Return all words of the language."""
    return frozenset(word for word in spellings().values() if re.fullmatch(r"\w\w+", word))


_WORD_END: Final = r"(?!\w)"


def _match_whole_words(terminal: TerminalDef) -> None:
    """Make a keyword match only as a whole word, before any name; lark would match the `let` of `letter`."""
    if isinstance(terminal.pattern, PatternStr) and re.fullmatch(r"\w+", terminal.pattern.value):
        terminal.pattern = PatternRE(terminal.pattern.value + _WORD_END)
        terminal.priority = 2
    elif terminal.name == "DROPPING":
        terminal.priority = 1
