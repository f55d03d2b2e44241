"""Symmetry in missions with times: verdicts and dates are those of the full search, and what is shown replays."""

from dataclasses import replace

import numpy as np
import pytest
from checked_missions import load
from hypothesis import HealthCheck, assume, given
from hypothesis import strategies as st
from replaying import assert_replays
from scale import IS_WHOLE, examples, some_long
from swarms import AROUND, LISTENS, LOOKS, ORBITS, mission, swarm, swarms
from timed_missions import alike_timings, with_timing
from timed_reports import assert_alike

from checker import Engine, Keeping, Limits, Outcome, RefusedError, check, explore
from checker.check import BY_LOOKING
from checker.engines.fast.compiled.jit_decorators import njit
from checker.engines.fast.store.canonicalise import represent
from checker.properties.schedule import flights_of
from checker.reduction import Reduced, Reduction
from checker.reduction.symmetry import MissionSymmetry
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import And, Ended, Inside, Not, Or
from semantics.successors import expand
from semantics.timing.intervals import Interval
from semantics.timing.timing import ClauseTimes, Endurance, Every, Motion, Sayable, Timing, Window

SYMMETRY = (Reduction.SYMMETRY,)
ENGINES = (Engine.REFERENCE, Engine.FAST)
ALWAYS = [
    Property(kind, kind.value) for kind in (*BY_LOOKING, PropertyKind.RACE_FREEDOM, PropertyKind.ENDURANCE)
]


def there(robot, place="room0"):
    return Inside(f"robot{robot}", place, actually=True)


MOST = 2_000
"""The most states in whole ticks."""


def of_all(robots, part, joined=And):
    return joined(tuple(part(robot) for robot in range(robots)))


def ended(robot):
    return Ended(f"r{robot}")


def within(bound, formula, then=None):
    return Property(PropertyKind.WITHIN, f"within {bound}", formula, bound=bound, then=then)


def when(formula, name="time"):
    return Property(PropertyKind.TIME, name, formula)


FORMULAS = (
    of_all(2, there),
    of_all(2, there, Or),
    of_all(2, ended),
    of_all(2, ended, Or),
    Not(of_all(2, lambda each: there(each, "dock0"))),
)


@st.composite
def asked(draw):
    formula, other = (st.sampled_from(FORMULAS) for _ in range(2))
    return [
        *ALWAYS,
        within(draw(st.integers(0, 8)), draw(formula)),
        replace(within(draw(st.integers(0, 4)), draw(formula), draw(other)), name="response"),
        when(draw(formula)),
    ]


def decided(c, properties, engine, reduce=(), **more):
    report = check(
        c, properties, Limits(configurations=4_000), engine=engine, reduce=reduce, times=True, **more
    )
    assert_replays(report)
    return report


def shortest(verdict):
    """Return the least number of steps to a violation; 0 where time stops, since runs go round differently there."""
    return min((0 if each.trace.loop else len(each.trace) for each in verdict.violations), default=None)


def assert_same_answers(found, right):
    """Look whether a reduced search decides the same, with the same dates."""
    assert found.configurations <= right.configurations
    for one, other in zip(found.verdicts, right.verdicts, strict=True):
        assert (one.property, one.outcome) == (other.property, other.outcome)
        if one.property.kind in (PropertyKind.TIME, PropertyKind.WITHIN):
            assert one.note == other.note
        if one.property.kind is PropertyKind.ENDURANCE:
            assert one.different == other.different
            assert {each.subject for each in one.violations} == {each.subject for each in other.violations}
        assert shortest(one) == shortest(other)
        if one.witness is not None and one.property.kind is PropertyKind.TIME:
            assert one.witness.dates[-1:] == other.witness.dates[-1:]
    assert found.schedule == right.schedule
    assert found.flights == right.flights


def assert_reduced_soundly(c, properties):
    """Compare both engines, each with and without symmetry."""
    try:
        Reduced(c, SYMMETRY)
    except RefusedError:
        assume(False)
    right = decided(c, properties, Engine.REFERENCE)
    assume(right.complete)
    try:
        slow = decided(c, properties, Engine.REFERENCE, SYMMETRY, keeping=Keeping(doubted=5))
    except RefusedError:
        assume(False)
    fast = decided(c, properties, Engine.FAST, SYMMETRY, keeping=Keeping(doubted=5))
    assert_alike(slow, fast)
    assert_same_answers(slow, right)
    assert_same_answers(fast, right)


@given(st.data(), swarms(), asked())
@examples(36, 9, suppress_health_check=list(HealthCheck))
def test_generated_swarms_are_decided_alike_with_and_without_symmetry(data, text, properties):
    c = load(text, "").initial
    assert_reduced_soundly(with_timing(c, data.draw(alike_timings(c.setting))), properties)


# --- by hand --------------------------------------------------------------------------------------------------------

FAST_ONES = Motion((40.0, 60.0))
TICK = 60_000
SOON = Interval(0, 1)


def timed(c, **more):
    """Give a mission times that are the same for all its vehicles."""
    motions = tuple((name, FAST_ONES) for name in c.setting.driven())
    return with_timing(c, replace(Timing(TICK, motions, (), SOON, SOON), **more))


def lasting(c, **more):
    return tuple((name, replace(Endurance(4, ("dock0",), 1), **more)) for name in c.setting.driven())


def each(kind, *times):
    """Return the times of clauses."""
    return tuple(ClauseTimes(kind(*pair)) for pair in times)


COMES_BACK = "control(MOVE_HOST_TO room0) control(MOVE_HOST_TO dock0)"
VANISHING = "control timed\nenvironment { robot0 vanishes robot1 vanishes robot2 vanishes }"
TIMED_CONTROL = "control timed\nscheduler fcfs"


def with_crates(environment):
    text = swarm("skip", 1, f"control timed\nenvironment {{ {environment} }}")
    there = "".join(f"  c{k}: Crate = point (37.00, -8.70)\n" for k in range(2))
    return load(text.replace("}\ndef", f"{there}}}\ndef"), "").initial


def crate(number):
    return Inside(f"c{number}", "dock0", actually=True)


CRATES = with_crates(
    "c0 vanishes c1 vanishes c0 appears at point (37.00, -8.70) c1 appears at point (37.00, -8.70)"
)
GONE = [within(5, Not(Or((crate(0), crate(1))))), when(Not(Or((crate(0), crate(1)))))]
BACK = [replace(within(2, Not(Or((crate(0), crate(1)))), And((crate(0), crate(1)))), name="back")]
ARRIVALS = [when(of_all(3, there)), when(of_all(3, there, Or), "one"), within(5, of_all(3, there))]
BOTH_HOME = [
    when(of_all(2, there, Or)),
    replace(within(3, of_all(2, there, Or), of_all(2, lambda each: there(each, "dock0"), Or)), name="home"),
]
FIRST_IS_TOLD = (
    'BigActor base hosted_at gcs0 with_behavior { react { case ("at", who) => send "go" to who } }'
)
MISSIONS = {
    "one queue": (mission(LOOKS, 3, TIMED_CONTROL).initial, {}, ARRIVALS),
    "no queue": (mission(LOOKS, 2, "control timed").initial, {}, BOTH_HOME),
    "endurance": (mission(COMES_BACK, 2, TIMED_CONTROL).initial, {"lasts": 4}, BOTH_HOME),
    "endurance renewed": (
        mission(COMES_BACK, 2, "control timed").initial,
        {"lasts": 3, "after": 0},
        BOTH_HOME,
    ),
    "windows": (
        mission("skip", 3, VANISHING).initial,
        {"clauses": each(Window, (1, 3), (1, 3), (1, 3))},
        [when(Not(of_all(3, lambda each: there(each, "dock0"), Or)))],
    ),
    "windows not open yet": (CRATES, {"clauses": each(Window, (1, 2), (1, 2), (2, 3), (2, 3))}, GONE + BACK),
    "events in turn": (
        mission("skip", 2, f"control timed\n{AROUND[4]}").initial,
        {"clauses": (ClauseTimes(Every(2), 1),) * 2},
        [],
    ),
    "messages": (
        mission(*ORBITS["answered"][:1], 3, f"control timed\n{LISTENS}").initial,
        {"messages": (("mesh", Interval(1, 2)),), "clauses": each(Sayable, (1, 2), (1, 2), (1, 2))},
        [when(of_all(3, ended)), within(3, of_all(3, ended, Or))],
    ),
    "answers to whoever was first": (
        mission('send ("at", SELF) to base', 2, f"control timed\n{FIRST_IS_TOLD}").initial,
        {"messages": (("mesh", Interval(1, 2)),)},
        [],
    ),
    "time stops": (
        mission('loop { send "go" to SELF react { case "go" => skip } }', 2).initial,
        {"react": Interval(0, 0), "messages": (("", Interval(0, 0)),)},
        [],
    ),
}


def made(name):
    c, times, properties = MISSIONS[name]
    if "lasts" in times:
        times = {"endurances": lasting(c, **times)}
    return timed(c, **times), [*ALWAYS, *properties]


@pytest.mark.parametrize("name", some_long(MISSIONS, every=2))
def test_symmetry_decides_as_the_full_search_does(name):
    c, properties = made(name)
    right = decided(c, properties, Engine.FAST)
    fast = decided(c, properties, Engine.FAST, SYMMETRY, keeping=Keeping(doubted=9))
    slow = decided(c, properties, Engine.REFERENCE, SYMMETRY)
    assert right.complete
    if slow.complete:
        assert_alike(slow, fast)
    assert_same_answers(fast, right)
    assert fast.configurations < right.configurations


def names(c, formulas=()):
    """Return the robots that are exchanged."""
    classes = MissionSymmetry(c, formulas).classes
    found = {name for each in classes for several in each.names for name in several}
    return {name for name in found if name.startswith("robot")}


THREE = mission(LOOKS, 3, TIMED_CONTROL).initial
LASTING = dict(lasting(THREE))
APART = {
    "speeds": timed(
        THREE, motions=(("robot0", FAST_ONES), ("robot1", FAST_ONES), ("robot2", Motion((40.0, 61.0))))
    ),
    "a speed for two": timed(THREE, motions=(("robot0", FAST_ONES), ("robot1", FAST_ONES))),
    "endurances": timed(THREE, endurances=tuple((LASTING | {"robot2": Endurance(5, ("dock0",), 1)}).items())),
    "places": timed(THREE, endurances=tuple((LASTING | {"robot2": Endurance(4, ("room0",), 1)}).items())),
    "an endurance of one": timed(THREE, endurances=(("robot2", LASTING["robot2"]),)),
    "windows": timed(MISSIONS["windows"][0], clauses=each(Window, (1, 3), (1, 3), (1, 2))),
}


@pytest.mark.parametrize("name", APART)
def test_who_has_times_of_its_own_is_not_exchanged(name):
    assert names(APART[name]) == {"robot0", "robot1"}


def test_of_two_with_different_times_nothing_is_exchanged_and_the_reason_is_told():
    two = mission(LOOKS, 2, TIMED_CONTROL).initial
    slow = timed(two, motions=(("robot0", FAST_ONES), ("robot1", Motion((20.0, 60.0)))))
    for c, reason in (
        (slow, "their speeds differ"),
        (timed(two, endurances=lasting(two)[:1]), "their endurances differ"),
    ):
        with pytest.raises(RefusedError, match=reason):
            check(c, ALWAYS, reduce=SYMMETRY)


def test_who_is_named_by_a_deadline_is_not_exchanged():
    engine = Engine.FAST
    c = timed(THREE)
    named = [*ALWAYS, within(4, there(2)), when(there(2))]
    report = decided(c, named, engine, SYMMETRY)
    assert_same_answers(report, decided(c, named, Engine.FAST))
    assert names(c, [there(2)]) == {"robot0", "robot1"}
    with pytest.raises(RefusedError, match="a property distinguishes them"):
        check(
            timed(mission(LOOKS, 2, TIMED_CONTROL).initial),
            [within(4, there(0))],
            engine=engine,
            reduce=SYMMETRY,
        )


def test_a_response_that_names_one_separates_it():
    c = timed(mission(LOOKS, 2, TIMED_CONTROL).initial)
    with pytest.raises(RefusedError, match="a property distinguishes them"):
        check(c, [within(4, of_all(2, there), there(1))], reduce=SYMMETRY)


def test_vehicles_that_come_back_in_flight_are_not_exchanged():
    events = " ".join(f"robot{i} vanishes robot{i} appears at point (37.00, -8.70)" for i in range(2))
    c = timed(mission(LOOKS, 2, f"control timed\nenvironment {{ {events} }}").initial)
    with pytest.raises(RefusedError, match="of two flights of it one is taken by name"):
        check(c, ALWAYS, reduce=SYMMETRY)


def test_endurance_of_each_alike_is_reported_with_a_run_of_its_own():
    c, properties = made("endurance renewed")
    for engine in ENGINES:
        found = decided(c, properties, engine, SYMMETRY).verdicts["endurance"]
        assert found.outcome is Outcome.VIOLATED
        assert sorted(each.subject for each in found.violations) == ["robot0", "robot1"]


PAIRING = """
BigActor base hosted_at gcs0 with_behavior {
  loop { react { case ("here", x) => react { case ("here", y) => send ("two", x) to y } } }
}"""
PAIRED = 'send ("here", SELF) to base react { case ("two", z) => skip }'
TIED = {
    "one queue": made("one queue")[0],
    "messages": made("messages")[0],
    "two pairs": timed(mission(PAIRED, 4, TIMED_CONTROL + PAIRING).initial),
}


@pytest.mark.parametrize("name", TIED)
def test_both_engines_replace_a_row_by_the_same_exchange(name):
    """Several exchanges may lead to one representative, as with two pairs that are alike; dates are those of one."""
    c = TIED[name]
    found = explore(c, limits=Limits(configurations=300), engine=Engine.FAST, reduce=Reduced(c, SYMMETRY))
    network, symmetry = found.times.shown.network, found.reducer.symmetry
    members, several = range(len(symmetry.items.members)), 0
    for one in list(found.configurations)[:120]:
        for step in expand(one).transitions:
            renaming, place = symmetry.sorting(step.target)[0], place_of(network, step.target)
            assert all(moves(symmetry, renaming, member, place[member]) for member in members)
            several += place != sorted(place)
    assert several


def moves(symmetry, renaming, member, to):
    """Tell whether a renaming replaces a member by another one."""
    items = symmetry.items
    return tuple(map(renaming.name, items.members[member][0])) == items.members[to][0]


@njit()
def represented(x, d, words, columns):
    return represent(x, d, words, 0, len(words), columns)


def place_of(network, c):
    """Return the place of each member in the representative, by the compiled loops."""
    tables, words = network.model.exchanging, packed(network, c)
    while not represented(tables.exchanges, tables.desk, words.copy(), network.store.packing.columns):
        tables.learn()
        network.model.see()
        words = packed(network, c)
    return tables.desk.place.tolist()


def packed(network, c):
    codes = network.learner.columns.codes(c.state)
    network.model.see()
    where = network.store.packing
    words = np.zeros(where.words, np.uint64)
    for word, shift, code in zip(where.word, where.shift, codes, strict=True):
        words[word] |= np.uint64(code) << shift
    return words


def test_a_loop_that_exchanges_names_is_unfolded_until_it_closes():
    goes_round = 'send "go" to SELF loop { react { case "go" => send "go" to SELF } }'
    none = Interval(0, 0)
    c = with_timing(mission(goes_round, 2).initial, Timing(TICK, react=none, messages=(("", none),)))
    for engine in ENGINES:
        found = explore(c, engine=engine, reduce=Reduced(c, SYMMETRY)).times
        shown, stop = found.shown.stop(), found.stop()
        assert len(stop.run.steps) - stop.steps == 2 * (len(shown.run.steps) - shown.steps)
        decided(c, ALWAYS, engine, SYMMETRY)  # its loop replays


def test_flights_of_each_alike_have_the_dates_of_all():
    c = timed(mission(COMES_BACK, 2, TIMED_CONTROL).initial)
    right = flights_of(explore(c, engine=Engine.FAST).times)
    for engine in ENGINES:
        found = explore(c, engine=engine, reduce=Reduced(c, SYMMETRY)).times
        assert flights_of(found) == right
        assert flights_of(found.shown) != right


def test_the_path_of_an_exhausted_vehicle_ends_with_its_own_return():
    initial = mission(COMES_BACK, 3, TIMED_CONTROL).initial
    c = timed(initial, endurances=lasting(initial, lasts=2))
    found = check(c, ALWAYS[-1:], engine=Engine.FAST, reduce=SYMMETRY).verdicts["endurance"]
    assert [each.path[-1].label.agent for each in found.violations] == ["r0", "r1", "r2"]
    assert [each.subject for each in found.violations] == ["robot0", "robot1", "robot2"]


def test_clocks_that_are_exchanged_have_the_same_constants():
    for name in ("one queue", "messages", "endurance"):
        c = made(name)[0]
        network = explore(c, engine=Engine.FAST, reduce=Reduced(c, SYMMETRY)).times.shown.network
        constants = {}
        for number, (clock, _) in enumerate(network.keys):
            constants.setdefault(network.kin(clock), set()).add(network.automaton.constants(number))
        assert all(len(several) == 1 for several in constants.values())
        assert len(constants) < len(network.keys)


def test_findings_are_told_in_the_names_of_their_traces():
    rest = "control timed\nenvironment { robot0 vanishes robot1 vanishes robot2 vanishes }"
    c = timed(mission(LOOKS, 3, rest).initial)
    told = 0
    for engine in ENGINES if IS_WHOLE else (Engine.FAST,):
        for verdict in decided(c, ALWAYS, engine, SYMMETRY).verdicts:
            make = BY_LOOKING.get(verdict.property.kind)
            for violation in verdict.violations if make is not None else ():
                assert violation.message in set().union(
                    *map(messages(make), violation.trace.configurations[-2:])
                )
                told += "r1" in violation.message or "r2" in violation.message
    assert told


def messages(make):
    """Return a function that tells what an inspection finds in a configuration."""

    def found(c):
        inspection = make(9)
        inspection(0, c, expand(c))
        return {each.message for each in inspection.collected.first.values()}

    return found
