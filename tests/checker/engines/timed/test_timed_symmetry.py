"""Symmetry in missions with times: verdicts and dates are those of the full search, and what is shown replays."""

from dataclasses import replace

from checked_missions import load
from hypothesis import HealthCheck, assume, given
from hypothesis import strategies as st
from replaying import assert_replays
from scale import examples
from swarms import swarms
from timed_missions import timings, with_timing
from timed_reports import assert_alike

from checker import Engine, Keeping, Limits, RefusedError, check
from checker.check import BY_LOOKING
from checker.reduction import Reduced, Reduction
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import And, Ended, Inside, Not, Or
from semantics.timing.flight_history import vehicles
from semantics.timing.timing import Endurance, Motion

SYMMETRY = (Reduction.SYMMETRY,)
ENGINES = (Engine.REFERENCE, Engine.FAST)
ALWAYS = [
    Property(kind, kind.value) for kind in (*BY_LOOKING, PropertyKind.RACE_FREEDOM, PropertyKind.ENDURANCE)
]


def there(robot, place="room0"):
    return Inside(f"robot{robot}", place, actually=True)


def of_all(robots, part, joined=And):
    return joined(tuple(part(robot) for robot in range(robots)))


def ended(robot):
    return Ended(f"r{robot}")


def within(bound, formula, then=None):
    return Property(PropertyKind.WITHIN, f"within {bound}", formula, bound=bound, then=then)


def when(formula, name="time"):
    return Property(PropertyKind.TIME, name, formula)


@st.composite
def alike_timings(draw, setting):
    """Yield timings, most of them the same for robots that are alike."""
    timing = draw(timings(setting, 60_000))
    driven = vehicles(setting)
    motions, lasting = dict(timing.motions), dict(timing.endurances)
    if draw(st.integers(0, 5)):
        motions = dict.fromkeys(driven, Motion((40.0, 60.0)))
        places = draw(st.sampled_from([(), ("dock0",), ("dock0", "room0")]))
        one = Endurance(draw(st.integers(0, 6)), places, draw(st.integers(0, 2)))
        lasting = dict.fromkeys(driven, one) if draw(st.booleans()) else {}
    clauses = list(timing.clauses)
    for number, clause in enumerate(setting.environment if draw(st.integers(0, 5)) else ()):
        first = next(at for at, each in enumerate(setting.environment) if type(each) is type(clause))
        clauses[number] = clauses[first]
    return replace(
        timing,
        motions=tuple(sorted(motions.items())),
        endurances=tuple(sorted(lasting.items())),
        clauses=tuple(clauses),
    )


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
        lengths = [sorted(len(each.trace) for each in verdict.violations)[:1] for verdict in (one, other)]
        assert lengths[0] == lengths[1]
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
@examples(36, suppress_health_check=list(HealthCheck))
def test_generated_swarms_are_decided_alike_with_and_without_symmetry(data, text, properties):
    c = load(text, "").initial
    assert_reduced_soundly(with_timing(c, data.draw(alike_timings(c.setting))), properties)
