"""Steps that the world decides: what may be written, where flights end, and that both are read back as written."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_missions import figure_2, run

from physical import Band, box, circle, point, translate_to
from semantics.observed_steps import Sight, admitting, arriving, happening, steps_seen
from semantics.state.canonical import canonical, digest, digest_of_step, written
from semantics.state.cell_values import Row
from semantics.state.configuration import Configuration
from semantics.state.observation_serialization import placement_of, sight_json, sight_of, value_json
from semantics.state.physical_model import Carried, InTransit, Placed, channels_cell, placement_cell
from semantics.state.relations import Parent
from semantics.state.setting import Control

BASE, AREA = Placed(point(37.16, -8.71)), Placed(point(36.75, -8.65))
U0 = placement_cell("u0")


def flying():
    """u0 has been sent from base to area."""
    return run(figure_2(control=Control.TIMED), "req_ctr", "command")


def test_what_is_observed_happens_and_changes_p_alone():
    c = figure_2()
    (step,) = happening(c, Sight("u0 is elsewhere", {U0: AREA}))
    assert str(step.label) == "⟨env : u0 is elsewhere⟩"
    assert set(written(c, step.target)) == {U0}
    assert step.target.structure.physical.abstract_parent("u0") == "area"
    assert step.target.structure.believes(Parent("u0", "base"))


def test_what_is_in_transit_is_placed_by_commit_alone():
    c = flying()
    assert isinstance(c.structure.physical.placement("u0"), InTransit)
    assert list(happening(c, Sight("u0 is elsewhere", {U0: BASE}))) == []
    assert [step.label.rule for step in steps_seen(c, Sight("u0 arrives", {U0: AREA}), ("a",))] == ["commit"]


@pytest.mark.parametrize("cell", [("parent", "u0"), ("placement", "nobody"), ("line", "a"), ("host", "a")])
def test_nothing_but_p_can_be_observed(cell):
    assert list(happening(figure_2(), Sight("x", {cell: AREA}))) == []


def test_commit_takes_the_place_that_was_observed():
    (step,) = arriving(flying(), "a", Sight("", {U0: AREA}))
    after = step.target.structure
    assert after.physical.placement("u0") is AREA
    assert after.believes(Parent("u0", "area"))


@pytest.mark.parametrize(
    "elsewhere",
    [BASE, Placed(point(36.7, -8.7)), Placed(point(36.9, -8.7)), None, Carried("spill", AREA)],
    ids=["at home", "in a smaller place inside", "on the way", "nowhere", "aboard another"],
)
def test_commit_requires_that_the_observed_place_satisfies_its_premises(elsewhere):
    assert list(arriving(flying(), "a", Sight("", {U0: elsewhere}))) == []


def test_a_flight_of_which_nothing_was_observed_does_not_end():
    assert list(arriving(flying(), "a", Sight("", {}))) == []


def test_who_comes_in_is_named_from_then_on_and_only_then():
    c = figure_2()
    there = admitting(c, {"u7": "Uav", "u0": "Spill"})
    assert there.setting.kinds["u7"] == "Uav"
    assert there.setting.kinds["u0"] == "Uav"
    assert "u7" not in there.structure.physical
    assert "u7" not in there.structure.logical
    assert admitting(c, {"u0": "Uav"}) is c
    (step,) = happening(c, Sight("u7 appears", {placement_cell("u7"): AREA}, {"u7": "Uav"}))
    assert step.target.structure.physical.children("area") == ("spill", "u7")


# --- plain data -----------------------------------------------------------------------------------------

POINTS = st.builds(point, st.floats(-89, 89), st.floats(-179, 179))
SHAPES = st.sampled_from([box((36.5, -9.0), (37.0, -8.0)), circle((36.7, -8.7), 400)])
MOVED = st.builds(translate_to, SHAPES, st.builds(point, st.floats(30, 40), st.floats(-10, 10)))
BANDS = st.none() | st.tuples(st.integers(0, 90), st.integers(100, 900)).map(lambda pair: Band(*pair))
PLACED = st.builds(Placed, POINTS | SHAPES | MOVED, BANDS)
PLACEMENTS = st.none() | PLACED | st.builds(Carried, st.just("ship"), PLACED)


@given(PLACEMENTS, st.lists(st.sampled_from(["wifi", "control:gcs0"]), unique=True).map(tuple), st.booleans())
def test_an_observation_is_read_as_it_was_written(placement, channels, down):
    writes = {
        U0: placement,
        channels_cell("u0"): channels,
        ("down", "wifi"): down,
        ("left", "u0", "wifi"): down,
    }
    sight = Sight("u0 does something", writes, {"u9": "Uav"})
    assert sight_of(json.loads(json.dumps(sight_json(sight)))) == sight


@given(PLACED)
def test_a_geometry_is_the_same_object_after_a_round_trip(placed):
    assert placement_of(json.loads(json.dumps(value_json(placed)))).geometry is placed.geometry


@pytest.mark.parametrize(
    "data",
    [
        None,
        {"words": "x", "writes": [[["placement"], None]]},
        {"words": "x", "writes": [[["placement", "u0"], 3]]},
        {"words": "x", "writes": [[["placement", "u0"], {"at": {"ring": []}}]]},
        {"words": "x", "writes": [[["placement", "u0"], {"at": {"ring": [[1, 2], [3, 4]]}}]]},
        {"words": "x", "writes": [[["placement", "u0"], {"at": {"ring": [[10**12, 2]]}}]]},
        {"words": "x", "writes": [[["placement", "u0"], {"by": "s", "shape": {"by": "s", "shape": None}}]]},
        {"words": "x", "writes": [[["channels", "u0"], ["a", 1]]]},
        {"words": "x", "writes": [[["down", "c"], 1]]},
        {"words": "x", "writes": [[["code", "a"], []]]},
        {"words": "x", "writes": [], "admits": {"u": 3}},
        {"words": "x", "writes": [[["down", "c"], True]] * 20_000},
    ],
)
def test_what_is_no_observation_is_refused(data):
    with pytest.raises(ValueError, match=r"\w"):
        sight_of(data)


# --- digests --------------------------------------------------------------------------------------------


def test_a_digest_of_a_step_tells_targets_apart():
    c = flying()
    targets = [
        next(arriving(c, "a", Sight("", {U0: Placed(point(36.75, lon))}))).target for lon in (-8.65, -8.66)
    ]
    assert digest_of_step(c, targets[0]) != digest_of_step(c, targets[1])
    assert digest_of_step(c, targets[0]) == digest_of_step(c, targets[0])


@given(st.recursive(st.integers() | st.text(), lambda inner: st.lists(inner).map(tuple), max_leaves=6))
def test_equal_values_are_written_alike(value):
    assert canonical((value, frozenset({value}))) == canonical((value, frozenset({value})))


def test_a_digest_of_a_step_does_not_depend_on_the_order_in_which_cells_came():
    c = flying()
    one, two = admitting(c, {"x": "Uav", "b": "Uav"}), admitting(admitting(c, {"x": "Uav"}), {"b": "Uav"})
    apart = Configuration.of(one.setting, dict(one.state.items()))
    assert one == two == apart
    assert len({hash(one), hash(two), hash(apart)}) == 1
    assert written(c, one) == written(c, two) == written(c, apart)
    assert digest_of_step(c, one) == digest_of_step(c, two) == digest_of_step(c, apart)
    assert digest_of_step(one, c) == digest_of_step(apart, c)


SHORT = st.lists(st.integers(0, 1), max_size=2)


@given(SHORT, SHORT, SHORT, SHORT)
def test_of_a_tuple_a_digest_has_what_came_in_the_place_of_what(first, gone, come, last):
    old, new = (tuple(first + middle + last) for middle in (gone, come))
    shorter = min(len(old), len(new))
    kept = next((at for at in range(shorter) if old[at] != new[at]), shorter)
    behind = next((at for at in range(shorter - kept) if old[-1 - at] != new[-1 - at]), shorter - kept)
    changed = (kept, behind, new[kept : len(new) - behind])
    setting = flying().setting
    before, after = (Configuration.of(setting, {("line", "a"): each}) for each in (old, new))
    assert digest_of_step(before, after) == digest({("line", "a"): changed} if old != new else {})


@given(st.dictionaries(st.integers(0, 299), st.integers(), max_size=5))
def test_what_a_step_wrote_is_found_among_many_cells(changes):
    before = Configuration.of(flying().setting, {("store", str(number)): 0 for number in range(200)})
    assert isinstance(before.state, Row)
    writes = {("store", str(number)): value for number, value in changes.items()}
    after = Configuration(before.setting, before.state.growing(writes))
    expected = {cell: value for cell, value in writes.items() if before.read(cell) != value}
    assert written(before, after) == expected
