"""Reading BigraphER's notation: controls, named bigraphs, reactions and one system, or a single expression.

`K{x, y}` is an ion, `K.e` nests, `|` merges, `||` sets side by side and `+` likewise without sharing names,
`*` composes; `|` and `||` bind least, to the left. Each kind of syntax is one class in big_syntax.py and one
method of the builder here, so the rest of the language joins by adding to both and to the grammar.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Final

from lark import Lark, Token, Transformer, v_args

from bigraphs.notation.big_syntax import (
    BigDeclaration,
    Chain,
    Close,
    ControlDeclaration,
    Declaration,
    Expression,
    Identity,
    Ion,
    Model,
    Nest,
    NewNames,
    Number,
    Placed,
    PriorityClass,
    ReactDeclaration,
    Ref,
    Share,
    Substitute,
    System,
    Wired,
)
from bigraphs.notation.reading import read

GRAMMAR: Final = r"""
model: declaration* [system]
?declaration: control | big | react
control: [ATOMIC] "ctrl" CONTROL "=" INT ";"
big: "big" NAME "=" expression ";"
react: "react" NAME "=" expression ("-->" | "->") expression ["@" "[" numbers "]"] ";"
system: "begin" "brs" "init" NAME ";" "rules" "=" "[" classes "]" ";" [predicates] "end"
classes: class ("," class)*
class: "{" names "}" -> ordinary | "(" names ")" -> instantaneous
predicates: "preds" "=" "{" names "}" ";"

?expression: sums (PRODUCT sums)* -> chain
?sums: compositions (PLUS compositions)* -> chain
?compositions: operand (TIMES operand)* -> chain
?operand: simple | wire+ wired_body -> wired | share
!share: "share" simple "by" simple "in" simple
?wired_body: "(" expression ")" | ion | nest | ref
?simple: "(" expression ")" | ion | nest | ref | wire | identity | merge | split | placing | new_names
    | INT -> number
ion: CONTROL ["{" names "}"]
nest: ion "." simple
ref: NAME
?wire: close | close_joined | NAME "/" "{" names "}" -> substitute
!close: "/" NAME
!close_joined: "/" "{" names "}"
!new_names: "{" names "}"
!merge: "merge" ["(" INT ")"]
!split: "split" ["(" INT ")"]
!placing: "(" "[" [sets] "]" "," INT ")"
sets: set ("," set)*
!identity: "id" ["(" INT ")"]
    | "id" inner_names -> identity_of_names
    | "id" "(" INT "," inner_names ")" -> identity_of_both
inner_names: "{" names "}"
set: "{" numbers "}"
names: NAME ("," NAME)*
numbers: [INT ("," INT)*]

ATOMIC: "atomic"
PRODUCT.2: "||" | "|"
PLUS: "+"
TIMES: "*"
CONTROL: /[A-Z][A-Za-z0-9_']*/
NAME: /[a-z_][A-Za-z0-9_']*/
INT: /[0-9]{1,4}/
COMMENT: /#[^\n]*/
%ignore COMMENT
%ignore /[ \t\r\n\f]+/
"""
_WORDS: Final = {
    "NAME": "a name",
    "CONTROL": "a control",
    "INT": "a number",
    "PRODUCT": "'|'",
    "PLUS": "'+'",
    "TIMES": "'*'",
    "SEMICOLON": "';'",
    "EQUAL": "'='",
    "LPAR": "'('",
    "RPAR": "')'",
    "LSQB": "'['",
    "RSQB": "']'",
    "LBRACE": "'{'",
    "RBRACE": "'}'",
    "COMMA": "','",
    "DOT": "'.'",
    "SLASH": "'/'",
    "AT": "'@'",
    "__ANON_0": "'-->'",
    "__ANON_1": "'->'",
    "$END": "the end",
} | {
    word.upper(): f"'{word}'"
    for word in (
        "atomic",
        "ctrl",
        "big",
        "react",
        "begin",
        "brs",
        "init",
        "rules",
        "preds",
        "end",
        "share",
        "by",
        "in",
        "merge",
        "split",
        "id",
    )
}


def parse_model(text: str) -> Model:
    """Parse a `.big` file; raises NotationError at the first thing that does not fit."""
    model: Model = read(_parser(), text, _WORDS, "model")
    return model


def parse_expression(text: str) -> Expression:
    """Parse one expression; raises NotationError at the first thing that does not fit.

    >>> parse_expression("/x K{x}.1")
    Wired(wires=(Close(names=('x',), offset=0),), body=Nest(ion=Ion(control='K', links=('x',), offset=3), \
inside=Number(value=1, offset=8)))
    """
    expression: Expression = read(_parser(), text, _WORDS, "expression")
    return expression


@cache
def _parser() -> Lark:
    start = ["model", "expression"]
    return Lark(GRAMMAR, parser="lalr", start=start, transformer=_Build(), maybe_placeholders=True)


def _at(token: Token) -> int:
    return token.start_pos or 0


@v_args(inline=True)
class _Build(Transformer[Token, Any]):
    """Build syntax while lark reads."""

    def names(self, *names: Token) -> tuple[str, ...]:
        return tuple(map(str, names))

    def numbers(self, *numbers: Token | None) -> tuple[int, ...]:
        return tuple(int(number) for number in numbers if number is not None)

    def inner_names(self, names: tuple[str, ...]) -> tuple[str, ...]:
        return names

    def set(self, numbers: tuple[int, ...]) -> tuple[int, ...]:
        return numbers

    def sets(self, *sets: tuple[int, ...]) -> tuple[tuple[int, ...], ...]:
        return sets

    def ref(self, name: Token) -> Ref:
        return Ref(str(name), _at(name))

    def number(self, number: Token) -> Number:
        return Number(int(number), _at(number))

    def ion(self, control: Token, links: tuple[str, ...] | None) -> Ion:
        return Ion(str(control), links or (), _at(control))

    def nest(self, ion: Ion, inside: Expression) -> Nest:
        return Nest(ion, inside)

    def close(self, slash: Token, name: Token) -> Close:
        return Close((str(name),), _at(slash))

    def close_joined(self, slash: Token, _open: Token, names: tuple[str, ...], _close: Token) -> Close:
        return Close(names, _at(slash))

    def substitute(self, outer: Token, inner: tuple[str, ...]) -> Substitute:
        return Substitute(str(outer), inner, _at(outer))

    def new_names(self, opening: Token, names: tuple[str, ...], _close: Token) -> NewNames:
        return NewNames(names, _at(opening))

    def merge(self, word: Token, *parts: Token | None) -> Placed:
        return Placed(((0,),) * _count(parts, 2), 1, _at(word))

    def split(self, word: Token, *parts: Token | None) -> Placed:
        width = _count(parts, 2)
        return Placed((tuple(range(width)),), width, _at(word))

    def placing(self, opening: Token, *parts: Any) -> Placed:
        sets = next((part for part in parts if isinstance(part, tuple)), ())
        regions = next(int(part) for part in parts if isinstance(part, Token) and part.type == "INT")
        return Placed(sets, regions, _at(opening))

    def identity(self, word: Token, *parts: Token | None) -> Identity:
        return Identity(_count(parts, 1), (), _at(word))

    def identity_of_names(self, word: Token, names: tuple[str, ...]) -> Identity:
        return Identity(0, names, _at(word))

    def identity_of_both(self, word: Token, *parts: Any) -> Identity:
        names = next(part for part in parts if isinstance(part, tuple) and not isinstance(part, Token))
        return Identity(_count(parts, 1), names, _at(word))

    def wired(self, *parts: Any) -> Wired:
        return Wired(parts[:-1], parts[-1])

    def chain(self, first: Expression, *rest: Any) -> Expression:
        pairs = zip(rest[::2], rest[1::2], strict=True)
        return Chain(first, tuple((str(operator), operand) for operator, operand in pairs)) if rest else first

    def share(
        self, word: Token, what: Expression, _by: Token, by: Expression, _in: Token, where: Expression
    ) -> Share:
        return Share(what, by, where, _at(word))

    def control(self, atomic: Token | None, name: Token, arity: Token) -> ControlDeclaration:
        return ControlDeclaration(str(name), int(arity), atomic is not None, _at(name))

    def big(self, name: Token, body: Expression) -> BigDeclaration:
        return BigDeclaration(str(name), body, _at(name))

    def react(
        self, name: Token, redex: Expression, reactum: Expression, instantiation: tuple[int, ...] | None
    ) -> ReactDeclaration:
        return ReactDeclaration(str(name), redex, reactum, instantiation, _at(name))

    def ordinary(self, names: tuple[str, ...]) -> PriorityClass:
        return PriorityClass(names)

    def instantaneous(self, names: tuple[str, ...]) -> PriorityClass:
        return PriorityClass(names, instantaneous=True)

    def classes(self, *classes: PriorityClass) -> tuple[PriorityClass, ...]:
        return classes

    def predicates(self, names: tuple[str, ...]) -> tuple[str, ...]:
        return names

    def system(
        self, init: Token, classes: tuple[PriorityClass, ...], predicates: tuple[str, ...] | None
    ) -> System:
        return System(str(init), classes, predicates or (), _at(init))

    def model(self, *parts: Declaration | System | None) -> Model:
        declarations = tuple(part for part in parts if part is not None and not isinstance(part, System))
        return Model(declarations, next((part for part in parts if isinstance(part, System)), None))


def _count(parts: tuple[Any, ...], default: int) -> int:
    return next((int(part) for part in parts if isinstance(part, Token) and part.type == "INT"), default)
