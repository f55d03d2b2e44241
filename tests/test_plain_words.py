"""Docstrings use nouns, and not clauses that begin with "what", "whose" or "who is told"."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ROOMS = ("adapters", "bigactors", "bigraphs", "checker", "physical", "semantics", "specs")

CLAUSES = re.compile(r"\b(what|whatever|whose|whom|whoever|nobody)\b", re.IGNORECASE)
TELLING = re.compile(r"\b(tell|tells|telling|told|say|says|saying|said)\b", re.IGNORECASE)
CODE = re.compile(r"^ *(>>>|\.\.\. ).*|`[^`]*`", re.MULTILINE)

MOST_CLAUSES = 3.0
MOST_TELLING = 2.0
"""In 1,000 words; hypothesis and trio have 0.4 and 0.8 of the first, and 0.4 of the second."""

LONGEST = 35
"""The most words of a sentence."""


def docstrings(room):
    """Yield the docstrings of a room, those of constants too, without code."""
    for path in sorted((ROOT / room).rglob("*.py")):
        if "node_modules" in path.parts:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            body = getattr(node, "body", None)
            for statement in body if isinstance(body, list) else ():
                match statement:
                    case ast.Expr(ast.Constant(str(text))) if "───" not in text:  # an inference rule
                        yield f"{path.relative_to(ROOT)}:{statement.lineno}", CODE.sub("", text)


@pytest.mark.parametrize("room", ROOMS)
def test_the_docstrings_of_a_room_are_in_plain_words(room):
    texts = [text for _, text in docstrings(room)]
    thousands = sum(len(text.split()) for text in texts) / 1000
    assert sum(len(CLAUSES.findall(text)) for text in texts) / thousands <= MOST_CLAUSES
    assert sum(len(TELLING.findall(text)) for text in texts) / thousands <= MOST_TELLING


@pytest.mark.parametrize("room", ROOMS)
def test_the_sentences_of_docstrings_are_short(room):
    long = [
        f"{place}: {sentence.strip()}"
        for place, text in docstrings(room)
        for sentence in re.split(r"[.:;]\s", text)
        if len(sentence.split()) > LONGEST
    ]
    assert long == []
