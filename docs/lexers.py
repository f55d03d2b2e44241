"""How the site colours the languages of these pages: their keywords are the words that a grammar names in quotes."""

import re
from typing import ClassVar

from pygments.lexer import RegexLexer, words
from pygments.token import Comment, Keyword, Number, Operator, String, Text

from bigraphs.notation.big.grammar import GRAMMAR
from specs.grammar import grammar_text


def lexer(grammar: str, comment: str) -> type[RegexLexer]:
    """Return the lexer of a language."""
    keywords = sorted(set(re.findall(r'"([A-Za-z_]+)"', grammar)))

    class Lexer(RegexLexer):
        tokens: ClassVar = {
            "root": [
                (comment, Comment),
                (r'"(\\.|[^"\\])*"', String),
                (words(keywords, r"\b", r"\b"), Keyword),
                (r"\d+(\.\d+)?", Number),
                (r"\w+|\s+", Text),
                (r".", Operator),
            ]
        }

    return Lexer


LEXERS = {
    "big": lexer(GRAMMAR, r"#.*"),
    "ebnf": lexer('"NAME" "STRING" "NUMBER" "CHANNEL"', r"//.*"),
    "mission": lexer(grammar_text(), r"(//|#).*"),
}
