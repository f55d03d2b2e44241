"""The grammar of `.big` files, and its symbols in the user's words.

Operators on bigraphs associate to the left: `|` and `||` bind least and equally, then `+`, then `*`. Closures and
substitutions bind to the following ion, name or parenthesis. Of the operators on numbers, `+` and `-` bind least, then
`*` and `/`, then the sign, then `^`, which associates to the right.
"""

from __future__ import annotations

from typing import Final

GRAMMAR: Final = r"""
model: declaration* [system]
?declaration: control | constant | big | fun_big | react | fun_react | action | sort | place | link

control: modifier* "ctrl" CONTROL "=" INT ";"
    | modifier* "fun" modifier* "ctrl" CONTROL "(" names ")" "=" INT ";" -> fun_control
!modifier: "atomic" | "passive" | "ordered"
constant: TYPE NAME "=" value ";"
big: "big" NAME [arguments] "=" expression ";"
fun_big: "fun" "big" NAME "(" names ")" "=" expression ";"
react: "react" NAME [arguments] "=" change ";"
fun_react: "fun" "react" NAME "(" names ")" "=" change ";"
change: expression arrow expression ["@" "[" numbers "]"] ["if" conditions]
arrow: ARROW -> plain | LARROW value RARROW -> weighted
conditions: [condition ("," condition)*]
condition: [BANG] expression "in" WHERE
action: "action" NAME ["[" value "]"] (react | fun_react)+ "end"
sort: "sort" CONTROL "=" controls ";"
place: "place" CONTROL "=" controls ";"
controls: "{" [CONTROL ("," CONTROL)*] "}"
link: "link" NAME "=" "{" port ("," port)* "}" ";"
port: CONTROL ["." INT]

system: "begin" KIND parameter* init "rules" "=" "[" classes "]" ";" [actions] [predicates] "end"
parameter: TYPE names "=" value ";" -> single
    | TYPE names "=" "{" values "}" ";" -> several
    | TYPE names "=" "[" value ":" value ":" value "]" ";" -> range
init: "init" call ";"
classes: [class ("," class)*]
class: "{" calls "}" -> ordinary | "(" calls ")" -> instantaneous
calls: call ("," call)*
call: NAME [arguments]
actions: "actions" "=" "[" listed_action ("," listed_action)* "]" ";"
listed_action: NAME ["[" value "]"] "=" "{" names "}"
predicates: "preds" "=" "{" predicate ("," predicate)* "}" ";"
predicate: NAME [arguments] ["[" value "]"]

arguments: "(" values ")"
values: value ("," value)*
?value: product (SIGN product)* -> arithmetic
?product: signed (FACTOR signed)* -> arithmetic
?signed: power | MINUS signed -> negated
?power: primary | primary CARET signed -> raised
?primary: NUMBER -> number_value | STRING -> string_value | NAME -> variable | "(" value ")"
    | "abs" "(" value ")" -> absolute

?expression: sums (PRODUCT sums)* -> chain
?sums: compositions (PLUS compositions)* -> chain
?compositions: operand (STAR operand)* -> chain
?operand: simple | wire+ wired_body -> wired | share
?wired_body: "(" expression ")" | ion | nest | ref | share
share: "share" simple "by" simple "in" simple
?simple: "(" expression ")" | "(" expression ")" "(" expression ")" -> applied
    | ion | nest | ref | wire | identity | merge | split | placing | new_names | repeat
    | INT -> number
ion: CONTROL [arguments] ["{" names "}"]
nest: ion "." simple
ref: NAME [arguments]
?wire: "/" NAME -> close | "/" "{" names "}" -> close_joined | NAME "/" "{" names "}" -> substitute
new_names: "{" names "}"
merge: "merge" ["(" INT ")"]
split: "split" ["(" INT ")"]
placing: "(" "[" [set ("," set)*] "]" "," INT ")"
set: "{" numbers "}"
identity: "id" ["(" INT ")"]
    | "id" "{" names "}" -> identity_of_names
    | "id" "(" INT "," "{" names "}" ")" -> identity_of_both
repeat: OPERATOR "(" value "," expression ")"
names: NAME ("," NAME)*
numbers: [INT ("," INT)*]

ARROW: "-->" | "->"
LARROW: "-["
RARROW: "]->"
BANG: "!"
TYPE: "int" | "float" | "string"
KIND: "brs" | "pbrs" | "sbrs" | "nbrs" | "abrs"
WHERE: "ctx" | "param"
OPERATOR.2: /p?par(?![A-Za-z0-9_'])/
PRODUCT.2: "||" | "|"
PLUS: "+"
STAR: "*"
SIGN: "+" | "-"
FACTOR: "*" | "/"
MINUS: "-"
CARET: "^"
CONTROL: /[A-Z][A-Za-z0-9_']*/
NAME: /[a-z_][A-Za-z0-9_']*/
INT: /[0-9][0-9_]*/
NUMBER.2: /inf\b|[0-9][0-9_]*(\.[0-9_]*)?([eE][+-]?[0-9][0-9_]*)?/
STRING: /"[A-Za-z0-9_' .:\/-]*"/
COMMENT: /#[^\n]*/
%ignore COMMENT
%ignore /[ \t\r\n\f]+/
"""

_LANGUAGE: Final = """
ctrl atomic big react init int float string fun action begin brs pbrs sbrs nbrs abrs abs end rules preds share by in id
merge split par ppar if ctx param
"""
RESERVED: Final = frozenset(_LANGUAGE.split())
"""The reserved words, as in BigraphER."""

WORDS: Final = {
    "NAME": "a name",
    "CONTROL": "a control",
    "INT": "a number",
    "NUMBER": "a number",
    "STRING": "a string",
    "PRODUCT": "'|'",
    "PLUS": "'+'",
    "STAR": "'*'",
    "SIGN": "'+'",
    "FACTOR": "'*'",
    "MINUS": "'-'",
    "CARET": "'^'",
    "ARROW": "'-->'",
    "LARROW": "'-['",
    "RARROW": "']->'",
    "BANG": "'!'",
    "TYPE": "a type",
    "KIND": "'brs', 'pbrs', 'sbrs', 'nbrs' or 'abrs'",
    "WHERE": "'ctx' or 'param'",
    "OPERATOR": "'par'",
    "SEMICOLON": "';'",
    "COLON": "':'",
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
    "$END": "the end",
} | {
    word.upper(): f"'{word}'"
    for word in (RESERVED | {"actions", "passive", "ordered", "sort", "place", "link"})
    - {"int", "float", "string", "brs", "pbrs", "sbrs", "nbrs", "abrs", "ctx", "param", "par", "ppar"}
}
