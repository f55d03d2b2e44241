"""Worlds from files: what is read of them, what is said of the rest, and how points become places."""

import json

import pytest
from elaborating import elaborated, told
from geojson import collection, feature

from physical import Band, circle, point, write_plan, write_waypoints
from physical.nmea import checksum

SIGNATURE = """signature {
  kind Location contains Location, UAV, Vessel, Helicopter, Waypoint, Station
  kind UAV driven kind Vessel kind Helicopter kind Waypoint kind Station
}
"""
VESSEL = b"!AIVDM,1,1,,A,139>JhOP000eM?@N`o:00001P000,0*53"
AIRCRAFT = b"!AIVDM,1,1,,A,91b3ktBF1J0eM;PN`dH0I0000000,0*27"


def world(text, folder):
    return elaborated(f"{SIGNATURE}world {{ {text} }}", folder)


def mistakes(text, folder):
    return told(f"{SIGNATURE}world {{ {text} }}", folder)


def placed(mission, name):
    return mission.initial.structure.physical.placement(name)


@pytest.fixture
def folder(tmp_path):
    plan = json.loads(write_plan([point(47.39, 8.54), point(47.39, 8.54), point(47.40, 8.55)], 50.0))
    plan["rallyPoints"]["points"] = [[47.4, 8.5, 20]]
    plan["mission"]["items"].append({"type": "ComplexItem", "complexItemType": "StructureScan"})
    (tmp_path / "survey.plan").write_text(json.dumps(plan))
    (tmp_path / "way.waypoints").write_text(write_waypoints([point(47.41, 8.56)], 50.0, point(47.42, 8.56)))
    return tmp_path


def test_what_is_not_read_of_a_file_is_a_note_of_the_verdict(folder):
    mission = world('from "survey.plan"', folder)
    assert mission.notes == (
        "survey.plan: 1 x complex item StructureScan, not read; 1 x rally point, not read",
    )


def test_what_is_left_out_at_the_mission_s_wish_is_counted_too(folder):
    mission = world('from "way.waypoints" within circle (47.41, 8.56) radius 100 m keep Waypoint', folder)
    assert mission.setting.kinds.keys() == {"waypoint1"}
    assert mission.notes == ("way.waypoints: 1 x Waypoint outside the area, not read",)


def test_points_become_places_by_a_radius_and_two_at_one_spot_are_one(folder):
    mission = world('from "survey.plan" keep Waypoint as Location radius 60 m', folder)
    assert mission.setting.kinds == dict.fromkeys(["waypoint0", "waypoint3"], "Location")
    assert placed(mission, "waypoint3").geometry is circle((47.40, 8.55), 60)
    assert placed(mission, "waypoint3").altitude == Band(50, 50)
    told = [f"survey.plan: waypoint{n} lies where waypoint0 does: it is left out" for n in (1, 2)]
    assert list(mission.notes[1:]) == told


def test_a_radius_that_is_none_is_a_mistake(folder):
    (code, message, _), *_ = mistakes('from "way.waypoints" keep Waypoint as Location radius 0 m', folder)
    assert (code, "the radius 0" in message) == ("LS301", True)


def test_a_point_that_has_no_room_hints_at_a_radius(folder):
    text = 'from "way.waypoints" uav0: UAV = point (47.4, 8.5) linked control:uav0 }'
    text += " BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO waypoint1) } check { deadlock_freedom"
    found = mistakes(text.replace('.waypoints"', '.waypoints" keep Waypoint as Location'), folder)
    assert [(code, "radius 50 m" in hint) for code, _, hint in found] == [("LS506", True)]


def test_names_of_two_files_are_told_apart_by_their_beginnings(folder):
    found = mistakes('from "survey.plan" from "way.waypoints"', folder)
    assert [code for code, *_ in found] == ["LS203"]  # one cause, one finding
    assert "as second" in found[0][2]
    mission = world('from "survey.plan" as survey from "way.waypoints" as way limit 1', folder)
    names = [f"survey_waypoint{number}" for number in range(4)]
    assert sorted(mission.setting.kinds) == [*names, "way_waypoint0"]


def test_a_beginning_is_put_before_carriers_too(tmp_path):
    ship, heli = (
        feature("ship", "Carrier", [8.5, 47.4]),
        feature("heli", "Helicopter", [8.5, 47.4], carried_by="ship"),
    )
    (tmp_path / "a.geojson").write_text(collection(ship, heli))
    signature = "signature { kind Carrier carries Helicopter kind Helicopter }"
    mission = elaborated(signature + 'world { from "a.geojson" as a }', tmp_path)
    assert mission.initial.structure.physical.carrier("a_heli") == "a_ship"


def test_a_time_outside_of_a_recording_is_a_mistake_with_its_span(tmp_path):
    pytest.importorskip("pyais")
    body = b"c:1772596000"
    (tmp_path / "x.nmea").write_bytes(b"\\%s*%02X\\%s\n" % (body, checksum(body), VESSEL))
    assert world('from "x.nmea" at "2026-03-04T03:46:41Z"', tmp_path)
    for time in ("2026-03-05T03:46:41Z", "2026-03-04T03:46:39Z"):
        ((code, message, _),) = mistakes(f'from "x.nmea" at "{time}"', tmp_path)
        assert code == "LS306"
        assert "it runs from 2026-03-04T03:46:40Z to 2026-03-04T03:46:40Z" in message


def test_an_aircraft_above_a_place_is_not_in_it(tmp_path):
    pytest.importorskip("pyais")
    (tmp_path / "x.nmea").write_bytes(AIRCRAFT + b"\n" + VESSEL + b"\n")
    text = 'from "x.nmea" keep Vessel, SearchAndRescueAircraft as Helicopter harbour0: Location = box {}'
    for band, is_within in (("altitude 0 m to 50 m", False), ("altitude 0 m to 700 m", True), ("", True)):
        mission = world(text.format(f"(53.56, 9.92) (53.53, 9.94) {band}"), tmp_path)
        assert placed(mission, "mmsi111211505").altitude == Band(600, 600)
        within = mission.initial.structure.logical.parent("mmsi111211505") == "harbour0"
        assert within == is_within


def test_vessels_without_a_time_are_in_the_world_and_that_is_noted(tmp_path):
    pytest.importorskip("pyais")
    lines = (VESSEL, b"$GPZDA,120000.00,04,03,2026,00,00*64", AIRCRAFT)
    (tmp_path / "x.nmea").write_bytes(b"\n".join(lines))
    mission = world('from "x.nmea" keep Vessel, SearchAndRescueAircraft as Helicopter', tmp_path)
    assert len(mission.setting.kinds) == 2
    assert "1 x position without a time" in mission.notes[0]


@pytest.mark.parametrize(
    "shape",
    [
        "box (10, -100) (-10, 100)",
        "box (10, 100) (-10, -100)",
        "polygon (10, -100) (10, 100) (-10, 100) (-10, -100)",
    ],
)
def test_a_place_that_may_be_its_complement_is_refused(tmp_path, shape):
    ((code, message, _),) = mistakes(f"basin: Location = {shape}", tmp_path)
    assert (code, "across the antimeridian" in message) == ("LS301", True)


def test_a_thousand_cells_are_a_world(tmp_path):
    cells = " ".join(
        f"c{i}_{j}: Location = box ({50 + i / 100}, {4 + j / 100}) ({50.009 + i / 100}, {4.009 + j / 100})"
        for i in range(32)
        for j in range(32)
    )
    mission = world(f"{cells} v0: Vessel = point (50.005, 4.005)", tmp_path)
    assert mission.initial.structure.logical.parent("v0") == "c0_0"
