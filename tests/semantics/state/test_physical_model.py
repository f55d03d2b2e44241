"""σ_P and the abstraction A(P)."""

from hypothesis import given
from small_missions import SHAPES, SIGNATURE, aboard, mission

from physical import Band, area, contains, point, translate_to
from semantics import hypothesis_strategies
from semantics.state.abstraction import all_as_it_is, as_it_is
from semantics.state.physical_model import Carried, InTransit, PhysicalModel, Placed
from semantics.state.signature import REGION, Kind, Signature


def brute_force_parent(physical: PhysicalModel, entity: str) -> str:
    """Return the parent by its definition: the carrier, else the smallest total container of a kind that may."""
    placement = physical.placement(entity)
    if isinstance(placement, Carried):
        return placement.by
    setting, best = physical.sorting, []
    for place in physical.entities():
        at = physical.placement(place)
        shape = at.origin if isinstance(at, InTransit) else at
        if place == entity or isinstance(shape, Carried) or shape.geometry.is_point:
            continue
        if setting.kind(entity) not in setting.signature[setting.kind(place)].contains:
            continue
        ends = [placement] if isinstance(placement, Placed) else [placement.origin]
        if isinstance(placement, InTransit):
            to = physical.position(placement.to)
            ends += [to] if to is not None and place != placement.to else [None]
        if all(end is not None and inside(shape, end) for end in ends):
            best.append((area(shape.geometry), place))
    return min(best, default=(0.0, REGION))[1]


def inside(outer: Placed, inner: Placed) -> bool:
    bands = outer.altitude, inner.altitude
    level = None in bands or (bands[0].low <= bands[1].low and bands[1].high <= bands[0].high)
    return level and contains(outer.geometry, inner.geometry)


reached = hypothesis_strategies.configurations(hypothesis_strategies.initial_configurations())


@given(reached)
def test_the_abstraction_is_the_one_that_brute_force_finds(c):
    physical = c.structure.physical
    for entity in physical.entities():
        assert physical.abstract_parent(entity) == brute_force_parent(physical, entity)


@given(reached)
def test_the_parents_of_all_are_those_of_each(c):
    physical = c.structure.physical
    assert physical.abstract_parents() == {
        name: physical.abstract_parent(name) for name in physical.entities()
    }
    assert all_as_it_is(c) == as_it_is(c)


@given(reached)
def test_children_and_points_are_parents_and_links_seen_from_the_other_side(c):
    physical = c.structure.physical
    for entity in physical.entities():
        assert entity in physical.children(physical.abstract_parent(entity))
        assert all(entity in physical.points(link) for link in physical.links(entity))


def test_a_place_of_another_altitude_contains_nothing():
    low = Placed(SHAPES["area"].geometry, Band(0, 50))
    for band, parent in ((Band(60, 70), "sea"), (Band(10, 20), "area"), (None, "area")):
        bird = Placed(SHAPES["spill"].geometry, band)
        physical = mission(["sea", "area", "spill"], placed={"area": low, "spill": bird}).structure.physical
        assert physical.abstract_parent("spill") == parent


def test_what_is_carried_has_its_carrier_for_parent_and_is_contained_where_the_carrier_is():
    physical = mission(["sea", "ship", "crate"], placed={"crate": aboard("ship", "crate")}).structure.physical
    assert physical.abstract_parent("crate") == "ship"
    assert physical.contains("sea", "crate")
    assert not physical.contains("ship", "crate")
    assert physical.carries("ship", "crate")


def test_what_is_carried_contains_nothing_by_its_carriers_shape():
    kinds = [
        Kind("Place", SIGNATURE["Place"].contains),
        Kind("Vessel", frozenset({"Uav"}), frozenset({"Vessel"}), True),
    ]
    c = mission(
        ["sea", "ship", "boat", "u0"],
        placed={"boat": aboard("ship", "boat"), "u0": Placed(point(36.9, -8.2))},
        signature=Signature.of([*kinds, Kind("Uav", driven=True)]),
    )
    assert c.structure.physical.abstract_parent("u0") == "ship"
    assert not c.structure.physical.contains("boat", "u0")


def test_an_entity_in_transit_is_contained_only_by_what_contains_both_ends_the_destination_excepted():
    def parent(start: str, to: str) -> str:
        flight = InTransit(Placed(point(*{"sea": (36.9, -8.3), "area": (36.65, -8.65)}[start])), to)
        physical = mission(["sea", "area", "spill", "base", "u0"], placed={"u0": flight}).structure.physical
        assert not physical.contains(to, "u0")
        return physical.abstract_parent("u0")

    assert parent("sea", "area") == "sea"
    assert parent("area", "spill") == "area"
    assert parent("area", "sea") == REGION
    assert parent("area", "base") == REGION


def test_what_an_entity_in_transit_carries_stays_in_it():
    flight = InTransit(SHAPES["ship"], "base")
    c = mission(["sea", "base", "ship", "crate"], placed={"ship": flight, "crate": aboard("ship", "crate")})
    assert c.structure.physical.abstract_parent("crate") == "ship"
    assert not c.structure.physical.contains("sea", "crate")


def test_a_channel_that_is_down_connects_nobody():
    c = mission(["u0", "u1"], channels={"u0": ["w"], "u1": ["w"]}).with_({("down", "w"): True})
    assert c.structure.physical.points("w") == ()
    assert not c.structure.physical.connected("w", "u0")


def test_an_absent_entity_is_connected_to_nothing_and_nowhere():
    c = mission(["base", "u0", "u1"], placed={"u0": None}, channels={"u0": ["w"]})
    assert "u0" not in c.structure.physical
    assert not c.structure.physical.connected("w", "u0")
    assert c.structure.physical.children("base") == ("u1",)


def test_where_a_shape_was_before_it_was_carried_means_nothing():
    assert Carried("ship", SHAPES["crate"]) == Carried("ship", SHAPES["u0"])
    moved = translate_to(SHAPES["boat"].geometry, SHAPES["u0"].geometry)
    assert Carried("ship", Placed(moved)) == Carried("ship", SHAPES["boat"])
    assert Carried("ship", SHAPES["boat"]) != Carried("ship", SHAPES["ship"])
