"""`check --ways`: each flight's length and distances, and the least distance of vehicles under way together."""

import json
from pathlib import Path

import pytest
from pyproj import Geod
from test_json import validator

from checker.properties.corridors import Corridors
from checker.reports.corridors_table import corridors_text

WGS84 = Geod(ellps="WGS84")
TABLE = """\
  ways                           length             from tower0
    uav0 from west0 to east0     6,900 to 7,501 m   866 m
    uav1 from south0 to north0   6,469 to 7,070 m   may cross its border
  vehicles under way together   least distance   where
    uav0, uav1                  may meet         uav0 between west0 and east0, uav1 between south0 and north0
    uav0, uav1, one at rest     2,873 m          uav0 between west0 and east0, uav1 in north0
"""
MISSION = """\
signature {
  kind Location contains UAV
  kind UAV driven
}
world {
  west0: Location = circle (37.1, -8.64) radius 300 m
  east0: Location = circle (37.1, -8.56) radius 300 m
  tower0: Location = circle (37.111, -8.6) radius 200 m
  south0: Location = circle (37.07, -8.6) radius 300 m
  north0: Location = circle (37.13, -8.6) radius 300 m
  uav0: UAV = point (37.1, -8.641)
  uav1: UAV = point (37.069, -8.6)
}
BigActor first hosted_at uav0 with_behavior { control(MOVE_HOST_TO east0) }
BigActor second hosted_at uav1 with_behavior { control(MOVE_HOST_TO north0) }
environment { uav0 arrives  uav1 arrives }
control timed
check { invariant "clear of the tower": not possibly uav0 in tower0 }
"""


@pytest.fixture
def mission(tmp_path):
    path = tmp_path / "ways.mission"
    path.write_text(MISSION)
    return str(path)


def ways_of(bigactors, *words):
    """Check a mission; return the ways in its JSON report, which is as its schema says."""
    _, out, _ = bigactors("check", *words, "--ways", "--json", "-")
    report = json.loads(out)
    validator("report").validate(report)
    return report["ways"]


@pytest.mark.parametrize("engine", ["reference", "fast"])
def test_a_check_lists_the_ways_of_flights(done, mission, engine):
    assert TABLE in done("check", mission, "--ways", "--no-traces", "--engine", engine)


def test_the_figures_are_those_of_pyproj(bigactors):
    found = ways_of(bigactors, "broken_corridor")
    back = next(each for each in found["flights"] if (each["vehicle"], each["to"]) == ("uav1", "west1"))
    _, _, metres = WGS84.inv(-8.56, 37.095, -8.64, 37.095)
    assert back["length"]["at_least"] == pytest.approx(metres, abs=0.1) == back["length"]["at_most"]
    assert [each["side"] for each in back["places"]] == ["inside", "across"]
    there = next(each for each in found["flights"] if each["to"] == "east0")
    gate, end = (-8.6, 37.125), (-8.56, 37.105)
    _, _, metres = WGS84.inv(*gate, *end)
    assert there["legs"][1]["length"]["at_least"] == pytest.approx(metres, abs=0.1)
    assert there["via"] == ["northGate0"]


def test_the_nearest_points_of_two_vehicles_are_as_far_apart_as_the_figure(bigactors):
    for pair in ways_of(bigactors, "corridor")["pairs"]:
        (south, west), (north, east) = pair["points"]
        _, _, metres = WGS84.inv(west, south, east, north)
        assert 0.0 <= metres - pair["at_least"] < 0.6


def test_all_engines_find_the_same_ways(bigactors):
    assert ways_of(bigactors, "crossing", "--engine", "reference") == ways_of(
        bigactors, "crossing", "--engine", "fast"
    )


def test_vehicles_that_are_never_under_way_together_have_no_distance(bigactors):
    pairs = ways_of(bigactors, "crossing_timed")["pairs"]
    assert [pair["both_fly"] for pair in pairs] == [False]


def test_a_place_in_range_has_a_greatest_distance(bigactors):
    flights = ways_of(bigactors, "broken_range_of_radio")["flights"]
    (far,) = (each["at_most"] for flight in flights for each in flight["places"] if each["place"] == "gcs0")
    _, _, metres = WGS84.inv(-8.7, 37.1, -8.59, 37.1)
    assert metres + 100 <= far <= metres + 102  # it strays at most 100 m


def test_without_any_flight_nothing_is_listed():
    assert list(corridors_text(Corridors())) == ["  ways: none; the mission makes no flight"]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("oil_spill",), "with 'control atomic' nothing is under way"),
        (("broken_corridor", "--reduce", "por"), "'por' leaves configurations out"),
        (("broken_corridor", "--reduce", "symmetry"), "'symmetry' visits one of several alike"),
    ],
)
def test_ways_are_refused_where_they_cannot_be_listed(bigactors, words, reason):
    code, _, said = bigactors("check", *words, "--ways")
    assert code == 2
    assert reason in said


def test_a_bound_leaves_ways_out_and_says_so(bigactors):
    found = ways_of(bigactors, "corridor", "--max-configurations", "3")
    assert not found["complete"]
    _, out, _ = bigactors("check", "corridor", "--max-configurations", "8", "--ways")
    assert "\n  ways so far " in out


@pytest.mark.parametrize(
    "check",
    ['ltl "l": [] not possibly uav0 in tower0', 'ctl "c": AG uav0 within 30 km of tower0'],
    ids=["ltl", "ctl"],
)
def test_places_of_properties_of_runs_have_columns(bigactors, mission, check):
    path = Path(mission)
    path.write_text(MISSION[: MISSION.index("check {")] + f"check {{ {check} }}")
    _, text, _ = bigactors("check", mission, "--ways", "--no-traces")
    assert "from tower0" in text


def test_a_flight_is_measured_though_a_place_is_too_far(bigactors, mission):
    path = Path(mission)
    far = "far0: Location = circle (50, 20) radius 300 m\n  uav0: UAV"
    path.write_text(MISSION.replace("uav0: UAV", far).replace("in tower0 }", "in far0 }"))
    _, text, _ = bigactors("check", mission, "--ways", "--no-traces")
    assert "uav0 from west0 to east0     6,900 to 7,501 m   -" in text
    assert "not measured" in text


def test_a_table_without_flights_says_whether_any_was_left_out():
    assert list(corridors_text(Corridors())) == ["  ways: none; the mission makes no flight"]
    assert list(corridors_text(Corridors(complete=False))) == ["  ways: none was measured"]
