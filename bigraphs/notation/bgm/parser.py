"""The parser of `.bgm` files. `|` binds more tightly than `||`, as in BigMC's manual; `%check` ends a file."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from bigraphs.errors import NotationError
from bigraphs.notation.bgm import syntax
from bigraphs.notation.bgm.syntax import Line, Query, Term, Wide
from bigraphs.notation.bounded_parsing import read_into
from bigraphs.notation.lalr import Span, Tables, Token, kept_tables
from bigraphs.notation.spelling import did_you_mean

if TYPE_CHECKING:
    from lark import Lark

TABLES: Final = Path(__file__).with_name("bgm.tables.json")

GRAMMAR: Final = r"""
file: [line] (";" [line])*
?line: control | name | rule | property | term
control: STATUS IDENT ":" INT
name: NAMING IDENT
rule: ["%rule" IDENT] wide "->" wide ["{" "}"]
property: "%property" IDENT query
term: ["%agent"] wide
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
NAMING: "%outername" | "%outer" | "%innername" | "%inner" | "%name"
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
    "LBRACE": "'{'",
    "RBRACE": "'}'",
    "BANG": "'!'",
    "$END": "the end",
}
_CHECK: Final = re.compile(r"^(?P<code>[^#\n]*)%check\b.*", re.DOTALL | re.MULTILINE)
_NAMED: Final = re.compile(r"(?P<name>\b[A-Za-z]\w*)\s*(?P<colon>:)\s*(?P<meant>[A-Za-z]\w*)")
_DIRECTIVE: Final = re.compile(r"%[A-Za-z]+")
_LINK_KINDS: Final = frozenset({"outername", "innername", "edge", "binding"})
"""The kinds of link in another dialect, which writes them after the name: `x:edge`."""
_OTHER_WORDS: Final = {
    "%prop": "write '%property NAME matches(TERM)', or another property",
    "%binding": "links are not bound here: leave it out where no node is of this control",
    "%ltlSpec": "leave it out, and ask it of 'bigactors big check --ltl'",
    "%ctlSpec": "leave it out, and ask it of 'bigactors big check --ctl'",
}
"""Words of other dialects, and the replacements to suggest."""
_DIALECT: Final = re.compile(r"^[^#\n]*%(?:agent|outername|innername)\b", re.MULTILINE)
"""Words of a dialect that writes `idle` for an unlinked port."""
MAX_QUERY: Final = 50
OPTIONS: Final[dict[str, Any]] = {
    "parser": "lalr",
    "start": ["file"],
    "propagate_positions": True,
    "maybe_placeholders": True,
}


def parse_bgm(text: str) -> tuple[Line, ...]:
    """Parse a `.bgm` file up to `%check`; raises NotationError at the first syntax error."""
    ends = _CHECK.search(text)
    kept = text if ends is None else text[: ends.end("code")]
    try:
        lines: tuple[Line, ...] = read_into(_Build(text), tables(), make_parser, kept, _WORDS, "file")
    except NotationError as error:
        raise _named_apart(error, kept) or error from None
    return lines


def _named_apart(error: NotationError, text: str) -> NotationError | None:
    """Return a specific error for a construct of another dialect; None for anything else."""
    if word := _DIRECTIVE.match(text, error.offset):
        return _other_word(word.group(), error, text)
    before = text[: error.offset].rstrip()
    if before.endswith("{"):
        message = "a rule has no constraints, which another dialect of .bgm writes in braces"
        return NotationError("syntax", message, text, len(before) - 1, hint="leave them out, with the braces")
    for named in _NAMED.finditer(text):
        if named.start("colon") == error.offset:
            return _colon(named, text)
    return None


def _other_word(word: str, error: NotationError, text: str) -> NotationError | None:
    """Return the error for a word of another dialect or an unknown word; None for a misplaced known word."""
    known = sorted({found.group() for found in _DIRECTIVE.finditer(GRAMMAR)} | {"%check"})
    if word in known:
        return None
    dialect = " is a word of another dialect of .bgm" if word in _OTHER_WORDS else " is no word of .bgm"
    hint = _OTHER_WORDS.get(word) or did_you_mean(word, known) or f"the words are {', '.join(known)}"
    return NotationError("syntax", f"'{word}'{dialect}", text, error.offset, length=len(word), hint=hint)


def _colon(named: re.Match[str], text: str) -> NotationError:
    """Return the error for `a:Ctrl` or `x:edge`."""
    name, meant, at = named["name"], named["meant"], named.start("colon")
    port = text.rfind("[", 0, at) > text.rfind("]", 0, at)
    if port and meant in _LINK_KINDS:
        message = f"'{name}:{meant}' gives the kind of a link, as another dialect of .bgm does"
        hint = f"write the link alone, '{name}'"
    else:
        what = "port" if port else "node"
        message = f"'{name}:{meant}' names a {what}, as another dialect of .bgm does"
        hint = f"write the link alone, '{meant}'" if port else f"write '{meant}', or '{name}_{meant}'"
    return NotationError("syntax", message, text, named.start(), length=len(named.group()), hint=hint)


@cache
def tables() -> Tables:
    """Return the tables of the grammar."""
    return kept_tables(TABLES, f"{GRAMMAR}{OPTIONS}", make_parser)


@cache
def make_parser() -> Lark:
    """Return lark's parser, which explains mistakes and has the tables; its construction is slow."""
    from lark import Lark  # noqa: PLC0415 - lark takes time to load

    return Lark(GRAMMAR, **OPTIONS)


class _Build:
    """Builds syntax while the parser reads."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.unlinked = ("-", "idle") if _DIALECT.search(text) else ("-",)

    def file(self, _at: Span, *lines: Line | None) -> tuple[Line, ...]:
        return tuple(line for line in lines if line is not None)

    def control(self, _at: Span, status: Token, name: Token, arity: Token) -> syntax.ControlLine:
        active = status == "%active"
        return syntax.ControlLine(str(name), int(arity), "active" if active else "passive", name.start)

    def name(self, _at: Span, word: Token, name: Token) -> syntax.NameLine:
        return syntax.NameLine(str(name), word.startswith("%inner"), name.start)

    def rule(self, at: Span, name: Token | None, redex: Wide, reactum: Wide) -> syntax.RuleLine:
        return syntax.RuleLine(redex, reactum, None if name is None else str(name), at.start)

    def property(self, _at: Span, name: Token, query: Query) -> syntax.PropertyLine:
        return syntax.PropertyLine(str(name), query, name.start)

    def term(self, at: Span, wide: Wide) -> syntax.ModelLine:
        return syntax.ModelLine(wide, at.start)

    def wide(self, _at: Span, *terms: Term) -> Wide:
        return terms

    def parallel(self, _at: Span, *elements: Any) -> Term:
        return tuple(term for element in elements for term in _several(element))

    def nil(self, _at: Span, _word: Token) -> Term:
        return ()

    def prefix(self, _at: Span, control: Token, *rest: Any) -> syntax.Prefix:
        *ports, inside = rest
        names = tuple(port.name for port in ports if port is not None)
        within = () if inside is None else _several(inside)
        return syntax.Prefix(str(control), names, within, control.start)

    def port(self, _at: Span, name: Token) -> _Port:
        return _Port(None if name in self.unlinked else str(name))

    def hole(self, at: Span, index: Token) -> syntax.Hole:
        return syntax.Hole(int(index), at.start)

    def either(self, at: Span, *operands: Query) -> Query:
        return self.operation("||", operands, at)

    def both(self, at: Span, *operands: Query) -> Query:
        return self.operation("&&", operands, at)

    def operation(self, symbol: str, operands: tuple[Query, ...], at: Span) -> Query:
        return operands[0] if len(operands) == 1 else syntax.Operation(symbol, operands, at.start)

    def compared(self, at: Span, left: Query, symbol: Token, right: Query) -> Query:
        return syntax.Operation(str(symbol), (left, right), at.start)

    def negated(self, at: Span, operand: Query) -> Query:
        return self.nested(syntax.Operation("!", (operand,), at.start))

    def choice(self, at: Span, condition: Query, then: Query, otherwise: Query) -> Query:
        return self.nested(syntax.Operation("if", (condition, then, otherwise), at.start))

    def nested(self, query: Query) -> Query:
        """Return the query; raise NotationError if it nests too deeply for a recursive walk."""
        depth, inner = 0, [query]
        while inner:
            depth += 1
            if depth > MAX_QUERY:
                message = f"properties nest deeper than {MAX_QUERY}"
                raise NotationError("too-deep", message, self.text, query.offset)
            inner = [each for outer in inner for each in _parts(outer)]
        return query

    def ask(self, at: Span, predicate: Token, term: Wide | None) -> syntax.Ask:
        return syntax.Ask(str(predicate), term, None, at.start)

    def scoped(self, at: Span, scope: Token, operand: Query) -> Query:
        named = str(scope[1:])
        if isinstance(operand, syntax.Ask) and operand.scope is None:
            return syntax.Ask(operand.predicate, operand.term, named, at.start)
        return self.nested(syntax.Scoped(named, operand, at.start))

    def count(self, at: Span, number: Token) -> syntax.Count:
        return syntax.Count(int(number), at.start)


def _parts(query: Query) -> tuple[Query, ...]:
    match query:
        case syntax.Operation(_, operands):
            return operands
        case syntax.Scoped(_, operand):
            return (operand,)
        case _:
            return ()


class _Port:
    """The name on a port, None if unlinked; the wrapper distinguishes it from an absent port."""

    def __init__(self, name: str | None) -> None:
        self.name = name


def _several(element: Any) -> Term:
    return element if isinstance(element, tuple) else (element,)
