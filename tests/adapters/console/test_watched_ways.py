"""Ways on the console: the permitted straying of vehicles, and the invariants with their figures."""

import jsonschema
import pytest
from console_clients import SCHEMA
from live_missions import EAST, TOUR, WEST, seen
from recorded import Tape, read

from adapters.recording.schemas import SCHEMAS
from bigactors.recordings import open_recording

WATCHED = f"""mission tour
{TOUR}
BigActor a hosted_at uav0 with_behavior {{ control(MOVE_HOST_TO east0) }}
environment {{ uav0 strays at most 80 m uav0 arrives }}
live {{ on broken assumption: continue }}
check {{ invariant "near": uav0 within 6 km of gcs0 invariant "inside": not possibly uav0 in east0 }}
"""
HALF = (37.01, -8.63)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    path = tmp_path_factory.mktemp("ways") / "r.mcap"
    with Tape(path, WATCHED) as tape:
        tape.turn(0, seen("uav0", WEST, 1000.0))
        tape.turn(1, seen("uav0", WEST, 1001.0))
        tape.turn(5, seen("uav0", HALF, 1005.0))
        tape.turn(5.1, seen("uav0", HALF, 1005.1))
        tape.turn(9, seen("uav0", EAST, 1009.0))
        tape.turn(12, seen("uav0", EAST, 1012.0))
    return path


def at(path, seconds):
    sections = read(path).at(1000.0 + seconds).forward(1000.0 + seconds).sections
    return sections["ways"], sections["invariants"]


def rounded(points):
    return [(round(north, 6), round(east, 6)) for north, east in points]


def test_the_way_to_which_a_vehicle_keeps_is_shown_with_its_bound(recorded):
    ways, _ = at(recorded, 5)
    assert (ways["uav0"]["to"], ways["uav0"]["strays"]) == ("east0", 80.0)
    assert rounded(ways["uav0"]["points"]) == [WEST, EAST]
    ways, _ = at(recorded, 12)
    assert rounded(ways["uav0"]["points"]) == [EAST]


def test_invariants_about_ways_are_shown_with_figures_and_points(recorded):
    _, invariants = at(recorded, 5)
    assert invariants["near"]["holds"]
    assert invariants["near"]["figure"].startswith("uav0 is at most ")
    assert not invariants["inside"]["holds"]
    assert invariants["inside"]["figure"] == "uav0 may be in east0"
    assert len(invariants["inside"]["points"]) == 1


def test_the_vehicles_card_and_the_alert_say_what_is_broken(recorded):
    sections = read(recorded).at(1005.0).forward(1005.0).sections
    assert (
        "broken property: invariant 'inside' is broken: uav0 may be in east0"
        in sections["vehicles"]["uav0"]["why"]
    )
    assert "broken property" in [each["kind"] for each in sections["alarms"].values()]


def test_sections_and_messages_are_as_their_schemas_say(recorded):
    ways, invariants = at(recorded, 5)
    kinds = SCHEMA["$defs"]["sections"]["properties"]
    for name, section in (("ways", ways), ("invariants", invariants)):
        whole = {**kinds[name], "$defs": SCHEMA["$defs"]}
        jsonschema.validate({key: _lists(value) for key, value in section.items()}, whole)
    recording = open_recording(str(recorded))
    for topic in ("ways", "invariants"):
        found = recording.of(topic)
        assert found
        for message in found:
            jsonschema.validate(message.data, SCHEMAS[topic][1])


def test_a_figure_is_recorded_at_most_once_a_second(recorded):
    times = [
        each.time
        for each in open_recording(str(recorded)).of("invariants")
        if each.data["property"] == "near"
    ]
    assert 1005.1 not in times
    assert len(times) >= 2


def _lists(value):
    if isinstance(value, dict):
        return {key: _lists(each) for key, each in value.items()}
    return [_lists(each) for each in value] if isinstance(value, list | tuple) else value
