"""Parse `.big` files and single expressions."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

from lark import Lark, Token, Tree

from bigraphs.errors import NotationError
from bigraphs.notation.big.build import Build
from bigraphs.notation.big.declarations import Model
from bigraphs.notation.big.grammar import GRAMMAR, WORDS
from bigraphs.notation.big.syntax import Expression
from bigraphs.notation.reading import read

_STARTS: Final = ["model", "expression"]


def parse_model(text: str) -> Model:
    """Parse a `.big` file; raises NotationError at the first thing that does not fit."""
    model: Model = _build(read(_parser(), text, WORDS, "model"), text)
    return model


def parse_expression(text: str) -> Expression:
    """Parse one expression; raises NotationError at the first thing that does not fit.

    >>> parse_expression("K{x}.id(2)").inside
    Identity(width=2, names=(), span=Span(start=5, end=10))
    """
    expression: Expression = _build(read(_parser(), text, WORDS, "expression"), text)
    return expression


@cache
def _parser() -> Lark:
    return Lark(GRAMMAR, parser="lalr", start=_STARTS, propagate_positions=True, maybe_placeholders=True)


def _build(tree: Tree[Token], text: str) -> Any:
    build = Build(text)
    found = build.transform(tree)
    if build.mistakes:
        raise NotationError.of(build.mistakes)
    return found
