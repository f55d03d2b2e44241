"""Families, routes and quantifiers over bigActors, judged by missions in which all of them are written out by hand."""

from math import comb

import pytest
from checked_missions import load, verdict_of
from hypothesis import assume, example, given
from hypothesis import strategies as st
from scale import examples

from checker import Engine, Limits, Reduction, check

LIMITS = Limits(configurations=3_000)
WORLD = """
signature {{
  kind Location contains Location, UAV
  kind UAV driven
  kind Station
}}
world {{
  a0: Location = box (37.04, -8.59) (36.94, -8.79)
  b0: Location = box (37.24, -8.59) (37.14, -8.79)
  gcs0: Station = point (37.3, -8.5) linked mesh
{uavs}
}}
def visit(place, who) = {{ control(MOVE_HOST_TO place) send ("at", place) to who }}
BigActor gcs hosted_at gcs0 with_behavior {{ loop {{ react {{ case ("at", x) => skip }} }} }}
"""

STEPS = (
    "control(MOVE_HOST_TO a0)",
    "visit(b0, gcs)",
    'send ("at", {u}) to gcs',
    "observe(PARENT({u})) react {{ case o => if a0 in o {{ control(MOVE_HOST_TO b0) }} }}",
    "if {i} == 0 {{ control(MOVE_HOST_TO b0) }} else {{ send SELF to {first} react {{ case x => skip }} }}",
    "if {i} > 0 {{ send ({u}, {i}) to {before} }} else {{ react {{ case (={other}, n) => skip }} }}",
    "react {{ case m: Message => skip }}",
    "let n = {i} + 1",
    "control({{ {u}_UAV || a0.$0 -> a0.({u}_UAV | $0) }})",
)
ROUTES = (("a0",), ("a0", "b0", "a0"), ())
STOPS = ("control(MOVE_HOST_TO {stop})", "observe(PARENT({stop})) react {{ case o => skip }}")

CHECKS = (
    "local_consistency race_freedom deadlock_freedom "
    'invariant "not all": not ({ended}) reachable "one in b": {some} ltl "end": {ends} invariant "once": {apart}'
)


def world(number):
    uavs = [f"  uav{n}: UAV = point (37.3, -8.6) linked mesh" for n in range(number)]
    return WORLD.format(uavs="\n".join(uavs))


def as_family(steps, number, control):
    """Return the mission with a family, routes and quantifiers."""
    names = {"u": "u", "i": "i", "first": "f[0]", "before": "f[i - 1]", "other": f"uav{number - 1}"}
    body = " ".join(_written(step, names) for step in steps)
    asked = CHECKS.format(
        ended="forall x: f . ended x",
        some="exists x: agents . x hosted_at uav0 and actually uav0 in b0",
        ends="forall x: f . <> (ended x or waiting x)",
        apart="forall x: f . forall y: f . waiting x and waiting y -> x == y",
    )
    text = f"BigActor f[i] for u in UAV hosted_at u with_behavior {{ {body} }}"
    return f"{world(number)}{text}\ncontrol {control}\ncheck {{ {asked} }}"


def _written(step, names):
    if isinstance(step, str):
        return step.format(**names)
    stops, body = step
    return f"for stop in [{', '.join(stops)}] {{ {body.format(stop='stop')} }}"


def by_hand(steps, number, control):
    """Return the mission with a bigActor for each, its loops unrolled, and formulas written out."""
    actors = []
    for n in range(number):
        names = {"u": f"uav{n}", "i": n, "first": "f_uav0", "other": f"uav{number - 1}"}
        names["before"] = f"f_uav{max(n - 1, 0)}"
        body = " ".join(_unrolled(step, names) for step in steps)
        actors.append(f"BigActor f_uav{n} hosted_at uav{n} with_behavior {{ {body} }}")
    each = [f"f_uav{n}" for n in range(number)]
    pairs = [(x, y) for x in each for y in each if x != y]
    asked = CHECKS.format(
        ended=" and ".join(f"ended {x}" for x in each),
        some=" or ".join(f"({x} hosted_at uav0 and actually uav0 in b0)" for x in ["gcs", *each]),
        ends=" and ".join(f"<> (ended {x} or waiting {x})" for x in each),
        apart=" and ".join(f"not (waiting {x} and waiting {y})" for x, y in pairs) or "true",
    )
    return f"{world(number)}{chr(10).join(actors)}\ncontrol {control}\ncheck {{ {asked} }}"


def _unrolled(step, names):
    """Return a step; a loop takes an internal step before each turn and after the last, and so does an empty `if`."""
    if isinstance(step, str):
        return step.format(**names)
    stops, body = step
    return " ".join(["if true { }", *(f"{body.format(stop=stop)} if true {{ }}" for stop in stops)])


def told(report):
    """Return what does not depend on names: sizes, and for each property its outcome and how often it was found."""
    verdicts = [(each.property.name, each.outcome, each.count) for each in report.verdicts]
    return report.configurations, report.transitions, report.depth, report.rules, verdicts


def checked(text, **more):
    mission = load(text, "")
    return check(mission.initial, mission.properties, LIMITS, **more)


@given(
    st.lists(
        st.one_of(st.sampled_from(STEPS), st.tuples(st.sampled_from(ROUTES), st.sampled_from(STOPS))),
        min_size=1,
        max_size=2,
    ),
    st.sampled_from([1, 2, 2, 3]),
    st.sampled_from(["atomic", "timed"]),
)
@example(steps=[(("a0",), "control(MOVE_HOST_TO {stop})")], number=2, control="atomic")  # what varies of one
@examples(25)
def test_a_family_on_its_routes_is_what_is_written_out_by_hand(steps, number, control):
    family, hand = as_family(steps, number, control), by_hand(steps, number, control)
    whole = checked(hand)
    assume(whole.complete)  # else what was found depends on the order, and that on the names
    expected = told(whole)
    assert told(checked(family)) == expected
    assert told(checked(family, engine=Engine.FAST)) == expected
    reduced = [checked(text, reduce=(Reduction.POR,)) for text in (family, hand)]
    outcomes = [[(each.property.name, each.outcome) for each in report.verdicts] for report in reduced]
    assert outcomes[0] == outcomes[1]


# --- what is found and said


def test_who_is_no_member_is_a_fault_where_it_is_reached():
    looks = 'react { case ("x", v) => send 2 to f[v] }'
    said = 'environment { says ("x", uav1) to f[0] says ("x", gcs0) to f[1] }'
    family = f"BigActor f[i] for u in UAV hosted_at u with_behavior {{ {looks} }}"
    found = verdict_of(checked(world(2) + family + said), "computation")
    (violation,) = found.violations
    assert violation.message == (
        "f[uav1]: there is no member for gcs0: the family's members are f[uav0], f[uav1]"
    )


def test_members_are_named_in_races_and_traces():
    family = """
    BigActor f[i] for u in UAV hosted_at u with_behavior {
      observe(CHILDREN(a0)) react { case o if empty(o of UAV) => control(MOVE_HOST_TO a0) case o => skip }
    }
    check { race_freedom }
    """
    found = verdict_of(checked(world(2) + family), "race_freedom")
    assert found.violations[0].message.startswith("CTR(f[uav1], MOVE_HOST_TO a0) depends on")
    assert str(found.violations[0].trace.steps[-1].label) == "⟨actuate : CTR(f[uav1], MOVE_HOST_TO a0)⟩"


def test_what_one_member_passes_is_covered_for_all():
    family = """
    BigActor f[i] for u in UAV hosted_at u with_behavior {
      if i == 0 { visit(a0, gcs) } else { visit(b0, gcs) }
    }
    """
    found = checked(world(2) + family).coverage
    assert (found.statements.reached, found.statements.of) == (7, 7)
    assert (found.branches.reached, found.branches.of) == (3, 3)
    assert found.gaps == ()


def test_what_is_said_of_each_bigactor_is_one_part_for_vacuity():
    asked = """
    BigActor boss hosted_at gcs0 with_behavior { spawn late hosted_at uav0 with_behavior visit(b0, gcs) }
    check { invariant "f": forall x: agents with_behavior visit . waiting x -> ended x
            invariant "all": forall x: agents . pending OBS x -> waiting x }
    """
    report = checked(world(1) + asked)
    assert verdict_of(report, "f").remarks == (
        "vacuous: 'waiting late' is never true, so that 'ended late' is never needed",
    )
    assert verdict_of(report, "all").remarks == (
        "vacuous: 'pending OBS boss' and its like are never true, so that 'waiting boss' and its like are never needed",
    )


@pytest.mark.long
@pytest.mark.parametrize("route", ["[a0, b0]", "[b0, a0]"])
def test_members_on_one_route_are_interchangeable(route):
    family = f"""
    BigActor f[u] for u in UAV hosted_at u with_behavior {{ for p in {route} {{ control(MOVE_HOST_TO p) }} }}
    check {{ local_consistency deadlock_freedom invariant "f": forall x: f . exists y: f . ended x -> ended y }}
    """
    whole, part = (checked(world(3) + family, reduce=by) for by in ((), (Reduction.SYMMETRY,)))
    assert [each.outcome for each in whole.verdicts] == [each.outcome for each in part.verdicts]
    assert (whole.configurations, part.configurations) == (12**3, comb(12 + 2, 3))
