"""The parser of `.big` files and single expressions."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from bigraphs.errors import NotationError
from bigraphs.notation.big.build_syntax import Build
from bigraphs.notation.big.declarations import Model
from bigraphs.notation.big.grammar import GRAMMAR, WORDS
from bigraphs.notation.big.syntax import Expression
from bigraphs.notation.bounded_parsing import read_into
from bigraphs.notation.lalr import Tables, kept_tables

if TYPE_CHECKING:
    from lark import Lark

TABLES: Final = Path(__file__).with_name("big.tables.json")
_GUARD: Final = re.compile(r"\[(?P<name>[a-z_][A-Za-z0-9_']*), *(?P<guard>[^\]\n]*\$[^\]\n]*)\]")
OPTIONS: Final[dict[str, Any]] = {
    "parser": "lalr",
    "start": ["model", "expression"],
    "propagate_positions": True,
    "maybe_placeholders": True,
}


def parse_model(text: str) -> Model:
    """Parse a `.big` file; raises NotationError at the first syntax error."""
    try:
        model: Model = _read(text, "model")
    except NotationError as error:
        raise _guarded(error, text) or error from None
    return model


def _guarded(error: NotationError, text: str) -> NotationError | None:
    """Return the error for a guarded number, `K([n, $ >= 0])`, which BigraphER does not support either."""
    found = _GUARD.match(text, error.offset)
    if found is None:
        return None
    name, guard = found["name"], found["guard"]
    message = f"'{found.group()}' guards a number, as no published BigraphER does"
    hint = f"write '{name}' in 'fun react r({name})', and list in the system the values that '{guard}' admits"
    return NotationError("syntax", message, text, found.start(), length=len(found.group()), hint=hint)


def parse_expression(text: str) -> Expression:
    """Parse one expression; raises NotationError at the first syntax error.

    >>> parse_expression("K{x}.id(2)").inside
    Identity(width=2, names=(), span=Span(start=5, end=10))
    """
    expression: Expression = _read(text, "expression")
    return expression


def _read(text: str, start: str) -> Any:
    build = Build(text)
    found = read_into(build, tables(), make_parser, text, WORDS, start)
    if build.mistakes:
        raise NotationError.of(build.mistakes)
    return found


@cache
def tables() -> Tables:
    """Return the tables of the grammar."""
    return kept_tables(TABLES, f"{GRAMMAR}{OPTIONS}", make_parser)


@cache
def make_parser() -> Lark:
    """Return lark's parser, which explains mistakes and has the tables; its construction is slow."""
    from lark import Lark  # noqa: PLC0415 - lark takes time to load

    return Lark(GRAMMAR, **OPTIONS)
