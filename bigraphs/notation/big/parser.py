"""Parse `.big` files and single expressions."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any, Final

from lark import Lark, Token, Tree

from bigraphs.errors import NotationError
from bigraphs.notation.big.build import Build
from bigraphs.notation.big.declarations import Model
from bigraphs.notation.big.grammar import GRAMMAR, WORDS
from bigraphs.notation.big.syntax import Expression
from bigraphs.notation.parse_tables import parser_with_tables
from bigraphs.notation.reading import read

TABLES: Final = Path(__file__).with_name("big.tables.json")
_GUARD: Final = re.compile(r"\[(?P<name>[a-z_][A-Za-z0-9_']*), *(?P<guard>[^\]\n]*\$[^\]\n]*)\]")
OPTIONS: Final[dict[str, Any]] = {
    "parser": "lalr",
    "start": ["model", "expression"],
    "propagate_positions": True,
    "maybe_placeholders": True,
}


def parse_model(text: str) -> Model:
    """Parse a `.big` file; raises NotationError at the first thing that does not fit."""
    try:
        tree = read(parser(), text, WORDS, "model")
    except NotationError as error:
        raise _guarded(error, text) or error from None
    model: Model = _build(tree, text)
    return model


def _guarded(error: NotationError, text: str) -> NotationError | None:
    """Return what to say of a number with a guard, `K([n, $ >= 0])`, which BigraphER does not have either."""
    found = _GUARD.match(text, error.offset)
    if found is None:
        return None
    name, guard = found["name"], found["guard"]
    message = f"'{found.group()}' guards a number, as no published BigraphER does"
    hint = f"write '{name}' in 'fun react r({name})', and list in the system the values that '{guard}' admits"
    return NotationError("syntax", message, text, found.start(), length=len(found.group()), hint=hint)


def parse_expression(text: str) -> Expression:
    """Parse one expression; raises NotationError at the first thing that does not fit.

    >>> parse_expression("K{x}.id(2)").inside
    Identity(width=2, names=(), span=Span(start=5, end=10))
    """
    expression: Expression = _build(read(parser(), text, WORDS, "expression"), text)
    return expression


@cache
def parser() -> Lark:
    """Return the parser."""
    return parser_with_tables(TABLES, f"{GRAMMAR}{OPTIONS}", make_parser, {})


def make_parser() -> Lark:
    """Return the parser, its tables made anew."""
    return Lark(GRAMMAR, **OPTIONS)


def _build(tree: Tree[Token], text: str) -> Any:
    build = Build(text)
    found = build.transform(tree)
    if build.mistakes:
        raise NotationError.of(build.mistakes)
    return found
