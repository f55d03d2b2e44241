"""Regions of entities at rest, in faces, aboard and in transit, one test for each sentence about them."""

import pytest

from physical import (
    Band,
    CarriedBy,
    DriftWithin,
    EntityMotion,
    FlightPlan,
    RegionError,
    RegionKind,
    Transit,
    Ways,
    box,
    centroid,
    circle,
    distance,
    drift_faces,
    nearest_placement,
    point,
    polygon,
    translate_to,
)
from physical.place_nesting import Place

WEST, EAST, SOUTH = (
    box((37.0, -9.0), (37.05, -8.95)),
    box((37.0, -8.6), (37.05, -8.55)),
    box((36.8, -8.8), (36.85, -8.75)),
)
HOME = point(37.03, -8.97)
NAMES = frozenset({"west", "east", "south"})


def fixed(name, geometry, **more):
    return EntityMotion(name, (Place(geometry),), **more)


def uav(geometry=HOME, **more):
    settings = {"targets": NAMES, "via": NAMES, "containers": NAMES} | more
    return EntityMotion("uav", (Place(geometry),), **settings)


def ways(*motions):
    """Return the ways of three places and more; a motion replaces the place of its name."""
    places = {name: fixed(name, at) for name, at in (("west", WEST), ("east", EAST), ("south", SOUTH))}
    return Ways((places | {motion.name: motion for motion in motions}).values())


def flight(to="east", via=(), origin=HOME, **more):
    return Transit(Place(origin), to), frozenset({FlightPlan(to, tuple(via), **more)})


def sources(part):
    return set(part.sources)


# --- at rest --------------------------------------------------------------------------------------


def test_an_absent_entity_is_nowhere():
    assert not ways(uav()).region("uav", None)
    assert ways(uav()).located("uav", lambda _: None, dict).region == ways().region("x", None)


def test_where_the_mission_puts_an_entity_and_no_control_could_have_it_is_certain():
    region = ways(uav()).region("uav", Place(HOME, Band(30, 60)))
    assert region.certain
    [part] = region.parts
    assert (part.sources, part.margin, part.altitude) == ((HOME,), 0.0, Band(30, 60))
    assert not region.is_area
    assert ways().region("west", Place(WEST)).is_area


def test_at_the_waypoint_of_a_place_it_may_be_anywhere_in_the_place():
    region = ways(uav(centroid(WEST))).region("uav", Place(centroid(WEST)))
    assert not region.certain
    [part] = region.parts
    assert (part.sources, part.spanned, part.margin, part.kind) == ((WEST,), False, 0.0, RegionKind.REST)


def test_what_no_control_moves_is_certain_wherever_a_clause_puts_it():
    among = EntityMotion("spill", (Place(WEST), Place(EAST)))
    assert ways(among).region("spill", Place(EAST)).certain
    assert not ways(among).is_fixed("spill")
    assert ways().is_fixed("west")


def test_a_position_where_what_moves_in_the_place_may_have_forced_the_waypoint_is_not_certain():
    moving = EntityMotion("spill", (Place(circle((37.025, -8.975), 300)), Place(SOUTH)))
    craft = uav(containers=NAMES | {"spill"})
    assert not ways(craft, moving).region("uav", Place(HOME)).certain
    elsewhere = EntityMotion("spill", (Place(circle((36.9, -8.9), 300)), Place(circle((36.9, -8.8), 300))))
    assert ways(craft, elsewhere).region("uav", Place(HOME)).certain


def test_said_to_stray_little_it_is_near_its_waypoint():
    [part] = ways(uav(centroid(WEST), strays=30.0)).region("uav", Place(centroid(WEST))).parts
    assert (part.sources, part.margin) == ((centroid(WEST),), 30.0)


def test_its_circle_counts_where_the_mission_says_nothing():
    [part] = ways(uav(centroid(WEST), circle=160.0)).region("uav", Place(centroid(WEST))).parts
    assert (part.sources, part.margin) == ((WEST,), 160.0)


def test_a_place_with_a_dent_counts_with_its_hull():
    dented = polygon([(37.0, -9.0), (37.0, -8.9), (37.05, -8.9), (37.01, -8.95), (37.05, -9.0)])
    at = point(37.005, -8.99)
    [part] = ways(uav(at), fixed("west", dented)).region("uav", _arrived(dented)).parts
    assert (part.sources, part.spanned) == ((dented,), True)


def _arrived(place):
    return Place(nearest_placement(HOME, place))


def test_of_nested_places_the_smallest_counts_and_a_larger_one_if_that_may_be_absent():
    """Sent into the larger one while the smaller one was absent, it may still be on its way to the centre of both."""
    inner = circle(centroid(WEST).vertices[0], 200)
    craft = uav(centroid(WEST), containers=NAMES | {"inner"}, targets=NAMES | {"inner"})
    [part] = ways(craft, fixed("inner", inner)).region("uav", Place(centroid(WEST))).parts
    assert part.sources == (inner,)
    [part] = ways(craft, fixed("inner", inner, may_be_absent=True)).region("uav", Place(centroid(WEST))).parts
    assert part.sources == (WEST,)


def test_a_place_at_another_height_is_not_around_it():
    low = EntityMotion("west", (Place(WEST, Band(0, 10)),))
    wide = fixed("around", box((36.9, -9.1), (37.2, -8.4)))
    craft = uav(centroid(WEST), containers=NAMES | {"around"})
    [part] = ways(craft, low, wide).region("uav", Place(centroid(WEST), Band(50, 60))).parts
    assert part.sources == (wide.placements[0].geometry,)
    [part] = ways(craft, low, wide).region("uav", Place(centroid(WEST), Band(5, 6))).parts
    assert part.sources == (WEST,)


def test_a_target_that_moves_counts_with_all_its_geometries():
    one, other = circle((37.02, -8.98), 500), circle((37.03, -8.96), 500)
    spill = EntityMotion("spill", (Place(one), Place(other)))
    craft = uav(targets=frozenset({"spill"}), containers=frozenset({"spill", "west"}))
    parts = ways(craft, spill).region("uav", Place(centroid(other))).parts
    assert [(sources(part), part.spanned) for part in parts] == [({WEST}, False), ({one, other}, True)]


def test_a_point_that_run_may_not_take_counts_as_its_place_even_if_it_strays_little():
    """Off the centre, `run` keeps its circle clear of borders, and P only the point."""
    hole = fixed("hole", circle((37.025, -8.975), 300))
    craft = uav(strays=30.0, containers=NAMES | {"hole"})
    at = nearest_placement(HOME, WEST, [hole.placements[0].geometry])
    [part] = ways(craft, hole).region("uav", Place(at)).parts
    assert (part.sources, part.margin) == ((WEST,), 30.0)


# --- in transit -----------------------------------------------------------------------------------


def test_a_leg_is_the_hull_of_its_ends():
    [leg] = ways(uav()).region("uav", *flight()).parts
    assert (sources(leg), leg.spanned, leg.kind) == ({HOME, EAST}, True, RegionKind.LEG)
    assert leg.between == ("", "east")


def test_from_a_place_in_which_it_may_be_anywhere_the_leg_begins_anywhere_there():
    [leg] = ways(uav()).region("uav", *flight(origin=centroid(WEST))).parts
    assert sources(leg) == {WEST, EAST}


def test_a_way_by_other_places_has_a_leg_for_each_two_neighbours():
    legs = ways(uav()).region("uav", *flight(via=("south", "west"))).parts
    assert [sources(leg) for leg in legs] == [{HOME, SOUTH}, {SOUTH, WEST}, {WEST, EAST}]
    assert [leg.between for leg in legs] == [("", "south"), ("south", "west"), ("west", "east")]


@pytest.mark.parametrize(
    "other",
    [
        EntityMotion("south", (Place(SOUTH), Place(EAST))),
        fixed("south", SOUTH, may_be_absent=True),
        fixed("south", SOUTH, targets=frozenset({"east"})),
        fixed("east", EAST, may_be_absent=True),
    ],
    ids=["drifts", "may be absent", "may be moved", "destination may be absent"],
)
def test_where_a_renewal_may_come_the_way_is_one_hull(other):
    """What is absent is left out of the way; when it returns, the way is flown again from anywhere."""
    [leg] = ways(uav(), other).region("uav", *flight(via=("south",))).parts
    assert sources(leg) >= {HOME, SOUTH, EAST}


def test_several_flights_of_one_vehicle_are_one_hull():
    at, _ = flight()
    two = frozenset({FlightPlan("east"), FlightPlan("west", ("south",))})
    [leg] = ways(uav()).region("uav", at, two).parts
    assert sources(leg) == {HOME, EAST, WEST, SOUTH}


def test_without_a_request_that_moves_it_a_vehicle_in_transit_is_anywhere():
    [leg] = ways(uav()).region("uav", Transit(Place(HOME), "east")).parts
    assert sources(leg) == {HOME, WEST, EAST, SOUTH}


def test_said_to_stray_little_it_flies_from_point_to_point():
    legs = ways(uav(strays=30.0)).region("uav", *flight(via=("south",), origin=centroid(WEST))).parts
    assert [sources(leg) for leg in legs] == [
        {centroid(WEST), centroid(SOUTH)},
        {centroid(SOUTH), centroid(EAST)},
    ]
    assert {leg.margin for leg in legs} == {30.0}


def test_the_length_of_a_way_is_that_of_its_legs():
    near, far = ways(uav()).length("uav", *flight())
    assert near == pytest.approx(distance(HOME, EAST), abs=0.1)
    assert far == pytest.approx(distance(HOME, point(37.0, -8.55)), abs=1)
    exact = ways(uav(strays=30.0)).length("uav", *flight(via=("south",)))
    legs = distance(HOME, centroid(SOUTH)) + distance(centroid(SOUTH), centroid(EAST))
    assert exact == (pytest.approx(legs, abs=0.1), pytest.approx(legs, abs=0.1))
    assert ways(uav(), fixed("east", EAST, may_be_absent=True)).length("uav", *flight()) is None


def test_a_destination_counts_whole_where_the_point_may_change():
    """What moves in it, and a circle without room at its centre, both move the point."""
    spill = EntityMotion("spill", (Place(circle((37.02, -8.58), 300)), Place(circle((36.0, -8.0), 300))))
    craft = uav(strays=400.0, containers=NAMES | {"spill"})
    assert sources(ways(craft, spill).region("uav", *flight()).parts[0]) == {HOME, EAST}
    hole = fixed("hole", circle((37.025, -8.575), 300))
    craft = uav(strays=400.0, containers=NAMES | {"hole"})
    assert sources(ways(craft, hole).region("uav", *flight()).parts[0]) == {HOME, EAST}
    beside = fixed("hole", circle((37.025, -8.571), 300))
    assert sources(ways(craft, beside).region("uav", *flight()).parts[0]) == {HOME, centroid(EAST)}
    wide = uav(strays=400.0, circle=400.0, containers=NAMES | {"hole"})
    assert sources(ways(wide, beside).region("uav", *flight()).parts[0]) == {HOME, EAST}


def test_the_hull_of_a_target_that_may_be_moved_is_grown_by_what_that_strays():
    ship = EntityMotion("ship", (Place(SOUTH),), targets=frozenset({"west"}), strays=50.0, containers=NAMES)
    off = point(36.9, -8.3)
    craft = uav(off, targets=frozenset({"ship"}), carriers=frozenset({"ship"}), strays=30.0)
    [leg] = ways(craft, ship).region("uav", *flight("ship", origin=off)).parts
    assert sources(leg) == {off, SOUTH, WEST}
    assert leg.margin == pytest.approx(80.0 + 3_570, abs=50)  # half the diagonal of the ship


def test_what_an_area_covers_beside_its_centre_counts_where_it_passes_a_place():
    hover = circle((37.03, -8.97), 500)
    one = ways(uav(hover)).region("uav", *flight(origin=hover)).parts[0]
    first, last = ways(uav(hover)).region("uav", *flight(via=("south",), origin=hover)).parts
    assert one.margin == 0.0
    assert (first.margin, last.margin) == (pytest.approx(500, abs=1), pytest.approx(500, abs=1))


# --- carriers -------------------------------------------------------------------------------------

SHIP = EntityMotion(
    "ship",
    (Place(point(36.82, -8.78), Band(0, 5)),),
    targets=frozenset({"south"}),
    containers=frozenset({"south"}),
)


def test_what_is_carried_is_where_its_outermost_carrier_is():
    drifter = EntityMotion("drifter", loads=(Place(HOME),), carriers=frozenset({"uav"}))
    placements = {
        "drifter": CarriedBy("uav"),
        "uav": CarriedBy("ship"),
        "ship": Place(centroid(SOUTH), Band(0, 5)),
    }
    found = ways(uav(carriers=frozenset({"ship"})), SHIP, drifter).located("drifter", placements.get, dict)
    assert found.carriers == ("uav", "ship")
    assert found.bearer == "ship"
    assert [sources(part) for part in found.region.parts] == [{SOUTH}]
    assert not found.region.certain


def test_a_flight_from_or_to_a_carrier_is_at_all_altitudes_of_both():
    origin = Place(HOME, Band(50, 60))
    craft = EntityMotion(
        "uav", (origin,), targets=NAMES | {"ship"}, carriers=frozenset({"ship"}), containers=NAMES
    )
    known = ways(craft, SHIP)
    for to, start, band in (
        ("ship", "", Band(0, 60)),
        ("east", "ship", Band(0, 60)),
        ("east", "west", Band(50, 60)),
    ):
        region = known.region("uav", Transit(origin, to), frozenset({FlightPlan(to, start=start)}))
        assert {part.altitude for part in region.parts} == {band}
    no_band = EntityMotion("ship", (Place(point(36.82, -8.78)),))
    [part] = (
        ways(craft, no_band).region("uav", Transit(origin, "ship"), frozenset({FlightPlan("ship")})).parts
    )
    assert part.altitude is None


def test_put_down_it_may_be_where_its_carrier_may_be():
    """The carrier arrived in the harbour, and may be anywhere there; said to stray, the vehicle may not be, alone."""
    craft = uav(strays=30.0, carriers=frozenset({"ship"}), targets=NAMES | {"ship"})
    parts = ways(craft, SHIP).region("uav", Place(centroid(SOUTH), Band(50, 60))).parts
    assert [sources(part) for part in parts] == [{centroid(SOUTH)}, {SOUTH}]
    assert {part.margin for part in parts} == {30.0}
    assert {part.altitude for part in parts} == {Band(0, 60)}


def test_put_down_by_a_carrier_that_drifts_it_is_anywhere_in_the_face():
    drift = DriftWithin(point(37.01, -8.99), WEST, {"west": WEST})
    barge = EntityMotion("barge", (Place(point(37.01, -8.99)),), drift=drift)
    [face] = drift_faces(drift.mover, drift.within, drift.places)
    craft = uav(strays=30.0, carriers=frozenset({"barge"}), targets=NAMES)
    parts = ways(craft, barge).region("uav", Place(face.representative)).parts
    assert [part.kind for part in parts] == [RegionKind.REST, RegionKind.FACE]


def test_where_a_carrier_may_have_put_it_down_it_is_not_certain():
    """The mission puts both at one point; the ship may have put the vehicle down there, somewhere in its circle."""
    ship = EntityMotion("ship", (Place(HOME),), targets=frozenset({"south"}), circle=40.0)
    assert ways(uav(), ship).region("uav", Place(HOME)).certain
    [part] = ways(uav(carriers=frozenset({"ship"})), ship).region("uav", Place(HOME)).parts
    assert (part.sources, part.margin, part.kind) == ((HOME,), 40.0, RegionKind.REST)


# --- faces ----------------------------------------------------------------------------------------


def test_in_a_drift_within_a_place_it_covers_its_face_from_the_first_placement_on():
    """P keeps the first placement although the entity may already be elsewhere in its face."""
    inner = box((37.02, -8.98), (37.03, -8.97))
    drift = DriftWithin(point(37.01, -8.99), WEST, {"west": WEST, "inner": inner})
    spill = EntityMotion("spill", (Place(drift.mover),), drift=drift)
    known = ways(spill, fixed("inner", inner))
    [first] = known.region("spill", Place(drift.mover)).parts
    assert first.kind is RegionKind.FACE
    faces = drift_faces(drift.mover, drift.within, drift.places)
    inside = {face.inside: known.region("spill", Place(face.representative)).parts for face in faces}
    assert inside["west",] == (first,)
    [source] = inside["inner", "west"][0].sources
    assert set(source.inside) == {inner, WEST}
    assert first.sources[0].outside == (inner,)
    assert len(first.sources[0].holes) == 1


def test_a_drifting_polygon_covers_all_around_its_centre():
    slick = circle((37.02, -8.98), 200, 12)
    drift = DriftWithin(slick, WEST, {"west": WEST})
    known = ways(EntityMotion("spill", (Place(slick),), drift=drift))
    [part] = known.region("spill", Place(slick)).parts
    north = max(position[0] for position in part.sources[0].shell)
    assert north / 1e7 == pytest.approx(
        37.05, abs=1e-5
    )  # the centre keeps 200 m from the border, the spill does not
    assert (
        known.region("spill", Place(translate_to(slick, point(36.0, -8.0)))).parts[0].kind
        is not RegionKind.FACE
    )


# --- refusals -------------------------------------------------------------------------------------


def test_a_way_that_is_too_long_is_refused_with_the_name_of_the_entity():
    far = fixed("east", box((37.0, 20.0), (37.05, 20.05)))
    known = ways(uav(), far)
    with pytest.raises(RegionError, match=r"the way of uav: a region reaches 1,2\d\d km from its middle"):
        known.region("uav", *flight())
    with pytest.raises(RegionError, match="the way of uav"):
        known.check("uav")
    known.check("west")
    assert known.region("uav", *flight("south")).parts
