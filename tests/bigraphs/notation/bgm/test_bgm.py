import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bigraphs.canonical_form import canonical, equal
from bigraphs.errors import NotationError
from bigraphs.exploration import explore
from bigraphs.notation import read_bgm
from bigraphs.notation.bgm.parser import parse_bgm
from bigraphs.notation.bgm.syntax import Hole, ModelLine, Prefix
from bigraphs.notation.codes import CODES
from bigraphs.properties import Compare, Not, Size, StateContext, StateScope, TerminalState, holds
from bigraphs.rewriting import successors

LOCKS = """
# Two doors on one key, and one that has none.
%active room : 0;
%passive door : 2;  # [key, state]
%passive key : 1;
%outer open;
%outer shut;
%outer brass;

%rule unlock room.(key[k] | $0) || door[k, shut].$1 -> room.(key[k] | $0) || door[k, open].$1;
door[k, open].$0 -> door[k, shut];

room.key[brass] | room.door[brass, shut] | door[brass, shut].door[-, open] | door[-, shut];

%property never_empty !empty() && size() >= 4;
%property shrinks $pred->size() >= size();
%property stuck if terminal() then size() == 5 else !matches(door[-, x].door[y, open]);
%check;
this is not read any more
"""


def test_a_term_is_places_nodes_and_holes():
    (line,) = parse_bgm("a.(b[x,-] | $3 | nil) || c.nil")
    assert line == ModelLine(((Prefix("a", (), (Prefix("b", ("x", None)), Hole(3))),), (Prefix("c"),)))


def test_a_dot_binds_more_tightly_than_a_bar():
    (line,) = parse_bgm("a.b.c | d")
    assert line == ModelLine((((Prefix("a", (), (Prefix("b", (), (Prefix("c"),)),)), Prefix("d"))),))


def test_a_file_is_read_up_to_check():
    system = read_bgm(LOCKS)
    assert [rule.name for rule in system.rules()] == ["unlock", "rule1"]
    assert [each.name for each in system.properties] == ["never_empty", "shrinks", "stuck"]
    assert system.initial.outer_names == ("brass", "open", "shut")
    assert [(each.name, each.status, each.ordered) for each in system.signature.controls] == [
        ("door", "passive", True),
        ("key", "passive", True),
        ("room", "active", True),
    ]


def steps(system, state):
    """Return the states one step further, up to isomorphism."""
    return {canonical(result) for rule in system.rules() for _, result in successors(rule.reaction(), state)}


def test_declared_names_stand_for_themselves_and_others_for_any_link():
    system = read_bgm(LOCKS)
    (unlock, _) = system.rules()
    assert unlock.link_constants == {"open", "shut"}
    found = [result for _, result in successors(unlock.reaction(), system.initial)]
    opened = [[node.ports for node in state.nodes if "open" in node.ports] for state in found]
    assert [len(doors) for doors in opened] == [2, 2]  # one of two on brass; the one without a key stays shut
    assert all(("brass", "open") in doors for doors in opened)


def test_a_dropped_hole_drops_what_it_holds():
    system = read_bgm(LOCKS)
    after = {state for opened in steps(system, system.initial) for state in steps(system, opened)}
    assert {len(state.nodes) for state in after} == {len(system.initial.nodes), len(system.initial.nodes) - 1}


def test_holes_beside_a_redex_that_stay_there_are_left_out():
    system = read_bgm("%active a : 0; %active b : 0; a.b | b; a.$0 | $1 -> $0 | $1;")
    (rule,) = system.rules()
    assert (len(rule.redex.sites), rule.instantiation) == (1, (0,))
    assert steps(system, system.initial) == {canonical(read_bgm("%active a:0; %active b:0; b | b").initial)}


def test_holes_are_moved_and_copied():
    (rule,) = read_bgm("%active a : 0; a; a.$7 || a.$2 -> a.$2 || a.(a.$7 | a.$7);").rules()
    assert rule.instantiation == (1, 0, 0)


def test_properties_hold_in_situations():
    system = read_bgm(LOCKS)
    small = read_bgm("%active room : 0; room;").initial
    never_empty, shrinks, stuck = (each.formula for each in system.properties)
    here = StateContext(system.initial, successors=tuple(steps(system, system.initial)))
    assert holds(never_empty, here)
    assert not holds(never_empty, StateContext(small))
    assert holds(shrinks, here)
    assert not holds(shrinks, StateContext(system.initial, predecessors=(small,)))
    assert not holds(stuck, StateContext(small))
    assert holds(stuck, here)


def test_scopes_speak_of_the_states_around():
    text = "%active a : 0; a; %property p $succ->matches(a.a) && $terminal->equal(a); %property q $pred->(!empty());"
    system = read_bgm(text)
    one, two = system.initial, read_bgm("%active a : 0; a.a").initial
    before, after = (each.formula for each in system.properties)
    assert holds(before, StateContext(one))
    assert not holds(before, StateContext(two))
    assert holds(before, StateContext(one, successors=(two,)))
    assert holds(after, StateContext(one, predecessors=(two,)))


def test_comparisons_and_negations_are_formulas():
    system = read_bgm("%active a : 0; a; %property p !terminal(); %property q $pred->size() < 3;")
    assert [each.formula for each in system.properties] == [
        Not(TerminalState()),
        Compare("<", Size(StateScope.PREDECESSOR), 3),
    ]


def test_declared_names_are_outer_names_of_the_first_state():
    system = read_bgm("%name x; %active a : 1; a[y];")
    assert system.initial.outer_names == ("x", "y")
    assert equal(system.initial, read_bgm("%outer y; %outer x; %active a : 1; a[y];").initial)


MISTAKES = [
    ("syntax", "%active a : ;", "found ';', expected a number"),
    ("syntax", "%prop p matches(UAV);", "'%prop' is a word of another dialect of .bgm"),
    ("syntax", "%binding Bind;", "'%binding' is a word of another dialect of .bgm"),
    ("syntax", "%ltlSpec G!(a);", "'%ltlSpec' is a word of another dialect of .bgm"),
    ("syntax", "%agnet UAV[x, y];", "'%agnet' is no word of .bgm"),
    (
        "syntax",
        "%agent UAV[idle, x:edge];",
        "'x:edge' gives the kind of a link, as another dialect of .bgm does",
    ),
    (
        "syntax",
        "%rule r UAV[x, y] -> UAV[x, y]{n > 3};",
        "a rule has no constraints, which another dialect of .bgm writes in braces",
    ),
    ("syntax", "u:UAV[p:x].nil;", "'u:UAV' names a node, as another dialect of .bgm does"),
    ("syntax", "UAV[x, p : y].nil;", "'p:y' names a port, as another dialect of .bgm does"),
    ("name", "b;", "unknown control 'b'"),
    ("name", "a; %active a : 1;", "control 'a' is declared twice"),
    ("name", "a; %rule r a -> a; %rule r a -> a;", "rule 'r' is declared twice"),
    ("arity", "a[x];", "'a' has 0 ports, this has 1 name"),
    ("system", "a -> a;", "the file has no first state"),
    ("system", "a; a.a;", "the file has 2 first states"),
    ("site", "a.$0;", "a first state has no holes"),
    ("site", "a; a.$0 -> a.$1;", "$1 is not in the redex"),
    ("site", "a; a.($0 | a.$0) -> a.$0;", "$0 is in the redex twice"),
    ("redex", "a; a | $0 -> a.$0;", "$0 is beside the redex, and does not stay there"),
    ("redex", "a; a.($0 | $1) -> a.($1 | $0);", "sites 0 and 1 of the redex are in one place"),
    ("redex", "a; nil || a -> a || a;", "region 0 of the redex has no node, so it would be anywhere"),
    ("rule", "a; a || a -> a;", "the redex has 2 regions, the reactum 1"),
    ("rule", "a; %active b : 1; a -> b[x];", "the redex lacks the name 'x' of the reactum"),
    ("initial", "a; %inner x;", "a first state has no inner names"),
    ("property", "a; %property p size();", "a size is neither true nor false"),
    ("property", "a; %property p 3;", "a number is neither true nor false"),
    ("property", "a; %property p empty() == 1;", "only numbers and size() can be compared"),
    ("property", "a; %property p matches();", "'matches' takes a term"),
    ("property", "a; %property p equal(a.$0);", "a state has no holes"),
    ("property", "a; %property p matches($0);", "this has no node, so it would always match"),
    (
        "property",
        "a; %property p $pred->terminal();",
        "$pred takes only patterns and sizes",
    ),
    ("too-large", "%active b : 99999999; b;", "a node of more than 20000 ports"),
    ("too-large", "%active b : 15000; b | b;", "a bigraph of more than 20000 parts"),
    ("too-deep", "a; %property p " + "!" * 60 + "empty();", "properties nest deeper than 50"),
    ("too-deep", "a; %property p " + "$this->" * 60 + "(empty());", "properties nest deeper than 50"),
]


@pytest.mark.parametrize(("code", "text", "message"), MISTAKES, ids=[message for _, _, message in MISTAKES])
def test_a_mistake_is_told_in_the_users_words(code, text, message):
    with pytest.raises(NotationError) as found:
        read_bgm("%active a : 0;\n" + text)
    assert (code, message) in [(mistake.code, mistake.message) for mistake in found.value.mistakes]
    assert code in CODES


def test_a_misspelt_control_is_told_with_its_likely_name():
    with pytest.raises(NotationError) as found:
        read_bgm("%active room : 0;\nromo;\n")
    assert found.value.render("doors.bgm") == (
        "doors.bgm:2:1: unknown control 'romo'\n    2 | romo;\n      | ^^^^\nhint: did you mean 'room'?"
    )


@pytest.mark.parametrize(
    "text",
    [
        "a." * 20_000,
        "(" * 20_000,
        "%property p " + "$pred->" * 5_000 + "empty()",
        "%property p " + "!" * 20_000,
        "%property p " + "if empty() then " * 2_000 + "empty()",
        "%active a : " + "9" * 9_000,
        "%check" * 10_000 + "a",
        " %chec" * 10_000,
    ],
    ids=lambda text: f"{text[:24]!r}…{len(text)}",
)
def test_hostile_texts_are_refused_soon(text):
    started = time.process_time()
    with pytest.raises(NotationError):
        read_bgm(text)
    assert time.process_time() - started < 8


WORDS = """
%active %passive a b : 0 1 ; %rule r -> | || . ( ) [ ] x , - $0 $1 nil %property p ! matches( size() == %check
"""
PIECES = st.sampled_from(WORDS.split())


@given(st.lists(PIECES, max_size=20).map(" ".join))
def test_any_text_is_read_or_refused_with_places_in_it(text):
    try:
        read_bgm(text)
    except NotationError as error:
        places = [mistake.offset for mistake in error.mistakes]
    else:
        places = []
    assert all(0 <= place <= len(text) for place in places)


def test_controls_that_no_file_declares_are_inferred_with_a_warning():
    system = read_bgm(
        "l0_Location.(u0_UAV[net] | $0) | l1_Location.$1 -> l0_Location.$0 | l1_Location.(u0_UAV[net] | $1);\n"
        "l0_Location.(u0_UAV[net] | u1_UAV[net]) | l1_Location | sea;"
    )
    (warning,) = system.warnings
    assert warning.message == "no control is declared, so they are inferred from their uses"
    assert warning.hint == "declare them: %active Location : 0, %active UAV : 1, %active sea : 0"
    assert sorted((node.name, node.control) for node in system.initial.nodes if node.name) == [
        ("l0", "Location"),
        ("l1", "Location"),
        ("u0", "UAV"),
        ("u1", "UAV"),
    ]
    found = explore(system)
    assert (len(found), len(found.starts)) == (2, 1)
    with pytest.raises(NotationError, match="node 'u0' is there twice"):
        read_bgm("u0_UAV | u0_UAV;")
    assert read_bgm("%active l0_Location : 0; l0_Location;").initial.nodes[0].name is None


def test_a_dialects_words_for_what_there_is_are_read():
    """`%outername`, `%innername`, `%agent`, `idle` ports and an empty `{}` behind a rule."""
    ours = "%active A : 2; %outer x; %rule go A[-, x].$0 -> A[x, -].$0; A[-, x] | A[-, -];"
    theirs = "%active A : 2; %outername x; %rule go A[idle, x].$0 -> A[x, idle].$0{}; %agent A[idle, x] | "
    theirs += "A[idle, idle];"
    assert read_bgm(theirs) == read_bgm(ours)
    with pytest.raises(NotationError, match="no inner names"):
        read_bgm(theirs.replace("%outername x", "%innername x"))


def test_a_link_may_be_called_idle_elsewhere():
    found = read_bgm("%active A : 1; %outer idle; A[idle] | A[idle];")
    assert found.initial.outer_names == ("idle",)
