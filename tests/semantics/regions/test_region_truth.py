"""The truth of claims about regions along runs of small missions, and what a report says of them."""

import pytest

from semantics.properties.property import watching
from semantics.properties.propositions import And, Not, Or, holds
from semantics.properties.region_atoms import ApartFrom, PossiblyIn, SurelyIn, WithinRangeOf
from semantics.regions.region_report import region_lines
from semantics.regions.region_truth import located
from semantics.successors import successors
from specs.elaboration import read_mission

WORLD = """
signature {
  kind Area contains Area, UAV, Vessel, Station
  kind UAV driven
  kind Vessel driven carries UAV
  kind Station
}
control timed
world {
  west0: Area = circle (37.1, -8.64) radius 300 m
  east0: Area = circle (37.1, -8.56) radius 300 m
  north0: Area = circle (37.15, -8.6) radius 300 m
  prison0: Area = circle (37.1, -8.6) radius 900 m
  uav0: UAV = point (37.1, -8.641) altitude 80 m to 120 m
  uav1: UAV = point (37.1, -8.59) altitude 200 m to 220 m
  ship0: Vessel = point (37.2, -8.6) altitude 0 m to 10 m
  uav2: UAV carried by ship0
  ghost0: UAV absent
  gcs0: Station = point (37.1, -8.7)
}
"""
NOTHING = 'check { invariant "p": possibly uav0 in prison0 }'


def runs(program, more="", labels=()):
    """Return the configurations of the run whose labels contain these words in turn."""
    text = f"{WORLD}\nBigActor a hosted_at uav0 with_behavior {{ {program} }}\n{more}\n{NOTHING}"
    mission = read_mission(text)
    found = [watching(mission.initial, mission.properties)]
    for word in labels:
        (step,) = [each for each in successors(found[-1]) if word in str(each.label)]
        found.append(step.target)
    return found


TO_EAST = ("req_ctr", "command", "commit")


def test_a_vehicle_on_its_way_may_be_over_a_place_that_it_only_crosses():
    _, asked, flying, there = runs("control(MOVE_HOST_TO east0)", labels=TO_EAST)
    truths = [holds(PossiblyIn("uav0", "prison0"), c) for c in (asked, flying, there)]
    assert truths == [False, True, False]
    assert [holds(PossiblyIn("uav0", "north0"), c) for c in (asked, flying, there)] == [False] * 3


def test_a_via_leads_around_a_place():
    *_, flying, _ = runs("control(MOVE_HOST_TO east0 VIA north0)", labels=TO_EAST)
    assert not holds(PossiblyIn("uav0", "prison0"), flying)
    assert holds(PossiblyIn("uav0", "north0"), flying)


def test_a_vehicle_that_a_control_left_in_a_place_may_be_anywhere_in_it():
    first, _, _, there = runs("control(MOVE_HOST_TO east0)", labels=TO_EAST)
    assert not holds(SurelyIn("uav0", "east0"), first)
    assert holds(SurelyIn("uav0", "east0"), there)
    assert holds(WithinRangeOf("uav0", "gcs0", 12_760.0), there)
    assert not holds(WithinRangeOf("uav0", "gcs0", 12_600.0), there)


def test_with_strays_a_vehicle_at_rest_is_near_its_waypoint():
    clause = "environment { UAV strays at most 30 m Vessel strays at most 30 m }"
    *_, there = runs("control(MOVE_HOST_TO east0)", clause, TO_EAST)
    (part,) = located(there, "uav0").region.parts
    assert part.margin == 30.0
    assert holds(WithinRangeOf("uav0", "gcs0", 12_600.0), there)


def test_what_is_absent_is_apart_from_everything_and_in_reach_of_nothing():
    (c,) = runs("skip")
    assert holds(ApartFrom("uav0", "ghost0", 1e6), c)
    assert holds(ApartFrom("ghost0", "uav0", 1e6), c)
    assert not holds(WithinRangeOf("ghost0", "uav0", 1e6), c)
    assert not holds(PossiblyIn("ghost0", "prison0"), c)
    assert not holds(SurelyIn("ghost0", "prison0"), c)


def test_cargo_is_where_its_carrier_is():
    (c,) = runs("skip")
    assert holds(SurelyIn("uav2", "ship0"), c)
    assert holds(PossiblyIn("uav2", "ship0"), c)
    assert not holds(ApartFrom("uav2", "ship0", 1.0), c)
    assert holds(WithinRangeOf("uav2", "ship0", 1.0), c)


def test_altitudes_part_vehicles_whose_ways_cross():
    *_, flying, _ = runs("control(MOVE_HOST_TO east0)", labels=TO_EAST)
    assert holds(ApartFrom("uav0", "uav1", 80.0), flying)
    assert not holds(ApartFrom("uav0", "uav1", 80.5), flying)
    assert holds(ApartFrom("uav0", "uav1", 500.0, 80.0), flying)
    assert not holds(ApartFrom("uav0", "uav1", 500.0, 81.0), flying)


def test_a_flight_from_a_carrier_has_the_altitudes_of_both():
    more = "BigActor b hosted_at uav2 with_behavior { control(MOVE_HOST_TO east0) }"
    text = WORLD.replace("uav2: UAV carried", "uav2: UAV = point (37.2, -8.6) altitude 90 m carried")
    mission = read_mission(f"{text}\n{more}\n{NOTHING}")
    c = watching(mission.initial, mission.properties)
    for word in ("req_ctr : b", "command"):
        (c,) = (each.target for each in successors(c) if word in str(each.label))
    (part,) = located(c, "uav2").region.parts
    assert (part.altitude.low, part.altitude.high) == (0.0, 90.0)


def test_an_entity_that_drifts_within_a_place_may_be_anywhere_in_its_face():
    text = WORLD.replace("gcs0: Station = point (37.1, -8.7)", "gcs0: Station = point (37.1, -8.641)")
    mission = read_mission(f"{text}\nenvironment {{ gcs0 drifts within west0 }}\n{NOTHING}")
    c = watching(mission.initial, mission.properties)
    for step in successors(c):
        assert holds(SurelyIn("gcs0", "west0"), step.target)
        assert not holds(ApartFrom("gcs0", "uav0", 1.0), step.target)


def test_two_flights_of_one_vehicle_are_flown_in_one_hull():
    more = "environment { uav0 vanishes uav0 appears at point (37.1, -8.642) }"
    programs = ("control(MOVE_HOST_TO east0 VIA north0)", "control(MOVE_HOST_TO east0 VIA north0, gate0)")
    text = WORLD.replace("gcs0:", "gate0: Area = circle (37.15, -8.56) radius 300 m\n  gcs0:")
    agents = "".join(
        f"BigActor {name} hosted_at uav0 with_behavior {{ {program} }}\n"
        for name, program in zip("ac", programs, strict=True)
    )
    mission = read_mission(f"{text}\n{agents}\n{more}\n{NOTHING}")
    c = watching(mission.initial, mission.properties)
    for word in ("req_ctr : a", "command", "vanishes", "appears", "req_ctr : c", "command : CTR(c"):
        (c, *_) = (each.target for each in successors(c) if word in str(each.label))
    (part,) = located(c, "uav0").region.parts
    assert len(part.between) == 4
    assert holds(PossiblyIn("uav0", "prison0"), c)


def test_an_atom_needs_the_facts_of_its_mission():
    mission = read_mission(f"{WORLD}\nBigActor a hosted_at uav0 with_behavior {{ skip }}")
    with pytest.raises(ValueError, match="begin with watching"):
        holds(PossiblyIn("uav0", "prison0"), mission.initial)


def test_a_report_says_why_two_names_are_never_apart():
    (c,) = runs("skip")
    assert region_lines(ApartFrom("uav0", "uav0", 5.0), c)[0].startswith("uav0 is compared with itself")
    (line,) = region_lines(ApartFrom("uav2", "ship0", 5.0), c)
    assert line == (
        "uav2 and ship0 are at one place, aboard one carrier: "
        "uav2 aboard ship0, ship0 at (37.20000, -8.60000), ship0 at (37.20000, -8.60000)"
    )


def test_a_report_says_the_figure_the_whereabouts_and_the_points():
    *_, flying, there = runs("control(MOVE_HOST_TO east0)", labels=TO_EAST)
    apart, crosses = ApartFrom("uav0", "uav1", 500.0, 90.0), PossiblyIn("uav0", "prison0")
    (line,) = region_lines(Or((apart, Not(crosses))), flying)[:1]
    assert line.startswith(
        "uav0 may come within 0 m of uav1, 80 m above or below: uav0 between west0 and east0"
    )
    (line,) = region_lines(Not(crosses), flying)
    assert line.startswith("uav0 may be in prison0: uav0 between west0 and east0; such as at (37.1")
    assert region_lines(And((Not(crosses), WithinRangeOf("uav0", "gcs0", 12_600.0))), there) == (
        "uav0 may be farther than 12.6 km from gcs0: uav0 in east0, gcs0 at (37.10000, -8.70000)",
    )


def test_a_report_of_an_atom_that_may_not_be_true_does_not_turn_it_round():
    *_, there = runs("control(MOVE_HOST_TO east0)", labels=TO_EAST)
    atoms = {
        PossiblyIn("uav0", "prison0"): "uav0 cannot be in prison0",
        Not(SurelyIn("uav0", "east0")): "uav0 is surely in east0",
        Not(WithinRangeOf("uav0", "gcs0", 20_000.0)): "uav0 cannot be farther than 20 km from gcs0",
        Not(ApartFrom("uav0", "gcs0", 1_000.0)): "uav0 cannot be nearer than 1 km to gcs0",
    }
    for formula, words in atoms.items():
        (line,) = region_lines(formula, there)
        assert line.startswith(f"{words}: uav0 in east0"), line
