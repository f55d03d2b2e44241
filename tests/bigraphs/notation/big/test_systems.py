import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical import equal
from bigraphs.errors import NotationError
from bigraphs.notation import read_big, read_system
from bigraphs.notation.codes import CODES
from bigraphs.system import Action, Position, SystemKind, Where


def system(declarations, block="", *, kind="brs", init="s", rules="", preds=""):
    """Return a file with a small signature, a first state s and a rule r."""
    listed = f"preds = {{{preds}}};" if preds else ""
    return (
        "ctrl A = 0; atomic ctrl Z = 1; ctrl B = 2; big s = A.Z{x};\n"
        f"{declarations}\nbegin {kind} {block} init {init}; rules = [{rules}]; {listed} end\n"
    )


def read(*arguments, **options):
    return read_system(system(*arguments, **options))


def rules(*arguments, **options):
    return [rule for each in read(*arguments, **options).classes for rule in each.rules]


# --- what is read


def test_a_rule_has_its_sides_map_and_conditions():
    (rule,) = rules(
        "react r = A.id || A.id --> A.id || A.1 @ [1] if !A.Z{x} in ctx, Z{x} in param;", rules="{r}"
    )
    assert (rule.name, rule.label, rule.instantiation, rule.weight) == ("r", "r", (1,), None)
    assert [(each.positive, each.where) for each in rule.conditions] == [
        (False, Where.CONTEXT),
        (True, Where.PARAM),
    ]
    signature = rule.redex.signature
    assert equal(rule.redex, read_big("A || A", signature))
    assert equal(rule.conditions[0].pattern, read_big("A.Z{x}", signature))
    assert rule.position == Position(2, 7)


def test_parameters_range_over_sets_ranges_and_single_values():
    declarations = "fun ctrl K(i, f) = 0; fun react r(i, f) = K(i, f) --> K(i + 1, f);"
    found = rules(declarations, "int n = {3, 1, 3}; float f = [0.5 : 0.5 : 1.0];", rules="{r(n, f)}")
    assert sorted(rule.label for rule in found) == ["r(1,0.5)", "r(1,1.0)", "r(3,0.5)", "r(3,1.0)"]
    (one,) = rules(declarations, "int n = 2 * 3;", rules="{r(n, -1.5)}")
    assert one.redex.nodes[0].control == "K(6,-1.5)"
    assert one.reactum.nodes[0].control == "K(7,-1.5)"


def test_the_last_value_of_a_parameter_comes_first_as_in_bigrapher():
    declarations = "fun ctrl K(i) = 0; fun react r(i, j) = K(i) --> K(j);"
    found = rules(declarations, "int b = {1, 2}; int a = {3, 4};", rules="{r(b, a)}")
    assert [rule.parameters for rule in found] == [(2, 4), (1, 4), (2, 3), (1, 3)]


def test_one_parameter_twice_has_one_value():
    declarations = "fun ctrl K(i) = 0; fun react r(i, j) = K(i) --> K(j);"
    found = rules(declarations, "int n = [1 : 1 : 3];", rules="{r(n, n + 1)}")
    assert [rule.parameters for rule in found] == [(3, 4), (2, 3), (1, 2)]


def test_strings_are_parameters_too():
    found = read(
        'fun ctrl K(w) = 0; string w = "one"; fun big p(w) = K(w);',
        'string v = {"two", "b", "two"};',
        preds="p(v), p(w)",
    )
    assert [predicate.label for predicate in found.predicates] == ['p("two")', 'p("b")', 'p("one")']


def test_constants_are_evaluated_in_any_order_and_can_be_given():
    text = system(
        "int a = b - 1; int b = 2 ^ 10 / 3; float c = 7; fun ctrl K(x, y) = 0; big t = K(a, c).1;", init="t"
    )
    assert read_system(text).initial.nodes[0].control == "K(340,7.0)"
    assert read_system(text, constants={"b": 5}).initial.nodes[0].control == "K(4,7.0)"


def test_whole_numbers_are_divided_towards_zero():
    found = read("fun ctrl K(a, b, c) = 0; big t = K(-7 / 2, 7 / -2, 7 / 2.0).1;", init="t")
    assert found.initial.nodes[0].control == "K(-3,-3,3.5)"


def test_bigraphs_take_arguments_and_repeat():
    found = read(
        "fun ctrl K(i) = 0; fun big row(n, i) = par(n, K(i).1) | par(0, 1); fun big two(n) = ppar(2, row(n, 5));",
        init="two(3)",
    )
    assert [node.control for node in found.initial.nodes] == ["K(5)"] * 6
    assert found.initial.regions == 2


def test_classes_keep_their_order_and_kind():
    found = read("react r = Z{x} --> Z{x}; react q = A --> A;", rules="(q), {r}, {q}")
    assert [(each.instantaneous, [rule.name for rule in each.rules]) for each in found.classes] == [
        (True, ["q"]),
        (False, ["r"]),
        (False, ["q"]),
    ]


def test_weights_are_evaluated_and_mean_what_the_kind_says():
    declarations = "float w = 2; fun react r(n) = Z{x} -[w / n]-> Z{x};"
    (rule,) = rules(declarations, kind="sbrs", rules="{r(4)}")
    assert rule.weight == 0.5
    (fast,) = rules("react r = Z{x} -[inf]-> Z{x};\nreact q = A -[1]-> A;", kind="sbrs", rules="(r), {q}")[:1]
    assert math.isinf(fast.weight)
    (plain,) = rules(declarations, rules="{r(4)}")
    assert plain.weight is None


def test_actions_have_rewards_and_predicates_too():
    found = read(
        "action go[2 * 3] react r = Z{x} -[1]-> Z{x}; end action stay react q = A -[2]-> A; end",
        kind="nbrs",
        rules="{r, q}",
        preds="s[4]",
    )
    assert found.kind is SystemKind.NBRS
    assert found.actions == (Action("go", 6), Action("stay", 0))
    assert [(rule.action, rule.reward, rule.weight) for rule in found.rules()] == [
        ("go", 6, 1.0),
        ("stay", 0, 2.0),
    ]
    assert [(predicate.name, predicate.reward) for predicate in found.predicates] == [("s", 4)]


def test_the_signature_has_the_instances_that_are_used():
    found = read("fun ctrl K(i) = 0; big t = K(1) || K(2); big u = K(3).1;", init="u")
    assert [control.name for control in found.signature.controls] == ["A", "B", "K(3)", "Z"]
    assert found.initial.signature is found.signature


def test_passive_and_ordered_controls_are_read():
    found = read(
        "passive ordered fun ctrl P(i) = 2; ordered atomic ctrl O = 1; big t = P(1){x, x}.O{x};", init="t"
    )
    statuses = {control.name: (control.status, control.ordered) for control in found.signature.controls}
    assert statuses["P(1)"] == ("passive", True)
    assert statuses["O"] == ("atomic", True)


def test_patterns_keep_only_what_decides_whether_they_occur():
    found = read("big p = A.(id | id) | id | {v} || 1;", preds="p")
    assert equal(found.predicates[0].pattern, read_big("A", found.signature))


def test_idle_edges_are_left_out():
    assert read("big t = /v (A.1 | {v});", init="t").initial.edges == 0


def test_a_bigraph_for_given_arguments_goes_before_none():
    found = read("fun ctrl K(i) = 0; big t(1) = K(1).1; big t(2) = K(2).1;", init="t(1 + 1)")
    assert found.initial.nodes[0].control == "K(2)"


def test_names_in_links_and_in_values_are_apart():
    assert rules("fun ctrl K(a) = 1; fun react r(a) = K(a){a} --> K(a){a};", rules="{r(1)}")


# --- what is refused

MISTAKES = [
    ("name", {"declarations": "react r = C --> A;"}, "unknown control 'C'"),
    ("name", {"rules": "{move}"}, "unknown rule 'move'"),
    ("name", {"preds": "q"}, "unknown bigraph 'q'"),
    ("name", {"init": "t"}, "unknown bigraph 't'"),
    ("name", {"declarations": "fun ctrl K(i) = 0; big b = K(n);"}, "unknown value 'n'"),
    ("name", {"declarations": "fun big b(i) = c;"}, "unknown bigraph 'c'"),
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
        {"declarations": "big b = share s by ([{0, 1}], 2) in A;"},
        "this has 1 sites, and the placing is over 2",
    ),
    (
        "interface",
        {"declarations": "big b = share s by ([{0}], 1) in (A || id{q});"},
        "this waits for the name 'q', which what is shared does not have",
    ),
    ("parent", {"declarations": "big b = ([{}], 1);"}, "site 0 has no parent"),
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


def mistakes(text):
    with pytest.raises(NotationError) as found:
        read_system(text)
    return found.value.mistakes


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


@pytest.mark.parametrize(
    "text",
    [
        "ctrl A = 0; big a = " + "A." * 20_000 + "1;",
        "ctrl A = 0; big a = " + "(" * 20_000,
        "int n = " + "-" * 20_000 + "1;",
        "int n = " + "2 ^ " * 5_000 + "2;",
        "int n = " + "(" * 190 + "1" + ")" * 190 + " + " + " + ".join(["1"] * 5_000) + ";",
        "int n = " + "9" * 9_000 + ";",
        "int n = 2 ^ 2 ^ 2 ^ 2 ^ 2 ^ 2;",
        "big a = id(999999999);",
        "big a = ([{0}], 999999999);",
        "big a = split(20000) * merge(20000);",
        "ctrl A = 999999999;",
        "\n".join(f"int n{n} = n{n + 1};" for n in range(1_000)),
        "ctrl A = 0;" + "\n".join(f"big b{n} = A.b{n + 1};" for n in range(1_000)),
        "ctrl A = 0; big b0 = A | A;\n" + "\n".join(f"big b{n} = b{n - 1} | b{n - 1};" for n in range(1, 60)),
        "ctrl A = 0; fun big f(n) = f(n + 1) | f(n + 2); big s = f(0);",
        "begin brs init s; rules = [" + "{r}, " * 5_000 + "{r}]; end",
        "ctrl A = 0; react r = " + " || ".join(["A"] * 1_000) + " --> A;",
        "\x00\ud800",
    ],
    ids=lambda text: f"{text[:30]!r}…{len(text)}",
)
def test_hostile_texts_are_refused_soon(text):
    started = time.process_time()
    with pytest.raises(NotationError):
        read_system(text)
    assert time.process_time() - started < 8


def test_the_work_of_one_file_is_bounded(monkeypatch):
    monkeypatch.setattr("bigraphs.notation.big.expressions.MAX_WORK", 2_000)
    text = system("".join(f"big b{n} = par(100, A.1);" for n in range(20)))
    assert "reading this file takes bigraphs of more than 2000 parts in all" in [
        mistake.message for mistake in mistakes(text)
    ]


def test_the_number_of_words_of_one_file_is_bounded():
    (found,) = mistakes("begin brs init s; rules = [" + "{r}, " * 50_000 + "{r}]; end")
    assert found.code == "too-long"


PIECES = st.sampled_from(
    [
        *("ctrl A = 0;", "atomic ctrl Z = 1;", "fun ctrl K(n) = 1;", "big s = A.1;", "react r = A --> A;"),
        *(
            "fun big f(n) = K(n){x} | f(n - 1);",
            "int n = 3;",
            "begin brs",
            "init s;",
            "rules = [{r}];",
            "end",
        ),
        *(
            "int m = {1, 2};",
            "big",
            "s",
            "=",
            "A",
            ".",
            "(",
            ")",
            "{x}",
            "|",
            "||",
            "share",
            "by",
            "in",
            "1",
            ";",
        ),
        *(
            "/x",
            "par(",
            "3,",
            "-->",
            "@ [0]",
            "if",
            "!",
            "ctx",
            "place A = {A};",
            "link l = {Z};",
            "sort",
            "\x1f",
        ),
    ]
)


@given(st.lists(PIECES, max_size=25).map(" ".join))
def test_any_text_is_read_or_refused_with_places_in_it(text):
    try:
        read_system(text)
    except NotationError as error:
        places = [mistake.offset for mistake in error.mistakes]
    else:
        places = []
    assert places == sorted(places)
    assert all(0 <= place <= len(text) for place in places)
