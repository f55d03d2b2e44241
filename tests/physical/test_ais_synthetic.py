"""The recording that the project encodes itself says what it was made to say."""

import runpy
from pathlib import Path

import pytest

from physical.ais_recording import read_recording
from physical.ais_world import world_at
from physical.geometry import box

DATA = Path(__file__).parents[1] / "data"
SYNTHETIC = DATA.parents[1] / "specs" / "missions" / "harbour_watch.nmea"
START = 1586295633.0


@pytest.fixture(scope="module")
def maker():
    return runpy.run_path(str(DATA / "make_synthetic_harbour.py"))


@pytest.fixture(scope="module")
def recording():
    return read_recording(SYNTHETIC)


def in_basin(recording, maker, second):
    return [known.entity for known in world_at(recording, START + second, area=box(*maker["BASIN"]))]


def test_encoding_it_again_gives_the_same_bytes(maker):
    assert maker["encode"]() == SYNTHETIC.read_bytes()


def test_its_first_line_says_that_it_is_synthetic():
    assert SYNTHETIC.read_bytes().startswith(b"# SYNTHETIC")


def test_it_has_eight_vessels_a_buoy_and_a_base_station(recording):
    world = world_at(recording)
    assert sorted(known.kind for known in world) == ["AidToNavigation", "BaseStation", *["Vessel"] * 8]
    assert {known.entity for known in world} >= {"mmsi992449991", "mmsi002449990"}


def test_three_vessels_lie_in_the_basin_and_a_fourth_sails_in(recording, maker):
    lying = ["mmsi244999001", "mmsi244999002", "mmsi244999003"]
    assert in_basin(recording, maker, 30) == lying
    assert in_basin(recording, maker, 102) == lying
    assert in_basin(recording, maker, 103) == [*lying, "mmsi244999004"]


def test_it_tells_the_name_and_type_of_every_vessel(recording, maker):
    told = {}
    for report in recording.statics:
        name, ship_type = told.get(report.mmsi, (None, None))
        told[report.mmsi] = (report.name or name, report.ship_type or ship_type)
    for vessel in maker["VESSELS"]:
        assert told[vessel.mmsi] == (vessel.name, vessel.ship_type)


def test_its_damage_is_counted(recording):
    head, *rows = recording.tally.rows()
    assert head.startswith(
        "224 sentences and other lines: 3 comments, 12 messages with a name or a type of ship, "
    )
    assert head.endswith("4 parts of a message, 78 positions, 120 times")
    assert rows == [
        "1 x checksum missing, not read",
        "1 x checksum wrong, not read",
        "1 x line without a sentence, not read",
        "1 x message too short, not read",
        "1 x part of an incomplete message, not read",
        "1 x payload with characters that AIS does not use, not read",
        "1 x position not available, not read",
    ]
    assert recording.tally.adds_up


def test_its_times_are_those_of_its_receiver(recording):
    assert (recording.positions[0].time, recording.positions[-1].time) == (START, START + 117)
