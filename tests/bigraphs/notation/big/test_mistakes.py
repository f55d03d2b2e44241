import pytest
from big_files import mistakes, system

from bigraphs.errors import NotationError
from bigraphs.notation import read_system
from bigraphs.notation.codes import CODES

MISTAKES = [
    ("name", {"declarations": "react r = C --> A;"}, "unknown control 'C'"),
    ("name", {"rules": "{move}"}, "unknown rule 'move'"),
    ("name", {"preds": "q"}, "unknown bigraph 'q'"),
    ("name", {"init": "t"}, "unknown bigraph 't'"),
    ("name", {"declarations": "fun ctrl K(i) = 0; big b = K(n);"}, "unknown value 'n'"),
    ("name", {"declarations": "fun big b(i) = c; big t = b(1);"}, "unknown bigraph 'c'"),
    ("name", {"declarations": "ctrl A = 1;"}, "control 'A' is declared twice"),
    ("name", {"declarations": "int s = 1;"}, "'s' is declared twice"),
    ("name", {"declarations": "int n = 1;", "block": "int n = {1, 2};"}, "'n' is declared twice"),
    ("name", {"declarations": "big b = /y s;"}, "there is no outer name 'y' here"),
    ("name", {"declarations": "big b = y/{z} s;"}, "there is no outer name 'z' here"),
    ("name", {"declarations": "big b = x/{y} (Z{x} | Z{y});"}, "the name 'x' is there already"),
    ("name", {"declarations": "react r = A --> A;", "rules": "{r, r}"}, "'r' is listed twice"),
    ("name", {"declarations": "big b(1) = 1; big c = b(2);"}, "'b' is not given for these arguments"),
    ("arity", {"declarations": "big b = A{x};"}, "'A' has no ports, this has 1 link"),
    ("arity", {"declarations": "big b = B{x};"}, "'B' has 2 ports, this has 1 link"),
    ("arguments", {"declarations": "big b = A(1);"}, "'A' takes no arguments, this has 1"),
    ("arguments", {"declarations": "big b = s(1);"}, "'s' takes no arguments, this has 1"),
    (
        "arguments",
        {"declarations": "fun react r(i) = A --> A;", "rules": "{r}"},
        "'r' takes 1 argument, this has 0",
    ),
    ("atomic", {"declarations": "big b = Z{x}.1;"}, "'Z' is atomic, so there is nothing in it"),
    ("type", {"declarations": 'int n = "a";'}, 'an int was expected, this is the string "a"'),
    ("type", {"declarations": "int n = 1.5;"}, "an int was expected, this is the float 1.5"),
    ("type", {"declarations": 'int n = 1 + "a";'}, "'+' takes numbers, not strings"),
    ("type", {"declarations": 'float n = -"a";'}, "a string has no sign"),
    (
        "type",
        {"declarations": "fun ctrl K(i) = 0; big b = K(1) || K(2.5);"},
        "'i' of 'K' is of type int, this is the float 2.5",
    ),
    (
        "type",
        {"declarations": "fun ctrl K(i) = 0; fun big f(i) = K(i); big b = f(1) || f(2.5);"},
        "'i' of 'f' is of type int, this is the float 2.5",
    ),
    (
        "type",
        {"declarations": "fun big f(i) = par(i, A.1); big b = f(1) || f(1.0);"},
        "'i' of 'f' is of type int, this is the float 1.0",
    ),
    (
        "name",
        {"declarations": "big b(1) = 1; big b(2 - 1) = 1;", "preds": "b(1)"},
        "'b(1)' is declared twice",
    ),
    ("name", {"declarations": "big b(1) = 1; big c = b(1.0);"}, "'b' is not given for these arguments"),
    ("cycle", {"declarations": "int n = m; int m = n + 1;"}, "'m' needs 'n', which is not known before it"),
    ("cycle", {"declarations": "big b = A.c; big c = A.b;"}, "'b' is made of itself"),
    ("number", {"declarations": "int n = 1 / 0;"}, "division by zero"),
    ("number", {"declarations": "int n = 10 ^ 30;"}, "the result is too large, or no number"),
    ("number", {"declarations": "float n = (-8) ^ 0.5;"}, "the result is too large, or no number"),
    ("number", {"declarations": "float n = inf - inf;"}, "the result is too large, or no number"),
    ("number", {"declarations": "int n = 2 ^ -1;"}, "the result is too large, or no number"),
    ("number", {"block": "int n = [1 : 0 : 3];"}, "a step is more than 0, this is 0"),
    ("number", {"declarations": "big b = par(-1, s);"}, "it is repeated -1 times, not a whole number"),
    (
        "interface",
        {"declarations": "big b = A * (s || s);"},
        "this shows <2, {x}>, and what it is put into is for <1, {}>",
    ),
    ("interface", {"declarations": "big b = Z{x} + Z{x};"}, "the outer name 'x' is on both sides"),
    ("interface", {"declarations": "big b = /x || y/{x};"}, "the inner name 'x' is on both sides"),
    (
        "interface",
        {"declarations": "big b = A.(s || s);"},
        "'A' has room for one region, this has 2",
    ),
    (
        "interface",
        {"declarations": "big b = share s by A in A;"},
        "'by' takes a placing, without nodes and names",
    ),
    (
        "interface",
        {"declarations": "big b = share s by ([{0}, {0}], 1) in A;"},
        "this places 2 regions, and 1 are shared",
    ),
    (
        "interface",
        {"declarations": "big b = share Z{x} by ([{0, 1}], 2) in (A.id | A.id);"},
        "this does not pass on the name 'x' of what is shared",
    ),
    (
        "interface",
        {"declarations": "big b = share s by ([{0, 1}], 2) in A;"},
        "this has 1 sites, and the placing is over 2",
    ),
    (
        "interface",
        {"declarations": "big b = share s by ([{0}], 1) in (A || id{q});"},
        "this waits for the name 'q', which what is shared does not have",
    ),
    (
        "parent",
        {"declarations": "big b = ([{3}], 1);"},
        "site 0 is in region 3, which the bigraph does not have",
    ),
    ("syntax", {"declarations": "big b = 2;"}, "a number is no bigraph"),
    (
        "redex",
        {"declarations": "react r = id --> id;"},
        "region 0 of the redex has no node, so it would be anywhere",
    ),
    ("redex", {"declarations": "react r = A | id --> A | id;"}, "site 1 of the redex is in no node"),
    (
        "redex",
        {"declarations": "react r = A.(id | id) --> A.(id | id);"},
        "sites 0 and 1 of the redex are in one place",
    ),
    (
        "redex",
        {"declarations": "react r = A | {v} --> A | {v};"},
        "no port of the redex is on 'v', so it would be any link",
    ),
    ("redex", {"declarations": "react r = A || /v --> A || /v;"}, "the redex has the inner name 'v'"),
    (
        "redex",
        {"declarations": "big f = share Z{x} by ([{0, 1}], 2) in (id(2, {x})); react r = f --> f;"},
        "a node of the redex is in two regions",
    ),
    ("rule", {"declarations": "react r = A || A --> A;"}, "the redex has 2 regions, the reactum 1"),
    ("rule", {"declarations": "react r = Z{x} --> 1;"}, "the reactum lacks the name 'x' of the redex"),
    ("rule", {"declarations": "react r = A --> A | {y};"}, "the redex lacks the name 'y' of the reactum"),
    ("rule", {"declarations": "react r = A --> A | A;"}, "the redex has 1 site, the reactum 2"),
    ("rule", {"declarations": "react r = A --> A @ [0, 0];"}, "the reactum has 1 site, the map speaks of 2"),
    ("rule", {"declarations": "react r = A --> A @ [3];"}, "the redex has 1 site, there is no site 3"),
    ("rule", {"declarations": "react r = A --> A || /v;"}, "the reactum has the inner name 'v'"),
    ("pattern", {"declarations": "big p = id;", "preds": "p"}, "this has no node, so it would always occur"),
    (
        "pattern",
        {"declarations": "react r = A --> A if 1 in ctx;"},
        "this has no node, so it would always occur",
    ),
    (
        "pattern",
        {"declarations": "big p = A || y/{x};", "preds": "p"},
        "a pattern has sites, but no inner names",
    ),
    ("initial", {"declarations": "big t = A;", "init": "t"}, "a first state is ground, 't' has <1, {}>"),
    (
        "weight",
        {"declarations": "react r = A --> A;", "kind": "pbrs", "rules": "{r}"},
        "a rule of a pbrs has a weight",
    ),
    (
        "weight",
        {"declarations": "react r = A -[0]-> A;", "kind": "sbrs", "rules": "{r}"},
        "a rate is more than 0, this is 0",
    ),
    (
        "weight",
        {"declarations": "react r = A -[inf]-> A;", "kind": "pbrs", "rules": "{r}"},
        "a weight is 0 or more, and finite, this is inf",
    ),
    (
        "weight",
        {"declarations": 'react r = A -["a"]-> A;', "kind": "sbrs", "rules": "{r}"},
        "a weight is a number, this is a string",
    ),
    (
        "weight",
        {"declarations": "react r = A -[inf]-> A;", "kind": "sbrs", "rules": "{r}"},
        "the rate of 'r' is inf, its class is not instantaneous",
    ),
    (
        "system",
        {"declarations": "react r = A -[1]-> A;", "kind": "nbrs", "rules": "{r}"},
        "'r' is in no action, in a nbrs",
    ),
    ("system", {"declarations": "react r = A --> A;", "rules": "(r)"}, "all classes are instantaneous"),
    ("too-large", {"block": "int n = [0 : 1 : 1_000_000_000];"}, "a range of more than 10000 values"),
    (
        "too-large",
        {
            "declarations": "fun react r(a, b, c) = A --> A;",
            "block": "int a, b, c = [0 : 1 : 99];",
            "rules": "{r(a, b, c)}",
        },
        "more than 10000 instances of 'r'",
    ),
    ("too-large", {"declarations": "big b = par(1_000_000_000, 0);"}, "a bigraph of more than 20000 parts"),
    ("too-large", {"declarations": "big b = par(9000, A.A.A.1);"}, "a bigraph of more than 20000 parts"),
    (
        "too-deep",
        {"declarations": "fun big f(n) = A.f(n + 1);", "init": "f(0)"},
        "bigraphs use each other more than 100 deep, in f(99)",
    ),
    (
        "sort",
        {"declarations": "place A = {B};"},
        "in the first state, Z is in A, which may not hold it",
    ),
    (
        "sort",
        {"declarations": "link l = {B.0};"},
        "the ports of 'B' are interchangeable",
    ),
    ("name", {"declarations": "place A = {C};"}, "unknown control 'C'"),
    ("arity", {"declarations": "link l = {A.0};"}, "'A' has no port 0"),
]


@pytest.mark.parametrize(("code", "parts", "message"), MISTAKES, ids=[message for _, _, message in MISTAKES])
def test_a_mistake_is_told_in_the_users_words(code, parts, message):
    found = mistakes(system(**({"declarations": ""} | parts)))
    assert message in [mistake.message for mistake in found]
    assert code in [mistake.code for mistake in found if mistake.message == message]


def test_every_mistake_has_a_documented_code():
    assert {code for code, _, _ in MISTAKES} <= set(CODES)


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
        "hint: its declaration says 1; every port needs a link\n"
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
