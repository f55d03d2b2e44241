import pytest
from big_files import mistakes, system

from bigraphs.errors import NotationError
from bigraphs.notation import read_system
from bigraphs.notation.codes import CODES

MISTAKES = [
    ("name", "react r = C --> A;", "unknown control 'C'"),
    ("name", "", "unknown rule 'move'", {"rules": "{move}"}),
    ("name", "", "unknown bigraph 'q'", {"preds": "q"}),
    ("name", "", "unknown bigraph 't'", {"init": "t"}),
    ("name", "fun ctrl K(i) = 0; big b = K(n);", "unknown value 'n'"),
    ("name", "fun big b(i) = c; big t = b(1);", "unknown bigraph 'c'"),
    ("name", "ctrl A = 1;", "control 'A' is declared twice"),
    ("name", "int s = 1;", "'s' is declared twice"),
    ("name", "int n = 1;", "'n' is declared twice", {"block": "int n = {1, 2};"}),
    ("name", "big b = /y s;", "there is no outer name 'y' here"),
    ("name", "big b = y/{z} s;", "there is no outer name 'z' here"),
    ("name", "big b = x/{y} (Z{x} | Z{y});", "the name 'x' is there already"),
    ("name", "react r = A --> A;", "'r' is listed twice", {"rules": "{r, r}"}),
    ("name", "big b(1) = 1; big c = b(2);", "'b' is not given for these arguments"),
    ("arity", "big b = A{x};", "'A' has no ports, this has 1 link"),
    ("arity", "big b = B{x};", "'B' has 2 ports, this has 1 link"),
    ("arguments", "big b = A(1);", "'A' takes no arguments, this has 1"),
    ("arguments", "big b = s(1);", "'s' takes no arguments, this has 1"),
    ("arguments", "fun react r(i) = A --> A;", "'r' takes 1 argument, this has 0", {"rules": "{r}"}),
    ("atomic", "big b = Z{x}.1;", "'Z' is atomic, so it has no content"),
    ("type", 'int n = "a";', 'an int was expected, this is the string "a"'),
    ("type", "int n = 1.5;", "an int was expected, this is the float 1.5"),
    ("type", 'int n = 1 + "a";', "'+' takes numbers, not strings"),
    ("type", 'float n = -"a";', "a string has no sign"),
    (
        "type",
        "fun ctrl K(i) = 0; big b = K(1) || K(2.5);",
        "'i' of 'K' is of type int, this is the float 2.5",
    ),
    (
        "type",
        "fun ctrl K(i) = 0; fun big f(i) = K(i); big b = f(1) || f(2.5);",
        "'i' of 'f' is of type int, this is the float 2.5",
    ),
    (
        "type",
        "fun big f(i) = par(i, A.1); big b = f(1) || f(1.0);",
        "'i' of 'f' is of type int, this is the float 1.0",
    ),
    ("name", "big b(1) = 1; big b(2 - 1) = 1;", "'b(1)' is declared twice", {"preds": "b(1)"}),
    ("name", "big b(1) = 1; big c = b(1.0);", "'b' is not given for these arguments"),
    ("cycle", "int n = m; int m = n + 1;", "'m' needs 'n', which is not known before it"),
    ("cycle", "big b = A.c; big c = A.b;", "'b' is made of itself"),
    ("number", "int n = 1 / 0;", "division by zero"),
    ("number", "int n = 10 ^ 30;", "the result is too large, or no number"),
    ("number", "float n = (-8) ^ 0.5;", "the result is too large, or no number"),
    ("number", "float n = inf - inf;", "the result is too large, or no number"),
    ("number", "int n = 2 ^ -1;", "the result is too large, or no number"),
    ("number", "", "a step is more than 0, this is 0", {"block": "int n = [1 : 0 : 3];"}),
    ("number", "big b = par(-1, s);", "it is repeated -1 times, not a whole number"),
    ("interface", "big b = A * (s || s);", "this shows <2, {x}>, and its context is for <1, {}>"),
    ("interface", "big b = Z{x} + Z{x};", "the outer name 'x' is on both sides"),
    ("interface", "big b = /x || y/{x};", "the inner name 'x' is on both sides"),
    ("interface", "big b = A.(s || s);", "'A' has room for one region, this has 2"),
    ("interface", "big b = share s by A in A;", "'by' takes a placing, without nodes and names"),
    ("interface", "big b = share s by ([{0}, {0}], 1) in A;", "this places 2 regions, and 1 are shared"),
    (
        "interface",
        "big b = share Z{x} by ([{0, 1}], 2) in (A.id | A.id);",
        "this does not pass on the name 'x' of the shared bigraph",
    ),
    ("interface", "big b = share s by ([{0, 1}], 2) in A;", "this has 1 site, and the placing is over 2"),
    (
        "interface",
        "big b = share s by ([{0}], 1) in (A || id{q});",
        "this needs the name 'q', which the shared bigraph lacks",
    ),
    ("parent", "big b = ([{3}], 1);", "site 0 is in region 3, which the bigraph does not have"),
    ("syntax", "big b = 2;", "a number is no bigraph"),
    ("redex", "react r = id --> id;", "region 0 of the redex has no node, so it would be anywhere"),
    ("redex", "react r = A | id --> A | id;", "site 1 of the redex is in no node"),
    ("redex", "react r = A.(id | id) --> A.(id | id);", "sites 0 and 1 of the redex are in one place"),
    ("redex", "react r = A | {v} --> A | {v};", "no port of the redex is on 'v', so it would be any link"),
    ("redex", "react r = A || /v --> A || /v;", "the redex has the inner name 'v'"),
    (
        "redex",
        "big f = share Z{x} by ([{0, 1}], 2) in (id(2, {x})); react r = f --> f;",
        "a node of the redex is in two regions",
    ),
    ("rule", "react r = A || A --> A;", "the redex has 2 regions, the reactum 1"),
    ("rule", "react r = Z{x} --> 1;", "the reactum lacks the name 'x' of the redex"),
    ("rule", "react r = A --> A | {y};", "the redex lacks the name 'y' of the reactum"),
    ("rule", "react r = A --> A | A;", "the redex has 1 site, the reactum 2"),
    ("rule", "react r = A --> A @ [0, 0];", "the reactum has 1 site, the map lists 2"),
    ("rule", "react r = A --> A @ [3];", "the redex has 1 site, there is no site 3"),
    ("rule", "react r = A --> A || /v;", "the reactum has the inner name 'v'"),
    ("pattern", "big p = id;", "this has no node, so it would always occur", {"preds": "p"}),
    ("pattern", "react r = A --> A if 1 in ctx;", "this has no node, so it would always occur"),
    ("pattern", "big p = A || y/{x};", "a pattern has sites, but no inner names", {"preds": "p"}),
    ("initial", "big t = A;", "a first state is ground, 't' has <1, {}>", {"init": "t"}),
    ("weight", "react r = A --> A;", "a rule of a pbrs has a weight", {"kind": "pbrs", "rules": "{r}"}),
    ("weight", "react r = A -[0]-> A;", "a rate is more than 0, this is 0", {"kind": "sbrs", "rules": "{r}"}),
    (
        "weight",
        "react r = A -[inf]-> A;",
        "a weight is 0 or more, and finite, this is inf",
        {"kind": "pbrs", "rules": "{r}"},
    ),
    (
        "weight",
        'react r = A -["a"]-> A;',
        "a weight is a number, this is a string",
        {"kind": "sbrs", "rules": "{r}"},
    ),
    (
        "weight",
        "react r = A -[inf]-> A;",
        "the rate of 'r' is inf, its class is not instantaneous",
        {"kind": "sbrs", "rules": "{r}"},
    ),
    ("system", "react r = A -[1]-> A;", "'r' is in no action, in a nbrs", {"kind": "nbrs", "rules": "{r}"}),
    ("system", "react r = A --> A;", "all classes are instantaneous", {"rules": "(r)"}),
    ("too-large", "", "a range of more than 10000 values", {"block": "int n = [0 : 1 : 1_000_000_000];"}),
    (
        "too-large",
        "fun react r(a, b, c) = A --> A;",
        "more than 10000 instances of 'r'",
        {"block": "int a, b, c = [0 : 1 : 99];", "rules": "{r(a, b, c)}"},
    ),
    ("too-large", "big b = par(1_000_000_000, 0);", "a bigraph of more than 20000 parts"),
    ("too-large", "big b = par(9000, A.A.A.1);", "a bigraph of more than 20000 parts"),
    (
        "too-deep",
        "fun big f(n) = A.f(n + 1);",
        "bigraphs use each other more than 100 deep, in f(99)",
        {"init": "f(0)"},
    ),
    ("sort", "place A = {B};", "in the first state, Z is in A, which may not hold it"),
    ("sort", "link l = {B.0};", "the ports of 'B' are interchangeable"),
    ("name", "place A = {C};", "unknown control 'C'"),
    ("arity", "link l = {A.0};", "'A' has no port 0"),
]


@pytest.mark.parametrize("mistake", MISTAKES, ids=[message for _, _, message, *_ in MISTAKES])
def test_a_mistake_is_told_in_the_users_words(mistake):
    code, declarations, message, *parts = mistake
    found = mistakes(system(declarations, **dict(*parts)))
    assert (code, message) in [(each.code, each.message) for each in found]
    assert code in CODES


def test_all_mistakes_are_told_at_once_by_position():
    with pytest.raises(NotationError) as found:
        read_system(
            "ctrl Room = 0;\n"
            "atomic ctrl Person = 1;\n"
            "big s = Romo.Person{x};\n"
            "react leave = Room.Person{x, y} --> Room.1;\n"
            "begin brs init s; rules = [ {leav} ]; end\n"
        )
    assert found.value.render("rooms.big") == (
        "rooms.big:3:9: unknown control 'Romo'\n"
        "    3 | big s = Romo.Person{x};\n"
        "      |         ^^^^\n"
        "hint: did you mean 'Room'?\n"
        "\n"
        "rooms.big:4:20: 'Person' has 1 port, this has 2 links\n"
        "    4 | react leave = Room.Person{x, y} --> Room.1;\n"
        "      |                    ^^^^^^^^^^^^\n"
        "hint: its declaration gives 1; every port needs a link\n"
        "\n"
        "rooms.big:5:30: unknown rule 'leav'\n"
        "    5 | begin brs init s; rules = [ {leav} ]; end\n"
        "      |                              ^^^^\n"
        "hint: did you mean 'leave'?"
    )


def test_a_mistake_in_a_call_says_in_which():
    (found,) = mistakes(system("fun big f(n) = par(n - 2, s);", init="f(1)"))
    assert found.message == "it is repeated -1 times, not a whole number, in f(1)"


def test_one_mistake_brings_no_others_after_it():
    assert len(mistakes(system("big b = C; big c = A.b; react r = b --> c;", rules="{r}", preds="b, c"))) == 1


def test_a_file_without_a_system_is_told_what_it_lacks():
    (found,) = mistakes("ctrl A = 0;\nbig s = A.1;\n")
    assert (found.code, found.message, found.line) == ("system", "the file has no system", 2)
