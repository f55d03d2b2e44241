"""Docstrings use nouns, and not clauses that begin with "what", "whose" or "who is told"."""

import ast
import re

import pytest
from repository import ROOMS, name_of, parsed, sources

CLAUSES = re.compile(r"\b(what|whatever|whose|whom|whoever|nobody)\b", re.IGNORECASE)
TELLING = re.compile(r"\b(tell|tells|telling|told|say|says|saying|said)\b", re.IGNORECASE)
CODE = re.compile(r"^ *(>>>|\.\.\. ).*|`[^`]*`", re.MULTILINE)

MOST_CLAUSES = 3 / 1_000
MOST_TELLING = 2 / 1_000
"""Of all words; hypothesis and trio have 0.4 and 0.8 in 1,000 of the first, and 0.4 of the second."""

LONGEST = 35
"""The most words of a sentence."""


def docstrings(room):
    """Yield the docstrings of a room, those of constants too, without code."""
    for path in sources([room]):
        for statement in statements(parsed(path)):
            match statement:
                case ast.Expr(ast.Constant(str(text))) if "───" not in text:  # an inference rule
                    yield f"{name_of(path)}:{statement.lineno}", CODE.sub("", text)


def statements(node):
    """Yield the statements in a module, and in its classes and functions: a docstring stands nowhere else."""
    for statement in node.body:
        yield statement
        if isinstance(statement, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield from statements(statement)


@pytest.mark.parametrize("room", ROOMS)
def test_the_docstrings_of_a_room_are_short_sentences_of_plain_words(room):
    words = clauses = telling = 0
    for place, text in docstrings(room):
        words += len(text.split())
        clauses += len(CLAUSES.findall(text))
        telling += len(TELLING.findall(text))
        sentences = re.split(r"[.:;]\s", text)
        assert [each.strip() for each in sentences if len(each.split()) > LONGEST] == [], place
    assert clauses / words <= MOST_CLAUSES
    assert telling / words <= MOST_TELLING
