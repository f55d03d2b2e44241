import math

import pytest
from big_files import mistakes, read, rules, system

from bigraphs.canonical_form import equal
from bigraphs.errors import NotationError
from bigraphs.exploration import explore
from bigraphs.matching import find_matches
from bigraphs.notation import read_big, read_system, write_system
from bigraphs.system import Action, SourcePosition, SystemKind, Where


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
    assert rule.position == SourcePosition(2, 7)


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
    assert [rule.parameters for rule in found] == [(1, 2), (2, 3), (3, 4)]


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


def test_constants_that_are_given_must_be_there_and_of_their_type():
    text = system("int a = 1; fun ctrl K(x, y) = 0; big t = K(a, b).1;", init="t")
    assert read_system(text, constants={"b": 2.5}).initial.nodes[0].control == "K(1,2.5)"
    with pytest.raises(NotationError, match=r"an int was expected, this is the float 2\.5"):
        read_system(text, constants={"a": 2.5, "b": 1})
    with pytest.raises(NotationError, match="no constant 'c' is in the file"):
        read_system(text, constants={"b": 1, "c": 1})


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


def test_an_abrs_is_an_nbrs_and_abs_is_a_function_of_numbers():
    text = """
        fun ctrl A(n) = 0; float f = 2.5;
        react r = A(abs(1 - 3)) -[1 / abs(-f) ^ 2]-> A(abs(2));
        big s = A(2).1;
        begin abrs init s; rules = [ {r} ]; actions = [ go[2] = {r} ]; end
    """
    found = read_system(text)
    assert found.actions == (Action("go", 2),)
    (rule,) = found.rules()
    assert (found.kind, rule.weight) == (SystemKind.NBRS, 1 / 2.5**2)
    assert rule.redex == rule.reactum
    assert read_system(write_system(found)) == found


def test_zero_is_a_site_without_a_region():
    text = """
        ctrl A = 0;
        big pick = A * (id + 0 + 0);
        big none = A * ([{0}, {}, {}], 1); big same = none * (A.1 || 1 || 1); big gone = split(0) * 1;
        big s = A.1; react r = A --> A;
        begin brs init s; rules = [ {r} ]; end
    """
    assert len(list(read_system(text).rules())) == 1
    wide = text.replace("big pick = A * (id + 0 + 0);", "big pick = A * (id + 0) * (id + id + id);")
    (found,) = mistakes(wide)
    assert (found.code, found.message[:10]) == ("interface", "this shows")


@pytest.mark.parametrize(
    ("text", "code", "found"),
    [
        ("big s = (A || 0) * (B.1 || B.1);", "parent", "B has no parent"),
        ("big s = A.1; react r = A.id --> A.1 || 0;", "rule", "site 0 of the reactum is in no region"),
        ("big s = A.1; react r = A.id || 0 --> A;", "redex", "site 1 of the redex is in no node"),
    ],
)
def test_what_would_be_an_orphan_is_refused(text, code, found):
    system = (
        f"ctrl A = 0; ctrl B = 0; react keep = A --> A; {text} begin brs init s; rules = [ {{keep}} ]; end"
    )
    assert any(each.code == code and each.message.startswith(found) for each in mistakes(system))


def test_an_action_lists_rules_that_there_are_once():
    text = """
        ctrl A = 0; react r = A -[1]-> A; big s = A.1;
        begin abrs init s; rules = [ {r} ]; actions = [ go = {r, q}, stay = {r} ]; end
    """
    assert [each.message for each in mistakes(text)] == ["rule 'r' is in action 'go', too"]
    found = read_system(text.replace(", stay = {r}", ""))
    assert [each.message for each in found.warnings] == ["unknown rule 'q'"]


def test_a_name_that_only_an_uncalled_declaration_uses_is_told_as_a_warning():
    text = """
        ctrl A = 0; fun ctrl K(n) = 0; big s = A.1; react r = A --> A;
        fun react lost(n) = Bee --> K(m); fun big far(n) = Sea | near(n); fun big near(n) = Dee;
        begin brs init s; rules = [ {r} ]; end
    """
    found = ["unknown control 'Bee'", "unknown value 'm'", "unknown control 'Sea'", "unknown control 'Dee'"]
    assert [each.message for each in read_system(text).warnings] == found
    called = mistakes(text.replace("big s = A.1;", "big s = A.far(1);"))
    assert [each.message for each in called] == found[2:]


AMBIENT = """
    fun ctrl K(n) = 0; ctrl A = 0; big s = A.(K(1).1 | K(2).1);
    fun big near(y) = K(m).1 | K(y).1;
    fun big far(z, x) = A.(near(x) | id); fun big own(m, x) = A.(near(x) | id);
    fun react make(x) = K(m).1 --> K(x + 5).1;
    begin brs
      int m = {1, 2}; int k = {1, 2};
      init s; rules = [ {make(m)} ]; preds = { CALL };
    end
"""


@pytest.mark.parametrize(
    ("call", "occurring"),
    [
        ("near(m)", []),
        ("far(m, k)", ["far(1,2)", "far(2,1)"]),
        ("own(k, k)", []),
        ("own(1, 2)", ["own(1,2)"]),
        ("own(k, m)", ["own(1,2)", "own(2,1)"]),
    ],
)
def test_a_free_name_in_a_declaration_means_what_it_means_to_the_caller_as_in_bigrapher(call, occurring):
    system = read_system(AMBIENT.replace("CALL", call))
    made = [
        (rule.label, rule.redex.nodes[0].control, rule.reactum.nodes[0].control) for rule in system.rules()
    ]
    assert made == [("make(2)", "K(2)", "K(7)"), ("make(1)", "K(1)", "K(6)")]
    patterns = {predicate.label: predicate.pattern for predicate in system.predicates}
    found = {label for label, pattern in patterns.items() if any(find_matches(pattern, system.initial))}
    assert sorted(found) == occurring
    assert len(explore(system).keys) == 4


def test_a_single_value_of_the_systems_parameter_needs_no_giving():
    system = read_system(AMBIENT.replace("m = {1, 2}", "m = 1").replace("CALL", "near(k)"))
    controls = [[node.control for node in each.pattern.nodes] for each in system.predicates]
    assert controls == [["K(1)", "K(2)"], ["K(1)", "K(1)"]]


@pytest.mark.parametrize(("call", "used"), [("near(k)", "near"), ("far(1, k)", "far")])
def test_a_parameter_of_the_system_that_a_call_does_not_give_is_told(call, used):
    (found, *_) = mistakes(AMBIENT.replace("CALL", call))
    assert found.message.startswith(
        f"'{used}' uses the system's parameter 'm', which this call does not give"
    )
    assert found.hint == "call it from the system with 'm' among its arguments"
