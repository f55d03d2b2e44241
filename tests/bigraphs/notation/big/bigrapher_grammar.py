"""What BigraphER 1.9.3 parses, as a grammar of its own: an oracle for texts that are written for it."""

from lark import Lark

GRAMMAR = r"""
start: declaration+ system
?declaration: (constant | control | big | react) ";" | action
constant: ("int" | "float" | "string") NAME "=" value
control: "atomic"? ("ctrl" CONTROL | "fun" "ctrl" CONTROL "(" names ")") "=" INT
big: "big" NAME "=" e | "fun" "big" NAME "(" names ")" "=" e
react: ("react" NAME | "fun" "react" NAME "(" names ")") "=" e arrow e map? conditions?
arrow: ("->" | "-->") | "-[" value "]->"
map: "@" "[" [INT ("," INT)*] "]"
conditions: "if" [condition ("," condition)*]
condition: "!"? e "in" ("param" | "ctx")
action: "action" NAME ["[" value "]"] (react ";")+ "end"

system: "begin" ("brs" | "pbrs" | "sbrs" | "nbrs") parameter* init rules predicates? "end"
parameter: ("int" | "float" | "string") names "=" range ";"
range: value | "{" values "}" | "[" value ":" value ":" value "]"
init: "init" call ";"
rules: "rules" "=" "[" [class ("," class)*] "]" ";"
class: "{" call ("," call)* "}" | "(" call ("," call)* ")"
predicates: "preds" "=" "{" predicate ("," predicate)* "}" ";"
predicate: call ["[" value "]"]
call: NAME ["(" values ")"]

values: value ("," value)*
value: INT | FLOAT | STRING | NAME | "(" value ")" | "-" value | value ("+" | "-" | "*" | "/" | "^") value

e: s | wire "(" e ")" | wire ion ["." s] | wire call | e ("*" | "+" | "|" | "||") e
    | "share" s "by" s "in" s
s: "(" e ")" | "(" e ")" "(" e ")" | id | ("merge" | "split") ["(" INT ")"] | "/" NAME
    | NAME "/" "{" names "}" | "{" NAME "}" | INT | placing | call | ion ["." s]
    | ("par" | "ppar") "(" value "," e ")"
id: "id" ["(" INT ")"] | "id" "{" names "}" | "id" "(" INT "," "{" names "}" ")"
ion: CONTROL ["(" values ")"] ["{" names "}"]
placing: "(" "[" [set ("," set)*] "]" "," INT ")"
set: "{" [INT ("," INT)*] "}"
wire: ("/" NAME)+ | NAME "/" "{" names "}" | "/" "{" names "}"
names: NAME ("," NAME)*

CONTROL: /[A-Z][A-Za-z0-9_']*/
NAME: /(?!(?:WORDS)\b)[a-z][A-Za-z0-9_']*/
INT: /[0-9][0-9_]*(?![0-9_.eE])/
FLOAT: /inf\b|[0-9][0-9_]*(\.[0-9_]*([eE][+-]?[0-9][0-9_]*)?|[eE][+-]?[0-9][0-9_]*)/
STRING: /"[A-Za-z0-9_'-]*"/
%ignore /#[^\n]*/
%ignore /[ \t\f\r\n]+/
"""
WORDS = (
    "ctrl atomic big react init int float string fun action begin brs pbrs sbrs nbrs end rules preds share by in id "
    "merge split par ppar if ctx param inf"
)
PARSER = Lark(
    GRAMMAR.replace("WORDS", WORDS.replace(" ", "|")), parser="earley", lexer="dynamic", ambiguity="resolve"
)


def parses(text):
    """Raise what lark raises if BigraphER would not parse this."""
    PARSER.parse(text)
