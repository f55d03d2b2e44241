"""Full transition systems: exact counts, priorities, conditions, weights, limits."""

import time
from dataclasses import replace
from itertools import combinations

import pytest
from bigraph_strategies import SIGNATURE, grounds, shuffled
from engine_strategies import solid_rules, system
from hypothesis import assume, given
from hypothesis import strategies as st

from bigraphs.algebra import atom, ion, lean, nest
from bigraphs.canonical_form import canonical, equal
from bigraphs.errors import BigraphError
from bigraphs.exploration import explore
from bigraphs.notation import read_big, read_system, write_big
from bigraphs.rewriting import successors
from bigraphs.system import Predicate, PriorityClass, Rule


def run(text, **limits):
    return explore(read_system(text), **limits)


def is_just(found, *terms):
    """Say whether the states of a system are these, in this order."""
    wanted = [read_big(term, found.system.signature) for term in terms]
    return len(found) == len(terms) and all(equal(found.state(n), term) for n, term in enumerate(wanted))


def counts(text):
    found = run(text)
    assert found.complete
    return len(found), len(found.starts), found.occurrences


def naive(given_system, most):
    """Return the states by the algebra alone, or None if there are more than `most`."""
    seen = [canonical(given_system.initial)]
    for state in seen:  # grows while it is walked
        for rule in given_system.rules():
            for _, result in successors(rule.reaction(), state):
                found = canonical(result)
                if found not in seen:
                    seen.append(found)
                if len(seen) > most or len(found.nodes) > 9:
                    return None
    return seen


@given(
    st.lists(solid_rules(max_nodes=2), min_size=1, max_size=2), grounds(max_nodes=4, controls=("A", "B", "Z"))
)
def test_states_are_those_that_the_algebra_reaches(rules, initial):
    rules = [replace(rule, name=f"r{number}") for number, rule in enumerate(rules)]
    one = system(lean(initial), *rules)
    states = naive(one, 12)
    assume(states is not None)
    found = explore(one)
    assert {canonical(found.state(number)) for number in range(len(found))} == set(states)


@given(
    st.lists(solid_rules(), min_size=1, max_size=2),
    grounds(max_nodes=5).flatmap(lambda b: st.tuples(st.just(b), shuffled(b))),
)
def test_the_order_in_which_a_term_is_written_changes_nothing(rules, pair):
    one, other = (explore(system(initial, *rules), max_states=25) for initial in pair)
    assert (one.keys, one.starts, one.targets, one.kinds) == (
        other.keys,
        other.starts,
        other.targets,
        other.kinds,
    )
    assert one.reason == other.reason


WALK = """
ctrl Room = 0; atomic ctrl Door = 1; atomic ctrl Robot = 0;
big world = /a /b (Room.(Robot | Robot | Door{a}) | Room.(Door{a} | Door{b}) | Room.Door{b});
react walk = Room.(Robot | Door{d} | id) || Room.(Door{d} | id) --> Room.(Door{d} | id) || Room.(Robot | Door{d} | id);
big meeting = Room.(Robot | Robot | id);
big first = /d (Room.(Door{d} | Robot | Robot) || Door{d});
begin brs
  init world;
  rules = [ {walk} ];
  preds = { meeting, first };
end
"""


def test_two_robots_walk_through_three_rooms():
    found = run(WALK)
    # Two equal robots in a row of rooms that may be turned round: both at one end, one there and one in the middle,
    # one at each end, both in the middle. From the second each of the others is reached, and back.
    assert (len(found), len(found.starts), found.complete) == (4, 6, True)
    assert sorted(found.labels_of(state) for state in range(4)) == [
        (),
        (),
        ("meeting",),
        ("meeting", "first"),
    ]
    assert found.labels_of(0) == ("meeting", "first")
    assert [len(found.path_to(state)) for state in range(4)] == [1, 2, 3, 3]
    graph = found.to_networkx()
    assert (graph.number_of_nodes(), graph.number_of_edges()) == (4, 6)


BLOCKED = """
ctrl A = 0; ctrl B = 0; ctrl C = 0; ctrl Key = 0;
big start = A.1;
react high = A --> B if Key in ctx;
react quiet = A --> C;
react other = B --> B;
begin brs
  init start;
  rules = [ {high}, (quiet), {other} ];
end
"""


def test_a_class_whose_conditions_are_false_does_not_hold_back_instantaneous_ones():
    # The reference takes a class for enabled where a redex occurs, whatever its condition: it stays at A for ever.
    found = run(BLOCKED)
    assert is_just(found, "C.1")


ONE_OF = """
ctrl Box = 0; atomic ctrl Ball = 0; atomic ctrl Mark = 0;
big start = %s;
react empty = Box.Ball --> Box.Mark if !Mark in ctx;
react still = Mark --> Mark;
begin brs
  init start;
  rules = [ (empty), {still} ];
end
"""


def test_an_instantaneous_rule_tries_its_condition_on_every_occurrence():
    # The reference asks it of the first occurrence only: which one that is depends on how the state is written.
    text = """
    ctrl Box = 0; atomic ctrl Ball = 0; atomic ctrl Mark = 0; atomic ctrl Red = 0;
    big start = %s;
    react empty = Box.(Ball | id) --> Box.(Mark | id) if !Red in param;
    react still = Mark --> Mark;
    begin brs
      init start;
      rules = [ (empty), {still} ];
    end
    """
    for start in ("Box.(Ball | Red) | Box.Ball", "Box.Ball | Box.(Red | Ball)"):
        found = run(text % start)
        assert is_just(found, "Box.(Ball | Red) | Box.Mark")


def test_instantaneous_rules_that_do_not_agree_make_the_same_of_every_way_to_write_a_state():
    made = {
        tuple(write_big(found.state(number)) for number in range(len(found)))
        for start in ("Box.Ball | Box.(Box.Ball | Ball) | Box.1", "Box.1 | Box.(Ball | Box.Ball) | Box.Ball")
        for found in [run(ONE_OF % start)]
    }
    assert len(made) == 1


def test_instantaneous_rules_that_never_come_to_rest_are_an_error():
    text = """
    ctrl A = 0; ctrl B = 0;
    big start = A.1;
    react there = A --> B;
    react back = B --> A;
    react never = A.A --> A.A;
    begin brs init start; rules = [ (there, back), {never} ]; end
    """
    with pytest.raises(BigraphError, match="the instantaneous rules back, there never come to rest"):
        run(text)


def test_a_lower_class_waits_until_nothing_higher_can_happen():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0;
    big start = A | A | B;
    react first = A --> B;
    react then = B --> C;
    begin brs init start; rules = [ {first}, {then} ]; end
    """
    found = run(text)
    assert is_just(found, "A | A | B", "A | B | B", "B | B | B", "B | B | C", "B | C | C", "C | C | C")


def test_an_asymmetric_rule_takes_both_of_two_symmetric_occurrences():
    # The redex has a symmetry that the rule has not. The reference keeps one occurrence, which depends on the order.
    text = """
    ctrl Room = 0; atomic ctrl Ball = 0;
    big start = Room.(Ball | Ball) || Room.Ball;
    react pass = Room.(Ball | id) || Room.(Ball | id) --> Room.id || Room.(Ball | Ball | id);
    begin brs init start; rules = [ {pass} ]; end
    """
    assert counts(text) == (4, 4, 8)  # two balls to choose from, two ways to pass one, in two of the states


def test_a_symmetric_rule_takes_them_for_one():
    text = """
    ctrl Room = 0; atomic ctrl Ball = 0; atomic ctrl Bell = 0;
    big start = Room.(Ball | Ball) || Room.Ball;
    react ring = Room.(Ball | id) || Room.(Ball | id) --> Room.(Bell | id) || Room.(Bell | id);
    begin brs init start; rules = [ {ring} ]; end
    """
    assert counts(text) == (2, 1, 2)


WEIGHTED = """
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0;
big start = A | A;
react left = A -[ 1 ]-> B;
react right = A -[ 3 ]-> C;
begin %s init start; rules = [ {left, right} ]; end
"""


def test_probabilities_are_shares_of_what_can_happen():
    found = run(WEIGHTED % "pbrs")
    assert [(each.weight, each.occurrences) for each in found.transitions() if each.source == 0] == [
        (0.25, 2),
        (0.75, 2),
    ]


def test_rates_of_several_occurrences_are_summed():
    found = run(WEIGHTED % "sbrs")
    assert [each.weight for each in found.transitions() if each.source == 0] == [2.0, 6.0]


def test_actions_that_lead_to_one_state_stay_two():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0;
    big start = A;
    action slow react walk = A -[ 2 ]-> B; end
    action quick[5] react run = A -[ 1 ]-> B; react stumble = A -[ 1 ]-> A; end
    begin nbrs init start; rules = [ {walk, run, stumble} ]; end
    """
    found = {(each.action, each.target): each.weight for each in run(text).transitions()}
    assert found == {("slow", 1): 1.0, ("quick", 1): 0.5, ("quick", 0): 0.5}


def test_a_limit_of_states_is_hard_and_said():
    growing = """
    ctrl A = 0;
    big start = A.1;
    react grow = A --> A.A;
    begin brs init start; rules = [ {grow} ]; end
    """
    found = run(growing.replace("A --> A.A", "A --> A.A"), max_states=5)
    assert (len(found), found.complete, found.reason) == (5, False, "the limit of 5 states was reached")
    assert found.expanded < 5
    assert run(growing, max_states=1).reason == "the limit of 1 state was reached"
    late = run(growing, max_time=0.05)
    assert (late.complete, late.reason) == (False, "the limit of 0.05 seconds was reached")


def test_a_redex_that_would_match_anywhere_is_refused():
    text = """
    ctrl A = 0;
    big start = A.1;
    react any = A || id --> id || A;
    begin brs init start; rules = [ {any} ]; end
    """
    with pytest.raises(BigraphError, match="region 1 of"):
        run(text)


def test_passive_controls_keep_rules_out_and_predicates_look_in():
    leaf, safe = atom(SIGNATURE, "A"), nest(ion(SIGNATURE, "P"), atom(SIGNATURE, "A"))
    rule = Rule("gone", leaf, atom(SIGNATURE, "P"), ())
    found = explore(system(safe, rule, predicates=(Predicate("there", leaf),)))
    assert (len(found), len(found.starts), found.labels_of(0)) == (1, 0, ("there",))
    assert len(explore(system(safe | leaf, rule))) == 2


def test_classes_without_rules_are_passed_over():
    one = read_system(WALK)
    empty = replace(one, classes=(PriorityClass(()), *one.classes))
    assert len(explore(empty)) == 4


def test_a_limit_of_time_ends_a_search_within_one_state():
    text = """
    atomic ctrl A = 0; atomic ctrl B = 0;
    big start = %s;
    react some = %s --> B;
    begin brs init start; rules = [ {some} ]; end
    """
    # There are 14,307,150 ways to choose 9 of 30.
    late = run(text % (" | ".join(["A"] * 30), " | ".join(["A"] * 9)), max_time=0.3)
    assert (len(late), late.complete, late.reason) == (1, False, "the limit of 0.3 seconds was reached")
    assert late.seconds < 5


def test_whoever_watches_is_told_how_far_it_has_come(monkeypatch):
    monkeypatch.setattr("bigraphs.exploration.LOOK_EVERY", 0.0)
    told = []
    run(WALK, watch=told.append)
    assert [progress.states for progress in told][-1] == 4


def test_an_interruption_leaves_what_was_found():
    def interrupt(_):
        raise KeyboardInterrupt

    growing = (
        "ctrl A = 0; big start = A.1; react grow = A --> A.A; begin brs init start; rules = [ {grow} ]; end"
    )
    found = run(growing, watch=interrupt, max_states=3000)
    assert (found.complete, found.reason) == (False, "it was interrupted")


def one_long_match():
    """A graph in which a path through more edges than it has vertices is looked for in vain."""
    edges = " || ".join(f"A{{x{one}, x{other}}}.1" for one, other in combinations(range(9), 2))
    path = " || ".join(f"A{{y{at}, y{at + 1}}}.1" for at in range(12))
    return (
        f"ctrl A = 2; big s = {edges}; react r = {path} --> {path}; begin brs init s; rules = [ {{r}} ]; end"
    )


def one_long_binding():
    """Two nodes of many ports: every order of the links of one is tried."""
    ports = [", ".join(f"{name}{at}" for at in range(12)) for name in "xy"]
    node = f"A{{{ports[0]}}}.1"
    other = "B{" + ", ".join(["x0"] * 12) + "}.1"
    return (
        f"ctrl A = 12; ctrl B = 12; big s = {node} || {other}; "
        f"react r = A{{{ports[1]}}}.1 || B{{{ports[1]}}}.1 --> A{{{ports[1]}}}.1 || B{{{ports[1]}}}.1; "
        "begin brs init s; rules = [ {r} ]; end"
    )


@pytest.mark.parametrize("text", [one_long_match(), one_long_binding()], ids=["match", "binding"])
def test_one_long_match_is_interrupted_and_ends_in_time(text, monkeypatch):
    monkeypatch.setattr("bigraphs.exploration.LOOK_EVERY", 0.2)
    looks = []

    def interrupt(progress):
        looks.append(progress)
        if len(looks) > 1:
            raise KeyboardInterrupt

    began = time.monotonic()
    found = run(text, watch=interrupt)
    assert (found.complete, found.reason) == (False, "it was interrupted")
    found = run(text, max_time=0.5)
    assert (found.complete, found.reason) == (False, "the limit of 0.5 seconds was reached")
    assert time.monotonic() - began < 20.0


def test_states_may_be_nested_as_deep_as_they_grow():
    growing = "ctrl A = 0; big start = A.1; react grow = A.1 --> A.A.1; begin brs init start; rules = [ {grow} ]; end"
    found = run(growing, max_states=1100)
    assert (len(found), found.expanded) == (1100, 1099)
    assert len(found.state(1099).nodes) == 1100


def test_a_pattern_that_is_too_large_is_refused():
    large = " | ".join(["A"] * 151)
    text = f"atomic ctrl A = 0; big start = A; react r = {large} --> A; begin brs init start; rules = [ {{r}} ]; end"
    with pytest.raises(BigraphError, match="a pattern of 151 nodes; 150 are the most"):
        run(text)
    fits = text.replace(large, " | ".join(["A"] * 150)).replace("big start = A;", f"big start = {large};")
    assert len(run(fits, max_states=3)) == 2


def test_instantaneous_reactions_after_equal_results_are_counted_once():
    """Either A may become a B, with the same result; the three C that follow are counted once, as BigraphER does."""
    text = """\
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0; atomic ctrl D = 0;
big s0 = A | A | C | C | C;
react change = A --> B;
react burn = B | C --> B;
begin brs init s0; rules = [ (burn), {change} ]; end
"""
    assert counts(text) == (3, 2, (2 + 3) + 1)


PICK = """\
atomic ctrl Fork = 2; atomic ctrl Held = 1; atomic ctrl Left = 1; atomic ctrl Right = 1;
big s0 = {start};
react pick = Fork{{x, y}} -[1.0]-> Held{{x}} | {{y}};
begin sbrs init s0; rules = [ {{pick}} ]; end
"""


@pytest.mark.parametrize(
    "start",
    [
        "/a /b (Fork{a, b} | Left{a} | Right{b})",
        "/b /a (Right{b} | Left{a} | Fork{a, b})",
        "/a /b (Fork{b, a} | Left{a} | Right{b})",
    ],
)
def test_ports_that_fit_in_two_ways_are_two_choices_however_the_state_is_written(start):
    """BigraphER takes one of the two, and which one depends on how the state is written."""
    assert counts(PICK.format(start=start)) == (3, 2, 2)


def test_rates_of_choices_between_ports_do_not_depend_on_what_else_is_on_the_links():
    """Where the two choices give equal states their rates are summed, as they are seen apart otherwise."""
    alike = run(PICK.format(start="/a /b (Fork{a, b} | Left{a} | Left{b})"))
    apart = run(PICK.format(start="/a /b (Fork{a, b} | Left{a} | Left{b} | Right{b})"))
    assert [each.weight for each in alike.transitions()] == [2]
    assert [each.weight for each in apart.transitions()] == [1, 1]


def test_what_would_be_put_nowhere_is_an_error_that_names_the_rule():
    """For BigraphER B becomes a node without a place, and one more with every step."""
    text = """\
ctrl Range = 0; atomic ctrl A = 0; atomic ctrl B = 0;
big start = Range.A;
big left = share (A || id) by ([{0, 1}, {0}], 2) in (Range || id);
react spill = left --> Range.(A | id) || B;
begin brs init start; rules = [ {spill} ]; end
"""
    with pytest.raises(BigraphError, match="rule 'spill' puts a node into a region without a place"):
        run(text)


DROP = """\
ctrl Room = 0; atomic ctrl A = 0;
big start = Room.(A | A | A);
react drop = Room.(A | id) --> {right};
begin brs init start; rules = [ {{drop}} ]; end
"""


def test_what_a_site_held_is_dropped_by_an_instantiation():
    assert counts(DROP.format(right="Room.A @ []")) == (2, 2, 4)


@pytest.mark.parametrize("right", ["Room.A || 0", "Room.A || split(0)", "Room.A || ([{}], 0)"])
def test_a_site_that_is_nowhere_is_refused(right):
    with pytest.raises(BigraphError):
        run(DROP.format(right=right))
