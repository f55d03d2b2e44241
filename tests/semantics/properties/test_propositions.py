"""Propositions about variables: what properties name is kept to the end of the run, and nothing else is."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_missions import explore, figure_2, mission, move_to, run

from semantics import hypothesis_strategies
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault, Literal
from semantics.behaviours.program import Program, VariableOf
from semantics.behaviours.statements import Assign
from semantics.behaviours.values import Truth
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, watched, watching
from semantics.properties.propositions import ORDERS, IsBound, Not, Or, VariableIs, holds
from semantics.properties.temporal import Either, Eventually, Globally, Now
from semantics.races.monitor import monitored
from semantics.races.provenance import NOTHING
from semantics.state.configuration import Configuration
from semantics.state.printing import print_agent
from semantics.successors import successors

N = VariableOf("a", ("n",))


def asking(*variables):
    return [Property(PropertyKind.REACHABLE, "r", IsBound(each)) for each in variables]


def storing(value, name="n"):
    """Return the end of Figure 2's start with a variable given by hand."""
    c = watching(figure_2(), asking(N, VariableOf("a", ("n", "n#2"))))
    return c.with_({("store", "a"): ((name, value),)})


def test_a_variable_that_nobody_keeps_is_not_evaluated():
    with pytest.raises(ValueError, match=r"'a\.n' is dropped .*: begin with watching"):
        holds(IsBound(N), figure_2())


def test_what_properties_name_is_found_wherever_it_stands():
    m, k = VariableOf("a", ("m",)), VariableOf("b", ("k", "k#2"))
    formula = Either(Globally(Now(Not(VariableIs(N, 1)))), Eventually(Now(IsBound(m))))
    properties = [
        Property(PropertyKind.LTL, "t", temporal=formula),
        Property(PropertyKind.INVARIANT, "i", Or((IsBound(k), VariableIs(N, 2)))),
    ]
    assert watched(properties) == {N, m, k}


def test_who_watches_already_what_is_asked_for_stays_as_it_is():
    c = watching(figure_2(), asking(N))
    assert watching(c, asking(N)) is c
    assert watching(c, asking(VariableOf("a", ("obs",)))).setting.program.watched == {
        N,
        VariableOf("a", ("obs",)),
    }


@pytest.mark.parametrize("unbound", [False, True])
@pytest.mark.parametrize("operator", ["==", *ORDERS])
def test_what_has_no_value_compares_as_where_it_stands_wants_it(operator, unbound):
    c = watching(figure_2(), asking(N))
    assert holds(VariableIs(N, 1, operator, unbound), c) is unbound
    assert not holds(IsBound(N), c)


@pytest.mark.parametrize("operator", ORDERS)
@pytest.mark.parametrize("value", ["x", Truth.TRUE, (1,), frozenset({1})])
@pytest.mark.parametrize("unbound", [False, True])
def test_what_is_no_number_has_no_place_among_numbers(operator, value, unbound):
    assert holds(VariableIs(N, 1, operator, unbound), storing(value)) is unbound


@given(st.integers(-3, 3), st.integers(-3, 3), st.booleans())
def test_numbers_are_compared_as_numbers(held, other, unbound):
    c = storing(held)
    assert holds(IsBound(N), c)
    for operator, meant in {"==": held == other, "<": held < other, ">=": held >= other}.items():
        assert holds(VariableIs(N, other, operator, unbound), c) is meant
    assert holds(VariableIs(N, other, "<=", unbound), c) is (held <= other)
    assert holds(VariableIs(N, other, ">", unbound), c) is (held > other)


def test_values_of_two_types_are_never_the_same():
    assert not holds(VariableIs(N, 1, unbound=True), storing(Truth.TRUE))
    assert not holds(VariableIs(N, "1", unbound=True), storing(1))


def test_of_several_variables_written_alike_the_one_given_last_counts():
    inner, both = VariableOf("a", ("x#2",)), VariableOf("a", ("x", "x#2"))
    program = Program(
        (
            Assign("x", Literal(1)),
            move_to("area"),
            Assign("x#2", Literal(2)),
            move_to("base"),
            Assign("x", Literal(3)),
        ),
        {},
        COMMANDS,
    )
    c = watching(
        mission(["u0", "area"], agents={"a": ("u0", (0, 1, 2, 3, 4))}, program=program), asking(inner, both)
    )
    seen = []
    for rules in (("fun",), ("req_ctr", "fun"), ("req_ctr", "fun")):
        c = run(c, *rules)
        seen.append([holds(VariableIs(both, value), c) for value in (1, 2, 3)])
    assert seen == [[True, False, False], [False, True, False], [False, False, True]]
    assert c.alpha.code("a") == ()
    assert c.alpha.store("a") == (("x#", 3), ("x#2", 2))
    assert print_agent(c, "a") == "a@u0 ended [x = 3, x = 2]"


def test_nothing_rests_on_what_is_only_watched():
    """So the search for races has no more to remember."""
    obs = VariableOf("a", ("obs",))
    live, watched_only = set(), set()
    for c in explore(monitored(watching(figure_2(), asking(obs)))).configurations:
        kept = zip(c.alpha.store("a"), c.alpha.watch("a").store, strict=True)
        found = live if "obs" in c.setting.program.live(c.alpha.code("a")) else watched_only
        found.update(rests_on for (name, _), rests_on in kept if name == "obs")
    assert NOTHING not in live
    assert live
    assert watched_only == {NOTHING}


# --- beside a program that forgets nothing ---------------------------------------------------------------------


class Hoarding(Program):
    """Keeps all variables for ever, and knows nothing of what is watched."""

    @property
    def live(self):
        everything = frozenset(_bound(self))
        return lambda _: everything


def _bound(program):
    """Yield all variables that a program may bind."""
    for statement in program.statements:
        for name in ("variable", "rest"):
            yield from filter(None, [getattr(statement, name, None)])
        for case in getattr(statement, "cases", ()):
            yield from _of_pattern(case.pattern)
    for behaviour in program.behaviours.values():
        yield from behaviour.parameters


def _of_pattern(pattern):
    for item in getattr(pattern, "items", (pattern,)):
        if item is not pattern:
            yield from _of_pattern(item)
        elif getattr(item, "variable", None):
            yield item.variable


def hoarding(c):
    program = c.setting.program
    kept = Hoarding(program.statements, program.behaviours, program.reactions)
    return Configuration(c.setting.with_(program=kept), c.state)


@settings(deadline=None)
@given(
    hypothesis_strategies.initial_configurations(monitored=None),
    st.lists(st.integers(0, 15), max_size=16),
    st.booleans(),
)
def test_what_is_watched_has_the_value_that_it_has_where_nothing_is_forgotten(c, turns, half):
    agents = c.alpha.names()
    names = sorted(each for each in _bound(c.setting.program) if not each.startswith("#"))
    wanted = [VariableOf(a, (name,)) for a in agents for name in (names[::2] if half else names)]

    def remembers(kept, whole):
        """Whether one configuration is the other without the variables that are neither live nor watched."""
        cells, others = (
            {cell: held for cell, held in each.state.items() if cell[0] not in ("store", "watch")}
            for each in (kept, whole)
        )
        return cells == others and all(
            dict(kept.alpha.store(a)) == remembered(a, kept, dict(whole.alpha.store(a)))
            for a in kept.alpha.names()
        )

    def remembered(a, kept, store):
        live = c.setting.program.live(kept.alpha.code(a))
        watches = {each.key for each in wanted if each.agent == a}
        return {name: store[name] for name in store if name in watches or name in live}

    kept, all_of_it = watching(c, asking(*wanted)), hoarding(c)
    for turn in turns:
        try:
            steps, others = successors(kept), successors(all_of_it)
        except Fault:
            return
        if not others:
            assert not steps
            return
        # Steps that differ in what is forgotten alone are one.
        images = [
            [each for each in steps if each.label == other.label and remembers(each.target, other.target)]
            for other in others
        ]
        assert all(len(each) == 1 for each in images)
        assert list(dict.fromkeys(image for (image,) in images)) == list(steps)
        kept, all_of_it = images[turn % len(others)][0].target, others[turn % len(others)].target
        for each in wanted:
            assert holds(IsBound(each), kept) == (each.key in dict(kept.alpha.store(each.agent)))
