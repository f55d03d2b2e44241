"""Invariants about ways while a mission runs: held against what is seen, to figures by pyproj."""

import math

import pytest
from live_missions import TWO, Run, aged, mission, seen
from pyproj import Geod

from adapters.live import property_watch
from adapters.live.ground_formulas import TooManyPartsError, about_ways, grounded
from adapters.live.plan import Plan
from adapters.live.seen_regions import STRONGEST
from adapters.plugin import Hold, TakenOver, Underway
from physical import Velocity
from semantics.state.station_partition import Parting, parted

GEOD = Geod(ellps="WGS84")
WEST, EAST, NORTH = (37.01, -8.65), (37.01, -8.61), (37.012, -8.652)
"""Of uav0, of east0's centre, of uav1."""
BOAT = (37.03, -8.63)

FLIES = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }"
STILL = 'BigActor a hosted_at uav0 with_behavior { react { case "go" => skip } }'
APART = 'invariant "apart": forall x, y: UAV . x != y -> x at least 50 m from y'
TIMED = "timing { tick 1 s uav0 flies at 10 m/s to 20 m/s uav1 flies at 10 m/s to 20 m/s }"


def metres(a, b):
    return GEOD.inv(a[1], a[0], b[1], b[0])[2]


def beside(at, azimuth, away):
    """The point so many metres from another."""
    east, north, _ = GEOD.fwd(at[1], at[0], azimuth, away)
    return north, east


def watching(checks, body=STILL, more="", both=True):
    """A run that watches the invariants about ways of two vehicles."""
    elaborated = mission(f"{TWO}{body} {more} check {{ {checks} }}")
    vehicles = {"uav0": "autopilot", **({"uav1": "autopilot"} if both else {})}
    plan = Plan(
        elaborated.initial,
        vehicles,
        elaborated.precautions,
        invariants=about_ways(*elaborated.properties),
        fixed=elaborated.fixed,
    )
    run = Run(plan)
    run.turn(0.0, seen("uav0", WEST, 0.0), seen("uav1", NORTH, 0.0))
    return run


def flown(run, now, uav0, uav1=None, speed=None, **more):
    moving = {} if speed is None else {"velocity": Velocity(speed, 0.0)}
    heard = [seen(name, at, now, **moving, **more) for name, at in (("uav0", uav0), ("uav1", uav1)) if at]
    return run.turn(now, *heard)


def standing(run, name="apart"):
    return next(each for each in run.state.watched.standings if each.property == name)


def test_two_vehicles_that_come_near_break_their_distance_at_once_with_the_figure_of_the_ellipsoid():
    run = watching(APART)
    assert standing(run).holds
    assert standing(run).figure == f"uav0 may come within {int(metres(WEST, NORTH))} m of uav1; at least 50 m"
    near = beside(WEST, 40.0, 49.9)
    flown(run, 1.0, WEST, near)
    (message,) = run.messages("broken property")
    assert message.startswith(
        "invariant 'apart' is broken: uav0 may come within 49 m of uav1; at least 50 m; from (37.01"
    )
    assert [each.fallback for each in run.findings if each.kind == "broken property"] == ["continue"]
    assert not standing(run).holds
    for shown, real in zip(standing(run).points, (WEST, near), strict=True):
        assert metres(shown, real) < 0.1
    assert not run.state.overrides.suspended


def test_vehicles_that_are_exactly_as_far_apart_as_asked_break_nothing():
    run = watching(APART)
    flown(run, 1.0, WEST, beside(WEST, 40.0, 50.1))
    assert standing(run).holds
    assert run.kinds() == []


def test_a_broken_property_is_reported_once_and_again_only_after_it_has_held_for_a_while():
    run, near, far = watching(APART), beside(WEST, 0.0, 40.0), beside(WEST, 0.0, 100.0)
    for now in (1.0, 2.0, 3.0):
        flown(run, now, WEST, near)
    flown(run, 4.0, WEST, far)
    flown(run, 5.0, WEST, beside(WEST, 0.0, 39.0))
    assert len(run.messages("broken property")) == 1
    flown(run, 6.0, WEST, far)
    flown(run, 17.0, WEST, far)
    flown(run, 18.0, WEST, beside(WEST, 0.0, 30.0))
    assert len(run.messages("broken property")) == 2


def test_the_mission_may_hold_its_vehicles_on_a_broken_property():
    run = watching(APART, more="live { on broken property: hold }")
    flown(run, 1.0, WEST, beside(WEST, 0.0, 40.0))
    assert {type(each) for each in run.commands} == {Hold}
    assert sorted(each.entity for each in run.commands) == ["uav0", "uav1"]
    assert run.state.overrides.suspended


def test_a_position_grows_by_its_age_at_the_greatest_speed_of_the_mission():
    run = watching(APART, more=TIMED)
    apart = beside(WEST, 90.0, 200.5)
    flown(run, 1.0, WEST, apart)
    run.turn(4.0, seen("uav0", WEST, 4.0))  # uav1 may be 60 m nearer
    assert standing(run).figure == "uav0 may come within 140 m of uav1; at least 50 m"
    run.turn(8.4, seen("uav0", WEST, 8.4))
    assert standing(run).holds
    run.turn(8.7, seen("uav0", WEST, 8.7))  # 46.5 m are left
    assert not standing(run).holds
    assert "uav0 may come within 46 m of uav1" in run.messages("broken property")[0]


def test_without_the_missions_speed_a_vehicle_may_gain_speed_from_the_one_that_it_reported():
    run = watching(APART)
    apart = beside(WEST, 90.0, 200.5)
    flown(run, 1.0, WEST, apart, speed=10.0)
    run.turn(3.0, seen("uav0", WEST, 3.0))
    assert (
        standing(run).figure
        == f"uav0 may come within {int(200.5 - 20 - STRONGEST * 2)} m of uav1; at least 50 m"
    )


def test_a_vehicle_whose_speed_nothing_bounds_may_be_anywhere():
    run = watching(
        f'{APART} invariant "out": forall x: UAV . not possibly x in east0 '
        'invariant "in": forall x: UAV . surely x in west0 invariant "near": uav0 within 5 km of gcs0'
    )
    assert all(each.holds for each in run.state.watched.standings)
    run.turn(2.0, seen("uav1", NORTH, 2.0))
    assert [each.property for each in run.state.watched.standings if not each.holds] == [
        "apart",
        "out",
        "in",
        "near",
    ]
    assert standing(run, "near").figure == (
        "uav0 was seen 2 s ago, and nothing bounds its speed; uav0 within 5000 m of gcs0"
    )


PRISON = TWO.replace(
    "gcs0: Station",
    "mid0: Location = box (37.02, -8.628) (37.00, -8.632)\n  south0: Location = box (36.96, -8.62) (36.95, -8.64)\n"
    "  gcs0: Station",
    1,
)
OUT = 'invariant "out": not possibly uav0 in mid0'
MID, SOUTH = (37.01, -8.63), (36.955, -8.63)
ROUND = "BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0 VIA south0) }"


def sent(checks, body, more=""):
    """A run whose uav0 is sent to east0."""
    elaborated = mission(f"{PRISON}{body} environment {{ {more} }} check {{ {checks} }}")
    plan = Plan(
        elaborated.initial,
        {"uav0": "autopilot", "uav1": "autopilot"},
        elaborated.precautions,
        invariants=about_ways(*elaborated.properties),
        fixed=elaborated.fixed,
    )
    run = Run(plan)
    run.turn(0.0, seen("uav0", WEST, 0.0), seen("uav1", NORTH, 0.0))
    return run


def test_the_way_ahead_counts_as_soon_as_a_vehicle_is_sent():
    run = sent(OUT, FLIES)
    assert "GoTo" in run.told
    assert not standing(run, "out").holds
    (message,) = run.messages("broken property")
    assert message.startswith("invariant 'out' is broken: uav0 may be in mid0; such as at (37.0")
    ((_, longitude),) = standing(run, "out").points
    assert -8.6321 < longitude < -8.6279


def test_a_way_round_a_place_keeps_out_of_it_and_says_how_far():
    run = sent(OUT, ROUND)
    assert "Follow" in run.told
    flown(run, 1.0, (36.99, -8.645), NORTH)
    assert standing(run, "out").holds
    assert run.messages("broken property") == []
    figure = standing(run, "out").figure
    assert figure.startswith("uav0 is ")
    assert figure.endswith(" m from mid0")


def test_what_is_behind_counts_no_more():
    run = sent(OUT, FLIES)
    flown(run, 1.0, (37.01, -8.625), NORTH)
    assert standing(run, "out").holds


def test_a_waypoint_is_behind_once_the_vehicle_turns_from_it_to_the_next():
    run = sent(OUT, ROUND)
    way = run.state.commanded.flights["uav0"].way
    assert [round(metres(way.points[i].vertices[0], at)) for i, at in enumerate((WEST, SOUTH, EAST))] == [
        0,
        0,
        0,
    ]
    assert run.state.commanded.flights["uav0"].way.passed == 1
    flown(run, 1.0, beside(SOUTH, 180.0, 150.0), NORTH)
    assert run.state.commanded.flights["uav0"].way.passed == 1
    flown(run, 2.0, beside(SOUTH, 20.0, 60.0), NORTH)
    assert run.state.commanded.flights["uav0"].way.passed == 2


def test_a_vehicle_that_was_taken_over_counts_where_it_is_seen():
    run = sent(OUT, FLIES)
    run.turn(1.0, seen("uav0", WEST, 1.0), reports=[TakenOver("uav0", 1.0, "a pilot")])
    assert standing(run, "out").holds


def figure_of(text):
    return int(text.split(" within ")[1].split(" m ")[0])


def test_strays_widens_the_way():
    checks, at = 'invariant "far": uav0 at least 1 m from mid0', (36.9825, -8.64)
    narrow, wide = sent(checks, ROUND), sent(checks, ROUND, "uav0 strays at most 100 m")
    for run in (narrow, wide):
        flown(run, 1.0, at, NORTH)
    # the nearest corner of mid0 to the line from south0's middle to east0's
    ahead, _, length = GEOD.inv(SOUTH[1], SOUTH[0], EAST[1], EAST[0])
    lines = [GEOD.fwd(SOUTH[1], SOUTH[0], ahead, length * i / 2000) for i in range(2001)]
    least = min(metres((north, east), (37.0, -8.628)) for east, north, _ in lines)
    assert figure_of(standing(narrow, "far").figure) == pytest.approx(least, abs=1)
    assert figure_of(standing(wide, "far").figure) == pytest.approx(least - 100, abs=1.5)


def test_one_look_measures_a_bounded_number_of_pairs_and_the_next_ones_the_others(monkeypatch):
    monkeypatch.setattr(property_watch, "MOST_COMPARED", 1)
    checks = " ".join(
        f'invariant "{name}": uav0 at least 10 m from {name}' for name in ("mid0", "uav1", "south0")
    )
    run = sent(checks, ROUND)
    measured = [frozenset(name for name, (_, at) in times(run).items() if at == 0.0)]
    for now in (1.0, 2.0, 3.0):
        flown(run, now, (36.99, -8.645), NORTH)
        measured.append(frozenset(name for name, (_, at) in times(run).items() if at == now))
    assert {len(each) for each in measured} == {1}
    assert len(frozenset().union(*measured)) == len(times(run)) >= 2
    assert not standing(run, "south0").holds  # its way leads through it


def times(run):
    return {str(atom): known for atom, known in run.state.watched.compared.items()}


def test_a_formula_with_too_many_pairs_is_not_watched():
    found = mission(f"{TWO}{STILL} check {{ {APART} }}").properties
    (formula,) = (each for each in found if each.name == "apart")
    (ground,) = about_ways(*found)
    assert str(ground.formula) == "uav0 at least 50 m from uav1"
    with pytest.raises(TooManyPartsError):
        grounded(formula.formula, 2)


def test_a_vehicle_that_is_not_heard_any_more_may_be_anywhere():
    run = watching(f"{APART}", more="live { on broken assumption: continue }")
    run.turn(1.0, aged(seen("uav0", WEST, 1.0), 5.0), aged(seen("uav1", beside(NORTH, 0.0, 300.0), 1.0), 5.0))
    run.turn(3.0, aged(seen("uav0", WEST, 3.0), 5.0), aged(seen("uav1", beside(NORTH, 0.0, 300.0), 3.0), 5.0))
    assert standing(run).holds
    run.turn(9.0, aged(seen("uav0", WEST, 9.0), 5.0))
    assert standing(run).figure == "uav1 is not seen and may be anywhere; uav0 at least 50 m from uav1"
    assert not standing(run).holds


def test_a_vehicle_that_may_leave_its_area_has_the_metres_and_the_point():
    run = watching('invariant "in": surely uav0 in west0', body=FLIES)
    beyond = metres(EAST, (EAST[0], -8.64))
    assert standing(run, "in").figure == f"uav0 may be up to {math.ceil(beyond)} m outside west0"
    assert metres(standing(run, "in").points[0], EAST) < 0.1


SENT = 'BigActor b hosted_at gcs0 with_behavior { react { case "go" => control(MOVE uav1 TO east0%s) } }'


@pytest.mark.parametrize(
    ("via", "holds"),
    [("", True), (" VIA north0", False)],
    ids=["straight", "by a place"],
)
def test_a_vehicle_that_another_station_sent_may_fly_by_any_way_that_the_mission_has(via, holds):
    """The other station does not say by which places: the text does."""
    away = TWO.replace("east0:", "north0: Location = box (37.042, -8.628) (37.038, -8.632)\n  east0:")
    checks = 'invariant "p": uav1 at least 300 m from boat0'
    elaborated = mission(f"{away}{STILL} {SENT % via} check {{ {checks} }}")
    parting = Parting("gcs1", {"gcs0": "gcs0", "gcs1": "gcs1", "uav0": "gcs1"}, {}, {})
    plan = Plan(
        parted(elaborated.initial, parting),
        {"uav0": "autopilot", "uav1": "stations"},
        invariants=about_ways(*elaborated.properties),
        fixed=elaborated.fixed,
        peers="stations",
    )
    run = Run(plan)
    run.turn(
        0.0,
        seen("uav0", WEST, 0.0),
        seen("uav1", NORTH, 0.0, "stations"),
        seen("boat0", BOAT, 0.0, kind="Vessel"),
    )
    assert standing(run, "p").holds
    run.turn(1.0, seen("uav1", NORTH, 1.0, "stations"), reports=[Underway("uav1", 1.0, "east0")])
    run.turn(2.0, seen("uav1", NORTH, 2.0, "stations"), seen("boat0", BOAT, 2.0, kind="Vessel"))
    assert run.messages() == []
    assert standing(run, "p").holds is holds


def test_another_ship_moves_on_at_the_speed_that_it_reported():
    run = watching('invariant "clear": uav0 at least 100 m from boat0')
    at = beside(WEST, 0.0, 300.5)
    run.turn(1.0, seen("uav0", WEST, 1.0), boat_at(at, 1.0, 10.0))
    assert standing(run, "clear").figure == "uav0 may come within 300 m of boat0; at least 100 m"
    run.turn(16.0, seen("uav0", WEST, 16.0))
    assert standing(run, "clear").figure == "uav0 may come within 150 m of boat0; at least 100 m"
    run.turn(22.0, seen("uav0", WEST, 22.0))
    assert not standing(run, "clear").holds


def boat_at(at, time, speed):
    return seen("boat0", at, time, "ais", "Vessel", (), velocity=Velocity(speed, 180.0))
