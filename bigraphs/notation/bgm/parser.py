"""Parse `.bgm` files. `|` binds more tightly than `||`, as in BigMC's manual; `%check` ends a file."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Final

from lark import Lark, Token, v_args
from lark.exceptions import VisitError
from lark.tree import Meta
from lark.visitors import Transformer_NonRecursive

from bigraphs.errors import NotationError
from bigraphs.notation.bgm import syntax
from bigraphs.notation.bgm.syntax import Line, Query, Term, Wide
from bigraphs.notation.reading import read

GRAMMAR: Final = r"""
file: [line] (";" [line])*
?line: control | name | rule | property | term
control: STATUS IDENT ":" INT
name: NAMING IDENT
rule: ["%rule" IDENT] wide "->" wide
property: "%property" IDENT query
term: wide
wide: parallel ("||" parallel)*
parallel: element ("|" element)*
?element: prefix | hole | NIL -> nil | "(" parallel ")"
prefix: IDENT ["[" port ("," port)* "]"] ["." element]
port: IDENT | UNLINKED
hole: "$" INT

?query: both ("||" both)* -> either
?both: compared ("&&" compared)* -> both
?compared: atom | atom COMPARISON atom -> compared
?atom: "(" query ")" | ask | scoped | "!" compared -> negated | INT -> count
    | "if" query "then" query "else" query -> choice
ask: PREDICATE "(" [wide] ")"
scoped: SCOPE "->" atom

STATUS: "%active" | "%passive"
NAMING: "%outer" | "%name" | "%inner"
COMPARISON: "==" | "!=" | "<=" | ">=" | "<" | ">"
PREDICATE: "matches" | "equal" | "empty" | "size" | "terminal"
SCOPE: "$this" | "$pred" | "$succ" | "$terminal"
NIL.2: /nil(?![A-Za-z0-9_])/
IDENT: /[A-Za-z][A-Za-z0-9_']*/
INT: /[0-9]{1,9}/
UNLINKED: "-"
COMMENT: /#[^\n]*/
%ignore COMMENT
%ignore /[ \t\r\n\f]+/
"""
_WORDS: Final = {
    "IDENT": "a name",
    "INT": "a number",
    "STATUS": "'%active' or '%passive'",
    "NAMING": "'%outer'",
    "COMPARISON": "a comparison",
    "PREDICATE": "'matches', 'equal', 'empty', 'size' or 'terminal'",
    "SCOPE": "'$this', '$pred', '$succ' or '$terminal'",
    "NIL": "'nil'",
    "UNLINKED": "'-'",
    "SEMICOLON": "';'",
    "COLON": "':'",
    "LPAR": "'('",
    "RPAR": "')'",
    "LSQB": "'['",
    "RSQB": "']'",
    "COMMA": "','",
    "DOT": "'.'",
    "VBAR": "'|'",
    "DOLLAR": "'$'",
    "BANG": "'!'",
    "$END": "the end",
}
_CHECK: Final = re.compile(r"^(?P<code>[^#\n]*)%check\b.*", re.DOTALL | re.MULTILINE)
_NAMED: Final = re.compile(r"(?P<name>\b[A-Za-z]\w*)\s*(?P<colon>:)\s*(?P<meant>[A-Za-z]\w*)")
MAX_QUERY: Final = 50


def parse_bgm(text: str) -> tuple[Line, ...]:
    """Parse a `.bgm` file up to `%check`; raises NotationError at the first thing that does not fit."""
    ends = _CHECK.search(text)
    kept = text if ends is None else text[: ends.end("code")]
    try:
        tree = read(_parser(), kept, _WORDS, "file")
    except NotationError as error:
        raise _named_apart(error, kept) or error from None
    try:
        lines: tuple[Line, ...] = _Build(text).transform(tree)
    except VisitError as error:
        raise error.orig_exc from None
    return lines


def _named_apart(error: NotationError, text: str) -> NotationError | None:
    """Return what to say of the dialect that names nodes and ports, `a:Ctrl[p:x]`; None for anything else."""
    for named in _NAMED.finditer(text):
        if named.start("colon") == error.offset:
            name, meant = named["name"], named["meant"]
            port = text.rfind("[", 0, error.offset) > text.rfind("]", 0, error.offset)
            message = (
                f"'{name}:{meant}' names a {'port' if port else 'node'}, as another dialect of .bgm does"
            )
            hint = f"write the link alone, '{meant}'" if port else f"write '{meant}', or '{name}_{meant}'"
            return NotationError("syntax", message, text, named.start(), length=len(named.group()), hint=hint)
    return None


@cache
def _parser() -> Lark:
    return Lark(GRAMMAR, parser="lalr", start=["file"], propagate_positions=True, maybe_placeholders=True)


def _at(meta: Meta) -> int:
    return 0 if meta.empty else meta.start_pos


@v_args(inline=True, meta=True)
class _Build(Transformer_NonRecursive[Token, Any]):
    """From lark's trees to syntax, without recursion."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text

    def file(self, _meta: Meta, *lines: Line | None) -> tuple[Line, ...]:
        return tuple(line for line in lines if line is not None)

    def control(self, _meta: Meta, status: Token, name: Token, arity: Token) -> syntax.ControlLine:
        active = status == "%active"
        return syntax.ControlLine(
            str(name), int(arity), "active" if active else "passive", name.start_pos or 0
        )

    def name(self, _meta: Meta, word: Token, name: Token) -> syntax.NameLine:
        return syntax.NameLine(str(name), word == "%inner", name.start_pos or 0)

    def rule(self, meta: Meta, name: Token | None, redex: Wide, reactum: Wide) -> syntax.RuleLine:
        return syntax.RuleLine(redex, reactum, None if name is None else str(name), _at(meta))

    def property(self, _meta: Meta, name: Token, query: Query) -> syntax.PropertyLine:
        return syntax.PropertyLine(str(name), query, name.start_pos or 0)

    def term(self, meta: Meta, wide: Wide) -> syntax.ModelLine:
        return syntax.ModelLine(wide, _at(meta))

    def wide(self, _meta: Meta, *terms: Term) -> Wide:
        return terms

    def parallel(self, _meta: Meta, *elements: Any) -> Term:
        return tuple(term for element in elements for term in _several(element))

    def nil(self, _meta: Meta, _word: Token) -> Term:
        return ()

    def prefix(self, _meta: Meta, control: Token, *rest: Any) -> syntax.Prefix:
        *ports, inside = rest
        names = tuple(port.name for port in ports if port is not None)
        within = () if inside is None else _several(inside)
        return syntax.Prefix(str(control), names, within, control.start_pos or 0)

    def port(self, _meta: Meta, name: Token) -> _Port:
        return _Port(None if name == "-" else str(name))

    def hole(self, meta: Meta, index: Token) -> syntax.Hole:
        return syntax.Hole(int(index), _at(meta))

    def either(self, meta: Meta, *operands: Query) -> Query:
        return self.operation("||", operands, meta)

    def both(self, meta: Meta, *operands: Query) -> Query:
        return self.operation("&&", operands, meta)

    def operation(self, symbol: str, operands: tuple[Query, ...], meta: Meta) -> Query:
        return operands[0] if len(operands) == 1 else syntax.Operation(symbol, operands, _at(meta))

    def compared(self, meta: Meta, left: Query, symbol: Token, right: Query) -> Query:
        return syntax.Operation(str(symbol), (left, right), _at(meta))

    def negated(self, meta: Meta, operand: Query) -> Query:
        return self.nested(syntax.Operation("!", (operand,), _at(meta)))

    def choice(self, meta: Meta, condition: Query, then: Query, otherwise: Query) -> Query:
        return self.nested(syntax.Operation("if", (condition, then, otherwise), _at(meta)))

    def nested(self, query: Query) -> Query:
        """Refuse what would nest too deeply to be walked."""
        depth, inner = 0, [query]
        while inner:
            depth += 1
            if depth > MAX_QUERY:
                message = f"properties nest deeper than {MAX_QUERY}"
                raise NotationError("too-deep", message, self.text, query.offset)
            inner = [each for outer in inner for each in _parts(outer)]
        return query

    def ask(self, meta: Meta, predicate: Token, term: Wide | None) -> syntax.Ask:
        return syntax.Ask(str(predicate), term, None, _at(meta))

    def scoped(self, meta: Meta, scope: Token, operand: Query) -> Query:
        named = str(scope[1:])
        if isinstance(operand, syntax.Ask) and operand.scope is None:
            return syntax.Ask(operand.predicate, operand.term, named, _at(meta))
        return self.nested(syntax.Scoped(named, operand, _at(meta)))

    def count(self, meta: Meta, number: Token) -> syntax.Count:
        return syntax.Count(int(number), _at(meta))


def _parts(query: Query) -> tuple[Query, ...]:
    match query:
        case syntax.Operation(_, operands):
            return operands
        case syntax.Scoped(_, operand):
            return (operand,)
        case _:
            return ()


class _Port:
    """The name on a port; None is one too."""

    def __init__(self, name: str | None) -> None:
        self.name = name


def _several(element: Any) -> Term:
    return element if isinstance(element, tuple) else (element,)
