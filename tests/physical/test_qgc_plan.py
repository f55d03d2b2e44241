"""Plans of QGroundControl, written and read."""

import json

import pytest

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


def test_what_goes_nowhere_is_no_place():
    jump = simple(0, 0, 0, command=177)
    assert [item.point for item in read_plan(plan(jump, simple()))][1:] == [None, point(37.0, -8.6)]


def test_the_items_that_a_survey_stands_for_are_taken():
    survey = {"type": "ComplexItem", "TransectStyleComplexItem": {"Items": [simple(), simple(37.01)]}}
    assert len(read_plan(plan(survey, simple()))) == 4


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
