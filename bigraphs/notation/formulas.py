"""The grammar of temporal formulas about systems of bigraphs.

It has the operators and priorities of `specs/mission.lark`. Its atoms are labels of predicates and rules; a label that
is a word of the language is quoted.
"""

import re
from dataclasses import dataclass
from functools import cache
from typing import Final

from lark import Lark, Token
from lark.tree import Meta
from lark.visitors import Transformer_NonRecursive

from bigraphs.errors import NotationError
from bigraphs.notation.bounded_parsing import read

MOST_WORDS: Final = 200
"""The largest number of words and signs in a formula."""

GRAMMAR: Final = r"""
?asked: formula
      | _UNDER fairness (_AND fairness)* ":" formula -> under
fairness: STRENGTH "fairness" "of" LABEL ("," LABEL)*

?formula: equivalence
        | equivalence LEADS equivalence -> leads_to
?equivalence: implication
            | equivalence "<->" implication -> equivalent
?implication: either
            | either "->" implication -> implies
?either: both
       | either _OR both -> either
?both: path
     | both _AND path -> both
?path: denial
     | denial OPERATION path -> operation
?denial: claim
       | _NOT denial -> denied
       | PREFIX denial -> prefix
       | FAR_PREFIX formula -> prefix
       | QUANTIFIER denial -> quantified
?claim: TRUTH -> truth
      | LABEL -> predicate
      | "taken" LABEL -> taken
      | "enabled" LABEL -> enabled
      | "(" formula ")"

LEADS: /leads\s+to(?!\w)/
_OR: "||" | /or(?!\w)/
_AND: "&&" | /and(?!\w)/
_NOT: "!" | /not(?!\w)/
OPERATION: /(?:[URW]|until)(?!\w)/
PREFIX: "[]" | "<>" | /[GFX](?!\w)/
FAR_PREFIX: /(?:always|eventually|next|infinitely\s+often)(?!\w)/
QUANTIFIER: /[AE][GFX]?(?!\w)/
_UNDER: /under(?!\w)/
STRENGTH: /(?:weak|strong)(?!\w)/
TRUTH: /(?:true|false)(?!\w)/
LABEL: /(?!(?:RESERVED)(?![\w']))[^\W\d][\w']*(?:\((?:[^()"]|"[^"]*")*\))?|"[^"]+"/
%ignore /\s+/
""".replace(
    "RESERVED",
    "under|leads|or|and|not|until|always|eventually|next|infinitely|true|false|taken|enabled|[URWGFX]|[AE][GFX]?",
)
_WORD: Final = re.compile(r"\w+|\[\]|<>|[^\w\s]")
_WORDS: Final = {
    "LABEL": "a predicate",
    "TRUTH": "'true'",
    "PREFIX": "'[]'",
    "QUANTIFIER": "'A' or 'E'",
    "OPERATION": "'U'",
    "LEADS": "'leads to'",
    "_OR": "'or'",
    "_AND": "'and'",
    "_NOT": "'not'",
    "LPAR": "'('",
    "RPAR": "')'",
    "TAKEN": "'taken'",
    "_UNDER": "'under'",
    "STRENGTH": "'weak' or 'strong'",
    "FAIRNESS": "'fairness'",
    "OF": "'of'",
    "COLON": "':'",
    "COMMA": "','",
    "$END": "the end",
}


@dataclass(frozen=True, slots=True)
class FormulaWord:
    """A word or sign of a formula, with its offset in the text."""

    text: str
    start: int

    @property
    def end(self) -> int:
        """Return the offset after the word."""
        return self.start + len(self.text)


@dataclass(frozen=True, slots=True)
class Term:
    """A formula as written: `kind` is its rule of the grammar; `start` and `end` are its offsets in the text."""

    kind: str
    parts: "tuple[Term | FormulaWord, ...]"
    start: int
    end: int


def parse_formula(text: str) -> Term:
    """Return a formula as written, with its fairness; raises NotationError for a syntax error or excessive length."""
    if sum(1 for _ in _WORD.finditer(text)) > MOST_WORDS:
        message = f"a formula of more than {MOST_WORDS} words and signs"
        raise NotationError("too-long", message, text, 0, hint="check its parts one by one")
    term: Term = _Build().transform(read(_parser(), text, _WORDS, "asked"))
    return term


@cache
def _parser() -> Lark:
    return Lark(GRAMMAR, parser="lalr", start=["asked"], propagate_positions=True)


class _Build(Transformer_NonRecursive[Token, Term]):
    """Turns lark's trees into terms."""

    def __default__(self, data: str, children: list[Term | Token], meta: Meta) -> Term:
        parts = (
            FormulaWord(str(each), each.start_pos or 0) if isinstance(each, Token) else each
            for each in children
        )
        return Term(str(data), tuple(parts), meta.start_pos, meta.end_pos)
