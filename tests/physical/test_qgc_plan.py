"""Plans of QGroundControl, written and read."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical import (
    JoinChannel,
    PhysicalError,
    Waypoint,
    point,
    read_plan,
    visited,
    waypoint_places,
    write_plan,
)
from physical.qgc_plan import read_plan_places

STOPS = (point(37.0, -8.6), point(37.01, -8.61))


def plan(*items, home=(37.0, -8.6, 20)):
    return json.dumps(
        {"fileType": "Plan", "mission": {"plannedHomePosition": list(home), "items": list(items)}}
    )


def simple(latitude=37.0, longitude=-8.6, altitude=100, command=16, frame=3):
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": frame,
        "params": [0, 0, 0, None, latitude, longitude, altitude],
    }


def test_what_is_written_is_read_again():
    items = read_plan(write_plan(STOPS, 100.0, home=point(37.02, -8.62)))
    assert [item.point for item in items] == [point(37.02, -8.62), *STOPS]
    assert [item.index for item in items] == [0, 1, 2]
    assert [item.altitude for item in items] == [0.0, 100.0, 100.0]


def test_a_plan_has_what_qgroundcontrol_asks_for():
    document = json.loads(write_plan(STOPS, 100.0))
    assert {"fileType", "version", "groundStation", "mission", "geoFence", "rallyPoints"} == set(document)
    assert document["mission"]["items"][0]["params"][4:] == [37.0, -8.6, 100.0]
    assert document["mission"]["plannedHomePosition"] == [37.0, -8.6, 0]


def test_the_items_are_places_above_sea_level():
    places = waypoint_places(read_plan(plan(simple())))
    assert [(place.entity, place.altitude.low) for place in places] == [
        ("waypoint0", 20.0),
        ("waypoint1", 120.0),
    ]


def test_the_items_that_a_survey_stands_for_are_taken():
    survey = {"type": "ComplexItem", "TransectStyleComplexItem": {"Items": [simple(), simple(37.01)]}}
    assert len(read_plan(plan(survey, simple()))) == 4


def complex_item(kind, **more):
    return {"type": "ComplexItem", "complexItemType": kind, **more}


def landing(kind="fwLandingPattern", **more):
    where = {"landCoordinate": [37.02, -8.62, 0], "landingApproachCoordinate": [37.01, -8.61, 40]}
    return complex_item(kind, **({"altitudesAreRelative": True} | where | more))


def read(*items, home=(37.0, -8.6, 20), **members):
    document = json.loads(plan(*items, home=home)) | members
    return read_plan_places(json.dumps(document))


@pytest.mark.parametrize(
    ("pattern", "commands", "altitudes"),
    [
        (landing(), [189, 31, 21], [60.0, 20.0]),
        (landing("vtolLandingPattern"), [189, 31, 85], [60.0, 20.0]),
        (landing(useLoiterToAlt=False), [189, 16, 21], [60.0, 20.0]),
        (landing(altitudesAreRelative=False), [189, 31, 21], [40.0, 0.0]),
        (landing(loiterCoordinate=[37.01, -8.61, 40]), [189, 31, 21], [60.0, 20.0]),
    ],
)
def test_a_landing_pattern_is_read_as_what_is_flown(pattern, commands, altitudes):
    _, *items = read_plan(plan(simple(), pattern))
    assert [item.command for item in items[1:]] == commands
    places = {place.entity: place for place in read(simple(), pattern).properties}
    assert [places[name].geometry for name in ("waypoint3", "waypoint4")] == [
        point(37.01, -8.61),
        point(37.02, -8.62),
    ]
    assert [places[name].altitude.low for name in ("waypoint3", "waypoint4")] == altitudes


@pytest.mark.parametrize(
    ("item", "kind"),
    [
        (complex_item("StructureScan", polygon=[[1, 2], [1, 3], [2, 3]]), "complex item StructureScan"),
        (complex_item("survey", polygon=[[1, 2]], TransectStyleComplexItem={}), "complex item survey"),
        (complex_item("CorridorScan"), "complex item CorridorScan"),
        (complex_item("fwLandingPattern"), "complex item fwLandingPattern"),
        ({"type": "ComplexItem"}, "complex item without a type"),
    ],
)
def test_a_complex_item_that_is_not_read_is_named_and_the_rest_is_read(item, kind):
    found = read(simple(), item, simple(37.01))
    assert [place.entity for place in found.properties] == ["waypoint0", "waypoint1", "waypoint2"]
    assert found.tallies[0].left_out == ((kind, 1),)


def test_fences_and_rally_points_are_counted():
    fence = {
        "circles": [{"circle": {"center": [1, 2], "radius": 3}, "inclusion": True}, {"inclusion": False}],
        "polygons": [{"inclusion": True, "polygon": []}, {"inclusion": False, "polygon": []}],
        "breachReturn": [1, 2, 3],
    }
    tally = read(simple(), geoFence=fence, rallyPoints={"points": [[1, 2, 3], [1, 2, 4]]}).tallies[0]
    assert dict(tally.left_out) == {
        "fence circle (to stay in)": 1,
        "fence circle (to stay out)": 1,
        "fence polygon (to stay in)": 1,
        "fence polygon (to stay out)": 1,
        "fence return point": 1,
        "rally point": 2,
    }
    assert (tally.total, tally.adds_up) == (9, True)
    first_version = read(geoFence={"polygon": [[1, 2], [3, 4]], "version": 1}).tallies[0]
    assert first_version.left_out == (("fence polygon (to stay in)", 1),)


@pytest.mark.parametrize("home", [(0, 0, 0), (None, None, None)])
def test_a_planned_home_that_is_none_gives_no_altitudes(home):
    (place,) = read(simple(), home=home).properties
    assert (place.entity, place.altitude) == ("waypoint1", None)


def test_what_is_null_is_not_known():
    found = read(simple(altitude=None), simple(None, None), simple(None, -8.6), home=(37.0, -8.6, None))
    assert [(place.entity, place.altitude) for place in found.properties] == [
        ("waypoint0", None),
        ("waypoint1", None),
    ]
    assert found.tallies[0].left_out == (("WAYPOINT without a position", 2),)


simples = st.builds(
    simple,
    st.sampled_from([0, None, 37.0]),
    st.sampled_from([0, -8.6]),
    st.sampled_from([None, 50]),
    st.sampled_from([16, 20, 31, 84, 177, 206, 201]),
    st.sampled_from([0, 2, 3, 10]),
)
complexes = st.sampled_from([landing(), complex_item("StructureScan"), complex_item("survey")]) | st.lists(
    simples, max_size=3
).map(lambda items: complex_item("survey", TransectStyleComplexItem={"Items": items}))


@given(st.lists(simples | complexes, max_size=8), st.integers(0, 3), st.integers(0, 3))
def test_the_account_adds_up_to_items_fences_and_rally_points(items, fences, points):
    found = read(*items, geoFence={"polygons": [{}] * fences}, rallyPoints={"points": [[1, 2, 3]] * points})
    unread = sum(
        item.get("complexItemType") in ("StructureScan", "survey") and len(item) == 2 for item in items
    )
    assert found.tallies[0].adds_up
    assert found.tallies[0].total == len(read_plan(plan(*items))) + unread + fences + points
    assert sum(count for _, count in found.tallies[0].taken) == len(found.properties)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("{", "not JSON"),
        ("[" * 100_000, "nested too deeply"),
        ("[]", "fileType"),
        ('{"fileType": "Plan"}', "no mission"),
        (plan(home=(1, 2)), "home"),
        (plan(5), "no item"),
        (plan({"type": "Poem"}), "not known"),
        (plan(simple("here")), "no number"),
        (plan(simple(91)), "item 1"),
        (plan(simple(altitude=1e8)), "item 1"),
        (plan({"type": "SimpleItem", "params": []}), "seven params"),
        (plan(*[simple()] * 10_001), "over 10,000 items|over 1,000,000"),
    ],
)
def test_what_is_no_plan_is_refused_with_the_place(text, found):
    with pytest.raises(PhysicalError, match=found):
        read_plan(text)


def test_complex_items_without_end_are_refused():
    item = simple()
    for _ in range(50):
        item = {"type": "ComplexItem", "Items": [item]}
    with pytest.raises(PhysicalError, match="no list of items"):
        read_plan(plan(item))


def test_a_plan_visits_points_and_at_least_one():
    with pytest.raises(PhysicalError, match="visits points"):
        write_plan((), 100.0)


def test_the_moves_of_a_trace_are_the_points_of_a_plan():
    moves = [
        Waypoint("uav0", STOPS[0]),
        JoinChannel("uav0", "wifi"),
        Waypoint("uav1", STOPS[0]),
        Waypoint("uav0", STOPS[1]),
    ]
    assert visited(moves, "uav0") == STOPS
